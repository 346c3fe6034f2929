#pragma once

#include <optional>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

/// Curves in the parameters of a surface, lifted into space: t -> S(c(t)).
namespace isorim::geometry {

Point3 lifted_point(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, double t);

/// Where a lifted curve is and what the surface does there. Limits at breakpoints as for curves and surfaces.
struct LiftedJet {
  Point2 uv;
  Point3 point;
  /// d S(c(t)) / dt.
  Vector3 tangent;
  /// S_u x S_v.
  Vector3 normal;
};
LiftedJet lifted_jet(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, double t);

/// The lifted curve as a NURBS curve with the parameter of the pcurve, to rounding, where it is one of the pcurve's or
/// the surface's degree: if the surface is an affine image of its parameters, or if the pcurve is a segment of a line
/// u = constant or v = constant. Empty otherwise.
std::optional<NurbsCurve<3>> exact_lift(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve);

/// A NURBS curve that stays within `tolerance` (> 0, in the units of the shape) of the lifted curve at equal
/// parameters: exact_lift() if there is one, else cubic Hermite segments, bisected until they agree to half the
/// tolerance at three inner points each (or have become shorter than 1e-9 of their span, as at a jump of the surface).
/// The error of a segment falls as the fourth power of its length. Throws GeometryError if the tolerance is not
/// positive.
NurbsCurve<3> lift(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, double tolerance);

}  // namespace isorim::geometry
