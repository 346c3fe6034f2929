#include "io/case/shape_builder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <span>
#include <type_traits>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/swept_solids.h"
#include "geometry/shapes/transforms.h"
#include "io/case/curve_builder.h"
#include "io/case/face_builder.h"
#include "io/case/tspline_builder.h"
#include "io/propeller/propeller_shape.h"

namespace isorim::io {
namespace {

using geometry::Boundary;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Patch;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;

constexpr double pi = std::numbers::pi;

/// Runs each of several builders and gathers what they complain of.
class Gatherer {
 public:
  template <class Build>
  void run(Build&& build) {
    try {
      build();
    } catch (const InputError& error) {
      complaints_.add(error.what());
    }
  }
  void throw_if_any() const { complaints_.throw_if_any(); }

 private:
  Complaints complaints_;
};

// --- Names ----------------------------------------------------------------------------------------------------

/// One patch takes the name itself; several get it before their own names.
template <int Dim>
void prefix_names(Boundary<Dim>& boundary, const std::string& name) {
  if (name.empty()) return;
  if (boundary.patches.size() == 1) {
    boundary.patches.front().name = name;
    return;
  }
  for (Patch<Dim>& patch : boundary.patches) patch.name = name + "_" + patch.name;
}

template <int Dim>
void append(Boundary<Dim>& boundary, const Boundary<Dim>& more) {
  boundary.patches.insert(boundary.patches.end(), more.patches.begin(), more.patches.end());
}

template <int Dim>
void check_unique_names(const Boundary<Dim>& boundary, const KeyPlace& where) {
  std::vector<std::string> names;
  for (const Patch<Dim>& patch : boundary.patches) names.push_back(patch.name);
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) refuse(where, fmt::format("two patches have the name \"{}\"", *twice));
}

template <int Dim>
Boundary<Dim> numbered(const std::vector<geometry::PatchShape<Dim>>& shapes, const std::string& stem) {
  Boundary<Dim> boundary;
  for (const auto& shape : shapes) {
    boundary.patches.push_back({fmt::format("{}_{}", stem, boundary.patches.size() + 1), shape});
  }
  if (shapes.size() == 1) boundary.patches.front().name = stem;
  return boundary;
}

// --- Regions of the plane -------------------------------------------------------------------------------------

/// The curves of a path; unnamed ones are called "curve_1", ...
Boundary<2> path_boundary(const PathKeys& keys) {
  Boundary<2> boundary;
  Gatherer gatherer;
  for (std::size_t i = 0; i < keys.curves.size(); ++i) {
    gatherer.run([&] {
      const std::string& name = common_keys(keys.curves[i]).name;
      append(boundary, numbered<2>(plane_curves(keys.curves[i]), name.empty() ? fmt::format("curve_{}", i + 1) : name));
    });
  }
  gatherer.throw_if_any();
  return boundary;
}

struct PlaneShapeBuilder {
  Boundary<2> operator()(const CircleKeys& keys) const { return geometry::disc(keys.radius, keys.centre); }
  Boundary<2> operator()(const EllipseKeys& keys) const {
    return geometry::elliptic_disc(keys.radii, keys.centre, keys.rotation * (pi / 180.0));
  }
  Boundary<2> operator()(const RectangleKeys& keys) const { return geometry::rectangle(keys.size, keys.corner); }
  Boundary<2> operator()(const PolygonKeys& keys) const { return geometry::polygon(points_of<2>(keys.points)); }
  Boundary<2> operator()(const NurbsCurveKeys& keys) const { return {{{"nurbs", nurbs_curve<2>(keys)}}}; }
  Boundary<2> operator()(const PathKeys& keys) const { return path_boundary(keys); }
};

/// A loop by itself must close, without crossing itself, around something.
void check_loop(const Boundary<2>& loop) {
  std::vector<NurbsCurve<2>> curves;
  for (const Patch<2>& patch : loop.patches) curves.push_back(patch.shape);
  geometry::region(std::span<const std::vector<NurbsCurve<2>>>(&curves, 1));
}

template <class Keys>
Boundary<2> plane_shape(const Keys& keys) {
  return located(keys.where, [&] { return finished<2>(PlaneShapeBuilder{}(keys), keys); });
}

BuiltBoundary<2> region_boundary(const RegionKeys& keys) {
  BuiltBoundary<2> result;
  Gatherer gatherer;
  for (std::size_t i = 0; i < keys.loops.size(); ++i) {
    gatherer.run([&] {
      std::visit(
          [&](const auto& loop) {
            Boundary<2> boundary = plane_shape(loop);
            located(loop.where, [&] {
              check_loop(boundary);
              return 0;
            });
            if (loop.name.empty()) prefix_names(boundary, fmt::format("loop_{}", i + 1));
            result.claims.push_back({static_cast<int>(result.boundary.patches.size()), loop.role, loop.where});
            append(result.boundary, boundary);
          },
          keys.loops[i]);
    });
  }
  gatherer.throw_if_any();
  result.boundary = finished<2>(std::move(result.boundary), keys);
  return result;
}

BuiltBoundary<2> plane_region(const PlaneRegionKeys& keys) {
  return std::visit(
      [](const auto& shape) -> BuiltBoundary<2> {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, RegionKeys>) {
          return region_boundary(shape);
        } else {
          const Boundary<2> boundary = plane_shape(shape);
          located(shape.where, [&] {
            check_loop(boundary);
            return 0;
          });
          return {boundary, {}};
        }
      },
      keys);
}

BuiltBoundary<2> nurbs_curves(const NurbsKeys& keys) {
  if (!keys.clip.items.empty()) refuse(keys.where, "found \"clip\"; a shape of the plane cannot be clipped");
  BuiltBoundary<2> result;
  Gatherer gatherer;
  for (std::size_t i = 0; i < keys.curves.size(); ++i) {
    gatherer.run([&] {
      Boundary<2> boundary = plane_shape(keys.curves[i]);
      if (keys.curves[i].name.empty()) prefix_names(boundary, fmt::format("curve_{}", i + 1));
      result.claims.push_back({static_cast<int>(i), keys.curves[i].role, keys.curves[i].where});
      append(result.boundary, boundary);
    });
  }
  gatherer.throw_if_any();
  result.boundary = finished<2>(std::move(result.boundary), keys);
  return result;
}

// --- Sweeps ---------------------------------------------------------------------------------------------------

/// The curves of a profile in space, with names.
struct NamedCurve {
  std::string name;
  NurbsCurve<3> curve;
};

std::vector<NamedCurve> profile_curves(const std::vector<CurveKeys>& profile) {
  std::vector<NamedCurve> result;
  Gatherer gatherer;
  for (const CurveKeys& keys : profile) {
    gatherer.run([&] {
      for (NurbsCurve<3>& curve : space_curves(keys)) {
        const std::string& name = common_keys(keys).name;
        result.push_back({name.empty() ? fmt::format("side_{}", result.size() + 1) : name, std::move(curve)});
      }
    });
  }
  gatherer.throw_if_any();
  if (result.size() == 1 && common_keys(profile.front()).name.empty()) result.front().name = "side";
  return result;
}

Boundary<3> revolved_curves(const std::vector<NamedCurve>& curves, const geometry::Axis& axis, double angle) {
  Boundary<3> boundary;
  for (const NamedCurve& side : curves) {
    const double on_axis =
        (side.curve.control_points().colwise() - axis.point).colwise().cross(axis.direction.normalized()).norm();
    const double size = side.curve.control_points().cwiseAbs().maxCoeff() + axis.point.norm();
    // A side along the axis sweeps nothing.
    if (curves.size() > 1 && on_axis <= 1e-14 * size) continue;
    boundary.patches.push_back({side.name, geometry::revolve(side.curve, axis, angle)});
  }
  return boundary;
}

std::vector<NurbsCurve<3>> shapes_of(const std::vector<NamedCurve>& curves) {
  std::vector<NurbsCurve<3>> shapes;
  for (const NamedCurve& side : curves) shapes.push_back(side.curve);
  return shapes;
}

Boundary<3> revolve_boundary(const RevolveKeys& keys) {
  const geometry::Axis axis{keys.axis.point, keys.axis.direction};
  const double angle = keys.angle * (pi / 180.0);
  if (keys.region) return geometry::revolve(plane_region(*keys.region).boundary, axis, angle);
  const std::vector<NamedCurve> curves = profile_curves(keys.profile);
  if (keys.angle == 360.0) geometry::require_simple_profile(shapes_of(curves), axis);
  if (keys.ends == SweepEnds::open) return revolved_curves(curves, axis, angle);
  return geometry::revolve_solid(shapes_of(curves), axis, angle);
}

Boundary<3> extrude_boundary(const ExtrudeKeys& keys) {
  if (keys.region) return geometry::extrude(plane_region(*keys.region).boundary, keys.vector);
  Boundary<3> boundary;
  for (const NamedCurve& side : profile_curves(keys.profile)) {
    boundary.patches.push_back({side.name, geometry::extrude(side.curve, keys.vector)});
  }
  return boundary;
}

Boundary<3> loft_boundary(const LoftKeys& keys) {
  std::vector<NurbsCurve<3>> sections;
  std::transform(keys.sections.begin(), keys.sections.end(), std::back_inserter(sections), single_space_curve);
  if (keys.ends == SweepEnds::caps) return geometry::loft_solid(sections, {.degree = keys.degree});
  return {{{"loft", geometry::loft(sections, {.degree = keys.degree})}}};
}

// --- Surfaces -------------------------------------------------------------------------------------------------

/// A rotation that takes z to `normal`.
geometry::AffineMap<3> tilt(const Vector3& normal) {
  const Vector3 unit = normal.normalized();
  const Vector3 axis = Vector3::UnitZ().cross(unit);
  const double angle = std::atan2(axis.norm(), unit.z());
  if (angle == 0.0) return {};
  return geometry::rotation(geometry::Axis{Point3::Zero(), axis.norm() > 0.0 ? axis : Vector3(Vector3::UnitX())},
                            angle);
}

NurbsSurface<3> disc_surface(const DiscKeys& keys) {
  const NurbsSurface<3> flat =
      geometry::fan<3>(geometry::embed(geometry::circle_curve(keys.radius)), Point3(Point3::Zero()));
  return geometry::transform(geometry::transform(flat, tilt(keys.normal)), geometry::translation<3>(keys.centre));
}

NurbsSurface<3> quadrilateral_surface(const QuadrilateralKeys& keys) {
  const geometry::Points<3> round = points_of<3>(keys.corners);
  geometry::Points<3> net(3, 4);
  net << round.col(0), round.col(1), round.col(3), round.col(2);
  return NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), net);
}

/// How many control points the knots ask for, against those that are there.
void check_net(const NurbsPatchKeys& keys, const PointGrid& grid, const KnotVector& u, const KnotVector& v) {
  const int nu = u.basis_count();
  const int nv = v.basis_count();
  if (static_cast<int>(grid.points.size()) != nu * nv) {
    refuse(grid.where, fmt::format("found {} control points; the degrees and knots ask for {} x {} = {}",
                                   grid.points.size(), nu, nv, nu * nv));
  }
  if (grid.row_length > 0 && grid.row_length != nu) {
    refuse(grid.where, fmt::format("found rows of {} control points; knots_u asks for {}", grid.row_length, nu));
  }
  const NumberArray& weights = keys.weights;
  if (!weights.values.empty() && static_cast<int>(weights.values.size()) != nu * nv) {
    refuse(weights.where,
           fmt::format("found {} weights; expected one for each of {} control points", weights.values.size(), nu * nv));
  }
}

NurbsSurface<3> nurbs_surface(const NurbsPatchKeys& keys) {
  const KnotVector u =
      located(keys.where.key("knots_u", keys.where.place), [&] { return KnotVector(keys.degrees(0), keys.knots_u); });
  const KnotVector v =
      located(keys.where.key("knots_v", keys.where.place), [&] { return KnotVector(keys.degrees(1), keys.knots_v); });
  const bool is_homogeneous = !keys.homogeneous.points.empty();
  const PointGrid& grid = is_homogeneous ? keys.homogeneous : keys.points;
  check_net(keys, grid, u, v);
  if (!is_homogeneous) return NurbsSurface<3>::from_points(u, v, points_of<3>(grid.points), keys.weights.values);
  geometry::HomogeneousPoints<3> net(4, static_cast<Eigen::Index>(grid.points.size()));
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    net.col(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::Vector4d>(grid.points[i].values.data());
  }
  return NurbsSurface<3>(u, v, net);
}

/// The T-meshes of the T-splines that are built, one after the other.
using Meshes = std::vector<geometry::TMesh>;

/// The surfaces of a list; unnamed ones are called "patch_1", ...
template <class List>
Boundary<3> surface_list(const List& list, Meshes& meshes);

/// One surface keeps the names of its patches.
Boundary<3> nurbs_surfaces(const std::vector<NurbsSurfaceKeys>& list);

struct SurfaceBuilder {
  using Result = Boundary<3>;
  Meshes& meshes;

  Result operator()(const SphereKeys& keys) const {
    return keys.patches == 6 ? geometry::six_patch_sphere(keys.radius, keys.centre)
                             : geometry::sphere(keys.radius, keys.centre);
  }
  Result operator()(const EllipsoidKeys& keys) const { return geometry::ellipsoid(keys.radii, keys.centre); }
  Result operator()(const TorusKeys& keys) const {
    return keys.patches == 16 ? geometry::sixteen_patch_torus(keys.major_radius, keys.minor_radius, keys.centre)
                              : geometry::torus(keys.major_radius, keys.minor_radius, keys.centre);
  }
  Result operator()(const CylinderKeys& keys) const { return geometry::cylinder(keys.radius, keys.height, keys.base); }
  Result operator()(const ConeKeys& keys) const {
    const Eigen::Vector2d radii = keys.radii ? *keys.radii : Eigen::Vector2d(*keys.radius, 0.0);
    return geometry::cone(radii(0), radii(1), keys.height, keys.base);
  }
  Result operator()(const BoxKeys& keys) const { return geometry::box(keys.size, keys.corner); }
  Result operator()(const RevolveKeys& keys) const { return revolve_boundary(keys); }
  Result operator()(const ExtrudeKeys& keys) const { return extrude_boundary(keys); }
  Result operator()(const RuledKeys& keys) const {
    return face("ruled", geometry::ruled(single_space_curve(keys.curves[0]), single_space_curve(keys.curves[1])), keys);
  }
  Result operator()(const LoftKeys& keys) const { return loft_boundary(keys); }
  Result operator()(const DiscKeys& keys) const { return face("disc", disc_surface(keys), keys); }
  Result operator()(const QuadrilateralKeys& keys) const {
    return face("quadrilateral", quadrilateral_surface(keys), keys);
  }
  Result operator()(const NurbsPatchKeys& keys) const { return face("nurbs", nurbs_surface(keys), keys); }
  Result operator()(const TSplineKeys& keys) const {
    const Result source = keys.from.items.empty() ? Result{} : nurbs_surfaces(keys.from.items);
    Result result;
    for (const geometry::TSpline& surface : tsplines(source, keys)) {
      const std::size_t i = result.patches.size();
      result.patches.push_back({source.patches.empty() ? "tspline" : source.patches[i].name, geometry::extract(surface),
                                source.patches.empty() ? 1 : source.patches[i].orientation});
      meshes.push_back(surface.mesh());
    }
    return result;
  }

 private:
  static Result face(const char* name, const NurbsSurface<3>& surface, const FaceKeys& keys) {
    return {{{name, trimmed(surface, keys.trims, keys.where.key("trims", keys.where.place))}}};
  }
};

bool has_clip(const SolidKeys& keys) {
  return !keys.clip.items.empty();
}
bool has_clip(const ShapeKeys&) {
  return false;
}

/// Moved, cut and named.
template <class Keys>
Boundary<3> placed(Boundary<3> boundary, const Keys& keys) {
  if constexpr (std::is_base_of_v<SolidKeys, Keys>) return finished_solid(std::move(boundary), keys);
  return finished<3>(std::move(boundary), keys);
}

/// Patches of a solid that is cut are no T-splines any more.
template <class Keys>
BuiltBoundary<3> built(Boundary<3> boundary, const Keys& keys, Meshes meshes) {
  if (has_clip(keys)) meshes.clear();
  return {std::move(boundary), {}, std::move(meshes)};
}

template <class Keys>
Boundary<3> surface(const Keys& keys, Meshes& meshes) {
  return located(keys.where, [&] {
    const auto before = static_cast<std::ptrdiff_t>(meshes.size());
    Boundary<3> boundary = placed(SurfaceBuilder{meshes}(keys), keys);
    if (has_clip(keys)) meshes.erase(meshes.begin() + before, meshes.end());
    return boundary;
  });
}

template <class List>
Boundary<3> surface_list(const List& list, Meshes& meshes) {
  Boundary<3> boundary;
  Gatherer gatherer;
  for (std::size_t i = 0; i < list.size(); ++i) {
    gatherer.run([&] {
      const auto add = [&](const auto& keys) {
        Boundary<3> piece = surface(keys, meshes);
        if (keys.name.empty()) prefix_names(piece, fmt::format("patch_{}", i + 1));
        append(boundary, piece);
      };
      if constexpr (std::is_base_of_v<ShapeKeys, typename List::value_type>) {
        add(list[i]);
      } else {
        std::visit(add, list[i]);
      }
    });
  }
  gatherer.throw_if_any();
  return boundary;
}

Boundary<3> nurbs_surfaces(const std::vector<NurbsSurfaceKeys>& list) {
  Meshes none;
  if (list.size() > 1) return surface_list(list, none);
  return std::visit([&](const auto& keys) { return surface(keys, none); }, list.front());
}

// --- The whole ------------------------------------------------------------------------------------------------

template <int Dim>
struct GeometryBuilder;

template <>
struct GeometryBuilder<2> {
  BuiltBoundary<2> operator()(const RegionKeys& keys) const { return region_boundary(keys); }
  BuiltBoundary<2> operator()(const NurbsKeys& keys) const { return nurbs_curves(keys); }
  BuiltBoundary<2> operator()(const EllipseArcKeys& keys) const {
    return {numbered<2>(plane_curves(keys), keys.name.empty() ? "ellipse_arc" : keys.name), {}};
  }
  template <class Keys>
  BuiltBoundary<2> operator()(const Keys& keys) const {
    if constexpr (std::is_invocable_v<PlaneShapeBuilder, const Keys&>) {
      return {plane_shape(keys), {}};
    } else {
      refuse(keys.where, "found a shape of space; expected one of the plane");
    }
  }
};

template <>
struct GeometryBuilder<3> {
  BuiltBoundary<3> operator()(const NurbsKeys& keys) const { return patches(keys); }
  BuiltBoundary<3> operator()(const PatchesKeys& keys) const { return patches(keys); }
  BuiltBoundary<3> operator()(const PropellerKeys& keys) const { return build_propeller_shape(keys).boundary; }
  template <class Keys>
  BuiltBoundary<3> operator()(const Keys& keys) const {
    if constexpr (std::is_invocable_v<SurfaceBuilder, const Keys&>) {
      Meshes meshes;
      Boundary<3> boundary = surface(keys, meshes);
      return built(std::move(boundary), keys, std::move(meshes));
    } else {
      refuse(keys.where, "found a shape of the plane; expected one of space");
    }
  }

 private:
  template <class Keys>
  static BuiltBoundary<3> patches(const Keys& keys) {
    return located(keys.where, [&] {
      Meshes meshes;
      Boundary<3> boundary = finished_solid(surface_list(keys.patches, meshes), keys);
      return built(std::move(boundary), keys, std::move(meshes));
    });
  }
};

}  // namespace

std::optional<int> dimension(const GeometryKeys& geometry) {
  return std::visit(
      [](const auto& shape) -> std::optional<int> {
        using Keys = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Keys, FileKeys>) return std::nullopt;
        if constexpr (std::is_same_v<Keys, FitKeys>) return shape.is_body() ? 3 : 2;
        if constexpr (std::is_same_v<Keys, NurbsKeys>) return shape.patches.empty() ? 2 : 3;
        const bool plane = std::is_same_v<Keys, CircleKeys> || std::is_same_v<Keys, EllipseKeys> ||
                           std::is_same_v<Keys, EllipseArcKeys> || std::is_same_v<Keys, RectangleKeys> ||
                           std::is_same_v<Keys, PolygonKeys> || std::is_same_v<Keys, RegionKeys>;
        return plane ? 2 : 3;
      },
      geometry);
}

BuiltBoundary<2> build_region(const RegionKeys& keys) {
  return region_boundary(keys);
}

template <int Dim>
Boundary<Dim> finished(Boundary<Dim> boundary, const ShapeKeys& keys) {
  if (!keys.transform.items.empty()) {
    const geometry::AffineMap<Dim> map = affine_map<Dim>(keys.transform);
    boundary = geometry::transform(boundary, map);
  }
  prefix_names(boundary, keys.name);
  return boundary;
}

Boundary<3> finished_solid(Boundary<3> boundary, const SolidKeys& keys) {
  if (!has_clip(keys)) return finished<3>(std::move(boundary), keys);
  ShapeKeys moving;
  moving.transform = keys.transform;
  boundary = clipped(finished<3>(std::move(boundary), moving), keys.clip, keys.where);
  prefix_names(boundary, keys.name);
  return boundary;
}

template Boundary<2> finished<2>(Boundary<2>, const ShapeKeys&);
template Boundary<3> finished<3>(Boundary<3>, const ShapeKeys&);

template <int Dim>
BuiltBoundary<Dim> build_boundary(const GeometryKeys& keys) {
  BuiltBoundary<Dim> result = std::visit(GeometryBuilder<Dim>{}, keys);
  check_unique_names(result.boundary, common_keys(keys).where);
  return result;
}

template BuiltBoundary<2> build_boundary<2>(const GeometryKeys&);
template BuiltBoundary<3> build_boundary<3>(const GeometryKeys&);

}  // namespace isorim::io
