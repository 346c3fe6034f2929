#include "io/analysis/points.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/excerpt.h"

namespace isorim::io {
namespace {

Eigen::VectorXd vector_of(const Coordinates& coordinates) {
  return Eigen::Map<const Eigen::VectorXd>(coordinates.values.data(),
                                           static_cast<Eigen::Index>(coordinates.values.size()));
}

/// Appends the numbers of a line, separated by commas, semicolons or blanks; false if something else is there.
bool read_numbers(std::string_view line, std::vector<double>& numbers) {
  constexpr std::string_view separators = " \t\r,;";
  while (true) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return true;
    line.remove_prefix(begin);
    double number = 0.0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    if (!line.empty() && separators.find(line.front()) == std::string_view::npos) return false;
    numbers.push_back(number);
  }
}

Eigen::MatrixXd read_points(const std::filesystem::path& path, int dim) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot read the file of points", path.string()));
  std::vector<double> all;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::vector<double> numbers;
    const bool good = read_numbers(std::string_view(line).substr(0, line.find('#')), numbers);
    if (good && numbers.empty()) continue;
    if (!good || numbers.size() != static_cast<std::size_t>(dim)) {
      throw InputError(
          fmt::format("{}:{}: found \"{}\"; expected {} numbers", path.string(), number, excerpt(line), dim));
    }
    all.insert(all.end(), numbers.begin(), numbers.end());
  }
  if (all.empty()) throw InputError(fmt::format("{}: found no points", path.string()));
  return Eigen::Map<const Eigen::MatrixXd>(all.data(), dim, static_cast<Eigen::Index>(all.size()) / dim);
}

}  // namespace

Eigen::MatrixXd probe_points(const ProbeKeys& keys, int dim, const std::filesystem::path& folder) {
  if (!keys.file.empty()) return read_points(folder / keys.file, dim);
  if (!keys.from) {
    Eigen::MatrixXd points(dim, static_cast<Eigen::Index>(keys.points.size()));
    for (std::size_t i = 0; i < keys.points.size(); ++i) {
      points.col(static_cast<Eigen::Index>(i)) = vector_of(keys.points[i]);
    }
    return points;
  }
  const Eigen::VectorXd from = vector_of(*keys.from);
  const Eigen::VectorXd to = vector_of(*keys.to);
  const int count = keys.line_count();
  Eigen::MatrixXd points(dim, count);
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    points.col(i) = (1.0 - share) * from + share * to;
  }
  return points;
}

ImageShape grid_shape(const GridKeys& keys, int dim) {
  ImageShape shape;
  std::copy(keys.counts.begin(), keys.counts.end(), shape.counts.begin());
  const auto set_spacing = [&](int axis, double length) {
    const int steps = shape.counts[static_cast<std::size_t>(axis)] - 1;
    shape.spacing[axis] = steps > 0 ? length / steps : 1.0;
  };
  if (keys.from) {
    shape.origin.head(dim) = vector_of(*keys.from);
    for (int i = 0; i < dim; ++i) {
      set_spacing(i, keys.to->values[static_cast<std::size_t>(i)] - keys.from->values[static_cast<std::size_t>(i)]);
    }
    return shape;
  }
  shape.origin = vector_of(*keys.corner);
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d side = vector_of(keys.sides[static_cast<std::size_t>(i)]);
    shape.directions.col(i) = side.normalized();
    set_spacing(i, side.norm());
  }
  const Eigen::Vector3d u = shape.directions.col(0);
  shape.directions.col(2) = u.cross(Eigen::Vector3d(shape.directions.col(1)));
  return shape;
}

Eigen::MatrixXd grid_points(const ImageShape& shape, int dim) {
  Eigen::MatrixXd points(dim, shape.point_count());
  Eigen::Index column = 0;
  for (int k = 0; k < shape.counts[2]; ++k) {
    for (int j = 0; j < shape.counts[1]; ++j) {
      for (int i = 0; i < shape.counts[0]; ++i) {
        const Eigen::Vector3d steps = shape.spacing.cwiseProduct(Eigen::Vector3d(i, j, k));
        const Eigen::Vector3d point = shape.origin + shape.directions * steps;
        points.col(column++) = point.head(dim);
      }
    }
  }
  return points;
}

}  // namespace isorim::io
