#include "geometry/trimming/face_locator.h"

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/trimming/faces.h"

namespace isorim::geometry {
namespace {

using testing::blob;
using testing::circle_loop;
using testing::plane_surface;
using testing::polygon;
using testing::Random;
using testing::reversed;

const std::vector<double> unit{0.0, 1.0};

/// The least distance of the point from the loops, relative to the surface's domain, by sampling.
double clearance(const TrimmedSurface& face, const Point2& uv) {
  double least = 1.0;
  const Vector2 size(face.surface().knots_u().domain().length(), face.surface().knots_v().domain().length());
  for (const PlanePiece& piece : loop_pieces(face.loops()))
    for (int k = 0; k <= 100; ++k)
      least = std::min(least, (evaluate(piece, k / 100.0) - uv).cwiseQuotient(size).norm());
  return least;
}

TEST(FaceLocator, KnowsTheInsideOfAnAnnulus) {
  const TrimmedSurface face(plane_surface(1, unit, unit),
                            {circle_loop(0.5, {0.5, 0.5}), reversed(circle_loop(0.25, {0.5, 0.5}))});
  Random random(31);
  const FaceLocator locator(face);
  for (int i = 0; i < 2000; ++i) {
    const Point2 uv(random.real(0, 1), random.real(0, 1));
    const double r = (uv - Point2(0.5, 0.5)).norm();
    EXPECT_EQ(locator.contains(uv), r < 0.5 && r > 0.25);
    EXPECT_EQ(contains(face, uv), r < 0.5 && r > 0.25);
  }
  EXPECT_EQ(contains(face, {0.5 + std::sqrt(0.125), 0.5 + std::sqrt(0.125)}), std::nullopt);
  EXPECT_EQ(contains(face, {0.75, 0.5}), std::nullopt);
  EXPECT_EQ(contains(face, {0.75 + 1e-10, 0.5}), true);
  EXPECT_EQ(contains(face, {0.75 - 1e-10, 0.5}), false);
  EXPECT_EQ(contains(face, {7.0, 0.5}), false);
}

TEST(FaceLocator, CountsTurnsOfLoopsThatOverlap) {
  const std::vector<TrimLoop> loops{circle_loop(0.5, {0.5, 0.5}), circle_loop(0.3, {0.5, 0.5}),
                                    reversed(circle_loop(0.1, {3.0, 0.5}))};
  const FaceLocator locator(loops);
  EXPECT_EQ(locator.winding_number({0.5, 0.5}), 2);
  EXPECT_EQ(locator.winding_number({0.5, 0.9}), 1);
  EXPECT_EQ(locator.winding_number({3.0, 0.5}), -1);
  EXPECT_EQ(locator.winding_number({2.0, 0.5}), 0);
}

TEST(FaceLocator, InteriorPointsLieWellInside) {
  Random random(32);
  for (int trial = 0; trial < 300; ++trial) {
    const double width = std::pow(10.0, random.integer(-3, 6));
    const NurbsSurface<3> surface = plane_surface(1, {0.0, width}, unit);
    std::vector<TrimLoop> loops{blob(random, {0.5, 0.5}, 0.5, random.integer(1, 4))};
    if (random.integer(0, 1) == 0) loops.push_back(reversed(blob(random, {0.5, 0.5}, 0.1, 3)));
    AffineMap<2> stretch;
    stretch.linear(0, 0) = width;
    for (TrimLoop& loop : loops)
      for (NurbsCurve<2>& curve : loop.curves) curve = transform(curve, stretch);
    const TrimmedSurface face(surface, loops);
    const Point2 inside = interior_point(face);
    EXPECT_EQ(contains(face, inside), true) << trial;
    EXPECT_GT(clearance(face, inside), 0.03) << trial;
  }
}

TEST(FaceLocator, InteriorPointsOfThinAndTouchingLoops) {
  const NurbsSurface<3> surface = plane_surface(1, unit, unit);
  const std::vector<std::vector<TrimLoop>> faces{
      // A thin ring, a thin diagonal, two islands far apart, a hole that touches the outer loop, the frame of a square.
      {circle_loop(0.5, {0.5, 0.5}), reversed(circle_loop(0.4999, {0.5, 0.5}))},
      {polygon({{0, 0}, {1, 0.9999}, {1, 1}})},
      {polygon({{0, 0}, {0.01, 0}, {0.01, 0.01}, {0, 0.01}}), polygon({{0.9, 0.99}, {1, 0.99}, {1, 1}, {0.9, 1}})},
      {circle_loop(0.5, {0.5, 0.5}), reversed(circle_loop(0.49, {0.5, 0.51}))},
      {polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), reversed(polygon({{0.001, 0.001}, {1, 0.001}, {1, 1}, {0.001, 1}}))}};
  for (const std::vector<TrimLoop>& loops : faces) {
    const TrimmedSurface face(surface, loops);
    EXPECT_EQ(contains(face, interior_point(face)), true);
  }
}

TEST(FaceLocator, RefusesLoopsThatEncloseNothing) {
  const std::vector<TrimLoop> clockwise{reversed(circle_loop(0.5, {0.5, 0.5}))};
  EXPECT_GEOMETRY_ERROR(FaceLocator(clockwise).interior_point(), "enclose nothing");
  const std::vector<TrimLoop> flat{polygon({{0, 0}, {1, 0}, {0.5, 0}})};
  EXPECT_GEOMETRY_ERROR(FaceLocator{flat}, "line of constant parameter");
}

}  // namespace
}  // namespace isorim::geometry
