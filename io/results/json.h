#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/results/report.h"

namespace isorim::io {

/// The report as JSON: the keys are a contract with the outside (adding is free, renaming breaks). Reals have the 17
/// digits that give the same bits back; what is not finite is null.
std::string to_json(const Report& report);

/// Writes results.json; whole or not at all. Throws InputError with the path if it cannot.
void write_json(const std::filesystem::path& path, const Report& report);

/// One case of `isorim verify`.
struct VerifiedCase {
  std::string file;
  std::string title;
  /// The expectations, if the case ran.
  std::vector<ExpectationResult> expectations;
  /// Seconds.
  double time = 0.0;
  RunStatus status = RunStatus::ok;
  /// Why it did not run.
  std::string failure;
  /// The exit status that the case alone would give.
  int exit_status = 0;
};

/// { "isorim", "status", "cases": [ { "file", "case", "status", "time", "expectations": [..] } ] }.
std::string verification_json(const std::vector<VerifiedCase>& cases);

}  // namespace isorim::io
