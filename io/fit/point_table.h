#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::io {

/// The points of a file of text.
struct PointTable {
  /// As messages call it.
  std::string name;
  /// 3 x n; z = 0 where the file gives none.
  geometry::Points<3> points;
  bool has_z = false;
  /// One a point if the file gives weights, else empty.
  std::vector<double> weights;
  /// Of each point, from 1.
  std::vector<int> lines;
};

/// Reads lines of numbers: x, y or x, y, z or x, y, z, weight. Separators are commas, semicolons, tabs or blanks, the
/// same in the whole file. Lines that begin with #, % or // and empty lines are passed over; a byte order mark and both
/// kinds of line ends are taken. A first line of names (x, y, z, w or weight; units in brackets and case play no part)
/// says which columns are which; other columns are passed over then.
///
/// Throws InputError "name:line: ..." for decimal commas, what is no finite number, a line of another number of
/// columns, names without x and y, a weight that is not positive, and a file without points.
PointTable parse_points(std::string_view text, const std::string& name);

/// Throws InputError if the file cannot be read, or as parse_points().
PointTable read_points(const std::filesystem::path& path);

/// The same for a file of one column, whose line of names may say anything. Throws also if a number is not positive.
std::vector<double> parse_weights(std::string_view text, const std::string& name);
std::vector<double> read_weights(const std::filesystem::path& path);

}  // namespace isorim::io
