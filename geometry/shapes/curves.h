#pragma once

#include <numbers>

#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// Exact rational curves. Angles are in radians, counter-clockwise from the x axis; lengths in the units of the
/// shape. Every function throws GeometryError naming the parameter and its value if a radius is not positive or a
/// number is not finite.
namespace isorim::geometry {

/// cos and sin of an angle; exactly 0 and +-1 where the angle is a multiple of a quarter turn to within rounding.
struct CosineSine {
  double cosine = 1.0;
  double sine = 0.0;
};
CosineSine cosine_sine(double angle);

/// The arc of the unit circle about the origin from angle `from` to angle `to`, as the fewest equal rational quadratic
/// pieces of at most a quarter turn, on knots 0, 1/n, ..., 1 of multiplicity 2; weights 1 and cos(half a piece)
/// (Piegl & Tiller, A7.1). to < from runs clockwise. Throws if |to - from| is zero or exceeds a full turn by more than
/// rounding; a full turn ends exactly where it starts.
NurbsCurve<2> unit_arc(double from, double to);

/// A circular arc from angle `from` to angle `to`, divided as unit_arc().
NurbsCurve<2> circular_arc(double radius, const Point2& centre, double from, double to);

/// The full circle, counter-clockwise from (radius, 0) + centre: four quarter arcs on knots 0, .25, .5, .75, 1.
NurbsCurve<2> circle_curve(double radius, const Point2& centre = Point2::Zero());

/// centre + R(rotation) (a cos t, b sin t), t from `from` to `to`: the angles are those of the parametric (eccentric)
/// form, not polar angles.
NurbsCurve<2> ellipse_arc(const Vector2& radii, const Point2& centre, double rotation, double from, double to);

/// The full ellipse, counter-clockwise; `rotation` turns the first radius away from the x axis.
NurbsCurve<2> ellipse_curve(const Vector2& radii, const Point2& centre = Point2::Zero(), double rotation = 0.0);

/// Degree 1 on [0, 1]. Throws if the ends coincide.
template <int Dim>
NurbsCurve<Dim> line_segment(const Point<Dim>& from, const Point<Dim>& to);

/// Degree 1 through the points (columns, at least two) on the knots 0, 1/n, ..., 1. Throws if neighbours coincide.
template <int Dim>
NurbsCurve<Dim> polyline(const Points<Dim>& points);

}  // namespace isorim::geometry
