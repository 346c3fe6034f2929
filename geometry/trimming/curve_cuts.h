#pragma once

#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/trimming/parameter_rectangle.h"
#include "geometry/vocabulary.h"

/// Cutting parameter curves at lines of constant parameter.
namespace isorim::geometry {

/// A stretch of a curve that stays on one side of a line.
struct CurvePart {
  Interval domain;
  /// -1 below, +1 above; 0: along the line, farther than the tolerance nowhere.
  int side = 0;
};

/// Divides a curve where it passes from one side of the line x_d = value (d = 0: u, 1: v) to the other, at roots exact
/// to rounding. Stretches that leave the line by no more than the tolerance do not divide it. Only whole polynomial
/// segments count as running along the line.
std::vector<CurvePart> parts_about_line(const NurbsCurve<2>& curve, int d, double value, double tolerance);

/// The part of the curve over `piece`; the curve itself, bit for bit, if that is all of it.
NurbsCurve<2> part_of(const NurbsCurve<2>& curve, Interval piece);

/// The straight line, degree 1 on [0, 1].
NurbsCurve<2> straight(const Point2& from, const Point2& to);

Point2 start_of(const NurbsCurve<2>& curve);
Point2 end_of(const NurbsCurve<2>& curve);

/// What remains of a curve inside the open sides of the rectangle: where it leaves the rectangle by more than
/// tolerance() it is replaced by straight lines along the side.
struct ClippedCurve {
  /// The curve itself if nothing was clipped.
  std::vector<NurbsCurve<2>> parts;
  bool is_clipped = false;
  /// How far it left the rectangle: the largest distance, in space, of its control points from the side, taken along
  /// the surface's tangent there.
  double excess = 0.0;
};
ClippedCurve clip_at_open_sides(const NurbsCurve<2>& curve, const ParameterRectangle& rectangle);

}  // namespace isorim::geometry
