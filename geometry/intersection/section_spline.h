#pragma once

#include <vector>

#include "geometry/intersection/plane_section.h"
#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// A section curve as one B-spline, for drawings, CAD files and lofts.
struct SectionSpline {
  /// Degree 5, parametrised by arc length (to about the fit's tolerance), in the coordinates of the plane. A closed
  /// curve without corners is periodic (unclamped, the last 5 control points repeat the first), any other clamped, a
  /// closed one with its first corner at both ends.
  NurbsCurve<2> curve;
  bool is_periodic = false;
  /// Parameters of the corners; those of a closed curve with the start among them, without the end.
  std::vector<double> corners;
  double length = 0.0;
  /// The largest distance from the section curve that was found, at equal arc lengths.
  double error = 0.0;
  /// Or the error is that of the gaps of the section. If not, segments of 1e-7 of the length do not meet it.
  bool tolerance_met = true;
};

struct SectionSplineOptions {
  /// In the units of the shape; must be positive.
  double tolerance = 1e-8;
  /// Pieces that meet at a larger angle (radians) have a corner there.
  double corner_angle = 1e-6;
};

/// Between corners and jumps of the curvature a quintic spline by least squares on as few simple knots as the tolerance
/// takes (smooth_run.h), so C4; it starts from quintic Hermite interpolation of position, tangent and curvature at
/// points of the arc length, bisected until the distance between them is at most half the tolerance. Where that alone
/// does it with fewer control points (straight parts, gaps as wide as the tolerance) it stays: C2, knots of
/// multiplicity
/// 3. The spline is C1 where the curvature of the section jumps (4), C0 at corners (5). The error of a segment falls as
/// the sixth power of its length. Across the gaps of the section, which `error` knows of, the spline takes the middle.
/// Throws GeometryError if the tolerance is not positive or the curve is a point.
SectionSpline fit_section(const SectionCurve& curve, const SectionSplineOptions& options);

NurbsCurve<3> to_space(const NurbsCurve<2>& curve, const PlaneFrame& frame);

/// Points of a section curve in their order, dense enough that a polyline through them stays within `sag` (in the units
/// of the shape) of the curve: both ends of each piece and parameters between. A closed curve ends with its first
/// point.
struct SectionSample {
  SectionPoint place;
  /// In the coordinates of the plane.
  Point2 plane;
  /// Unit; zero where the derivative vanishes.
  Vector3 tangent;
};
std::vector<SectionSample> sample_section(const SectionCurve& curve, const PlaneFrame& frame, double sag);

}  // namespace isorim::geometry
