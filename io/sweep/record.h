#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/results/report.h"

namespace isorim::io {

/// What is known of a case that has ended, well or not.
struct CaseRecord {
  /// From 0.
  std::size_t index = 0;
  /// "ok", "expectation_missed", "tolerance_not_reached", "failed", "crashed" or "timed_out".
  std::string status;
  /// What the case would give by itself: 0, 1, 2 or 3.
  int exit_status = 0;
  /// Why it is not "ok".
  std::string message;
  int expectations_met = 0;
  int expectations_missed = 0;
  double seconds = 0.0;
  /// Bytes; the largest resident size of its process.
  std::int64_t peak_memory = 0;
  /// Names of the files that the case has written, and their folder from that of the sweep. Empty if there are none.
  std::vector<std::string> files;
  std::string folder;
  /// Every number of results.json by its name; no value for what is not finite.
  std::vector<std::pair<std::string, std::optional<double>>> results;

  bool has_results() const {
    return status == "ok" || status == "expectation_missed" || status == "tolerance_not_reached";
  }
  bool is_failed() const { return !has_results(); }
};

/// The numbers and booleans of a report, named by their paths in results.json with dots, entries of lists counted from
/// 0
/// ("analysis.errors.boundary_l2", "geometry.elements"). What stands below "properties" and "integrals" goes without
/// these and without "value": "volume", "volume.error", "centroid.0". Of lists with more than 16 entries only those
/// below one of the `chosen` names are taken.
std::vector<std::pair<std::string, std::optional<double>>> flat_results(const Report& report,
                                                                        const std::vector<std::string>& chosen);

/// On one line, without its end.
std::string record_json(const CaseRecord& record);
/// Throws InputError for what record_json() has not made.
CaseRecord parse_record(std::string_view text);

}  // namespace isorim::io
