#include "geometry/fitting/point_reduction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::geometry {
namespace {

template <typename Matrix>
void require_finite(const char* what, const Matrix& points) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!points.col(i).allFinite()) {
      throw GeometryError(
          fmt::format("{}: point {} of {} has a coordinate that is not a number", what, i + 1, points.cols()));
    }
  }
}

using Key = std::uint64_t;

/// The key of a cell; keys rise along the rows, row by row.
Key key_of(std::uint32_t column, std::uint32_t row) {
  return (static_cast<Key>(row) << 32U) | column;
}

/// Of a point: its cell's key.
std::vector<Key> cell_keys(const Points<2>& points, const Point2& origin, const Vector2& cell_size) {
  std::vector<Key> keys(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector2 arm = points.col(i) - origin;
    keys[static_cast<std::size_t>(i)] = key_of(static_cast<std::uint32_t>(std::floor(arm.x() / cell_size.x())),
                                               static_cast<std::uint32_t>(std::floor(arm.y() / cell_size.y())));
  }
  return keys;
}

void check_cells(const Points<2>& points, const Vector2& cell_size) {
  if (points.cols() == 0) throw GeometryError("reduction: there are no points");
  require_finite("reduction", points);
  const Vector2 extent = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
  for (int d = 0; d < 2; ++d) {
    if (!(cell_size(d) > 0.0) || !std::isfinite(cell_size(d))) {
      throw GeometryError(fmt::format("reduction: cell size[{}] is {}, it must be positive", d, cell_size(d)));
    }
    if (extent(d) / cell_size(d) >= static_cast<double>(std::numeric_limits<std::int32_t>::max())) {
      throw GeometryError(fmt::format("reduction: cell size[{}] is {}, too small for points that extend over {}", d,
                                      cell_size(d), extent(d)));
    }
  }
}

std::size_t occupied_cells(const Points<2>& points, const Vector2& cell_size) {
  std::vector<Key> keys = cell_keys(points, points.rowwise().minCoeff(), cell_size);
  std::ranges::sort(keys);
  return static_cast<std::size_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
}

}  // namespace

Point3 in_space(const Point2& point, int axis, double position) {
  Point3 result;
  result((axis + 1) % 3) = point.x();
  result((axis + 2) % 3) = point.y();
  result(axis) = position;
  return result;
}

std::vector<Slice> slice_cloud(const Points<3>& cloud, int axis, double thickness) {
  if (axis < 0 || axis > 2) throw GeometryError(fmt::format("slices: the axis is {}, expected 0, 1 or 2", axis));
  if (!(thickness > 0.0) || !std::isfinite(thickness)) {
    throw GeometryError(fmt::format("slices: the thickness is {}, it must be positive", thickness));
  }
  require_finite("slices", cloud);
  if (cloud.cols() == 0) return {};
  const double start = cloud.row(axis).minCoeff() - 0.5 * thickness;
  constexpr double most = 1e6;
  if ((cloud.row(axis).maxCoeff() - start) / thickness > most) {
    throw GeometryError(fmt::format("slices: the thickness is {}, too small for a cloud of height {}", thickness,
                                    cloud.row(axis).maxCoeff() - cloud.row(axis).minCoeff()));
  }
  std::vector<std::vector<int>> slabs;
  for (Eigen::Index i = 0; i < cloud.cols(); ++i) {
    const auto slab = static_cast<std::size_t>((cloud(axis, i) - start) / thickness);
    if (slab >= slabs.size()) slabs.resize(slab + 1);
    slabs[slab].push_back(static_cast<int>(i));
  }
  std::vector<Slice> slices;
  for (std::vector<int>& indices : slabs) {
    if (indices.empty()) continue;
    Slice slice;
    slice.points.resize(2, static_cast<Eigen::Index>(indices.size()));
    double sum = 0.0;
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const Point3 point = cloud.col(indices[k]);
      slice.points.col(static_cast<Eigen::Index>(k)) << point((axis + 1) % 3), point((axis + 2) % 3);
      sum += point(axis) - start;
    }
    slice.position = start + sum / static_cast<double>(indices.size());
    // Points at one height leave no rounding behind.
    const double first = cloud(axis, indices.front());
    if (std::ranges::all_of(indices, [&](int i) { return cloud(axis, i) == first; })) slice.position = first;
    slice.indices = std::move(indices);
    slices.push_back(std::move(slice));
  }
  return slices;
}

ReducedPoints reduce_points(const Points<2>& points, const Vector2& cell_size) {
  check_cells(points, cell_size);
  ReducedPoints reduced;
  reduced.origin = points.rowwise().minCoeff();
  reduced.cell_size = cell_size;
  const std::vector<Key> keys = cell_keys(points, reduced.origin, cell_size);
  std::vector<std::pair<Key, int>> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = {keys[i], static_cast<int>(i)};
  std::ranges::sort(order);
  std::vector<Point2> centroids;
  for (std::size_t begin = 0; begin < order.size();) {
    const Key key = order[begin].first;
    const Eigen::Vector2i cell(static_cast<int>(key & 0xffffffffU), static_cast<int>(key >> 32U));
    const Point2 corner = reduced.origin + cell.cast<double>().cwiseProduct(cell_size);
    Vector2 sum = Vector2::Zero();
    std::size_t end = begin;
    for (; end < order.size() && order[end].first == key; ++end) sum += points.col(order[end].second) - corner;
    const int count = static_cast<int>(end - begin);
    centroids.emplace_back(count == 1 ? Point2(points.col(order[begin].second)) : Point2(corner + sum / count));
    reduced.counts.push_back(count);
    reduced.cells.push_back(cell);
    begin = end;
  }
  reduced.points.resize(2, static_cast<Eigen::Index>(centroids.size()));
  for (std::size_t i = 0; i < centroids.size(); ++i) reduced.points.col(static_cast<Eigen::Index>(i)) = centroids[i];
  return reduced;
}

Vector2 automatic_cell_size(const Points<2>& points, int most) {
  if (points.cols() == 0) throw GeometryError("reduction: there are no points");
  require_finite("reduction", points);
  const double diagonal = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
  if (diagonal == 0.0) throw GeometryError("reduction: all points coincide");
  double size = diagonal / 400.0;
  while (occupied_cells(points, Vector2::Constant(size)) > static_cast<std::size_t>(most)) size *= 2.0;
  return Vector2::Constant(size);
}

}  // namespace isorim::geometry
