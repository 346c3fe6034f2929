#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/nurbs/surface.h"
#include "io/iges/entity_reader.h"

/// The surface entities.
namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::Axis;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

AnySurface EntityReader::surface(const Entity& entity) {
  const Visit visit(*this, entity);
  charge(entity, entity.tokens.size());
  return named(entity, [&]() -> AnySurface {
    const AnySurface result = unplaced_surface(entity);
    const AffineMap<3> map = placement(entity);
    return std::visit([&](const auto& surface) -> AnySurface { return transform(surface, map); }, result);
  });
}

AnySurface EntityReader::unplaced_surface(const Entity& entity) {
  switch (entity.type) {
    case 108:
      return read_plane(entity);
    case 114:
      return read_parametric_spline_surface(entity);
    case 118:
      return read_ruled_surface(entity);
    case 120:
      return read_surface_of_revolution(entity);
    case 122:
      return read_tabulated_cylinder(entity);
    case 128:
      return read_b_spline_surface(entity);
    case 140:
      return read_offset_surface(entity);
    case 190:
    case 192:
    case 194:
    case 196:
    case 198:
      return read_analytic_surface(entity);
    default:
      refuse(entity, "a surface (108, 114, 118, 120, 122, 128, 140, 190, 192, 194, 196, 198) is expected here");
  }
}

AnySurface EntityReader::read_plane(const Entity& entity) {
  Parameters p(file_, entity);
  Vector3 normal;
  for (double& component : normal) component = p.real();
  const double distance = p.real();
  const double squared = normal.squaredNorm();
  if (!(squared > 0.0)) refuse(entity, "the normal of the plane is zero");
  AnalyticSurface plane;
  plane.kind = AnalyticKind::plane;
  plane.frame = frame_of(distance / squared * normal, normal, std::nullopt);
  plane.parametrised = false;
  return plane;
}

AnySurface EntityReader::read_parametric_spline_surface(const Entity& entity) {
  Parameters p(file_, entity);
  p.skip(2);
  const int count_u = p.count();
  const int count_v = p.count();
  // 48 numbers a patch, and a row of arbitrary ones behind each of the first direction.
  const long long needed = 2LL + count_u + count_v + 48LL * ((count_u - 1LL) * (count_v + 1LL) + count_v);
  if (count_u < 1 || count_v < 1 || needed > p.remaining())
    p.refuse(fmt::format("{} x {} patches need {} numbers; {} follow", count_u, count_v, needed, p.remaining()));
  const std::vector<double> breakpoints_u = p.reals(count_u + 1);
  const std::vector<double> breakpoints_v = p.reals(count_v + 1);
  std::vector<Eigen::Matrix<double, 3, 16>> patches(static_cast<std::size_t>(count_u) * count_v);
  for (int i = 0; i < count_u; ++i) {
    for (int j = 0; j < count_v; ++j) {
      Eigen::Matrix<double, 3, 16>& patch = patches[static_cast<std::size_t>(i + j * count_u)];
      for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 16; ++k) patch(row, k) = p.real();
    }
    if (i + 1 < count_u) p.skip(48);
  }
  return parametric_spline_surface(breakpoints_u, breakpoints_v, patches);
}

AnySurface EntityReader::read_ruled_surface(const Entity& entity) {
  Parameters p(file_, entity);
  const auto rail = [&](const Entity& curve_entity) {
    if (curve_entity.type != 116) return curve(curve_entity);
    const Point3 apex = point(curve_entity);
    return line(apex, apex);
  };
  const ParametrisedCurve first = rail(p.target());
  ParametrisedCurve second = rail(p.target());
  if (p.integer(0) == 1) second = reverse(second);
  const double size = extent(first.curve.control_points()) + extent(second.curve.control_points());
  charge(entity,
         4096u * static_cast<std::size_t>(first.curve.homogeneous().cols() + second.curve.homogeneous().cols()));
  const double tolerance = tolerance_for(size);
  ParametrisedSurface result =
      entity.form == 0 ? ruled_by_length(first, second, tolerance) : ruled_surface(first, second, tolerance);
  approximation(entity, entity.form == 0 ? "surface ruled by arc length" : "ruled surface", result.tolerance,
                result.deviation);
  return result;
}

Axis EntityReader::axis(const Entity& entity) {
  if (entity.type != 110) refuse(entity, "an axis must be a line (110)");
  Parameters p(file_, entity);
  Point3 start;
  Point3 end;
  for (double& coordinate : start) coordinate = p.real();
  for (double& coordinate : end) coordinate = p.real();
  if (start == end) refuse(entity, "the axis has no direction: both its points are the same");
  const AffineMap<3> map = placement(entity);
  const Point3 placed = map(start);
  return {placed, map(end) - placed};
}

AnySurface EntityReader::read_surface_of_revolution(const Entity& entity) {
  Parameters p(file_, entity);
  const Axis turn_axis = axis(p.target());
  const ParametrisedCurve generatrix = curve(p.target());
  const double first = p.real();
  double last = p.real();
  if (last < first) {
    remark("its last angle is before the first; a turn is added", entity);
    last += 2.0 * std::numbers::pi;
  }
  charge(entity, 9u * static_cast<std::size_t>(generatrix.curve.homogeneous().size()));
  return surface_of_revolution(generatrix, turn_axis, first, last);
}

AnySurface EntityReader::read_tabulated_cylinder(const Entity& entity) {
  Parameters p(file_, entity);
  const ParametrisedCurve directrix = curve(p.target());
  Point3 end;
  for (double& coordinate : end) coordinate = p.real();
  return tabulated_cylinder(directrix, end);
}

AnySurface EntityReader::read_b_spline_surface(const Entity& entity) {
  Parameters p(file_, entity);
  const int last_u = p.integer();
  const int last_v = p.integer();
  BSplineSurfaceData data;
  data.degree_u = p.integer();
  data.degree_v = p.integer();
  p.skip(2);
  const bool says_polynomial = p.integer(0) == 1;
  p.skip(2);
  const int remaining = p.remaining();
  const bool fits = data.degree_u >= 1 && data.degree_v >= 1 && last_u >= data.degree_u && last_v >= data.degree_v &&
                    last_u < remaining && last_v < remaining &&
                    4LL * (last_u + 1LL) * (last_v + 1LL) + last_u + last_v <= remaining;
  if (!fits)
    p.refuse(fmt::format("the degrees are {} and {}, the last control point has the numbers {} and {}, with {} values "
                         "to follow",
                         data.degree_u, data.degree_v, last_u, last_v, remaining),
             3);
  const int count = (last_u + 1) * (last_v + 1);
  data.knots_u = p.reals(last_u + data.degree_u + 2);
  data.knots_v = p.reals(last_v + data.degree_v + 2);
  data.weights = p.reals(count);
  data.points.resize(3, count);
  p.reals(std::span<double>(data.points.data(), static_cast<std::size_t>(data.points.size())));
  data.range_u.first = p.real(0.0);
  data.range_u.last = p.real(0.0);
  data.range_v.first = p.real(0.0);
  data.range_v.last = p.real(0.0);
  Remark remarked;
  ParametrisedSurface result = b_spline_surface(data, remarked);
  if (remarked) remark(*remarked, entity);
  if (says_polynomial && !result.surface.is_polynomial())
    remark("is marked as polynomial (PROP3), but its weights differ; the weights are taken", entity);
  return result;
}

AnySurface EntityReader::read_offset_surface(const Entity& entity) {
  Parameters p(file_, entity);
  Vector3 indicator;
  for (double& component : indicator) component = p.real();
  const double distance = p.real();
  const AnySurface base = surface(p.target());
  if (const AnalyticSurface* analytic = std::get_if<AnalyticSurface>(&base)) return offset(*analytic, distance);
  const ParametrisedSurface& carrier = std::get<ParametrisedSurface>(base);
  const Eigen::Index spans = static_cast<Eigen::Index>(carrier.surface.knots_u().breakpoints().size()) *
                             static_cast<Eigen::Index>(carrier.surface.knots_v().breakpoints().size());
  charge(entity, static_cast<std::size_t>(spans) * 2048);
  const double size = extent(carrier.surface.control_points()) + std::abs(distance);
  ParametrisedSurface result = offset_surface(carrier, distance, tolerance_for(size));
  approximation(entity, "offset surface", result.tolerance, result.deviation);
  return result;
}

AnySurface EntityReader::read_analytic_surface(const Entity& entity) {
  Parameters p(file_, entity);
  const Point3 origin = point(p.target());
  AnalyticSurface result;
  result.parametrised = entity.form == 1;
  Vector3 normal = Vector3::UnitZ();
  if (entity.type != 196) normal = direction(p.target());
  switch (entity.type) {
    case 190:
      result.kind = AnalyticKind::plane;
      break;
    case 192:
      result.kind = AnalyticKind::cylinder;
      result.radius = p.real();
      break;
    case 194: {
      result.kind = AnalyticKind::cone;
      result.radius = p.real();
      const double angle = p.real();
      if (!(std::abs(angle) < 90.0)) p.refuse(fmt::format("half the cone's angle is {} degrees", angle));
      result.slope = std::tan(angle * std::numbers::pi / 180.0);
      break;
    }
    case 196:
      result.kind = AnalyticKind::sphere;
      result.radius = p.real();
      if (result.parametrised) normal = direction(p.target());
      break;
    default:
      result.kind = AnalyticKind::torus;
      result.radius = p.real();
      result.minor_radius = p.real();
      if (!(result.minor_radius > 0.0)) p.refuse(fmt::format("the minor radius is {}", result.minor_radius));
  }
  const bool may_vanish = result.kind == AnalyticKind::plane || result.kind == AnalyticKind::cone;
  if (!may_vanish && !(result.radius > 0.0)) refuse(entity, fmt::format("the radius is {}", result.radius));
  if (result.kind == AnalyticKind::cone && !(result.radius >= 0.0))
    refuse(entity, fmt::format("the radius is {}", result.radius));
  std::optional<Vector3> reference;
  if (result.parametrised) reference = direction(p.target());
  result.frame = frame_of(origin, normal, reference);
  return result;
}

}  // namespace isorim::io::iges
