#pragma once

#include <filesystem>

#include "io/case/case_file.h"
#include "io/results/compute.h"

namespace isorim::io {

/// Writes everything that a case asks for into a folder, which is made if need be: pictures, fields, drawings, tables
/// and results. results.json comes last, so whoever finds it finds the rest as well. The time that it takes, and what
/// the user should know of the drawings, go into the report first. The results.json of an earlier run is removed before
/// anything is written.
void write_case_files(const std::filesystem::path& folder, const CaseFile& file, const AnyModel& model,
                      const Convergence& study, Report& report);

}  // namespace isorim::io
