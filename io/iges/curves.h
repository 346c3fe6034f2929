#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"
#include "io/iges/parameter_map.h"

/// The curves of IGES as NURBS: conversions of numbers, which know no file. Angles are in radians. All throw
/// GeometryError if the numbers describe no curve.
namespace isorim::io::iges {

/// A curve with the parameter that IGES gives it: the point at parameter t is evaluate(curve, parameters(t)).
struct ParametrisedCurve {
  geometry::NurbsCurve<3> curve;
  ParameterMap parameters;
  /// 0 if the NURBS is exact; else the largest distance found, and what was asked for.
  double deviation = 0.0;
  double tolerance = 0.0;
};

/// The interval of IGES parameters.
geometry::Interval parameter_range(const ParametrisedCurve& curve);
/// Where the parameter map or the curve is not smooth, ends included, in IGES parameters.
std::vector<double> parameter_breakpoints(const ParametrisedCurve& curve);
geometry::Point3 evaluate_at(const ParametrisedCurve& curve, double t);

ParametrisedCurve reverse(const ParametrisedCurve& curve);
ParametrisedCurve transform(const ParametrisedCurve& curve, const geometry::AffineMap<3>& map);

/// 100: counter-clockwise about `centre` in the plane z, parameter the angle, starting in [0, 2 pi). The full circle if
/// the ends coincide. The ends are as written if their distances to the centre agree to rounding; else the radius is
/// that of the start.
ParametrisedCurve arc(double z, const geometry::Point2& centre, const geometry::Point2& start,
                      const geometry::Point2& end);

/// a x^2 + b x y + c y^2 + d x + e y + f = 0.
struct Conic {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
  double d = 0.0;
  double e = 0.0;
  double f = 0.0;
};

/// 104, in the plane z. Which conic it is, is decided by the coefficients. In standard position (axes along x and y,
/// centre or vertex in the origin) the parameter is the standard's: the eccentric angle t of (a cos t, b sin t) or
/// (a sec t, b tan t), a coordinate for parabolas; elsewhere the same about the conic's own axes. Ellipses run
/// counter-clockwise, and once around if the ends coincide.
ParametrisedCurve conic_arc(const Conic& conic, double z, const geometry::Point2& start, const geometry::Point2& end);

/// 110: degree 1 on [0, 1].
ParametrisedCurve line(const geometry::Point3& start, const geometry::Point3& end);

/// 106 (11, 12, 13, 63): degree 1 on 0, 1, .., n - 1. At least two points.
ParametrisedCurve linear_path(const geometry::Points<3>& points);

/// 112: piece i is sum_k coefficients[i].col(k) (t - breakpoints[i])^k on [breakpoints[i], breakpoints[i + 1]]. The
/// degree is that of the highest coefficient that is not 0. Throws if the pieces do not meet.
ParametrisedCurve parametric_spline(std::span<const double> breakpoints,
                                    std::span<const Eigen::Matrix<double, 3, 4>> coefficients);

struct BSplineCurveData {
  int degree = 1;
  std::vector<double> knots;
  std::vector<double> weights;
  geometry::Points<3> points;
  /// The part of the domain that is meant. Empty or outside the domain: all of it.
  geometry::Interval range;
};

/// Clamped, every breakpoint with the multiplicity of the degree: Bézier pieces end to end.
geometry::KnotVector piecewise_knots(int degree, std::span<const double> breakpoints);

/// What two equal-sounding statements of a file disagree on; in words, for a warning.
using Remark = std::optional<std::string>;

/// `meant` as far as it lies in `domain`; all of the domain, with a remark, if the two contradict each other.
geometry::Interval meant_range(const geometry::Interval& meant, const geometry::Interval& domain, Remark& remark);

/// 126: knots, weights and points as written unless `range` is a part of the domain.
ParametrisedCurve b_spline(const BSplineCurveData& data, Remark& remark);

/// 102: the parameters follow one another from 0. Pieces that run backwards are turned. Throws if the ends of
/// neighbours are farther apart than `tolerance`.
ParametrisedCurve composite(std::span<const ParametrisedCurve> pieces, double tolerance);

/// 130. distance: the offset at a parameter of the base curve.
struct OffsetCurveData {
  geometry::Vector3 normal = geometry::Vector3::UnitZ();
  std::function<double(double)> distance;
  geometry::Interval range;
};

/// base(t) + distance(t) normal x tangent(t), for t in the range, fitted to the tolerance. Throws if the base curve has
/// a corner, where its offset would be in pieces, or a point without tangent.
ParametrisedCurve offset_curve(const ParametrisedCurve& base, const OffsetCurveData& data, double tolerance);

/// The curve as a spline whose parameter is that of IGES over `range`, fitted to the tolerance; exact if the two
/// parameters are affine to each other.
ParametrisedCurve in_own_parameter(const ParametrisedCurve& curve, geometry::Interval range, double tolerance);

}  // namespace isorim::io::iges
