#include "io/iges/analytic_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"

namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::HomogeneousPoints;
using geometry::Interval;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double degree = std::numbers::pi / 180.0;
constexpr double full_turn = 360.0;

const char* name_of(AnalyticKind kind) {
  switch (kind) {
    case AnalyticKind::plane:
      return "plane";
    case AnalyticKind::cylinder:
      return "cylinder";
    case AnalyticKind::cone:
      return "cone";
    case AnalyticKind::sphere:
      return "sphere";
    case AnalyticKind::torus:
      return "torus";
  }
  return "surface";
}

Vector3 unit(const Vector3& direction, const char* what) {
  const double length = direction.stableNorm();
  if (!(length > 0.0) || !std::isfinite(length)) throw GeometryError(fmt::format("the {} is no direction", what));
  return (direction / length).stableNormalized();
}

/// Begins at a multiple of a quarter turn, so that the needed angles are in one turn if they can be.
double turn_start(const Interval& needed) {
  constexpr double rounding = 1e-6;
  if (needed.first >= -rounding && needed.last <= full_turn + rounding) return 0.0;
  return 90.0 * std::floor((needed.first + rounding) / 90.0);
}

/// The unit circle from an angle in degrees once around.
NurbsCurve<2> turn_from(double start) {
  return geometry::unit_arc(start * degree, start * degree + two_pi);
}

ParameterMap turn_map(double start) {
  return ParameterMap::arc({start, start + full_turn}, 4, degree, true);
}

/// Straight in (distance from the axis, height), the height being the parameter.
NurbsCurve<2> straight_profile(double radius, double slope, const Interval& heights) {
  Points<2> points(2, 2);
  points << radius + slope * heights.first, radius + slope * heights.last, heights.first, heights.last;
  return NurbsCurve<2>::from_points(KnotVector::clamped(1, std::array{heights.first, heights.last}), points);
}

NurbsCurve<2> round_profile(double centre, double radius, const NurbsCurve<2>& unit_arc) {
  AffineMap<2> map;
  map.linear *= radius;
  map.translation = {centre, 0.0};
  return transform(unit_arc, map);
}

/// The profile (distance from z, height) turned about z: u runs round, v along the profile.
NurbsSurface<3> turned(const Frame& frame, const NurbsCurve<2>& turn, const NurbsCurve<2>& profile) {
  const HomogeneousPoints<2>& round = turn.homogeneous();
  const HomogeneousPoints<2>& along = profile.homogeneous();
  HomogeneousPoints<3> net(4, round.cols() * along.cols());
  for (Eigen::Index j = 0; j < along.cols(); ++j)
    for (Eigen::Index i = 0; i < round.cols(); ++i) {
      const Vector3 radial = along(0, j) * (round(0, i) * frame.x + round(1, i) * frame.y);
      const double weight = round(2, i) * along(2, j);
      net.col(i + j * round.cols()) << weight * frame.origin + radial + round(2, i) * along(1, j) * frame.z, weight;
    }
  return {turn.knots(), profile.knots(), std::move(net)};
}

Interval not_empty(const Interval& range, const AnalyticSurface& surface) {
  if (range.length() > 0.0 && std::isfinite(range.length())) return range;
  throw GeometryError(
      fmt::format("{}: nothing says how far it reaches ([{}, {}])", name_of(surface.kind), range.first, range.last));
}

ParametrisedSurface finite_plane(const AnalyticSurface& surface, const ParameterBox& needed) {
  const Interval u = not_empty(needed.u, surface);
  const Interval v = not_empty(needed.v, surface);
  const Frame& frame = surface.frame;
  Points<3> points(3, 4);
  points << frame.origin + u.first * frame.x + v.first * frame.y, frame.origin + u.last * frame.x + v.first * frame.y,
      frame.origin + u.first * frame.x + v.last * frame.y, frame.origin + u.last * frame.x + v.last * frame.y;
  return {NurbsSurface<3>::from_points(KnotVector::clamped(1, std::array{u.first, u.last}),
                                       KnotVector::clamped(1, std::array{v.first, v.last}), points),
          {},
          {}};
}

/// Cylinders and cones; a cone is not continued beyond its apex.
ParametrisedSurface finite_cone(const AnalyticSurface& surface, const ParameterBox& needed) {
  Interval heights = not_empty(needed.v, surface);
  if (surface.slope != 0.0) {
    const double apex = -surface.radius / surface.slope;
    // A face on the other half of the double cone is none of this surface: what lies there was needed by mistake.
    if (surface.slope > 0.0) heights.first = std::max(heights.first, apex);
    if (surface.slope < 0.0) heights.last = std::min(heights.last, apex);
    heights = not_empty(heights, surface);
  }
  const double start = turn_start(needed.u);
  NurbsCurve<2> profile = straight_profile(surface.radius, surface.slope, heights);
  if (surface.slope != 0.0) {
    // At the apex the radius is 0, not a rounding.
    HomogeneousPoints<2> net = profile.homogeneous();
    const double apex = -surface.radius / surface.slope;
    if (heights.first == apex) net(0, 0) = 0.0;
    if (heights.last == apex) net(0, 1) = 0.0;
    profile = NurbsCurve<2>(profile.knots(), net);
  }
  return {turned(surface.frame, turn_from(start), profile), {turn_map(start), {}, full_turn, {}}, {}};
}

ParametrisedSurface finite_sphere(const AnalyticSurface& surface, const ParameterBox& needed) {
  const double start = turn_start(needed.u);
  const NurbsCurve<2> half = geometry::unit_arc(-0.5 * std::numbers::pi, 0.5 * std::numbers::pi);
  const NurbsCurve<2> profile = round_profile(0.0, surface.radius, half);
  return {turned(surface.frame, turn_from(start), profile),
          {turn_map(start), ParameterMap::arc({-90.0, 90.0}, 2, degree), full_turn, {}},
          {}};
}

ParametrisedSurface finite_torus(const AnalyticSurface& surface, const ParameterBox& needed) {
  const double start_u = turn_start(needed.u);
  const double start_v = turn_start(needed.v);
  Frame frame = surface.frame;
  frame.y = -frame.y;
  const NurbsCurve<2> profile = round_profile(surface.radius, surface.minor_radius, turn_from(start_u));
  return {swap_directions(turned(frame, turn_from(start_v), profile)),
          {turn_map(start_u), turn_map(start_v), full_turn, full_turn},
          {}};
}

double angle_of(double x, double y) {
  const double angle = std::atan2(y, x) / degree;
  return angle < 0.0 ? std::min(angle + full_turn, std::nextafter(full_turn, 0.0)) : angle;
}

/// The same parameters in radians, which some programs write.
SurfaceParameters in_radians(const SurfaceParameters& parameters) {
  SurfaceParameters result;
  const auto converted = [](const ParameterMap& map) {
    if (map.is_affine()) return map;
    const Interval own = map.domain();
    return map.over({own.first * degree, own.last * degree});
  };
  result.u = converted(parameters.u);
  result.v = converted(parameters.v);
  if (parameters.turn_u) result.turn_u = two_pi;
  if (parameters.turn_v) result.turn_v = two_pi;
  return result;
}

}  // namespace

Point3 Frame::inward(const Point3& point) const {
  const Vector3 d = point - origin;
  return {x.dot(d), y.dot(d), z.dot(d)};
}

Frame frame_of(const Point3& origin, const Vector3& axis, const std::optional<Vector3>& reference) {
  Frame frame;
  frame.origin = origin;
  frame.z = unit(axis, "axis");
  Vector3 across = reference ? unit(*reference, "reference direction") : Vector3::Zero();
  if (!reference) {
    Eigen::Index smallest = 0;
    frame.z.cwiseAbs().minCoeff(&smallest);
    across = Vector3::Unit(smallest);
  }
  across -= across.dot(frame.z) * frame.z;
  if (!(across.norm() > 1e-9)) throw GeometryError("the reference direction is parallel to the axis");
  across = across.normalized();
  // Once more: the first subtraction leaves a rounding relative to the part that was taken away.
  frame.x = (across - across.dot(frame.z) * frame.z).normalized();
  frame.y = frame.z.cross(frame.x);
  return frame;
}

AnalyticSurface transform(const AnalyticSurface& surface, const AffineMap<3>& map) {
  if (map.linear.isIdentity(0.0) && map.translation.isZero(0.0)) return surface;
  const double scale = std::cbrt(std::abs(map.linear.determinant()));
  const Eigen::Matrix3d rest = map.linear.transpose() * map.linear / (scale * scale) - Eigen::Matrix3d::Identity();
  if (!(scale > 0.0) || !(rest.cwiseAbs().maxCoeff() < 1e-6))
    throw GeometryError(fmt::format("{}: its transformation is no rotation", name_of(surface.kind)));
  AnalyticSurface result = surface;
  result.frame.origin = map(surface.frame.origin);
  // A mirrored frame is left-handed; so is the surface, and its normal turns round.
  result.frame.x = (map.linear * surface.frame.x).normalized();
  result.frame.y = (map.linear * surface.frame.y).normalized();
  result.frame.z = (map.linear * surface.frame.z).normalized();
  result.radius *= scale;
  result.minor_radius *= scale;
  return result;
}

AnalyticSurface offset(const AnalyticSurface& surface, double distance) {
  AnalyticSurface result = surface;
  switch (surface.kind) {
    case AnalyticKind::plane:
      result.frame.origin += distance * surface.frame.x.cross(surface.frame.y);
      break;
    case AnalyticKind::cylinder:
    case AnalyticKind::sphere:
      result.radius += distance;
      break;
    case AnalyticKind::cone: {
      // The normal has the slope's angle against the radial direction.
      const double secant = std::hypot(1.0, surface.slope);
      result.radius += distance * secant;
      break;
    }
    case AnalyticKind::torus:
      result.minor_radius += distance;
      break;
  }
  const bool positive = surface.kind == AnalyticKind::plane || surface.kind == AnalyticKind::cone ||
                        (surface.kind == AnalyticKind::torus ? result.minor_radius : result.radius) > 0.0;
  if (!positive)
    throw GeometryError(fmt::format("{}: an offset of {} leaves no radius", name_of(surface.kind), distance));
  return result;
}

Point2 parameters_of(const AnalyticSurface& surface, const Point3& point) {
  const Point3 p = surface.frame.inward(point);
  const double distance = std::hypot(p.x(), p.y());
  switch (surface.kind) {
    case AnalyticKind::plane:
      return {p.x(), p.y()};
    case AnalyticKind::cylinder:
    case AnalyticKind::cone:
      return {angle_of(p.x(), p.y()), p.z()};
    case AnalyticKind::sphere:
      return {angle_of(p.x(), p.y()), std::atan2(p.z(), distance) / degree};
    case AnalyticKind::torus:
      return {angle_of(distance - surface.radius, p.z()), angle_of(p.x(), -p.y())};
  }
  return Point2::Zero();
}

ParametrisedSurface finite_part(const AnalyticSurface& surface, const ParameterBox& needed) {
  ParametrisedSurface result = [&] {
    switch (surface.kind) {
      case AnalyticKind::plane:
        return finite_plane(surface, needed);
      case AnalyticKind::cylinder:
      case AnalyticKind::cone:
        return finite_cone(surface, needed);
      case AnalyticKind::sphere:
        return finite_sphere(surface, needed);
      case AnalyticKind::torus:
        break;
    }
    return finite_torus(surface, needed);
  }();
  if (surface.kind != AnalyticKind::plane) result.alternatives.push_back(in_radians(result.parameters));
  return result;
}

}  // namespace isorim::io::iges
