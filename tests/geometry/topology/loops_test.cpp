#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::measures;
using testing::refusal;
constexpr double pi = std::numbers::pi;

Points<2> columns(const std::vector<Point2>& points) {
  Points<2> result(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = points[i];
  return result;
}

Boundary<2> boundary_of(const std::vector<NurbsCurve<2>>& curves) {
  Boundary<2> result;
  for (std::size_t i = 0; i < curves.size(); ++i) result.patches.push_back({fmt::format("c{}", i + 1), curves[i]});
  return result;
}

NurbsCurve<2> loop_through(std::vector<Point2> points) {
  points.push_back(points.front());
  return polyline<2>(columns(points));
}

double oriented_area(const Boundary<2>& boundary) {
  const OrientedBoundary<2> oriented = orient(boundary);
  EXPECT_TRUE(oriented.topology.closed);
  return measures(oriented.boundary).content;
}

/// The rectangle of the thesis: one degree-1 curve with doubled corners, C^-1.
NurbsCurve<2> broken_rectangle(double a, double b) {
  const Points<2> points = columns({{0, 0}, {a, 0}, {a, 0}, {a, b}, {a, b}, {0, b}, {0, b}, {0, 0}});
  return NurbsCurve<2>::from_points(KnotVector(1, {0, 0, .25, .25, .5, .5, .75, .75, 1, 1}), points);
}

TEST(OrientLoops, TurnsRandomlyFlippedPatchesRight) {
  std::mt19937 random(7);
  std::vector<NurbsCurve<2>> sides;
  for (const Patch<2>& patch : regular_polygon(9, 2.0).patches) sides.push_back(patch.shape);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<NurbsCurve<2>> curves = sides;
    curves.push_back(circle_curve(0.5, Point2(0.5, 0.5)));
    curves.push_back(circular_arc(0.4, Point2(-0.8, 0), 0.0, pi));
    curves.push_back(circular_arc(0.4, Point2(-0.8, 0), pi, 2.0 * pi));
    std::ranges::shuffle(curves, random);
    for (NurbsCurve<2>& curve : curves) {
      if (random() % 2 == 0) curve = reverse(curve);
    }
    const double expected = 18.0 * std::sin(2.0 * pi / 9.0) - pi * 0.41;
    EXPECT_NEAR(oriented_area(boundary_of(curves)), expected, 1e-13);
  }
}

TEST(OrientLoops, GivesTheOrderAndTheDepthOfLoops) {
  const OrientedBoundary<2> oriented = orient(
      boundary_of({circle_curve(1.0), line_segment<2>(Point2(3, 3), Point2(-3, 3)),
                   line_segment<2>(Point2(-3, -3), Point2(-3, 3)), circle_curve(0.5),
                   line_segment<2>(Point2(-3, -3), Point2(3, -3)), line_segment<2>(Point2(3, -3), Point2(3, 3))}));
  ASSERT_EQ(oriented.topology.shells.size(), 3U);
  const Shell<2>& square = oriented.topology.shells[1];
  EXPECT_EQ(square.patches.size(), 4U);
  EXPECT_FALSE(square.is_void);
  // Each patch starts, as it is run through, where the one before ends.
  for (std::size_t i = 0; i < 4; ++i) {
    const Patch<2>& a = oriented.boundary.patches[static_cast<std::size_t>(square.patches[i])];
    const Patch<2>& b = oriented.boundary.patches[static_cast<std::size_t>(square.patches[(i + 1) % 4])];
    EXPECT_EQ(evaluate(a.shape, a.orientation > 0 ? 1.0 : 0.0), evaluate(b.shape, b.orientation > 0 ? 0.0 : 1.0));
  }
  EXPECT_TRUE(oriented.topology.shells[0].is_void);
  EXPECT_FALSE(oriented.topology.shells[2].is_void);
  EXPECT_NEAR(measures(oriented.boundary).content, 36.0 - pi + 0.25 * pi, 1e-13);
}

TEST(OrientLoops, AllowTouching) {
  // The thesis's square with inscribed circular hole: four tangential contacts, each curve either way round.
  for (const bool flip : {false, true}) {
    const NurbsCurve<2> hole = circle_curve(1.0, Point2(1, 1));
    EXPECT_NEAR(oriented_area(boundary_of({broken_rectangle(2, 2), flip ? reverse(hole) : hole})), 4.0 - pi, 1e-13);
  }
  // Circles that touch from outside and from inside, near-equal radii included.
  EXPECT_NEAR(oriented_area(boundary_of({circle_curve(1.0), circle_curve(0.5, Point2(1.5, 0))})), 1.25 * pi, 1e-12);
  EXPECT_NEAR(oriented_area(boundary_of({circle_curve(1.0), circle_curve(0.5, Point2(0.5, 0))})), 0.75 * pi, 1e-12);
  EXPECT_NEAR(oriented_area(boundary_of({circle_curve(1.0), circle_curve(0.9, Point2(0.06, 0.08))})), 0.19 * pi, 1e-12);
  // Two triangles that share a corner; a hole whose corner touches a side.
  EXPECT_NEAR(
      oriented_area(boundary_of({loop_through({{0, 0}, {2, 1}, {2, -1}}), loop_through({{0, 0}, {-2, 1}, {-2, -1}})})),
      4.0, 1e-14);
  EXPECT_NEAR(oriented_area(boundary_of(
                  {loop_through({{0, 0}, {4, 0}, {4, 4}, {0, 4}}), loop_through({{2, 0}, {3, 1}, {1, 1}})})),
              15.0, 1e-13);
}

TEST(OrientLoops, JoinTouchingLoopsOfSeveralPatchesWithoutCrossing) {
  Boundary<2> pair = polygon(columns({{0, 0}, {2, 1}, {2, -1}}));
  for (Patch<2> patch : polygon(columns({{-2, -1}, {0, 0}, {-2, 1}})).patches) {
    patch.name += "_left";
    pair.patches.push_back(patch);
  }
  EXPECT_NEAR(oriented_area(pair), 4.0, 1e-14);
}

TEST(OrientLoops, AcceptCuspsAndDoubledControlPoints) {
  // The plate of the thesis: corners by doubled control points at single knots.
  const double w = 0.5 * std::numbers::sqrt2;
  HomogeneousPoints<2> net(3, 9);
  net << 0, 4, 4, 4, 4 * w, 2, 0, 0, 0,  //
      0, 0, 0, 2, 4 * w, 4, 4, 4, 0,     //
      1, 1, 1, 1, w, 1, 1, 1, 1;
  const NurbsCurve<2> plate(KnotVector(2, {0, 0, 0, .125, .25, .25, .5, .5, .875, 1, 1, 1}), net);
  const Boundary<2> shape = boundary_of(
      {plate, circle_curve(0.5, Point2(1, 3)), circle_curve(0.5, Point2(1, 1)), circle_curve(0.5, Point2(3, 1))});
  EXPECT_NEAR(oriented_area(shape), 12.0 + 0.25 * pi, 1e-12);
  // Four cubic arcs with cusps: area by Bezier's own formula against the sum of the arcs.
  std::vector<NurbsCurve<2>> arcs;
  for (int i = 0; i < 4; ++i) {
    const NurbsCurve<2> arc =
        NurbsCurve<2>::from_points(KnotVector::bezier(3), columns({{1, 0}, {0.25, 0}, {0, 0.25}, {0, 1}}));
    arcs.push_back(transform(arc, rotation(Point2(0, 0), 0.5 * pi * i)));
  }
  const double area = measures(boundary_of(arcs)).content;
  ASSERT_GT(area, 0.0);
  arcs[2] = reverse(arcs[2]);
  EXPECT_NEAR(oriented_area(boundary_of(arcs)), area, 1e-14);
}

TEST(OrientLoops, TakesEndsWithinTheToleranceAsOne) {
  const double gap = 5e-7;
  const std::vector<NurbsCurve<2>> curves{line_segment<2>(Point2(0, 0), Point2(1, 0)),
                                          line_segment<2>(Point2(1, gap), Point2(1, 1)),
                                          line_segment<2>(Point2(1, 1), Point2(0, 0))};
  const OrientedBoundary<2> oriented = orient(boundary_of(curves));
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_NEAR(oriented.topology.largest_gap, gap, 1e-15);
  EXPECT_NEAR(oriented.topology.tolerance, 1e-6 * std::sqrt(2.0), 1e-20);
  const OrientedBoundary<2> strict = orient(boundary_of(curves), {1e-8});
  EXPECT_FALSE(strict.topology.closed);
  ASSERT_EQ(strict.topology.free_edges.size(), 2U);
  EXPECT_THAT(refusal([&] { require_closed(strict); }),
              AllOf(HasSubstr("'c2' starts at (1, 5e-07)"), HasSubstr("a gap of 5e-07 to 'c1'")));
}

TEST(OrientLoops, KeepOpenChainsConsistent) {
  const OrientedBoundary<2> oriented =
      orient(boundary_of({line_segment<2>(Point2(0, 0), Point2(1, 0)), line_segment<2>(Point2(2, 1), Point2(1, 0))}));
  EXPECT_FALSE(oriented.topology.closed);
  ASSERT_EQ(oriented.topology.shells.size(), 1U);
  EXPECT_FALSE(oriented.topology.shells[0].closed);
  EXPECT_EQ(oriented.boundary.patches[0].orientation, -oriented.boundary.patches[1].orientation);
  ASSERT_EQ(oriented.topology.free_edges.size(), 2U);
}

TEST(OrientLoops, RefuseCrossings) {
  // A bow tie as one curve and as a polygon.
  const std::vector<Point2> bow_tie{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_THAT(refusal([&] { orient(boundary_of({loop_through(bow_tie)})); }),
              HasSubstr("a loop crosses itself: patch 'c1' at (0.5, 0.5)"));
  EXPECT_THAT(refusal([&] {
                orient(polygon(columns({{0, 0}, {4, 1}, {4, 0}, {0, 2}})));
              }),
              AllOf(HasSubstr("a loop crosses itself: patches 'side_1' and 'side_3'"),
                    HasSubstr("at (2.66666667, 0.666666667)")));
  // A curve that runs through its own vertex.
  EXPECT_THAT(refusal([&] {
                orient(boundary_of({loop_through({{-1, -1}, {0, 0}, {1, 1}, {1, -1}, {0, 0}, {-1, 1}})}));
              }),
              HasSubstr("a loop crosses itself"));
  // A smooth figure eight of one cubic spline.
  std::vector<double> breakpoints;
  for (int i = 0; i <= 16; ++i) breakpoints.push_back(i / 16.0);
  const KnotVector knots = KnotVector::periodic(3, breakpoints);
  Points<2> points(2, knots.basis_count());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double t = 2.0 * pi * static_cast<double>(i % 16) / 16.0;
    points.col(i) << 2.0 * std::cos(t), std::sin(2.0 * t) + 0.2 * std::cos(t);
  }
  EXPECT_THAT(refusal([&] { orient(boundary_of({clamp(NurbsCurve<2>::from_points(knots, points))})); }),
              HasSubstr("a loop crosses itself: patch 'c1' at ("));
}

TEST(OrientLoops, RefuseLoopsThatCrossOneAnother) {
  EXPECT_THAT(refusal([] {
                orient(boundary_of({circle_curve(1.0), circle_curve(1.0, Point2(1, 0))}));
              }),
              AllOf(HasSubstr("two loops cross: patches 'c1' and 'c2' at (0.5, "), HasSubstr("0.866025404)")));
  // Nearly tangential, five times the tolerance deep.
  EXPECT_THAT(refusal([] {
                orient(boundary_of({broken_rectangle(2, 2), circle_curve(1.0, Point2(1.0, 1.0 + 1.5e-5))}));
              }),
              HasSubstr("two loops cross"));
  // A sliver that pokes through a circle.
  EXPECT_THAT(refusal([] {
                orient(boundary_of({circle_curve(1.0), loop_through({{0, 0}, {1.001, 1e-4}, {0, 2e-4}})}));
              }),
              HasSubstr("two loops cross"));
}

TEST(OrientLoops, RefuseOverlaps) {
  EXPECT_THAT(refusal([] {
                orient(boundary_of({broken_rectangle(2, 2), broken_rectangle(2, 2)}));
              }),
              HasSubstr("run along each other at ("));
  EXPECT_THAT(refusal([] {
                orient(boundary_of({circle_curve(1.0), circular_arc(1.0, Point2(0, 0), 1.0, 1.0 + 2.0 * pi)}));
              }),
              HasSubstr("patches 'c1' and 'c2' run along each other at ("));
  EXPECT_THAT(refusal([] {
                orient(boundary_of(
                    {loop_through({{0, 0}, {2, 0}, {2, 2}, {0, 2}}), loop_through({{0.5, 0}, {1.5, 0}, {1, 1}})}));
              }),
              HasSubstr("run along each other at ("));
  EXPECT_THAT(refusal([] {
                orient(boundary_of({loop_through({{0, 0}, {2, 0}, {1, 0}, {1, 1}})}));
              }),
              HasSubstr("runs along itself at ("));
}

TEST(OrientLoops, RefuseLoopsWithoutArea) {
  EXPECT_THAT(refusal([] { orient(polygon(columns({{0, 0}, {1, 0}, {2, 0}}))); }), HasSubstr("encloses no area"));
  const NurbsCurve<2> arc = circular_arc(1.0, Point2(0, 0), 0.0, 2.0);
  EXPECT_THAT(refusal([&] {
                orient(boundary_of({arc, reverse(arc)}));
              }),
              HasSubstr("the loop of 'c1', 'c2' encloses no area"));
}

TEST(OrientLoops, RefuseWhatIsNoLoop) {
  EXPECT_THAT(refusal([] { orient(Boundary<2>{}); }), HasSubstr("has no patches"));
  const NurbsCurve<2> side = line_segment<2>(Point2(0, 0), Point2(1, 0));
  EXPECT_THAT(refusal([&] {
                orient(boundary_of({side, line_segment<2>(Point2(0, 0), Point2(0, 1)),
                                    line_segment<2>(Point2(0, 0), Point2(-1, -1))}));
              }),
              HasSubstr("3 curve ends meet at (0, 0) ('c1', 'c2', 'c3')"));
  const Points<2> jump = columns({{0, 0}, {1, 0}, {1, 0.5}, {0, 0}});
  EXPECT_THAT(refusal([&] {
                orient(boundary_of({NurbsCurve<2>::from_points(KnotVector(1, {0, 0, .5, .5, 1, 1}), jump)}));
              }),
              HasSubstr("patch 'c1': the curve jumps by 0.5 from (1, 0) to (1, 0.5)"));
  EXPECT_THAT(refusal([&] {
                orient(boundary_of({side, line_segment<2>(Point2(1, 0), Point2(1, 1e-9))}));
              }),
              HasSubstr("patch 'c2': the whole curve lies at (1, 0)"));
}

TEST(OrientLoops, HandlesManyHoles) {
  std::vector<NurbsCurve<2>> curves{broken_rectangle(50, 50)};
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) curves.push_back(circle_curve(0.4, Point2(1.5 * i + 2.0, 1.5 * j + 2.0)));
  }
  EXPECT_NEAR(oriented_area(boundary_of(curves)), 2500.0 - 900 * 0.16 * pi, 1e-9);
}

}  // namespace
}  // namespace isorim::geometry
