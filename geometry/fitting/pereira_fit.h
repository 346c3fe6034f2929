#pragma once

#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// L. R. Pereira's fit of a closed section by a cubic (dissertation, Universidade Federal de Uberlândia, 2014, sections
/// 5.2 and 5.3), as the published program does it, so that published control points can be reproduced and compared:
///
/// 1. chord-length parameters along the open polygon Q0 .. Qj (without the closing chord);
/// 2. weighted least squares on a clamped knot vector that averages parameters (eqs. 3.52 and 3.53, with one knot
///    interval less than Piegl & Tiller's rule, so that the last span is about twice as long);
/// 3. P1 and P2 are moved to their feet on a line through Q0, which is drawn to the point that has the coordinates of
///    the derivative vector at the curve's end (the text means the direction of the derivative at its start);
/// 4. the control points are used again on a periodic knot vector (eqs. 3.54 and 3.55).
///
/// The closed curve is therefore not the least-squares solution; FitMethod::fixed_knots is.
namespace isorim::geometry {

/// The derivative that gives the line of step 3: table 5.1 was made with the first, the published control points and
/// their start points with the second.
enum class PereiraTangent { of_start, of_end };

/// What stands in table 5.1 for one point that a curve may start from.
struct PereiraStart {
  /// Index of the point.
  int point = 0;
  /// Distances of P1 and P2 from the line.
  double first_distance = 0.0;
  double second_distance = 0.0;
  int control_points = 0;

  double sum() const { return first_distance + second_distance; }
};

/// The table for all aligned points (see section_rules.h), in their order; the start point of the method is the one
/// with the smallest sum. control_points 0: by the inversion rule, for each start anew. Weights: one a point.
std::vector<PereiraStart> pereira_starts(const Points<2>& points, const std::vector<double>& weights,
                                         int control_points = 0, PereiraTangent tangent = PereiraTangent::of_end);

struct PereiraFit {
  NurbsCurve<2> curve;
  /// 2 x n: the control points of the clamped fit with P1 and P2 moved.
  Points<2> control_points;
};

/// The closed cubic through the points in the given order, the first one being the start. Throws GeometryError if
/// control_points is less than 5 or not less than the number of points, or knots leave a control point without data.
PereiraFit pereira_fit(const Points<2>& points, const std::vector<double>& weights, int control_points);

}  // namespace isorim::geometry
