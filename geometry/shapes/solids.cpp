#include "geometry/shapes/solids.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/transforms.h"

namespace isorim::geometry {
namespace {

constexpr double pi = std::numbers::pi;

/// The meridian plane: (r, z) becomes (r, 0, z).
NurbsCurve<3> in_meridian_plane(const NurbsCurve<2>& profile) {
  AffineMap<3> upright;
  upright.linear << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0;
  return transform(embed(profile), upright);
}

NurbsSurface<3> revolve_about_z(const NurbsCurve<2>& profile) {
  return revolve(in_meridian_plane(profile), Axis{}, 2.0 * pi);
}

/// The horizontal circle about `centre`, counter-clockwise seen from above; radius 0 gives the point, on the same knots
/// with the same weights.
NurbsCurve<3> horizontal_circle(double radius, const Point3& centre) {
  AffineMap<3> place;
  place.linear.diagonal() << radius, radius, 1.0;
  place.translation = centre;
  return transform(embed(unit_arc(0.0, 2.0 * pi)), place);
}

/// The parallelogram corner + u a + v b.
NurbsSurface<3> parallelogram(const Point3& corner, const Vector3& a, const Vector3& b) {
  Points<3> points(3, 4);
  points << corner, corner + a, corner + b, corner + (a + b);
  return NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), points);
}

/// The part of the unit sphere above the face z = 1 of the cube, u along x and v along y (J. E. Cobb, Tiling the sphere
/// with rational Bezier patches, University of Utah, 1988). By symmetry a quarter of the net says everything.
NurbsSurface<3> sixth_of_unit_sphere() {
  const double t = std::numbers::sqrt3;
  const double d = std::numbers::sqrt2;
  using Quarter = std::array<std::array<Eigen::Vector4d, 3>, 3>;
  const Quarter quarter{{{{{4.0 * (1.0 - t), 4.0 * (1.0 - t), 4.0 * (t - 1.0), 4.0 * (3.0 - t)},
                           {-d, d * (t - 4.0), d * (4.0 - t), d * (3.0 * t - 2.0)},
                           {0.0, 4.0 * (1.0 - 2.0 * t) / 3.0, 4.0 * (2.0 * t - 1.0) / 3.0, 4.0 * (5.0 - t) / 3.0}}},
                         {{{d * (t - 4.0), -d, d * (4.0 - t), d * (3.0 * t - 2.0)},
                           {(2.0 - 3.0 * t) / 2.0, (2.0 - 3.0 * t) / 2.0, (t + 6.0) / 2.0, (t + 6.0) / 2.0},
                           {0.0, d * (2.0 * t - 7.0) / 3.0, 5.0 * d * t / 3.0, d * (t + 6.0) / 3.0}}},
                         {{{4.0 * (1.0 - 2.0 * t) / 3.0, 0.0, 4.0 * (2.0 * t - 1.0) / 3.0, 4.0 * (5.0 - t) / 3.0},
                           {d * (2.0 * t - 7.0) / 3.0, 0.0, 5.0 * d * t / 3.0, d * (t + 6.0) / 3.0},
                           {0.0, 0.0, 4.0 * (5.0 - t) / 3.0, 4.0 * (5.0 * t - 1.0) / 9.0}}}}};
  HomogeneousPoints<3> net(4, 25);
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) {
      Eigen::Vector4d point =
          quarter[static_cast<std::size_t>(std::min(j, 4 - j))][static_cast<std::size_t>(std::min(i, 4 - i))];
      if (i > 2) point.x() = -point.x();
      if (j > 2) point.y() = -point.y();
      net.col(i + 5 * j) = point;
    }
  return {KnotVector::bezier(4), KnotVector::bezier(4), net};
}

Boundary<3> turned_solid(double base_radius, double top_radius, double height, const Point3& base) {
  const Point3 top_centre = base + Vector3(0.0, 0.0, height);
  const NurbsCurve<3> bottom_rim = horizontal_circle(base_radius, base);
  const NurbsCurve<3> top_rim = horizontal_circle(top_radius, top_centre);
  Boundary<3> result;
  if (base_radius > 0.0) result.patches.push_back({"bottom", fan<3>(reverse(bottom_rim), base)});
  result.patches.push_back({"side", ruled(bottom_rim, top_rim)});
  if (top_radius > 0.0) result.patches.push_back({"top", fan<3>(top_rim, top_centre)});
  return result;
}

}  // namespace

Boundary<3> sphere(double radius, const Point3& centre) {
  checks::positive("sphere", "radius", radius);
  checks::finite("sphere", "centre", centre);
  Boundary<3> result = ellipsoid(Vector3::Constant(radius), centre);
  result.patches[0].name = "sphere";
  return result;
}

Boundary<3> six_patch_sphere(double radius, const Point3& centre) {
  checks::positive("sphere", "radius", radius);
  checks::finite("sphere", "centre", centre);
  const NurbsSurface<3> face = sixth_of_unit_sphere();
  const std::array<const char*, 6> names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  Boundary<3> result;
  for (int i = 0; i < 6; ++i) {
    const int axis = i / 2;
    // Rotations: a half turn about x for the lower side, then z to the axis in the cyclic order.
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    AffineMap<3> place;
    place.linear.setZero();
    place.linear((axis + 1) % 3, 0) = radius;
    place.linear((axis + 2) % 3, 1) = side * radius;
    place.linear(axis, 2) = side * radius;
    place.translation = centre;
    result.patches.push_back({names[static_cast<std::size_t>(i)], transform(face, place)});
  }
  return result;
}

Boundary<3> ellipsoid(const Vector3& radii, const Point3& centre) {
  checks::positive("ellipsoid", "radii", radii);
  checks::finite("ellipsoid", "centre", centre);
  AffineMap<3> map;
  map.linear = radii.asDiagonal();
  map.translation = centre;
  const NurbsSurface<3> unit_sphere = revolve_about_z(unit_arc(-0.5 * pi, 0.5 * pi));
  return {{{"ellipsoid", transform(unit_sphere, map)}}};
}

Boundary<3> torus(double major_radius, double minor_radius, const Point3& centre) {
  checks::positive("torus", "major_radius", major_radius);
  checks::positive("torus", "minor_radius", minor_radius);
  checks::finite("torus", "centre", centre);
  if (minor_radius >= major_radius) {
    throw GeometryError(fmt::format("torus: minor_radius is {}, it must be smaller than major_radius = {}",
                                    minor_radius, major_radius));
  }
  const NurbsSurface<3> ring = revolve_about_z(circle_curve(minor_radius, Point2(major_radius, 0.0)));
  return {{{"torus", transform(ring, translation<3>(centre))}}};
}

Boundary<3> sixteen_patch_torus(double major_radius, double minor_radius, const Point3& centre) {
  const Boundary<3> ring = torus(major_radius, minor_radius, centre);
  Boundary<3> result;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      result.patches.push_back({fmt::format("torus_{}_{}", i + 1, j + 1),
                                restrict_to(surface_of(ring.patches[0].shape), Interval{0.25 * i, 0.25 * (i + 1)},
                                            Interval{0.25 * j, 0.25 * (j + 1)})});
  return result;
}

Boundary<3> cylinder(double radius, double height, const Point3& base) {
  checks::positive("cylinder", "radius", radius);
  checks::positive("cylinder", "height", height);
  checks::finite("cylinder", "base", base);
  return turned_solid(radius, radius, height, base);
}

Boundary<3> cone(double base_radius, double top_radius, double height, const Point3& base) {
  checks::not_negative("cone", "base_radius", base_radius);
  checks::not_negative("cone", "top_radius", top_radius);
  checks::positive("cone", "height", height);
  checks::finite("cone", "base", base);
  if (base_radius == 0.0 && top_radius == 0.0) throw GeometryError("cone: base_radius and top_radius are both 0");
  return turned_solid(base_radius, top_radius, height, base);
}

Boundary<3> box(const Vector3& size, const Point3& corner) {
  checks::positive("box", "size", size);
  checks::finite("box", "corner", corner);
  const Vector3 x(size.x(), 0.0, 0.0);
  const Vector3 y(0.0, size.y(), 0.0);
  const Vector3 z(0.0, 0.0, size.z());
  return {{{"x_min", parallelogram(corner, z, y)},
           {"x_max", parallelogram(corner + x, y, z)},
           {"y_min", parallelogram(corner, x, z)},
           {"y_max", parallelogram(corner + y, z, x)},
           {"z_min", parallelogram(corner, y, x)},
           {"z_max", parallelogram(corner + z, x, y)}}};
}

Boundary<3> cube(double side, const Point3& corner) {
  checks::positive("cube", "side", side);
  return box(Vector3::Constant(side), corner);
}

}  // namespace isorim::geometry
