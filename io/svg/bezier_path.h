#pragma once

#include <string>
#include <vector>

#include "geometry/nurbs/curve.h"

namespace isorim::io::svg {

/// A polynomial Bézier segment of degree 1, 2 or 3: 2 x (degree + 1) points.
using PathSegment = geometry::Points<2>;

/// The curve as segments that SVG can draw, in its own units. Polynomial Bézier segments of degree 3 at most are
/// returned as they are; others as cubics with the same ends and end derivatives, halved until they are within
/// `tolerance` of the curve at 16 parameters each (an upper bound of the distance, since equal parameters are
/// compared).
std::vector<PathSegment> path_segments(const geometry::NurbsCurve<2>& curve, double tolerance);

/// "L x y", "Q ..." or "C ..." for a segment in pixels, from its second point on.
std::string path_command(const PathSegment& segment);

}  // namespace isorim::io::svg
