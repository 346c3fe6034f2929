#include "geometry/shapes/swept_solids.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/fill.h"
#include "geometry/topology/orientation.h"

namespace isorim::geometry {
namespace {

/// Off a plane by more than this, relative to the size, is off it.
constexpr double plane_tolerance = 1e-9;

/// A plane in space with Cartesian coordinates; the normal is first x second.
struct Frame {
  Point3 origin;
  Vector3 first;
  Vector3 second;

  Vector3 normal() const { return first.cross(second); }
};

NurbsCurve<2> project(const NurbsCurve<3>& curve, const Frame& frame) {
  HomogeneousPoints<2> net(3, curve.homogeneous().cols());
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const double weight = curve.homogeneous()(3, i);
    const Vector3 arm = curve.homogeneous().col(i).head<3>() - weight * frame.origin;
    net.col(i) << frame.first.dot(arm), frame.second.dot(arm), weight;
  }
  return {curve.knots(), std::move(net)};
}

NurbsSurface<3> place(const NurbsSurface<2>& surface, const Frame& frame) {
  HomogeneousPoints<3> net(4, surface.homogeneous().cols());
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const Eigen::Vector3d point = surface.homogeneous().col(i);
    net.col(i) << point(2) * frame.origin + point(0) * frame.first + point(1) * frame.second, point(2);
  }
  return {surface.knots_u(), surface.knots_v(), std::move(net)};
}

enum class CapSide { along_normal, against_normal };

/// The filled region in the frame's plane, its natural normal along or against the frame's.
void append_cap(const std::string& name, const std::vector<NurbsSurface<2>>& filling, const Frame& frame, CapSide side,
                Boundary<3>& solid) {
  for (std::size_t i = 0; i < filling.size(); ++i) {
    const NurbsSurface<3> placed = place(filling[i], frame);
    solid.patches.push_back({filling.size() == 1 ? name : fmt::format("{}_{}", name, i + 1),
                             side == CapSide::along_normal ? placed : swap_directions(placed)});
  }
}

/// The region oriented, and each curve in the direction that has the material on its left.
Boundary<2> forward(const Boundary<2>& region) {
  OrientedBoundary<2> oriented = orient(region);
  require_closed(oriented);
  for (Patch<2>& patch : oriented.boundary.patches) {
    if (patch.orientation < 0) patch.shape = reverse(patch.shape);
    patch.orientation = 1;
  }
  return oriented.boundary;
}

/// Largest distance of a control point from the axis, and the size of the whole.
double extent(std::span<const NurbsCurve<3>> curves, const Point3& from) {
  double size = 0.0;
  for (const NurbsCurve<3>& curve : curves) {
    size = std::max(size, (curve.control_points().colwise() - from).colwise().norm().maxCoeff());
  }
  return size;
}

/// The half-plane of the profile: first away from the axis, second along it.
Frame meridian_frame(std::span<const NurbsCurve<3>> curves, const Axis& axis) {
  const Vector3 k = checks::unit<3>("revolve", "axis direction", axis.direction);
  Vector3 farthest = Vector3::Zero();
  for (const NurbsCurve<3>& curve : curves) {
    const Points<3> points = curve.control_points();
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Vector3 arm = points.col(i) - axis.point;
      const Vector3 radial = arm - k * k.dot(arm);
      if (radial.squaredNorm() > farthest.squaredNorm()) farthest = radial;
    }
  }
  if (farthest.isZero(0.0)) throw GeometryError("revolve: the whole profile lies on the axis");
  return {axis.point, farthest.normalized(), k};
}

bool lies_in_plane(std::span<const NurbsCurve<3>> curves, const Frame& frame, double tolerance) {
  const Vector3 normal = frame.normal();
  return std::ranges::all_of(curves, [&](const NurbsCurve<3>& curve) {
    const Points<3> points = curve.control_points();
    return (normal.transpose() * (points.colwise() - frame.origin)).cwiseAbs().maxCoeff() <= tolerance;
  });
}

/// The point of the curve (of a few on every Bézier element) that lies farthest beyond the second axis.
Point2 farthest_beyond(const NurbsCurve<2>& curve) {
  const int samples = 4 * curve.degree();
  const std::vector<double> ends = curve.knots().breakpoints();
  Point2 farthest = evaluate(curve, ends.front());
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    for (int k = 1; k <= samples; ++k) {
      const Point2 point = evaluate(curve, std::lerp(ends[i], ends[i + 1], static_cast<double>(k) / samples));
      if (point.x() < farthest.x()) farthest = point;
    }
  }
  return farthest;
}

void check_profile(std::span<const NurbsCurve<3>> curves, const Frame& frame) {
  const double tolerance = plane_tolerance * extent(curves, frame.origin);
  const Vector3 normal = frame.normal();
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Points<3> points = curves[i].control_points();
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      const Vector3 arm = points.col(j) - frame.origin;
      if (std::abs(normal.dot(arm)) > tolerance) {
        throw GeometryError(
            fmt::format("revolve: curve {} leaves the plane through the axis by {:.3g} at control point {}: the "
                        "profile must lie in "
                        "one plane with the axis",
                        i + 1, std::abs(normal.dot(arm)), j));
      }
      if (frame.first.dot(arm) < -tolerance) {
        throw GeometryError(fmt::format(
            "revolve: curve {} lies {:.3g} beyond the axis at control point {}: the profile must lie on one "
            "side of the axis",
            i + 1, -frame.first.dot(arm), j));
      }
    }
  }
}

bool lies_on_axis(const NurbsCurve<2>& curve, double tolerance) {
  return curve.control_points().row(0).cwiseAbs().maxCoeff() <= tolerance;
}

constexpr const char* axis_name = "axis";

/// Joins free ends on the axis, in the order along it, by straight lines.
void close_along_axis(Boundary<2>& profile) {
  const OrientedBoundary<2> oriented = orient(profile);
  std::vector<Point2> ends;
  for (const FreeEdge<2>& edge : oriented.topology.free_edges) {
    if (std::abs(edge.from.x()) <= oriented.topology.tolerance) ends.push_back(edge.from);
  }
  std::ranges::sort(ends, {}, [](const Point2& point) { return point.y(); });
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    profile.patches.push_back({axis_name, line_segment<2>(ends[i], ends[i + 1])});
  }
}

Boundary<3> revolve_profile(const Boundary<2>& given, const Frame& frame, double angle) {
  const Axis axis{frame.origin, frame.second};
  Boundary<2> profile = given;
  close_along_axis(profile);
  profile = forward(profile);
  const double tolerance = 1e-14 * (1.0 + profile.patches[0].shape.control_points().cwiseAbs().maxCoeff());
  Boundary<3> solid;
  for (const Patch<2>& patch : profile.patches) {
    if (lies_on_axis(patch.shape, tolerance)) continue;
    HomogeneousPoints<3> net(4, patch.shape.homogeneous().cols());
    for (Eigen::Index i = 0; i < net.cols(); ++i) {
      const Eigen::Vector3d point = patch.shape.homogeneous().col(i);
      net.col(i) << point(2) * frame.origin + point(0) * frame.first + point(1) * frame.second, point(2);
    }
    solid.patches.push_back({patch.name, revolve(NurbsCurve<3>(patch.shape.knots(), std::move(net)), axis, angle)});
  }
  if (angle >= 2.0 * std::numbers::pi * (1.0 - 1e-14)) return solid;
  // first x second points against the rotation.
  const std::vector<NurbsSurface<2>> filling = fill(profile);
  append_cap("start_cap", filling, frame, CapSide::along_normal, solid);
  const AffineMap<3> turn = rotation(axis, angle);
  append_cap("end_cap", filling, {frame.origin, turn.linear * frame.first, frame.second}, CapSide::against_normal,
             solid);
  return solid;
}

/// The plane of a closed curve; Newell's normal of its control polygon.
Frame plane_of(const NurbsCurve<3>& section, const char* which) {
  const Points<3> points = section.control_points();
  const Point3 origin = points.rowwise().mean();
  Vector3 normal = Vector3::Zero();
  double size = 0.0;
  Vector3 arm = Vector3::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector3 a = points.col(i) - origin;
    const Vector3 b = points.col((i + 1) % points.cols()) - origin;
    normal += a.cross(b);
    size = std::max(size, a.norm());
    if (a.norm() > arm.norm()) arm = a;
  }
  if (normal.norm() <= 1e-12 * size * size) {
    throw GeometryError(fmt::format("loft: the {} section encloses no area", which));
  }
  normal.normalize();
  const double off = (normal.transpose() * (points.colwise() - origin)).cwiseAbs().maxCoeff();
  if (off > plane_tolerance * size) {
    throw GeometryError(
        fmt::format("loft: the {} section leaves its plane by {:.3g}: only plane ends can be capped", which, off));
  }
  const Vector3 first = (arm - normal * normal.dot(arm)).normalized();
  return {origin, first, normal.cross(first)};
}

bool is_point(const NurbsCurve<3>& section) {
  const Points<3> points = section.control_points();
  return (points.colwise() - points.col(0)).isZero(0.0);
}

/// The end of each wall: `first` or last.
void append_loft_cap(const std::string& name, std::span<const std::vector<NurbsCurve<3>>> walls, bool first,
                     Boundary<3>& solid) {
  const char* which = first ? "first" : "last";
  std::vector<NurbsCurve<3>> loops;
  for (const std::vector<NurbsCurve<3>>& wall : walls) {
    const NurbsCurve<3>& loop = first ? wall.front() : wall.back();
    if (!is_point(loop)) loops.push_back(loop);
  }
  if (loops.empty()) return;
  const Frame frame = plane_of(loops.front(), which);
  const double size = extent(loops, frame.origin);
  if (!lies_in_plane(loops, frame, plane_tolerance * size)) {
    throw GeometryError(fmt::format("loft: the loops of the {} section do not lie in one plane", which));
  }
  Boundary<2> region;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    region.patches.push_back(
        {loops.size() == 1 ? name : fmt::format("{}, loop {}", name, i + 1), project(loops[i], frame)});
  }
  append_cap(name, fill(region), frame, CapSide::along_normal, solid);
}

}  // namespace

Boundary<3> extrude(const Boundary<2>& region, const Vector3& by) {
  checks::unit<3>("extrude", "vector", by);
  if (std::abs(by.z()) <= 1e-12 * by.norm()) {
    throw GeometryError(
        fmt::format("extrude: the vector ({}, {}, {}) is parallel to the plane of the region", by.x(), by.y(), by.z()));
  }
  const Boundary<2> outline = forward(region);
  const bool upward = by.z() > 0.0;
  Boundary<3> solid;
  for (const Patch<2>& patch : outline.patches) {
    const NurbsCurve<3> curve = embed(patch.shape);
    solid.patches.push_back({patch.name, extrude(upward ? curve : reverse(curve), by)});
  }
  const std::vector<NurbsSurface<2>> filling = fill(outline);
  const Frame bottom{Point3::Zero(), Vector3::UnitX(), Vector3::UnitY()};
  const Frame top{Point3(by), Vector3::UnitX(), Vector3::UnitY()};
  append_cap("start_cap", filling, bottom, upward ? CapSide::against_normal : CapSide::along_normal, solid);
  append_cap("end_cap", filling, top, upward ? CapSide::along_normal : CapSide::against_normal, solid);
  return solid;
}

Boundary<3> revolve_solid(std::span<const NurbsCurve<3>> curves, const Axis& axis, double angle) {
  if (curves.empty()) throw GeometryError("revolve: the profile has no curves");
  checks::finite("revolve", "axis point", axis.point);
  const Frame frame = meridian_frame(curves, axis);
  check_profile(curves, frame);
  Boundary<2> profile;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    profile.patches.push_back({curves.size() == 1 ? "side" : fmt::format("side_{}", i + 1), project(curves[i], frame)});
  }
  return revolve_profile(profile, frame, angle);
}

void require_simple_profile(std::span<const NurbsCurve<3>> curves, const Axis& axis) {
  const Frame frame = meridian_frame(curves, axis);
  const double size = extent(curves, frame.origin);
  if (!lies_in_plane(curves, frame, plane_tolerance * size)) return;
  Boundary<2> profile;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    profile.patches.push_back({fmt::format("curve {}", i + 1), project(curves[i], frame)});
    const Point2 beyond = farthest_beyond(profile.patches.back().shape);
    if (beyond.x() >= -1e-6 * size) continue;
    throw GeometryError(
        fmt::format("revolve: curve {} of the profile reaches {:.3g} beyond the axis: a profile that "
                    "makes a full turn must lie on one side of the axis",
                    i + 1, -beyond.x()));
  }
  close_along_axis(profile);
  orient(profile);
}

Boundary<3> revolve(const Boundary<2>& region, const Axis& axis, double angle) {
  std::vector<NurbsCurve<3>> curves;
  for (const Patch<2>& patch : region.patches) curves.push_back(embed(patch.shape));
  if (curves.empty()) throw GeometryError("revolve: the region has no curves");
  checks::finite("revolve", "axis point", axis.point);
  const Frame frame = meridian_frame(curves, axis);
  check_profile(curves, frame);
  Boundary<2> profile;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    profile.patches.push_back({region.patches[i].name, project(curves[i], frame)});
  }
  return revolve_profile(profile, frame, angle);
}

Boundary<3> loft_solid(std::span<const NurbsCurve<3>> sections, const LoftOptions& options) {
  const std::vector<NurbsCurve<3>> wall(sections.begin(), sections.end());
  return loft_solid(std::span<const std::vector<NurbsCurve<3>>>(&wall, 1), options);
}

Boundary<3> loft_solid(std::span<const std::vector<NurbsCurve<3>>> walls, const LoftOptions& options) {
  if (walls.empty()) throw GeometryError("loft: there are no sections");
  Boundary<3> solid;
  for (const std::vector<NurbsCurve<3>>& wall : walls) {
    if (wall.size() != walls.front().size()) {
      throw GeometryError(
          fmt::format("loft: walls through {} and {} sections; expected the same", walls.front().size(), wall.size()));
    }
    const std::size_t number = solid.patches.size() + 1;
    solid.patches.push_back({walls.size() == 1 ? "side" : fmt::format("side_{}", number), loft(wall, options)});
  }
  if (!options.closed) {
    append_loft_cap("start_cap", walls, true, solid);
    append_loft_cap("end_cap", walls, false, solid);
  }
  OrientedBoundary<3> oriented = orient(solid);
  require_closed(oriented);
  for (Patch<3>& patch : oriented.boundary.patches) {
    if (patch.orientation < 0) patch.shape = reverse(surface_of(patch.shape), Direction::u);
    patch.orientation = 1;
  }
  return oriented.boundary;
}

}  // namespace isorim::geometry
