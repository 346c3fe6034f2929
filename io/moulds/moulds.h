#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/case/case_file.h"
#include "io/moulds/mould_stack.h"
#include "io/results/report.h"

/// [moulds] of a case.
namespace isorim::io {

/// The body that is moulded, in mm: of a propeller its first blade, along z whatever the shape's transform, as far as
/// it stands out of the hub; otherwise the whole boundary.
MouldBody mould_body(const CaseFile& file, const geometry::Boundary<3>& boundary);

/// Writes into the folder, in the formats of [drawings]: moulds.csv; moulds.pdf, one sheet a board; moulds.dxf and
/// moulds.svg with all sections over each other; and moulds/NUMBER.svg, one a board. Returns what the user should know:
/// how many boards there are, planes that only touch the body or fail.
std::vector<std::string> write_moulds(const std::filesystem::path& folder, const CaseFile& file,
                                      const geometry::Boundary<3>& boundary, int threads);

}  // namespace isorim::io
