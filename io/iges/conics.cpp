#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "io/iges/curves.h"

/// Circles, ellipses, parabolas and hyperbolas.
namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::HomogeneousPoints;
using geometry::Interval;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;
using geometry::Vector2;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
/// Ends of an arc that are nearer than this, in radians, are one point of a full turn.
constexpr double same_angle = 1e-8;

/// From the plane of the conic's axes to the plane of definition.
struct Placement {
  Point2 centre = Point2::Zero();
  Vector2 first_axis = Vector2::UnitX();

  Point2 inward(const Point2& p) const {
    const Vector2 d = p - centre;
    return {first_axis.dot(d), first_axis.x() * d.y() - first_axis.y() * d.x()};
  }
  AffineMap<2> outward() const {
    AffineMap<2> map;
    map.linear << first_axis.x(), -first_axis.y(), first_axis.y(), first_axis.x();
    map.translation = centre;
    return map;
  }
  bool is_standard() const { return centre == Point2::Zero() && first_axis == Vector2(1.0, 0.0); }
};

NurbsCurve<3> in_plane(const NurbsCurve<2>& curve, double z) {
  HomogeneousPoints<3> net(4, curve.homogeneous().cols());
  net << curve.homogeneous().topRows<2>(), z * curve.homogeneous().row(2), curve.homogeneous().row(2);
  return {curve.knots(), std::move(net)};
}

NurbsCurve<2> placed(const NurbsCurve<2>& curve, const Placement& placement) {
  return placement.is_standard() ? curve : transform(curve, placement.outward());
}

/// Puts the ends where they are written if they miss that by rounding only.
NurbsCurve<2> with_ends(const NurbsCurve<2>& curve, const Point2& start, const Point2& end) {
  HomogeneousPoints<2> net = curve.homogeneous();
  const double size = curve.control_points().cwiseAbs().maxCoeff();
  const auto put = [&](Eigen::Index column, const Point2& point) {
    const double weight = net(2, column);
    if ((net.col(column).head<2>() / weight - point).norm() <= 8.0 * std::numeric_limits<double>::epsilon() * size)
      net.col(column).head<2>() = weight * point;
  };
  put(0, start);
  put(net.cols() - 1, end);
  return {curve.knots(), std::move(net)};
}

double in_turn(double angle) {
  return angle < 0.0 ? std::min(angle + two_pi, std::nextafter(two_pi, 0.0)) : angle;
}

/// The arc of the ellipse (a cos t, b sin t) between two of its points, counter-clockwise.
ParametrisedCurve ellipse_arc(const Vector2& radii, const Placement& placement, double z, const Point2& start,
                              const Point2& end) {
  const auto angle = [&](const Point2& point) {
    const Point2 p = placement.inward(point).cwiseQuotient(radii);
    if (p.squaredNorm() == 0.0) throw GeometryError("conic arc: an end lies in the centre");
    return in_turn(std::atan2(p.y(), p.x()));
  };
  const double first = angle(start);
  double sweep = angle(end) - first;
  if (sweep < 0.0) sweep += two_pi;
  const bool full = sweep < same_angle || sweep > two_pi * (1.0 - 1e-15);
  const double last = first + (full ? two_pi : sweep);
  AffineMap<2> scale;
  scale.linear = radii.asDiagonal();
  const NurbsCurve<2> unit = geometry::unit_arc(first, last);
  const int pieces = static_cast<int>(unit.homogeneous().cols() - 1) / 2;
  const NurbsCurve<2> curve = with_ends(placed(transform(unit, scale), placement), start, full ? start : end);
  return {in_plane(curve, z), ParameterMap::arc({first, last}, pieces, 1.0, full)};
}

/// The arc of x = a sec t, y = b tan t (a < 0: the left branch) between two of its points.
ParametrisedCurve hyperbola_arc(const Vector2& radii, const Placement& placement, double z, const Point2& start,
                                const Point2& end) {
  // tan(t / 2), which is also the parameter of the NURBS, from tan t.
  const auto half_tangent = [&](const Point2& p) {
    const double tangent = placement.inward(p).y() / radii.y();
    return tangent / (1.0 + std::hypot(1.0, tangent));
  };
  const double first = half_tangent(start);
  const double last = half_tangent(end);
  if (first == last) throw GeometryError("conic arc: both ends of the hyperbola's arc are one point");
  const double mean = 0.5 * (first + last);
  HomogeneousPoints<2> net(3, 3);
  net.col(0) << radii.x() * (1.0 + first * first), 2.0 * radii.y() * first, 1.0 - first * first;
  net.col(1) << radii.x() * (1.0 + first * last), 2.0 * radii.y() * mean, 1.0 - first * last;
  net.col(2) << radii.x() * (1.0 + last * last), 2.0 * radii.y() * last, 1.0 - last * last;
  const NurbsCurve<2> unit(KnotVector::bezier(2), std::move(net));
  const NurbsCurve<2> curve = with_ends(placed(unit, placement), start, end);
  // Backwards the standard's parameter is -t, so that it rises all the same.
  const double sign = first < last ? 1.0 : -1.0;
  const ParameterMap::Piece piece{.from = {2.0 * std::atan(sign * first), 2.0 * std::atan(sign * last)},
                                  .to = {0.0, 1.0},
                                  .half_rate = 0.5,
                                  .centre = 0.0};
  return {in_plane(curve, z), ParameterMap({piece})};
}

/// The arc of y = k x^2 between the points with the given x; the parameter is x, or -x backwards.
ParametrisedCurve parabola_arc(double k, const Placement& placement, double z, const Point2& start, const Point2& end) {
  const double first = placement.inward(start).x();
  const double last = placement.inward(end).x();
  if (first == last) throw GeometryError("conic arc: both ends of the parabola's arc are one point");
  Points<2> points(2, 3);
  points.col(0) << first, k * first * first;
  points.col(1) << 0.5 * (first + last), k * first * last;
  points.col(2) << last, k * last * last;
  const double sign = first < last ? 1.0 : -1.0;
  const KnotVector knots = KnotVector::clamped(2, std::vector<double>{sign * first, sign * last});
  const NurbsCurve<2> curve = with_ends(placed(NurbsCurve<2>::from_points(knots, points), placement), start, end);
  return {in_plane(curve, z), {}};
}

/// The conic seen from other axes: x = outward(x').
Conic seen_from(const Conic& q, const Placement& placement) {
  const double c = placement.first_axis.x();
  const double s = placement.first_axis.y();
  const double x = placement.centre.x();
  const double y = placement.centre.y();
  Conic r;
  r.a = q.a * c * c + q.b * c * s + q.c * s * s;
  r.b = 2.0 * (q.c - q.a) * c * s + q.b * (c * c - s * s);
  r.c = q.a * s * s - q.b * c * s + q.c * c * c;
  const double gx = 2.0 * q.a * x + q.b * y + q.d;
  const double gy = q.b * x + 2.0 * q.c * y + q.e;
  r.d = gx * c + gy * s;
  r.e = -gx * s + gy * c;
  r.f = q.a * x * x + q.b * x * y + q.c * y * y + q.d * x + q.e * y + q.f;
  return r;
}

/// Axes along which b vanishes.
Placement principal_axes(const Conic& q) {
  Placement placement;
  if (q.b == 0.0) return placement;
  const double angle = 0.5 * std::atan2(q.b, q.a - q.c);
  placement.first_axis = {std::cos(angle), std::sin(angle)};
  return placement;
}

[[noreturn]] void refuse_conic(const Conic& q, const char* why) {
  throw GeometryError(fmt::format("conic arc: A = {}, B = {}, C = {}, D = {}, E = {}, F = {} describe no {}", q.a, q.b,
                                  q.c, q.d, q.e, q.f, why));
}

/// Ellipse or hyperbola.
ParametrisedCurve central_conic(const Conic& q, Placement axes, double z, const Point2& start, const Point2& end) {
  Conic own = seen_from(q, axes);
  if (own.d != 0.0 || own.e != 0.0) {
    axes.centre = axes.outward()(Point2(-0.5 * own.d / own.a, -0.5 * own.e / own.c));
    own = seen_from(q, axes);
  }
  const double x_squared = -own.f / own.a;
  const double y_squared = -own.f / own.c;
  if (x_squared > 0.0 && y_squared > 0.0)
    return ellipse_arc({std::sqrt(x_squared), std::sqrt(y_squared)}, axes, z, start, end);
  if (x_squared > 0.0) {
    const double side = axes.inward(start).x() < 0.0 ? -1.0 : 1.0;
    return hyperbola_arc({side * std::sqrt(x_squared), std::sqrt(-y_squared)}, axes, z, start, end);
  }
  if (!(y_squared > 0.0)) refuse_conic(q, "real ellipse or hyperbola");
  // (a tan t, b sec t): seen from axes turned by a quarter, its x runs along ours, its y along the negative.
  Placement turned{axes.centre, {-axes.first_axis.y(), axes.first_axis.x()}};
  const double side = axes.inward(start).y() < 0.0 ? -1.0 : 1.0;
  return hyperbola_arc({side * std::sqrt(y_squared), -std::sqrt(-x_squared)}, turned, z, start, end);
}

ParametrisedCurve parabola(const Conic& q, Placement axes, double z, const Point2& start, const Point2& end) {
  Conic own = seen_from(q, axes);
  const bool along_x = std::abs(own.a) >= std::abs(own.c);
  if (!along_x) {
    // x = k y^2: its axes turned by a quarter, where y = -k x^2.
    axes.first_axis = {-axes.first_axis.y(), axes.first_axis.x()};
    own = seen_from(q, axes);
  }
  if (own.a == 0.0 || own.e == 0.0) refuse_conic(q, "parabola");
  if (own.d != 0.0 || own.f != 0.0) {
    const double x = -0.5 * own.d / own.a;
    axes.centre = axes.outward()(Point2(x, -(own.a * x * x + own.d * x + own.f) / own.e));
  }
  return parabola_arc(-own.a / own.e, axes, z, start, end);
}

}  // namespace

ParametrisedCurve arc(double z, const Point2& centre, const Point2& start, const Point2& end) {
  const double radius = (start - centre).stableNorm();
  if (!(radius > 0.0) || !std::isfinite(radius))
    throw GeometryError(fmt::format("circular arc: the start ({}, {}) and the centre ({}, {}) are {} apart", start.x(),
                                    start.y(), centre.x(), centre.y(), radius));
  return ellipse_arc({radius, radius}, {centre, {1.0, 0.0}}, z, start, end);
}

ParametrisedCurve conic_arc(const Conic& q, double z, const Point2& start, const Point2& end) {
  const double size = std::max({std::abs(q.a), std::abs(q.b), std::abs(q.c)});
  if (!(size > 0.0) || !std::isfinite(size)) refuse_conic(q, "conic");
  const Placement axes = principal_axes(q);
  const double discriminant = q.a * q.c - 0.25 * q.b * q.b;
  // Thinner than this an ellipse cannot be told from a parabola with the digits of the coefficients.
  if (std::abs(discriminant) <= 1e-15 * size * size) return parabola(q, axes, z, start, end);
  return central_conic(q, axes, z, start, end);
}

}  // namespace isorim::io::iges
