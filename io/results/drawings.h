#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/case/case_file.h"
#include "io/drawing/drawing.h"
#include "io/results/compute.h"

/// The workshop drawings of a case: [drawings] and [moulds].
namespace isorim::io {

/// Writes one sheet as STEM.pdf, STEM.svg and STEM.dxf, those of them that the keys ask for, the PDF whole or tiled.
/// `scale`: true lengths over those of the sheet; the DXF file is in true size.
void write_sheet(const std::filesystem::path& folder, const std::string& stem, const drawing::Sheet& sheet,
                 const DrawingKeys& keys, double scale = 1.0);

/// Writes what the case asks for into the folder: overview.* of a propeller, moulds. Returns what the user should know.
std::vector<std::string> write_drawings(const std::filesystem::path& folder, const CaseFile& file,
                                        const AnyModel& model, int threads);

}  // namespace isorim::io
