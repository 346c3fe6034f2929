#pragma once

#include <vector>

#include "geometry/vocabulary.h"

/// Short tours through points of the plane. Private to the sources of this folder.
namespace isorim::geometry {

struct TourOptions {
  /// A step costs its length, but never more than this: the way out of an open curve, taken once.
  double largest_cost = 0.0;
  /// A tour is parted only into loops of at least this many points.
  int least_points = 8;
};

/// Closed tours that together visit every point once, indices of columns: a short tour by greedy matching and 2-opt and
/// or-opt moves over neighbour lists (J. L. Bentley, Fast algorithms for geometric traveling salesman problems, ORSA
/// Journal on Computing 4, 1992), then parted as long as two loops are shorter than one and the area of each exceeds
/// three quarters of its mean step times its length, without which the tips of thin shapes would be cut off.
/// Deterministic. At least three points.
std::vector<std::vector<int>> short_tours(const Points<2>& points, const TourOptions& options);

}  // namespace isorim::geometry
