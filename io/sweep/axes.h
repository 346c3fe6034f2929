#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/case/complaints.h"
#include "io/sweep/plan.h"

/// The axes of a sweep and their combinations; for plan.cpp.
namespace isorim::io {

/// Columns that vary together.
struct SweepAxis {
  std::vector<SweepColumn> columns;
  /// One value a column; empty if the axis is a range to be sampled.
  std::vector<std::vector<Value>> entries;
  double from = 0.0;
  double to = 0.0;
  Spacing spacing = Spacing::linear;
  KeyPlace where;
};

/// The axes in the order of the file, parameters before rows. Texts of CSV files are appended to `files`.
std::vector<SweepAxis> make_axes(const SweepKeys& keys, const std::filesystem::path& folder, Complaints& complaints,
                                 std::vector<std::pair<std::string, std::string>>& files);

/// The cases without derived values, and those of them that between them show every value of every axis.
struct Combinations {
  std::vector<SweepCase> cases;
  std::vector<std::size_t> representatives;
};
Combinations combine(const std::vector<SweepAxis>& axes, const SweepKeys& keys, Complaints& complaints);

/// "geometry.size.0" is called "size_0".
std::string name_of_key(const std::string& key);

}  // namespace isorim::io
