#include "geometry/shapes/solids.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/bezier/element_table.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::Measures;
using testing::measures;
using testing::refusal;
constexpr double pi = std::numbers::pi;

/// f = 0 on the surface, f of the size 1 and growing outward.
using Implicit = std::function<double(const Point3&)>;

void expect_on_surface(const Patch<3>& patch, const Implicit& f, double tolerance) {
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) {
      const SurfaceJet<3> jet = evaluate_jet(surface_of(patch.shape), Point2(i / 40.0, j / 40.0));
      ASSERT_NEAR(f(jet.point), 0.0, tolerance) << patch.name << " " << i << " " << j;
      const Vector3 normal = patch.orientation * jet.du.cross(jet.dv);
      if (normal.norm() < 1e-9) continue;  // at a pole
      const Point3 outside = jet.point + 1e-4 * normal.normalized();
      ASSERT_GT(f(outside), 1e-9) << patch.name << " " << i << " " << j;
    }
  }
}

void expect_solid(const Boundary<3>& solid, double area, double volume) {
  const Measures found = measures(solid);
  EXPECT_NEAR(found.boundary, area, 2e-13 * area);
  EXPECT_NEAR(found.content, volume, 2e-13 * volume);
  const OrientedBoundary<3> oriented = orient(solid);
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_LE(oriented.topology.largest_gap, 1e-14 * bounding_box(bezier_elements(solid)).diagonal());
  for (std::size_t i = 0; i < solid.patches.size(); ++i) {
    EXPECT_EQ(oriented.boundary.patches[i].orientation, solid.patches[i].orientation) << solid.patches[i].name;
  }
}

TEST(Solids, Sphere) {
  const Point3 centre(0.5, -2.0, 1.0);
  const Boundary<3> solid = sphere(1.5, centre);
  ASSERT_EQ(solid.patches.size(), 1U);
  expect_on_surface(
      solid.patches[0], [&](const Point3& x) { return (x - centre).norm() / 1.5 - 1.0; }, 2e-15);
  expect_solid(solid, 9.0 * pi, 4.5 * pi);
  EXPECT_EQ(bezier_elements(solid).elements.size(), 8U);
}

TEST(Solids, SphereOfSixPatches) {
  const Point3 centre(0.5, -2.0, 1.0);
  const Boundary<3> solid = six_patch_sphere(1.5, centre);
  ASSERT_EQ(solid.patches.size(), 6U);
  for (const Patch<3>& patch : solid.patches)
    expect_on_surface(
        patch, [&](const Point3& x) { return (x - centre).norm() / 1.5 - 1.0; }, 2e-15);
  expect_solid(solid, 9.0 * pi, 4.5 * pi);
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const Patch<3>& patch = solid.patches[static_cast<std::size_t>(2 * axis + (side > 0 ? 1 : 0))];
      EXPECT_EQ(patch.name, std::string(1, "xyz"[axis]) + (side > 0 ? "_max" : "_min"));
      const Point3 middle = evaluate(surface_of(patch.shape), Point2(0.5, 0.5));
      EXPECT_LT((middle - centre - 1.5 * side * Vector3::Unit(axis)).norm(), 1e-15);
    }
}

TEST(Solids, TorusOfSixteenPatches) {
  const Boundary<3> solid = sixteen_patch_torus(2.0, 0.5, Point3(1, 1, 1));
  ASSERT_EQ(solid.patches.size(), 16U);
  EXPECT_EQ(solid.patches[1].name, "torus_2_1");
  EXPECT_EQ(bezier_elements(solid).elements.size(), 16U);
  expect_solid(solid, 4.0 * pi * pi, pi * pi);
}

TEST(Solids, Ellipsoid) {
  const Vector3 radii(2.0, 1.0, 0.25);
  const Boundary<3> solid = ellipsoid(radii);
  expect_on_surface(
      solid.patches[0], [&](const Point3& x) { return x.cwiseQuotient(radii).norm() - 1.0; }, 2e-15);
  EXPECT_NEAR(measures(solid).content, 4.0 / 3.0 * pi * 0.5, 1e-13);
}

TEST(Solids, Torus) {
  const Boundary<3> solid = torus(2.0, 0.5, Point3(1, 1, 1));
  const auto f = [](const Point3& x) {
    const Vector3 d = x - Point3(1, 1, 1);
    return std::hypot(std::hypot(d.x(), d.y()) - 2.0, d.z()) / 0.5 - 1.0;
  };
  expect_on_surface(solid.patches[0], f, 5e-15);
  expect_solid(solid, 4.0 * pi * pi, pi * pi);
}

TEST(Solids, Cylinder) {
  const Boundary<3> solid = cylinder(0.5, 3.0, Point3(1, 2, 3));
  ASSERT_EQ(solid.patches.size(), 3U);
  EXPECT_EQ(solid.patches[0].name, "bottom");
  EXPECT_EQ(solid.patches[1].name, "side");
  EXPECT_EQ(solid.patches[2].name, "top");
  expect_on_surface(
      solid.patches[0], [](const Point3& x) { return 3.0 - x.z(); }, 2e-15);
  expect_on_surface(
      solid.patches[1], [](const Point3& x) { return 2.0 * std::hypot(x.x() - 1.0, x.y() - 2.0) - 1.0; }, 2e-15);
  expect_on_surface(
      solid.patches[2], [](const Point3& x) { return x.z() - 6.0; }, 2e-15);
  expect_solid(solid, 3.5 * pi, 0.75 * pi);
}

TEST(Solids, ConeAndFrustum) {
  expect_solid(cone(3.0, 0.0, 4.0, Point3(1, 0, 0)), pi * 3.0 * 5.0 + 9.0 * pi, 12.0 * pi);
  expect_solid(cone(0.0, 3.0, 4.0), pi * 3.0 * 5.0 + 9.0 * pi, 12.0 * pi);
  const Boundary<3> frustum = cone(4.0, 1.0, 4.0);
  expect_solid(frustum, pi * 25.0 + 17.0 * pi, pi * 4.0 / 3.0 * 21.0);
  expect_on_surface(
      frustum.patches[1], [](const Point3& x) { return std::hypot(x.x(), x.y()) - (4.0 - 0.75 * x.z()); }, 4e-15);
}

TEST(Solids, BoxAndCube) {
  const Boundary<3> solid = box(Vector3(1, 2, 3), Point3(-1, 0.1, 7));
  expect_solid(solid, 22.0, 6.0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const Patch<3>& patch = solid.patches[static_cast<std::size_t>(2 * axis + side)];
      const SurfaceJet<3> jet = evaluate_jet(surface_of(patch.shape), Point2(0.5, 0.5));
      Vector3 outward = Vector3::Zero();
      outward(axis) = side == 0 ? -1.0 : 1.0;
      EXPECT_EQ(jet.du.cross(jet.dv).normalized(), outward) << patch.name;
      EXPECT_EQ(patch.name,
                std::string("xyz").substr(static_cast<std::size_t>(axis), 1) + (side == 0 ? "_min" : "_max"));
    }
  }
  expect_solid(cube(2.0), 24.0, 8.0);
}

TEST(Transforms, KeepNormalsOutward) {
  const Boundary<3> solid = cone(2.0, 1.0, 3.0);
  const double volume = 7.0 * pi;
  const AffineMap<3> mirror = mirroring<3>(Point3(1, 2, 3), Vector3(1, -2, 0.5));
  EXPECT_NEAR(measures(transform(solid, mirror)).content, volume, 1e-12);
  EXPECT_EQ(transform(solid, mirror).patches[0].orientation, -1);
  EXPECT_NEAR(measures(transform(solid, scaling<3>(Vector3(2, -3, 0.5), Point3(1, 0, 0)))).content, 3.0 * volume,
              1e-11);
  const AffineMap<3> turn = rotation(Axis{Point3(1, 1, 0), Vector3(1, 2, 3)}, 0.7);
  const AffineMap<3> moved = compose(translation<3>(Vector3(4, 5, 6)), turn);
  EXPECT_NEAR(measures(transform(solid, moved)).content, volume, 1e-12);
  EXPECT_TRUE(orient(transform(solid, moved)).topology.closed);
  EXPECT_NEAR((turn.linear * turn.linear.transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-15);
}

TEST(Transforms, RotateRightHanded) {
  EXPECT_EQ(rotation(Axis{}, 0.5 * pi)(Point3(1, 0, 0)), Point3(0, 1, 0));
  EXPECT_EQ(rotation(Axis{Point3(0, 0, 0), Vector3(3, 0, 0)}, 0.5 * pi)(Point3(0, 1, 0)), Point3(0, 0, 1));
  EXPECT_EQ(rotation(Point2(1, 0), 0.5 * pi)(Point2(2, 0)), Point2(1, 1));
  EXPECT_EQ(mirroring<2>(Point2(1, 0), Vector2(2, 0))(Point2(3, 5)), Point2(-1, 5));
  EXPECT_EQ(scaling<2>(Vector2(2, 3), Point2(1, 1))(Point2(2, 2)), Point2(3, 4));
}

TEST(Transforms, RefuseSingularMaps) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  AffineMap<3> flat;
  flat.linear(2, 2) = 0.0;
  EXPECT_THAT(refusal([&] { transform(cube(1.0), flat); }), HasSubstr("the map is singular"));
  EXPECT_THAT(refusal([] { scaling<3>(Vector3(1, 0, 1)); }), HasSubstr("scaling: factors[1] is 0"));
  EXPECT_THAT(refusal([] { mirroring<3>(Point3(0, 0, 0), Vector3(0, 0, 0)); }), HasSubstr("mirror: normal is zero"));
  EXPECT_THAT(refusal([] {
                rotation(Axis{Point3(0, 0, 0), Vector3(0, 0, 0)}, 1.0);
              }),
              HasSubstr("axis direction is zero"));
  EXPECT_THAT(refusal([&] { rotation(Axis{}, nan); }), HasSubstr("angle is nan"));
  EXPECT_THAT(refusal([&] { translation<2>(Vector2(nan, 0)); }), HasSubstr("by[0] is nan"));
}

TEST(Solids, RefuseWrongParameters) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal([] { sphere(-1.0); }), HasSubstr("sphere: radius is -1, it must be positive"));
  EXPECT_THAT(refusal([&] { sphere(1.0, Point3(0, infinity, 0)); }), HasSubstr("sphere: centre[1] is inf"));
  EXPECT_THAT(refusal([] { ellipsoid(Vector3(1, 1, 0)); }), HasSubstr("ellipsoid: radii[2] is 0"));
  EXPECT_THAT(refusal([] { torus(1.0, 1.0); }), HasSubstr("minor_radius is 1, it must be smaller"));
  EXPECT_THAT(refusal([] { torus(0.0, 1.0); }), HasSubstr("major_radius is 0"));
  EXPECT_THAT(refusal([] { cylinder(1.0, -2.0); }), HasSubstr("cylinder: height is -2"));
  EXPECT_THAT(refusal([] { cone(0.0, 0.0, 1.0); }), HasSubstr("are both 0"));
  EXPECT_THAT(refusal([] { cone(-1.0, 0.0, 1.0); }), HasSubstr("base_radius is -1, it must not be negative"));
  EXPECT_THAT(refusal([] { box(Vector3(1, 1, -1)); }), HasSubstr("box: size[2] is -1"));
  EXPECT_THAT(refusal([] { cube(0.0); }), HasSubstr("cube: side is 0"));
}

}  // namespace
}  // namespace isorim::geometry
