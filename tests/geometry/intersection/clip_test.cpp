#include "geometry/intersection/clip.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/intersection/plane_section.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/random_splines.h"
#include "tests/geometry/refusals.h"
#include "tests/geometry/trimming/face_measures.h"
#include "tests/geometry/tspline/extracted_surfaces.h"

namespace isorim::geometry {
namespace {

using testing::face_measures;
using testing::Measures;
using testing::Random;
using testing::refusal;

constexpr double pi = std::numbers::pi;

std::vector<std::string> names(const Boundary<3>& boundary) {
  std::vector<std::string> result;
  for (const Patch<3>& patch : boundary.patches) result.push_back(patch.name);
  return result;
}

/// Closed, turned as orient() turns it, with the given volume and area.
void expect_solid(const Boundary<3>& boundary, double volume, double area, double tolerance = 2e-13) {
  const OrientedBoundary<3> oriented = orient(boundary);
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_LE(oriented.topology.largest_gap, 1e-12);
  for (std::size_t i = 0; i < boundary.patches.size(); ++i)
    EXPECT_EQ(oriented.boundary.patches[i].orientation, boundary.patches[i].orientation) << boundary.patches[i].name;
  const Measures found = face_measures(boundary);
  EXPECT_NEAR(found.content, volume, tolerance * volume + 2e-15);
  if (std::isnan(area)) return;
  EXPECT_NEAR(found.boundary, area, tolerance * area);
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Without patches if nothing is left.
Boundary<3> clip_or_nothing(const Boundary<3>& solid, const ClipTool& tool) {
  try {
    return clip(solid, tool);
  } catch (const GeometryError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("nothing is left"));
    return {};
  }
}

/// Both parts of a cut add up to the whole; their areas differ from the whole's by twice the same cap.
void expect_complementary(const Boundary<3>& solid, const ClipTool& tool, const ClipTool& other) {
  const Measures whole = face_measures(solid);
  const Boundary<3> one_part = clip_or_nothing(solid, tool);
  const Boundary<3> other_part = clip_or_nothing(solid, other);
  const Measures one = face_measures(one_part);
  const Measures rest = face_measures(other_part);
  EXPECT_NEAR(one.content + rest.content, whole.content, 1e-13 * whole.content);
  if (!one_part.patches.empty()) expect_solid(one_part, one.content, one.boundary);
  if (!other_part.patches.empty()) expect_solid(other_part, rest.content, rest.boundary);
  double caps = 0.0;
  for (const Boundary<3>* part : {&one_part, &other_part})
    for (const Patch<3>& patch : part->patches)
      if (patch.name.substr(0, 3) == "cap") caps += testing::face_area(patch.shape);
  EXPECT_NEAR(one.boundary + rest.boundary - caps, whole.boundary, 1e-12 * whole.boundary);
}

TEST(Clip, HemispheresAnyWayRound) {
  for (const Vector3& normal :
       {Vector3(0, 0, 1), Vector3(0, 0, -2), Vector3(1, 0, 0), Vector3(0.6, 0.48, 0.64), Vector3(-3, 1, 0)}) {
    const Boundary<3> half = clip(sphere(1.0), PlaneTool{Point3::Zero(), normal});
    EXPECT_THAT(names(half), ::testing::ElementsAre("sphere", "cap"));
    expect_solid(half, 2.0 * pi / 3.0, 3.0 * pi);
  }
}

TEST(Clip, SphericalCaps) {
  for (const double height : {0.01, 0.5, 0.9, 1.7}) {
    const Vector3 normal = Vector3(0.2, -0.3, -1.0).normalized();
    const double inner = 1.0 - height;
    const Boundary<3> cap = clip(sphere(1.0, Point3(3, 2, 1)), PlaneTool{Point3(3, 2, 1) - inner * normal, normal});
    expect_solid(cap, pi * height * height * (3.0 - height) / 3.0, 2.0 * pi * height + pi * (1.0 - inner * inner),
                 1e-12);
  }
}

TEST(Clip, BoxesThroughCornersAndEdges) {
  expect_solid(clip(cube(1.0), PlaneTool{Point3(0.5, 0.5, 0), Vector3(1, 1, 1)}), 1.0 / 6.0,
               1.5 + std::sqrt(3.0) / 2.0);
  expect_solid(clip(cube(1.0), PlaneTool{Point3(0.5, 0.5, 0.5), Vector3(1, 1, 1)}), 0.5,
               3.0 + 3.0 * std::sqrt(3.0) / 4.0);
  expect_solid(clip(cube(1.0), PlaneTool{Point3::Zero(), Vector3(1, -1, 0)}), 0.5, 3.0 + std::sqrt(2.0));
  Boundary<3> wedge = clip(cube(1.0), PlaneTool{Point3::Zero(), Vector3(1, 0, -1)});
  wedge = clip(wedge, PlaneTool{Point3::Zero(), Vector3(1, -1, 0)});
  expect_solid(wedge, 1.0 / 3.0, 2.0 + std::sqrt(2.0));
  wedge = clip(wedge, PlaneTool{Point3::Zero(), Vector3(0, 1, -1)});
  EXPECT_THAT(names(wedge), ::testing::UnorderedElementsAre("x_min", "z_max", "cap", "cap_2"));
  expect_solid(wedge, 1.0 / 6.0, 1.0 + std::sqrt(2.0));
}

TEST(Clip, WhatIsNotCutComesBackAsItWas) {
  for (const PlaneTool& plane :
       {PlaneTool{Point3(0, 0, 1), Vector3(0, 0, 1)}, PlaneTool{Point3(1, 1, 0), Vector3(1, 1, 0)},
        PlaneTool{Point3(1, 1, 1), Vector3(1, 1, 1)}, PlaneTool{Point3(0, 0, 5), Vector3(0, 0, 1)}}) {
    const Boundary<3> same = clip(cube(1.0), plane);
    EXPECT_EQ(names(same), names(cube(1.0)));
    for (const Patch<3>& patch : same.patches) EXPECT_TRUE(std::holds_alternative<NurbsSurface<3>>(patch.shape));
  }
  EXPECT_EQ(names(clip(sphere(1.0), SphereTool{Point3(0.1, 0, 0), 3.0, KeptSide::inside})).size(), 1U);
  EXPECT_EQ(names(clip(sphere(1.0), CylinderTool{Point3(0, 5, 0), Vector3::UnitZ(), 1.0, KeptSide::outside})).size(),
            1U);
  // Tangent all along a great circle, across the parameter lines.
  EXPECT_EQ(names(clip(sphere(1.0), CylinderTool{Point3::Zero(), Vector3(1, 2, 3), 1.0, KeptSide::inside})).size(), 1U);
}

TEST(Clip, ObliqueCylinder) {
  expect_solid(clip(cylinder(1.0, 4.0), PlaneTool{Point3(0, 0, 2), Vector3(-0.5, 0, 1)}), 2.0 * pi,
               19.220370633469329389);
}

TEST(Clip, NapkinRingAndOffsetHole) {
  expect_solid(clip(sphere(1.0), CylinderTool{Point3::Zero(), Vector3::UnitZ(), 0.6, KeptSide::outside}),
               2.1446605848506321841, 16.084954386379741381);
  expect_solid(clip(sphere(1.0), CylinderTool{Point3(0.3, 0, 0), Vector3::UnitZ(), 0.4, KeptSide::outside}),
               3.2758268764267616527, 15.776344597301319911);
}

TEST(Clip, VivianisWindowAndTheSphereWithoutIt) {
  for (const double turn : {0.0, 1.0, 2.2}) {
    const Point3 centre(0.5 * std::cos(turn), 0.5 * std::sin(turn), 0);
    expect_solid(clip(sphere(1.0), CylinderTool{centre, Vector3::UnitZ(), 0.5, KeptSide::inside}),
                 1.2055062135043066034, 2.0 * pi, 1e-12);
    expect_solid(clip(sphere(1.0), CylinderTool{centre, Vector3::UnitZ(), 0.5, KeptSide::outside}),
                 2.9832839912820843812, 14.283185307179586477, 1e-12);
  }
}

TEST(Clip, SteinmetzSolids) {
  const Boundary<3> upright = cylinder(1.0, 4.0, Point3(0, 0, -2));
  const Boundary<3> two = clip(upright, CylinderTool{Point3::Zero(), Vector3::UnitX(), 1.0, KeptSide::inside});
  EXPECT_THAT(names(two), ::testing::ElementsAre("side", "cap"));
  expect_solid(two, 16.0 / 3.0, 16.0);
  const Boundary<3> three = clip(two, CylinderTool{Point3::Zero(), Vector3::UnitY(), 1.0, KeptSide::inside});
  expect_solid(three, 8.0 * (2.0 - std::sqrt(2.0)), 24.0 * (2.0 - std::sqrt(2.0)));
}

TEST(Clip, HolesBesideThroughAndAlongOneAnother) {
  const Boundary<3> plate = box(Vector3(2, 2, 1), Point3(-1, -1, 0));
  const auto drill = [](double x, double radius) {
    return CylinderTool{Point3(x, 0, 0), Vector3::UnitZ(), radius, KeptSide::outside};
  };
  expect_solid(clip(plate, drill(0.0, 0.5)), 4.0 - pi / 4.0, 16.0 - pi / 2.0 + pi);
  for (const double x : {0.5, 0.25})
    expect_solid(clip(clip(plate, drill(-x, 0.25)), drill(x, 0.25)), 4.0 - pi / 8.0, 16.0 - pi / 4.0 + pi);
  const Boundary<3> once = clip(plate, drill(0.1, 0.4));
  expect_solid(clip(once, drill(0.1, 0.4)), 4.0 - 0.16 * pi, 16.0 - 0.32 * pi + 0.8 * pi);
  // Two circles with the centres a radius apart: the lens has 2 pi / 3 - sqrt(3) / 2 of the radius squared.
  const double lens = 0.0625 * (2.0 * pi / 3.0 - std::sqrt(3.0) / 2.0);
  expect_solid(clip(clip(plate, drill(-0.125, 0.25)), drill(0.125, 0.25)), 4.0 - (pi / 8.0 - lens), unknown);
}

TEST(Clip, HolesThatTouchTheSides) {
  expect_solid(clip(cube(1.0), CylinderTool{Point3(0.5, 0.5, 0), Vector3::UnitZ(), 0.5, KeptSide::inside}), pi / 4.0,
               1.5 * pi);
  const Measures corners =
      face_measures(clip(cube(1.0), CylinderTool{Point3(0.5, 0.5, 0), Vector3::UnitZ(), 0.5, KeptSide::outside}));
  EXPECT_NEAR(corners.content, 1.0 - pi / 4.0, 1e-13);
  EXPECT_NEAR(corners.boundary, 6.0 + pi / 2.0, 1e-12);
}

TEST(Clip, Balls) {
  const auto ball = [](const Point3& centre, double radius, KeptSide keep) { return SphereTool{centre, radius, keep}; };
  const Point3 middle = Point3::Constant(0.5);
  expect_solid(clip(cube(1.0), ball(middle, 0.3, KeptSide::outside)), 1.0 - 0.036 * pi, 6.0 + 0.36 * pi);
  expect_solid(clip(cube(1.0), ball(middle, 0.3, KeptSide::inside)), 0.036 * pi, 0.36 * pi);
  expect_solid(clip(cube(1.0), ball(Point3::Zero(), 0.5, KeptSide::inside)), pi / 48.0, 5.0 * pi / 16.0);
  expect_solid(clip(cube(1.0), ball(Point3::Zero(), 0.5, KeptSide::outside)), 1.0 - pi / 48.0, 6.0 - pi / 16.0);
  expect_solid(clip(sphere(1.0), ball(Point3(1, 0, 0), 1.0, KeptSide::inside)), 5.0 * pi / 12.0, 2.0 * pi);
  expect_complementary(cube(1.0), ball(middle, 0.6, KeptSide::inside), ball(middle, 0.6, KeptSide::outside));
  // Much smaller than the solid, whose size gives the rounding.
  const Point3 corner(-0.6, 0.0, 0.5);
  expect_complementary(ellipsoid(Vector3(1.0, 0.5, 0.75)), ball(corner, 0.05, KeptSide::inside),
                       ball(corner, 0.05, KeptSide::outside));
}

TEST(Clip, ToriAcross) {
  const Boundary<3> ring = torus(1.0, 0.5);
  const double volume = pi * pi / 2.0;
  const double area = 2.0 * pi * pi;
  const Boundary<3> half = clip(ring, PlaneTool{Point3::Zero(), Vector3::UnitX()});
  EXPECT_THAT(names(half), ::testing::ElementsAre("torus", "cap", "cap_2"));
  expect_solid(half, volume / 2.0, area / 2.0 + pi / 2.0);
  expect_solid(clip(ring, PlaneTool{Point3::Zero(), Vector3::UnitZ()}), volume / 2.0, area / 2.0 + 2.0 * pi);
  expect_solid(clip(ring, PlaneTool{Point3::Zero(), Vector3(0.5, 0, -std::sqrt(0.75))}), volume / 2.0, unknown);
}

TEST(Clip, TangentPlaneOfATorus) {
  const Boundary<3> ring = torus(1.0, 0.5);
  for (const double turn : {0.0, 0.3}) {
    const Vector3 normal(std::cos(turn), std::sin(turn), 0);
    const Point3 point = 0.5 * normal;
    expect_complementary(ring, PlaneTool{point, normal}, PlaneTool{point, -normal});
    // mpmath, see cases/trimmed/torus_figure_eight.toml.
    EXPECT_NEAR(face_measures(clip(ring, PlaneTool{point, normal})).content, 3.3057929609229805, 1e-13);
  }
}

TEST(Clip, Cones) {
  const Boundary<3> whole = cone(1.0, 0.0, 2.0);
  const double slant = std::sqrt(5.0);
  expect_solid(clip(whole, PlaneTool{Point3(0, 0, 1), Vector3::UnitZ()}), pi / 3.0 * 1.75,
               pi + pi / 4.0 + 0.75 * pi * slant);
  expect_solid(clip(whole, PlaneTool{Point3(0, 0, 2), Vector3::UnitX()}), pi / 3.0, pi / 2.0 + 2.0 + pi * slant / 2.0);
  expect_complementary(whole, PlaneTool{Point3(0, 0, 1), Vector3(0.3, 0.1, 1)},
                       PlaneTool{Point3(0, 0, 1), -Vector3(0.3, 0.1, 1)});
  const Boundary<3> plate = box(Vector3(2, 2, 1), Point3(-1, -1, 0));
  const double tangent = std::tan(0.4);
  expect_solid(clip(plate, ConeTool{Point3(0, 0, 0), Vector3::UnitZ(), 0.4, KeptSide::outside}),
               4.0 - pi / 3.0 * tangent * tangent, unknown);
  expect_solid(clip(plate, ConeTool{Point3(0, 0, 0.5), Vector3::UnitZ(), 0.4, KeptSide::inside}),
               pi / 24.0 * tangent * tangent, unknown);
}

TEST(Clip, RandomCutsAddUp) {
  Random random(11);
  const std::vector<Boundary<3>> solids{torus(1.0, 0.4), cube(1.5, Point3::Constant(-0.75)), cone(1.0, 0.4, 1.5),
                                        ellipsoid(Vector3(1.0, 0.7, 0.5))};
  for (int round = 0; round < 4; ++round) {
    const Boundary<3>& solid = solids[static_cast<std::size_t>(round) % solids.size()];
    const Point3 point(random.real(-0.4, 0.4), random.real(-0.4, 0.4), random.real(-0.1, 0.3));
    const Vector3 direction(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    const double radius = random.real(0.2, 0.6);
    SCOPED_TRACE(round);
    expect_complementary(solid, PlaneTool{point, direction}, PlaneTool{point, -direction});
    expect_complementary(solid, CylinderTool{point, direction, radius, KeptSide::inside},
                         CylinderTool{point, direction, radius, KeptSide::outside});
    expect_complementary(solid, SphereTool{point, radius, KeptSide::inside},
                         SphereTool{point, radius, KeptSide::outside});
  }
}

/// What a yard's or a map's coordinates leave: rounding of them, not of the solid's size, is what counts as nothing.
TEST(Clip, OfSolidsFarFromTheOrigin) {
  const AffineMap<3> lie = rotation(Axis{Point3::Zero(), {1.0, 2.0, 0.5}}, 0.7);
  const Boundary<3> near = transform<3>(cylinder(1.0, 6.0, {0.0, 0.0, -3.0}), lie);
  const Vector3 slanting = Vector3(0.1, 0.2, 1.0).normalized();
  for (const double far : {1e2, 1e3, 1e4, 1e5}) {
    const Vector3 place(far, -far, 0.5 * far);
    const Boundary<3> solid = transform<3>(near, translation<3>(place));
    const auto expect_same = [&](const ClipTool& here, const ClipTool& there) {
      const Boundary<3> cut = clip(solid, there);
      EXPECT_TRUE(orient(cut).topology.closed) << far;
      // Measured where it was.
      const Measures found = face_measures(transform<3>(cut, translation<3>(-place)));
      const Measures expected = face_measures(clip(near, here));
      EXPECT_NEAR(found.content, expected.content, 3e-14 * far);
      EXPECT_NEAR(found.boundary, expected.boundary, 1e-13 * far);
    };
    expect_same(PlaneTool{Point3::Zero(), slanting}, PlaneTool{place, slanting});
    expect_same(SphereTool{Point3::Zero(), 1.5, KeptSide::outside}, SphereTool{place, 1.5, KeptSide::outside});
    expect_same(CylinderTool{Point3::Zero(), slanting, 0.4, KeptSide::outside},
                CylinderTool{place, slanting, 0.4, KeptSide::outside});
  }
}

TEST(Clip, Refusals) {
  EXPECT_THAT(refusal([] {
                clip(cube(1.0), PlaneTool{Point3(0, 0, -1), Vector3::UnitZ()});
              }),
              ::testing::HasSubstr("nothing is left"));
  EXPECT_THAT(refusal([] {
                clip(cube(1.0), PlaneTool{Point3(0, 0, 0), Vector3::UnitZ()});
              }),
              ::testing::HasSubstr("nothing is left"));
  EXPECT_THAT(refusal([] {
                clip(cube(1.0), PlaneTool{Point3(0, 0, 0), Vector3::Zero()});
              }),
              ::testing::HasSubstr("normal is zero"));
  EXPECT_THAT(refusal([] {
                clip(box(Vector3(2, 2, 1), Point3(-1, -1, 0)),
                     ConeTool{Point3(0, 0, 0.5), Vector3::UnitZ(), 0.4, KeptSide::outside});
              }),
              ::testing::HasSubstr("other nappe"));
  Boundary<3> open = cube(1.0);
  open.patches.pop_back();
  EXPECT_THAT(refusal([&] {
                clip(open, PlaneTool{Point3(0.5, 0, 0), Vector3::UnitX()});
              }),
              ::testing::HasSubstr("do not close"));
}

TEST(Clip, OfAHollowBall) {
  Boundary<3> hollow = sphere(1.0);
  hollow.patches.push_back(sphere(0.5).patches.front());
  hollow.patches.back().name = "void";
  hollow = orient(hollow).boundary;
  const auto loops_at = [&](double z) { return plane_section(hollow, plane_frame({0, 0, z}, {0, 0, 1})).loops.size(); };
  EXPECT_EQ(loops_at(0.3), 2U);
  EXPECT_EQ(loops_at(0.7), 1U);
  EXPECT_EQ(loops_at(1.7), 0U);
  const Boundary<3> half = clip(hollow, PlaneTool{Point3::Zero(), Vector3(0, 0, 1)});
  EXPECT_THAT(names(half), ::testing::ElementsAre("sphere", "void", "cap"));
  expect_solid(half, 7.0 * pi / 12.0, 2.0 * pi + 0.5 * pi + 0.75 * pi);
}

/// Of one patch by its elements, two of which are cut in two.
Boundary<3> torus_by_elements() {
  Boundary<3> solid = testing::extracted(torus(2.0, 0.5));
  const ExtractedSurface& whole = std::get<ExtractedSurface>(solid.patches[0].shape);
  solid.patches[0].shape = testing::cut_element(testing::cut_element(whole, 2, 0, 0.4), 9, 1, 0.7);
  return solid;
}

TEST(Clip, TakesExtractedSurfacesElementByElement) {
  const PlaneTool tool{Point3(0.3, 0.1, 0.05), Vector3(0.3, 1.0, 0.2)};
  const Boundary<3> expected = clip(torus(2.0, 0.5), tool);
  const Measures measure = face_measures(expected);
  expect_solid(clip(torus_by_elements(), tool), measure.content, measure.boundary, 1e-12);
  const KnotVector side = KnotVector::clamped(1, std::vector<double>{-4.0, 4.0});
  Points<3> corners(3, 4);
  corners << -4, 4, -4, 4, -4, -4, 4, 4, 0, 0, 0, 0;
  const auto area_of = [&](const Boundary<3>& solid) {
    const auto plane = NurbsSurface<3>::from_points(side, side, corners);
    std::vector<TrimLoop> loops;
    for (const SectionLoop& loop : plane_section(solid, plane_frame(tool.point, tool.normal)).loops)
      loops.push_back(loop.curve.plane_curves);
    return testing::face_area(TrimmedSurface(plane, std::move(loops)));
  };
  EXPECT_NEAR(area_of(torus_by_elements()), area_of(torus(2.0, 0.5)), 1e-12);
}

TEST(Clip, LeavesExtractedSurfacesThatItDoesNotMeet) {
  const Boundary<3> solid = torus_by_elements();
  const Boundary<3> left = clip(solid, PlaneTool{Point3(0.0, 0.0, 0.6)});
  ASSERT_EQ(left.patches.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<ExtractedSurface>(left.patches[0].shape));
}

}  // namespace
}  // namespace isorim::geometry
