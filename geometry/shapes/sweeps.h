#pragma once

#include <span>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/shapes/transforms.h"
#include "geometry/vocabulary.h"

/// Surfaces made by moving, turning or joining curves. All are exact, in the rational form.
namespace isorim::geometry {

/// The surface of revolution of a curve: u turns from the curve itself (u = 0) by `angle`, right-handed about the axis,
/// in the quadratic rational pieces of unit_arc(); v runs along the curve (Piegl & Tiller, A8.1). A control point on
/// the axis (to within rounding) stays there for all u: the edge degenerates.
///
/// With r the distance from the axis and z along it, the natural normal points away from what lies on the left of the
/// curve in the (r, z) plane: outward if the curve runs counter-clockwise about the material there.
///
/// Throws GeometryError if the axis direction is zero, the angle is outside (0, 2 pi], or the whole curve lies on the
/// axis.
NurbsSurface<3> revolve(const NurbsCurve<3>& curve, const Axis& axis, double angle);

/// u along the curve, v in [0, 1] along `by`; the natural normal is C' x by. Throws GeometryError if `by` is zero.
NurbsSurface<3> extrude(const NurbsCurve<3>& curve, const Vector3& by);

/// The straight lines from the apex to the rim: u in [0, 1] from the apex to the rim, v along the rim. Polynomial of
/// degree 1 in u whatever the rim. Jacobian in the plane: u (C - apex) x C', positive if the rim runs counter-clockwise
/// as seen from the apex. This is how flat discs are filled: the area element is linear in u and in v only as rational
/// as the rim itself, so integrals over the disc cost what those over the rim cost (the five-patch disc without a pole
/// has rational terms in both directions and needs about the square of the points for the same error).
template <int Dim>
NurbsSurface<Dim> fan(const NurbsCurve<Dim>& rim, const Point<Dim>& apex);

/// The same curves on one knot vector over [0, 1]: degrees raised to the largest, knots merged (those that differ by
/// rounding are taken as one), clamped.
template <int Dim>
std::vector<NurbsCurve<Dim>> make_compatible(std::span<const NurbsCurve<Dim>> curves);

/// u along the curves (made compatible), v in [0, 1] from the first to the second along straight lines.
NurbsSurface<3> ruled(const NurbsCurve<3>& first, const NurbsCurve<3>& second);

struct LoftOptions {
  /// Degree across the sections, at least 1; lowered to the number of sections minus one. 3 gives continuous curvature.
  int degree = 3;
  /// The last section is followed by the first. v is periodic then, knots lie at the parameters of the sections, and
  /// the degree must be odd and at most the number of sections; it is not lowered. The surface comes back clamped.
  bool closed = false;
};

/// The surface through the sections, u along them, v across (skinning: Piegl & Tiller, section 10.3): the sections are
/// made compatible, then their homogeneous control points are interpolated at chord-length parameters averaged over the
/// control points, with averaged knots (eq. 9.8). Each section is reproduced exactly, as a parameter line. Throws
/// GeometryError for fewer than two sections, for neighbours that coincide, and if the interpolation makes a weight
/// non-positive (sections whose weights differ much: fewer sections or degree 1 help).
NurbsSurface<3> loft(std::span<const NurbsCurve<3>> sections, const LoftOptions& options = {});

}  // namespace isorim::geometry
