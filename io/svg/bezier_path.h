#pragma once

#include <limits>
#include <string>
#include <vector>

#include "geometry/nurbs/curve.h"

namespace isorim::io::svg {

/// Curves of which each starts where the one before ends; closed if the last ends where the first starts.
using Chain = std::vector<geometry::NurbsCurve<2>>;

/// The smallest axis-parallel rectangle round what was added; empty (lower > upper) before.
struct Bounds {
  geometry::Point2 lower = geometry::Point2::Constant(std::numeric_limits<double>::infinity());
  geometry::Point2 upper = -lower;

  /// 2 x n, n > 0.
  void add(const geometry::Points<2>& points) {
    lower = lower.cwiseMin(points.rowwise().minCoeff());
    upper = upper.cwiseMax(points.rowwise().maxCoeff());
  }
  bool is_empty() const { return !(lower.array() <= upper.array()).all(); }
  double diagonal() const { return (upper - lower).norm(); }
};

/// A polynomial Bézier segment of degree 1, 2 or 3: 2 x (degree + 1) points.
using PathSegment = geometry::Points<2>;

/// The curve as segments that SVG can draw, in its own units. Polynomial Bézier segments of degree 3 at most are
/// returned as they are; others as cubics with the same ends and end derivatives, halved until they are within
/// `tolerance` of the curve at 16 parameters each (an upper bound of the distance, since equal parameters are
/// compared).
std::vector<PathSegment> path_segments(const geometry::NurbsCurve<2>& curve, double tolerance);

/// Those of all curves of a chain.
std::vector<PathSegment> path_segments(const Chain& chain, double tolerance);

/// The segment's point at t in [0, 1].
geometry::Point2 evaluate_segment(PathSegment segment, double t);

/// Adds the segment's own extent, not that of its control points.
void add_extent(const PathSegment& segment, Bounds& bounds);

/// "L x y", "Q ..." or "C ..." for a segment from its second point on, with so many decimals.
std::string path_command(const PathSegment& segment, int decimals = 3);

}  // namespace isorim::io::svg
