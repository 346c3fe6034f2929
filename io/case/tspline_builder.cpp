#include "io/case/tspline_builder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "geometry/tspline/partial_lines.h"
#include "geometry/tspline/refinement.h"
#include "io/case/curve_builder.h"
#include "io/expression.h"

namespace isorim::io {
namespace {

using geometry::Direction;
using geometry::KnotVector;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::TMesh;
using geometry::TSpline;

using Region = std::function<bool(const Point3& x, const Point2& uv)>;

KnotVector knots_of(const TSplineKeys& keys, const char* name, int degree, const std::vector<double>& knots) {
  return located(keys.where.key(name, keys.where.place), [&] { return KnotVector(degree, knots); });
}

std::vector<geometry::PartialLine> partial_lines(const std::vector<PartialLineKeys>& keys) {
  std::vector<geometry::PartialLine> lines;
  for (const PartialLineKeys& part : keys) lines.push_back({part.at, {part.from, part.to}});
  return lines;
}

geometry::HomogeneousPoints<3> homogeneous_points(const std::vector<Coordinates>& coordinates) {
  geometry::HomogeneousPoints<3> net(4, static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    net.col(static_cast<Eigen::Index>(k)) = Eigen::Map<const Eigen::Vector4d>(coordinates[k].values.data());
  return net;
}

/// Whether the expression is true (not zero) at a point.
std::function<bool(const Point3&)> condition(const RefineKeys& keys) {
  try {
    const auto integrand = compile_integrand<3>(keys.condition, ExpressionScope::domain)();
    return [integrand](const Point3& x) {
      double value = 0.0;
      integrand(x, geometry::Points<3>::Zero(3, 1), {&value, 1});
      if (std::isnan(value))
        throw GeometryError(fmt::format("the condition is not a number at ({}, {}, {})", x.x(), x.y(), x.z()));
      return value != 0.0;
    };
  } catch (const InputError& error) {
    refuse(keys.where.key("where", keys.where.place), error.what());
  }
}

Region region_of(const RefineKeys& keys) {
  std::vector<Region> conditions;
  if (!keys.condition.empty())
    conditions.emplace_back([holds = condition(keys)](const Point3& x, const Point2&) { return holds(x); });
  if (!keys.box.empty()) {
    const auto corners = points_of<3>(keys.box);
    const Point3 lower = corners.rowwise().minCoeff();
    const Point3 upper = corners.rowwise().maxCoeff();
    conditions.emplace_back([lower, upper](const Point3& x, const Point2&) {
      return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
    });
  }
  const auto range = [&](const std::optional<Eigen::Vector2d>& limits, Eigen::Index d) {
    if (!limits) return;
    conditions.emplace_back(
        [limits = *limits, d](const Point3&, const Point2& uv) { return limits(0) <= uv[d] && uv[d] <= limits(1); });
  };
  range(keys.u, 0);
  range(keys.v, 1);
  return [conditions](const Point3& x, const Point2& uv) {
    return std::ranges::all_of(conditions, [&](const Region& holds) { return holds(x, uv); });
  };
}

/// Divides what lies in the region once; returns how many faces that was.
std::size_t refine_once(std::vector<TSpline>& surfaces, const Region& region, geometry::Bisection direction) {
  std::size_t divided = 0;
  for (TSpline& surface : surfaces) {
    const std::vector<int> faces = geometry::faces_where(surface, region);
    divided += faces.size();
    if (!faces.empty()) surface = geometry::refine(surface, geometry::bisections(surface.mesh(), faces, direction));
  }
  return divided;
}

NurbsSurface<3> with_degrees(NurbsSurface<3> surface, const TSplineKeys& keys) {
  if (!keys.degrees) return surface;
  for (const Direction d : {Direction::u, Direction::v}) {
    const int missing = (*keys.degrees)(static_cast<Eigen::Index>(d)) - surface.knots(d).degree();
    if (missing > 0) surface = geometry::elevate_degree(surface, d, missing);
  }
  return surface;
}

/// Of the T-mesh and control points.
TSpline mesh_tspline(const TSplineKeys& keys) {
  const KnotVector u = knots_of(keys, "knots_u", (*keys.degrees)(0), keys.knots_u);
  const KnotVector v = knots_of(keys, "knots_v", (*keys.degrees)(1), keys.knots_v);
  return located(keys.where, [&] {
    const TMesh mesh = geometry::mesh_of_lines(u, v, partial_lines(keys.lines_u), partial_lines(keys.lines_v));
    return keys.points.empty() ? TSpline(mesh, homogeneous_points(keys.homogeneous))
                               : TSpline::from_points(mesh, points_of<3>(keys.points), keys.weights);
  });
}

/// Of a NURBS patch.
TSpline as_tspline(const geometry::Patch<3>& patch, const TSplineKeys& keys) {
  const auto* surface = std::get_if<NurbsSurface<3>>(&patch.shape);
  if (!surface)
    refuse(keys.where.key("from", keys.where.place),
           fmt::format("the patch \"{}\" is trimmed; only whole surfaces become T-splines", patch.name));
  return TSpline(with_degrees(*surface, keys));
}

void refine_all(std::vector<TSpline>& surfaces, const TSplineKeys& keys) {
  for (const RefineKeys& step : keys.refine.items) {
    const Region region = region_of(step);
    located(step.where, [&] {
      for (int level = 0; level < step.levels; ++level)
        if (refine_once(surfaces, region, step.direction) == 0 && level == 0)
          throw GeometryError("no part of the surface lies in the region");
      return 0;
    });
  }
}

}  // namespace

std::vector<TSpline> tsplines(const geometry::Boundary<3>& source, const TSplineKeys& keys) {
  std::vector<TSpline> surfaces;
  if (keys.from.items.empty()) surfaces.push_back(mesh_tspline(keys));
  for (const geometry::Patch<3>& patch : source.patches) surfaces.push_back(as_tspline(patch, keys));
  refine_all(surfaces, keys);
  return surfaces;
}

}  // namespace isorim::io
