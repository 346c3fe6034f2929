#include "solver/hydrostatics/hydrostatics.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/intersection/clip.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "solver/properties.h"
#include "tests/geometry/tspline/extracted_surfaces.h"
#include "tests/solver/hydrostatics/wigley.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;
using std::numbers::pi;

Hydrostatics at(const Boundary<3>& boundary, const Attitude& attitude, const std::optional<ShipFrame>& frame = {}) {
  const FloatingBody body(boundary);
  const ShipFrame ship = frame.value_or(default_frame(body));
  const geometry::PlaneCutter cutter(boundary);
  return hydrostatics(body, station_section(cutter, ship.origin.x()), ship, attitude);
}

ImmersedBody under(const Boundary<3>& boundary, const WaterPlane& plane) {
  const FloatingBody body(boundary);
  return immersed_body(body, plane, body.wetted(plane));
}

Boundary<3> together(const std::vector<Boundary<3>>& parts) {
  Boundary<3> all;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (geometry::Patch<3> patch : parts[i].patches) {
      patch.name += fmt::format("_{}", i + 1);
      all.patches.push_back(patch);
    }
  return all;
}

/// A solid cylinder of radius 1 along x, its patches' edges turned about the axis.
Boundary<3> lying_cylinder(double turn) {
  const Eigen::Matrix3d to_x = Eigen::AngleAxisd(0.5 * pi, Vector3::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d about_x = Eigen::AngleAxisd(turn, Vector3::UnitX()).toRotationMatrix();
  return geometry::transform<3>(geometry::cylinder(1.0, 6.0), {about_x * to_x, Vector3::Zero()});
}

// --- The Wigley hull ------------------------------------------------------------------------------------------

struct WigleyAtDraught {
  double draught, volume, kb, waterplane_area, it, il, bmt, bml;
};

// reference/hull_wigley.toml: the formulas evaluated with 16 digits.
constexpr WigleyAtDraught wigley_truth[] = {
    {0.15625, 0.2387152777777778, 0.1029829545454545, 2.916666666666667, 0.03190104166666667, 14.58333333333333,
     0.1336363636363636, 61.09090909090909},
    {0.3125, 0.8680555555555556, 0.2031250000000000, 5.0, 0.1607142857142857, 25.0, 0.1851428571428571, 28.8},
    {0.46875, 1.7578125, 0.2994791666666667, 6.25, 0.3138950892857143, 31.25, 0.1785714285714286, 17.77777777777778},
    {0.625, 2.777777777777778, 0.3906250000000000, 6.666666666666667, 0.3809523809523810, 33.33333333333333,
     0.1371428571428571, 12.0}};

class WigleyHydrostatics : public ::testing::TestWithParam<WigleyAtDraught> {};

TEST_P(WigleyHydrostatics, AreExact) {
  const WigleyAtDraught& truth = GetParam();
  const Hydrostatics h = at(testing::wigley_hull(), {.draught = truth.draught});
  const auto expect = [](const quadrature::Estimate& found, double expected, const char* what) {
    EXPECT_NEAR(found.value, expected, 1e-13 * std::max(1.0, expected)) << what;
    EXPECT_LE(std::abs(found.value - expected), found.error + 1e-15 * expected) << what;
  };
  expect(h.immersed.volume, truth.volume, "volume");
  expect(h.vcb, truth.kb, "vcb");
  expect(h.lcb, 0.0, "lcb");
  expect(h.tcb, 0.0, "tcb");
  expect(h.immersed.waterplane.area, truth.waterplane_area, "waterplane area");
  expect(h.lcf, 0.0, "lcf");
  expect(h.it, truth.it, "it");
  expect(h.il, truth.il, "il");
  expect(h.itl, 0.0, "itl");
  expect(h.bmt, truth.bmt, "bmt");
  expect(h.bml, truth.bml, "bml");
  expect(h.kmt, truth.kb + truth.bmt, "kmt");
  const double breadth = 1.0 - std::pow(truth.draught / 0.625 - 1.0, 2);
  EXPECT_NEAR(*h.waterline_length, 10.0, 1e-14);
  EXPECT_NEAR(*h.waterline_beam, breadth, 1e-15);
  expect(*h.cwp, 2.0 / 3.0, "cwp");
  expect(*h.cp, 2.0 / 3.0, "cp");
  expect(*h.cb, truth.volume / (10.0 * breadth * truth.draught), "cb");
  EXPECT_EQ(h.unfinished, 0);
  EXPECT_LT(h.immersed.closure_defect, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(FourDraughts, WigleyHydrostatics, ::testing::ValuesIn(wigley_truth));

TEST(WigleyWettedSurface, MeetsThirtyDigitQuadrature) {
  const Hydrostatics h = at(testing::wigley_hull(), {.draught = 0.625});
  EXPECT_NEAR(h.wetted_surface.value, 14.8790631049578, 2e-13);
  EXPECT_NEAR(h.cb->value, 4.0 / 9.0, 1e-15);
  EXPECT_NEAR(h.cm->value, 2.0 / 3.0, 1e-15);
}

// --- Boxes ----------------------------------------------------------------------------------------------------

TEST(BoxHydrostatics, FollowTheWallSidedFormulas) {
  const double length = 4.0;
  const double beam = 2.0;
  const double height = 3.0;
  const Boundary<3> box = geometry::box({length, beam, height}, {-2.0, -1.0, 0.0});
  for (const double trim : {-0.2, 0.0, 0.1})
    for (const double heel : {-0.3, 0.0, 0.4}) {
      const double draught = 1.4;
      const Hydrostatics h = at(box, {draught, trim, heel});
      // The depth of water over the bottom is draught - a x - b y.
      const double a = std::tan(trim) / std::cos(heel);
      const double b = std::tan(heel);
      const double area = length * beam;
      const double volume = area * draught;
      const double xx = std::pow(length, 3) * beam / 12.0;
      const double yy = std::pow(beam, 3) * length / 12.0;
      EXPECT_NEAR(h.immersed.volume.value, volume, 1e-13);
      EXPECT_NEAR(h.lcb.value, -a * xx / volume, 1e-14);
      EXPECT_NEAR(h.tcb.value, -b * yy / volume, 1e-14);
      EXPECT_NEAR(h.vcb.value, 0.5 * (draught * draught * area + a * a * xx + b * b * yy) / volume, 1e-14);
      EXPECT_NEAR(h.lcf.value, 0.0, 1e-14);
      const double stretch = std::sqrt(1.0 + a * a + b * b);
      EXPECT_NEAR(h.immersed.waterplane.area.value, area * stretch, 1e-13);
      // In the plane by its own axes: points (x, y, draught - a x - b y).
      const Vector3 along_x(1.0, 0.0, -a);
      const Vector3 along_y(0.0, 1.0, -b);
      const WaterAxes& axes = h.immersed.axes;
      const auto moment = [&](const Vector3& p, const Vector3& q) {
        return stretch * (xx * p.dot(along_x) * q.dot(along_x) + yy * p.dot(along_y) * q.dot(along_y));
      };
      EXPECT_NEAR(h.il.value, moment(axes.forward, axes.forward), 1e-12);
      EXPECT_NEAR(h.it.value, moment(axes.port, axes.port), 1e-12);
      EXPECT_NEAR(h.itl.value, moment(axes.forward, axes.port), 1e-12);
      // Bottom and the four sides, wall by wall.
      const double wetted = area + 2.0 * draught * (length + beam);
      EXPECT_NEAR(h.wetted_surface.value, wetted, 1e-12);
      EXPECT_NEAR(*h.waterline_length, length, 1e-14);
      EXPECT_NEAR(*h.waterline_beam, beam, 1e-14);
      EXPECT_LT(h.immersed.closure_defect, 1e-15);
    }
}

TEST(BoxHydrostatics, DeckAndBottomInTheWaterPlane) {
  const Boundary<3> box = geometry::box({4.0, 2.0, 3.0}, {-2.0, -1.0, 0.0});
  const Hydrostatics deck = at(box, {.draught = 3.0});
  EXPECT_NEAR(deck.immersed.volume.value, 24.0, 1e-13);
  EXPECT_NEAR(deck.immersed.waterplane.area.value, 8.0, 1e-13);
  EXPECT_NEAR(deck.wetted_surface.value, 44.0, 1e-12);
  EXPECT_NEAR(deck.it.value, 4.0 * 8.0 / 12.0, 1e-13);
  EXPECT_NEAR(*deck.waterline_length, 4.0, 1e-14);
  const Hydrostatics bottom = at(box, {.draught = 0.0});
  EXPECT_EQ(bottom.immersed.volume.value, 0.0);
  EXPECT_EQ(bottom.immersed.waterplane.area.value, 0.0);
  EXPECT_EQ(bottom.wetted_surface.value, 0.0);
  EXPECT_FALSE(bottom.waterline_length);
  EXPECT_FALSE(bottom.cb);
}

TEST(BoxHydrostatics, SubmergedAndEmerged) {
  const Boundary<3> box = geometry::box({4.0, 2.0, 3.0}, {-2.0, -1.0, 0.0});
  const Hydrostatics deep = at(box, {.draught = 7.0, .trim = 0.2, .heel = -0.4});
  EXPECT_NEAR(deep.immersed.volume.value, 24.0, 1e-13);
  EXPECT_NEAR(deep.vcb.value, 1.5, 1e-14);
  EXPECT_NEAR(deep.immersed.waterplane.area.value, 0.0, 1e-13);
  EXPECT_NEAR(deep.wetted_surface.value, 52.0, 1e-12);
  EXPECT_NEAR(deep.bmt.value, 0.0, 1e-13);
  EXPECT_EQ(deep.cut_elements, 0);
  const Hydrostatics dry = at(box, {.draught = -1.0});
  EXPECT_EQ(dry.immersed.volume.value, 0.0);
  EXPECT_EQ(dry.immersed_elements, 0);
}

TEST(BoxHydrostatics, WaterlineThroughEdgesAndCorners) {
  // The plane through the upper port and the lower starboard edge halves the box.
  const Boundary<3> box = geometry::box({4.0, 2.0, 2.0}, {-2.0, -1.0, -1.0});
  const double heel = pi / 4.0;
  const ImmersedBody half = under(box, {up_direction(0.0, heel), 0.0});
  EXPECT_NEAR(half.volume.value, 8.0, 1e-13);
  EXPECT_NEAR(half.waterplane.area.value, 4.0 * 2.0 * std::sqrt(2.0), 1e-13);
  EXPECT_NEAR(half.centre_of_buoyancy.y(), -1.0 / 3.0, 1e-14);
  EXPECT_NEAR(half.centre_of_buoyancy.z(), -1.0 / 3.0, 1e-14);
  // The plane through three corners of a cube cuts off a sixth; that through six edges' middles is a hexagon.
  const Boundary<3> cube = geometry::box({1.0, 1.0, 1.0});
  const Vector3 diagonal = Vector3::Ones().normalized();
  const ImmersedBody corner = under(cube, {diagonal, 1.0 / std::sqrt(3.0)});
  EXPECT_NEAR(corner.volume.value, 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(corner.waterplane.area.value, std::sqrt(3.0) / 2.0, 1e-15);
  EXPECT_LT((corner.centre_of_buoyancy - Point3::Constant(0.25)).norm(), 1e-14);
  const ImmersedBody middle = under(cube, {diagonal, 1.5 / std::sqrt(3.0)});
  EXPECT_NEAR(middle.volume.value, 0.5, 1e-15);
  EXPECT_NEAR(middle.waterplane.area.value, 0.75 * std::sqrt(3.0), 1e-14);
}

// --- Ellipsoids: affine images of a sphere's cap --------------------------------------------------------------

struct CapTruth {
  double volume;
  Point3 centre;
  double area;
  Point3 centroid;
  Eigen::Matrix3d second_moments;
};

/// Of the ellipsoid with semi-axes d about the origin, under up . x = offset.
CapTruth ellipsoid_cap(const Vector3& d, const WaterPlane& plane) {
  const Vector3 image = d.cwiseProduct(plane.up);
  const double length = image.norm();
  const Vector3 m = image / length;
  const double h = plane.offset / length;
  CapTruth cap;
  cap.volume = d.prod() * pi * (2.0 + 3.0 * h - h * h * h) / 3.0;
  const double height = -0.75 * std::pow(1.0 - h * h, 2) / (2.0 + 3.0 * h - h * h * h);
  cap.centre = height * d.cwiseProduct(m);
  cap.area = pi * (1.0 - h * h) * d.prod() / length;
  cap.centroid = h * d.cwiseProduct(m);
  const Eigen::Matrix3d scale = d.asDiagonal();
  cap.second_moments =
      cap.area * 0.25 * (1.0 - h * h) * scale * (Eigen::Matrix3d::Identity() - m * m.transpose()) * scale;
  return cap;
}

void expect_cap(const Boundary<3>& boundary, const Vector3& semi_axes, const WaterPlane& plane) {
  const CapTruth cap = ellipsoid_cap(semi_axes, plane);
  const ImmersedBody found = under(boundary, plane);
  EXPECT_NEAR(found.volume.value, cap.volume, 1e-10);
  EXPECT_LE(std::abs(found.volume.value - cap.volume), found.volume.error);
  EXPECT_LT((found.centre_of_buoyancy - cap.centre).norm(), 1e-10);
  EXPECT_NEAR(found.waterplane.area.value, cap.area, 1e-10);
  EXPECT_LT((found.waterplane.centroid - cap.centroid).norm(), 1e-10);
  Eigen::Matrix<double, 3, 2> axes;
  axes << found.axes.forward, found.axes.port;
  const Eigen::Matrix2d moments = axes.transpose() * cap.second_moments * axes;
  EXPECT_LT((found.waterplane.second_moments - moments).cwiseAbs().maxCoeff(), 2e-10);
}

TEST(EllipsoidHydrostatics, FollowTheAffineImageOfACap) {
  const Vector3 semi_axes(3.0, 1.2, 0.7);
  const Boundary<3> ellipsoid = geometry::ellipsoid(semi_axes);
  for (const double trim : {0.0, 0.35})
    for (const double heel : {0.0, 0.8, 2.2})
      for (const double offset : {-0.4, 0.0, 0.3}) {
        SCOPED_TRACE(::testing::Message() << "trim " << trim << ", heel " << heel << ", offset " << offset);
        expect_cap(ellipsoid, semi_axes, {up_direction(trim, heel), offset});
      }
}

TEST(EllipsoidHydrostatics, DoNotDependOnHowTheSurfaceIsGiven) {
  const WaterPlane plane{up_direction(0.2, 0.5), 0.15};
  expect_cap(geometry::testing::extracted(geometry::sphere(1.0)), Vector3::Ones(), plane);
  expect_cap(geometry::six_patch_sphere(1.0), Vector3::Ones(), plane);
}

TEST(EllipsoidHydrostatics, TangentPlanesTouchNothing) {
  const Boundary<3> sphere = geometry::sphere(1.0);
  const ImmersedBody full = under(sphere, {Vector3::UnitZ(), 1.0});
  EXPECT_NEAR(full.volume.value, 4.0 * pi / 3.0, 1e-11);
  EXPECT_NEAR(full.waterplane.area.value, 0.0, 1e-11);
  const ImmersedBody none = under(sphere, {Vector3::UnitZ(), -1.0});
  EXPECT_NEAR(none.volume.value, 0.0, 1e-14);
  // Beside a pole and beside a point on a knot line.
  for (const Vector3& up : {Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(0.6, 0.8, 0)})
    for (const double depth : {1e-3, 1e-6}) {
      const double h = -1.0 + depth;
      EXPECT_NEAR(under(sphere, {up, h}).volume.value, pi * depth * depth * (3.0 - depth) / 3.0, 1e-12);
    }
}

// --- Round and hollow bodies ----------------------------------------------------------------------------------

Boundary<3> lying_cylinder(double radius, double length) {
  const geometry::AffineMap<3> lay = geometry::rotation(geometry::Axis{Point3::Zero(), Vector3::UnitY()}, pi / 2.0);
  return geometry::transform(geometry::cylinder(radius, length, {0.0, 0.0, -0.5 * length}), lay);
}

TEST(CylinderHydrostatics, HaveTheCircularSegmentAtAnyHeel) {
  const double radius = 1.5;
  const double length = 4.0;
  const Boundary<3> cylinder = lying_cylinder(radius, length);
  for (const double offset : {-0.9, 0.0, 0.6, 1.4})
    for (const double heel : {0.0, 0.7, 3.0}) {
      const double half_angle = std::acos(-offset / radius);
      const double segment = radius * radius * (half_angle - std::sin(half_angle) * std::cos(half_angle));
      const double half_breadth = radius * std::sin(half_angle);
      const ImmersedBody found = under(cylinder, {up_direction(0.0, heel), offset});
      EXPECT_NEAR(found.volume.value, segment * length, 1e-10);
      EXPECT_NEAR(found.waterplane.area.value, 2.0 * half_breadth * length, 1e-10);
      EXPECT_NEAR(found.waterplane.second_moments(1, 1), 2.0 / 3.0 * std::pow(half_breadth, 3) * length, 1e-10);
      const double depth = 2.0 / 3.0 * std::pow(half_breadth, 3) / segment;
      EXPECT_LT((found.centre_of_buoyancy + depth * found.axes.up).norm(), 1e-10);
    }
}

/// The elliptic cylinder y = cos t, z = a sin t, |x| <= 3 up to z = 0.1 a: the wetted surface, for a = 0.01 and 1e-3,
/// by quadrature with 30 digits.
TEST(CylinderHydrostatics, WettedSurfacesOfThinOnesReachTheTolerance) {
  for (const auto& [thickness, area] : {std::pair{1e-2, 12.1009517336845391}, {1e-3, 12.0637732189889501}}) {
    const geometry::AffineMap<3> flat = geometry::scaling<3>({1.0, 1.0, thickness});
    for (const double turn : {0.0, 0.6, pi / 4.0}) {
      const Boundary<3> body = geometry::transform<3>(lying_cylinder(turn), flat);
      const Hydrostatics result = at(body, {1.1 * thickness, 0.0, 0.0});
      EXPECT_EQ(result.unfinished, 0) << thickness << ' ' << turn;
      EXPECT_NEAR(result.wetted_surface.value, area, 1e-11);
      EXPECT_LE(std::abs(result.wetted_surface.value - area), result.wetted_surface.error + 1e-14);
    }
  }
}

/// Coordinates of a yard or a map: what rounding leaves of a body far from the origin.
TEST(CylinderHydrostatics, FarFromTheOriginAreRoundingAway) {
  for (const double far : {1e3, 1e6}) {
    const geometry::AffineMap<3> shift = geometry::translation<3>({far, -far, far});
    const Hydrostatics result = at(geometry::transform<3>(lying_cylinder(0.6), shift), {1.0, 0.0, 0.0});
    EXPECT_EQ(result.unfinished, 0);
    EXPECT_NEAR(result.immersed.volume.value, 3.0 * pi, result.immersed.volume.error);
    EXPECT_LE(result.immersed.volume.error, 1e-13 * far);
    EXPECT_NEAR(result.wetted_surface.value, 7.0 * pi, result.wetted_surface.error);
    EXPECT_LE(result.wetted_surface.error, 1e-13 * far);
    EXPECT_NEAR(result.vcb.value, 1.0 - 4.0 / (3.0 * pi), 1e-14 * far);
  }
}

TEST(HollowHydrostatics, TorusHasAnAnnularWaterplane) {
  const double big = 2.0;
  const double small = 0.5;
  const ImmersedBody half = under(geometry::torus(big, small), {Vector3::UnitZ(), 0.0});
  EXPECT_NEAR(half.volume.value, pi * pi * big * small * small, 1e-10);
  EXPECT_NEAR(half.waterplane.area.value, pi * (std::pow(big + small, 2) - std::pow(big - small, 2)), 1e-10);
  const double moment = pi / 4.0 * (std::pow(big + small, 4) - std::pow(big - small, 4));
  EXPECT_NEAR(half.waterplane.second_moments(0, 0), moment, 1e-10);
  EXPECT_NEAR(half.waterplane.second_moments(1, 1), moment, 1e-10);
  // Upright on its rim: two loops.
  const ImmersedBody rim = under(geometry::torus(big, small), {Vector3::UnitX(), 0.0});
  EXPECT_NEAR(rim.waterplane.area.value, 2.0 * pi * small * small, 1e-10);
  EXPECT_NEAR(rim.waterplane.second_moments(0, 1), 0.0, 1e-10);
  // Tangent to the inner equator with R = 2 r: Bernoulli's lemniscate, whose area is its half width squared.
  const ImmersedBody eight = under(geometry::torus(1.0, 0.5), {Vector3::UnitX(), 0.5});
  EXPECT_NEAR(eight.waterplane.area.value, 1.5 * 1.5 - 0.5 * 0.5, 1e-10);
}

TEST(HollowHydrostatics, CatamaranIsItsHulls) {
  const Boundary<3> both =
      together({geometry::box({6.0, 1.0, 2.0}, {-3.0, 2.0, 0.0}), geometry::box({6.0, 1.0, 2.0}, {-3.0, -3.0, 0.0})});
  const Hydrostatics h = at(both, {.draught = 0.8});
  EXPECT_NEAR(h.immersed.volume.value, 9.6, 1e-13);
  EXPECT_NEAR(h.immersed.waterplane.area.value, 12.0, 1e-13);
  EXPECT_NEAR(h.it.value, 2.0 * (6.0 / 12.0 + 6.0 * 2.5 * 2.5), 1e-12);
  EXPECT_NEAR(h.tcb.value, 0.0, 1e-14);
  EXPECT_NEAR(*h.waterline_beam, 6.0, 1e-14);
}

// --- Any body: against the body clipped and closed --------------------------------------------------------------

class AnyBody : public ::testing::TestWithParam<int> {
 protected:
  static Boundary<3> body(int which) {
    switch (which) {
      case 0:
        return geometry::clip(geometry::sphere(1.0), geometry::CylinderTool{.point = {0.3, 0.1, 0.0},
                                                                            .axis = Vector3::UnitZ(),
                                                                            .radius = 0.4,
                                                                            .keep = geometry::KeptSide::outside});
      case 1:
        return geometry::clip(geometry::torus(1.0, 0.4), geometry::PlaneTool{{0.2, 0.0, 0.0}, {1.0, 0.3, 0.2}});
      case 2:
        return geometry::cone(1.0, 0.3, 1.5);
      default:
        return geometry::transform(testing::wigley_hull(),
                                   geometry::rotation(geometry::Axis{Point3(1, 0, 0), Vector3(1, 2, 3)}, 0.7));
    }
  }
};

TEST_P(AnyBody, AgreesWithTheClippedSolid) {
  Boundary<3> boundary = body(GetParam());
  for (std::size_t i = 0; i < boundary.patches.size(); ++i) boundary.patches[i].name = fmt::format("face_{}", i);
  const FloatingBody floating(boundary);
  const Point3 middle = floating.box().middle();
  for (const double heel : {0.0, 0.35, -1.2}) {
    const Vector3 up = up_direction(0.15, heel);
    const WaterPlane plane{up, up.dot(middle) + 0.07};
    const ImmersedBody found = immersed_body(floating, plane, floating.wetted(plane));
    const Boundary<3> clipped = geometry::clip(boundary, geometry::PlaneTool{plane.offset * up, up});
    const auto properties = geometric_properties(geometry::bezier_elements(clipped));
    EXPECT_NEAR(found.volume.value, properties.domain->measure.value, 2e-10);
    EXPECT_LT((found.centre_of_buoyancy - properties.domain->centroid).norm(), 2e-10);
    Boundary<3> caps;
    for (const geometry::Patch<3>& patch : clipped.patches)
      if (patch.name.starts_with("cap")) caps.patches.push_back(patch);
    const geometry::ElementTable<3> table = geometry::bezier_elements(caps);
    PropertyOptions<3> surface_only;
    surface_only.scope = PropertyOptions<3>::Scope::boundary_only;
    EXPECT_NEAR(found.waterplane.area.value, geometric_properties(table, surface_only).boundary_measure.value, 2e-10);
    const WettedPart part = floating.wetted(plane, WettedScope::moments_and_area);
    EXPECT_NEAR(part.sums.value[WettedLayout::area] + found.waterplane.area.value, properties.boundary_measure.value,
                1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, AnyBody, ::testing::Range(0, 4));

// --- Conventions ----------------------------------------------------------------------------------------------

TEST(Attitudes, TurnWithTheirSigns) {
  const Boundary<3> box = geometry::box({4.0, 2.0, 3.0}, {-2.0, -1.0, 0.0});
  // Starboard (-y) down: buoyancy moves to starboard. By the stern: it moves aft.
  EXPECT_LT(at(box, {1.0, 0.0, 0.1}).tcb.value, -0.01);
  EXPECT_LT(at(box, {1.0, 0.1, 0.0}).lcb.value, -0.01);
  const ShipFrame frame{0.3, {1.0, -0.2}};
  const Attitude attitude{1.7, -0.2, 0.9};
  const Attitude back = attitude_of(frame, water_plane(frame, attitude));
  EXPECT_NEAR(back.draught, attitude.draught, 1e-14);
  EXPECT_NEAR(back.trim, attitude.trim, 1e-15);
  EXPECT_NEAR(back.heel, attitude.heel, 1e-15);
  for (const double heel : {0.0, 1.0, 2.5})
    for (const double trim : {-0.4, 0.0, pi / 2.0}) {
      const WaterAxes axes = water_axes(up_direction(trim, heel));
      EXPECT_LT((axes.forward.cross(axes.port) - axes.up).norm(), 1e-15);
      EXPECT_NEAR(axes.port.x(), 0.0, 1e-16);
      EXPECT_GE(axes.forward.x(), -1e-16);
    }
}

TEST(LowestPoint, IsFoundToRounding) {
  EXPECT_EQ(FloatingBody(testing::wigley_hull()).lowest(Vector3::UnitZ()), -0.625);
  const FloatingBody sphere(geometry::sphere(1.0, {1.0, 2.0, 3.0}));
  const Vector3 direction = Vector3(0.3, -0.5, 0.7).normalized();
  EXPECT_NEAR(sphere.lowest(direction), direction.dot(Point3(1.0, 2.0, 3.0)) - 1.0, 5e-15);
  // A ball without its lower cap: the lowest points lie on the edge of a cut element.
  const FloatingBody cut(geometry::clip(geometry::sphere(1.0), geometry::PlaneTool{{0, 0, -0.5}, {0, 0, -1}}));
  EXPECT_NEAR(cut.lowest(Vector3::UnitZ()), -0.5, 1e-14);
  const Vector3 slanting = Vector3(1.0, 0.0, 2.0).normalized();
  EXPECT_NEAR(cut.lowest(slanting), slanting.dot(Point3(-std::sqrt(0.75), 0.0, -0.5)), 1e-13);
}

/// z = (x - y)^2 over the unit square, and a lid: enough of a body for its lowest points.
Boundary<3> diagonal_trough() {
  geometry::HomogeneousPoints<3> bottom(4, 9);
  geometry::HomogeneousPoints<3> lid(4, 9);
  // Polar forms of (x - y)^2.
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double z = (i == 2 ? 1.0 : 0.0) - 0.5 * i * j + (j == 2 ? 1.0 : 0.0);
      bottom.col(i + 3 * j) << 0.5 * i, 0.5 * j, z, 1.0;
      lid.col(i + 3 * j) << 0.5 * i, 0.5 * j, 2.0, 1.0;
    }
  const geometry::KnotVector knots = geometry::KnotVector::bezier(2);
  return {{{"bottom", geometry::NurbsSurface<3>(knots, knots, bottom), -1},
           {"lid", geometry::NurbsSurface<3>(knots, knots, lid), 1}}};
}

TEST(LowestPoint, IsFoundWhereItIsAWholeLine) {
  for (const double turn : {0.0, 0.3, pi / 4.0, 1.2})
    EXPECT_NEAR(FloatingBody(lying_cylinder(turn)).lowest(Vector3::UnitZ()), -1.0, 1e-14) << turn;
  // Its ends cut obliquely, so that elements are cut.
  const Boundary<3> cut = geometry::clip(lying_cylinder(0.3), geometry::PlaneTool{{2.0, 0, 0}, {1, 0.2, 0.3}});
  EXPECT_NEAR(FloatingBody(cut).lowest(Vector3::UnitZ()), -1.0, 1e-14);
  // Its lowest points follow no parameter line.
  EXPECT_NEAR(FloatingBody(diagonal_trough()).lowest(Vector3::UnitZ()), 0.0, 1e-9);
}

TEST(FloatingBodies, HaveTheSameBitsForAnyNumberOfThreads) {
  const Boundary<3> torus = geometry::torus(2.0, 0.5);
  const FloatingBody one(torus, {.threads = 1});
  const FloatingBody two(torus, {.threads = 2});
  const WaterPlane plane{up_direction(0.1, 0.2), 0.1};
  const auto sums = WettedScope::moments_and_area;
  EXPECT_TRUE((one.wetted(plane, sums).sums.value == two.wetted(plane, sums).sums.value).all());
}

TEST(FloatingBodies, RefuseABoundaryTurnedInsideOut) {
  Boundary<3> box = geometry::box({1.0, 1.0, 1.0});
  for (geometry::Patch<3>& patch : box.patches) patch.orientation = -patch.orientation;
  EXPECT_THROW(FloatingBody{box}, GeometryError);
}

}  // namespace
}  // namespace isorim::solver
