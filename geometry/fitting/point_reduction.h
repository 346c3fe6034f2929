#pragma once

#include <vector>

#include "geometry/vocabulary.h"

/// From the points that a scanner delivers to the few that say what the section is: slices of a cloud, and the
/// centroids of the cells of a grid.
namespace isorim::geometry {

/// The points of a cloud that lie in a slab across an axis, in the coordinates of its plane.
struct Slice {
  /// Mean coordinate of the points along the axis.
  double position = 0.0;
  /// 2 x n. Axis x: (y, z), y: (z, x), z: (x, y), so that with the axis they are right-handed.
  Points<2> points;
  /// Of the points among those of the cloud, in their order.
  std::vector<int> indices;
};

/// The slabs [start + k thickness, start + (k + 1) thickness) that hold points, along the axis (0, 1, 2 for x, y, z),
/// in rising order; `start` is the least coordinate minus half a thickness, so sections scanned at equal steps of one
/// thickness lie in the middle of their slabs. Throws GeometryError if a coordinate is not finite, the axis is none of
/// the three, the thickness is not positive and finite, or more than 10^6 slabs would be needed.
std::vector<Slice> slice_cloud(const Points<3>& cloud, int axis, double thickness);

/// The point of the plane of a slice, in space.
Point3 in_space(const Point2& point, int axis, double position);

/// Centroids of cells, and how many points each stands for.
struct ReducedPoints {
  /// 2 x n.
  Points<2> points;
  std::vector<int> counts;
  /// The cell (column, row) of each, counted from `origin`.
  std::vector<Eigen::Vector2i> cells;
  Point2 origin = Point2::Zero();
  Vector2 cell_size = Vector2::Zero();
};

/// The points of each cell of a grid of dx by dy replaced by their centroid, each point of unit mass, cells by rows
/// (L. R. Pereira, thesis, UFU 2014, eq. 4.1). The grid starts at the least coordinates. Coordinates are summed from
/// the cell's corner, so the centroids are right to rounding of the cell. O(n log n). Throws GeometryError if there
/// are no points, a coordinate is not finite, or a size is not positive or asks for more than 2^31 columns or rows.
ReducedPoints reduce_points(const Points<2>& points, const Vector2& cell_size);

/// A cell for points of which only the shape of the section is known: square, a 400th of the diagonal of the bounding
/// box, doubled while more than `most` cells are occupied. Throws as reduce_points(), and if all points coincide.
Vector2 automatic_cell_size(const Points<2>& points, int most = 6000);

}  // namespace isorim::geometry
