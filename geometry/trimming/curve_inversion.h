#pragma once

#include <optional>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/trimming/parameter_rectangle.h"
#include "geometry/trimming/point_inversion.h"
#include "geometry/vocabulary.h"

/// Parameter curves of curves in space.
namespace isorim::geometry {

struct InversionOptions {
  /// Of the face, in the units of the shape.
  double size = 1.0;
  /// How far the image of a fitted curve may lie from the nearest points of the surface.
  double tolerance = 1e-12;
  /// Curves farther from the surface are given up.
  double largest_deviation = 1e-3;
};

struct InvertedCurve {
  /// Continuous, in the direction of the curve in space; at any period of the closed directions and perhaps over its
  /// end, never outside the open sides. More than one if the curve runs through a pole: each ends there, on the pole's
  /// side. None if the curve was given up, its deviation being too large, or if it never leaves a pole.
  std::vector<NurbsCurve<2>> curves;
  /// The largest distance of the curve in space from the surface, and where it is.
  double deviation = 0.0;
  Point3 farthest = Point3::Zero();
  /// The largest distance of images from nearest points, where larger than the tolerance.
  double misfit = 0.0;
};

/// Inverts curves onto one surface.
///
/// A surface that is an affine image of its parameters gives the affine image of the curve: the same degree, knots and
/// weights. Curves along lines of constant parameter give straight lines: exact as sets of points, with another
/// parameter. Others are followed along the surface from point to point, divided where they cross knot lines of the
/// surface, and interpolated by polynomial Bézier pieces of degree 9 in the curve's own parameter at Chebyshev points,
/// bisected until the image lies within the tolerance of the nearest points.
class CurveInverter {
 public:
  CurveInverter(const ParameterRectangle& rectangle, const InversionOptions& options);

  InvertedCurve invert(const NurbsCurve<3>& curve) const;

 private:
  std::optional<NurbsCurve<2>> affine_image(const NurbsCurve<3>& curve) const;
  void append(const NurbsCurve<3>& curve, int depth, InvertedCurve& result) const;

  const ParameterRectangle& rectangle_;
  InversionOptions options_;
  PointInverter points_;
  /// (u, v) = parameters_of_(x) if the surface is affine.
  struct Affine {
    Point3 origin;
    Point2 parameters;
    Eigen::Matrix<double, 2, 3> inverse;
  };
  std::optional<Affine> affine_;
};

}  // namespace isorim::geometry
