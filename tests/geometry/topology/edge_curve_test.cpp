#include "geometry/topology/edge_curve.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/topology/trimmed_solids.h"

namespace isorim::geometry {
namespace {

using namespace testing;
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(EdgeCurve, FindsTheNearestPointThatBranchAndBoundFinds) {
  Random random(3);
  for (int trial = 0; trial < 24; ++trial) {
    const KnotVector u = KnotVector::clamped_uniform(random.integer(1, 3), random.integer(1, 8));
    const KnotVector v = KnotVector::clamped_uniform(random.integer(1, 3), random.integer(1, 8));
    const NurbsSurface<3> surface = random_surface<3>(random, u, v);
    const NurbsCurve<2> pcurve = blob(random, Point2(0.5, 0.5), 0.45, random.integer(2, 4)).curves[0];
    const EdgeCurve edge(surface, pcurve);
    const NurbsCurve<3> lifted = lift(surface, pcurve, 1e-8);
    for (int k = 0; k < 20; ++k) {
      const double away = std::pow(10.0, random.real(-8.0, 0.0));
      const Vector3 shift(random.real(-away, away), random.real(-away, away), random.real(-away, away));
      const Point3 target = edge.at(random.inside(edge.domain())) + shift;
      const ClosestCurvePoint<3> expected = closest_point(lifted, target);
      const std::optional<EdgeCurve::Foot> foot = edge.nearest(target, edge.domain(), infinity);
      ASSERT_TRUE(foot);
      EXPECT_NEAR(foot->distance, expected.distance, 3e-8 + 1e-7 * expected.distance) << trial << " " << k;
      EXPECT_EQ(foot->distance, (edge.at(foot->t) - target).norm());
      // Asked for less, it must not lose it, nor invent one.
      EXPECT_TRUE(edge.nearest(target, edge.domain(), 1.001 * foot->distance + 1e-12));
      EXPECT_FALSE(edge.nearest(target, edge.domain(), 0.999 * foot->distance - 1e-12));
    }
  }
}

TEST(EdgeCurve, StaysWithinTheInterval) {
  const NurbsSurface<3> plane = plane_through(Point3(0, 0, 0), {1, 0, 0}, {0, 1, 0});
  const EdgeCurve edge(plane, circle(0.25, Point2(0.5, 0.5)));
  const Interval quarter{edge.domain().first, edge.domain().first + 0.25 * edge.domain().length()};
  const std::optional<EdgeCurve::Foot> foot = edge.nearest(Point3(0.0, 0.5, 0.0), quarter, infinity);
  ASSERT_TRUE(foot);
  EXPECT_EQ(foot->t, quarter.last);
  EXPECT_NEAR(edge.length(quarter), 0.125 * std::numbers::pi, 1e-7);
}

TEST(EdgeCurve, LengthsMatchThoseOfLiftedCurves) {
  Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const KnotVector u = KnotVector::clamped_uniform(2, random.integer(1, 4));
    const NurbsSurface<3> surface = random_surface<3>(random, u, KnotVector::clamped_uniform(3, 2));
    const NurbsCurve<2> pcurve = blob(random, Point2(0.5, 0.5), 0.45, 3).curves[0];
    const EdgeCurve edge(surface, pcurve);
    const NurbsCurve<3> lifted = lift(surface, pcurve, 1e-9);
    const double expected = arc_length(lifted, lifted.domain(), 1e-9).value;
    EXPECT_NEAR(edge.length(), expected, 1e-3 * expected);
    const double middle = edge.domain().middle();
    EXPECT_NEAR(edge.length({edge.domain().first, middle}) + edge.length({middle, edge.domain().last}), expected,
                1e-3 * expected);
  }
}

TEST(EdgeCurve, FindsEveryPassage) {
  // A figure of eight that crosses itself at (0.5, 0.5).
  Points<2> points(2, 8);
  points << 0.5, 0.9, 0.9, 0.5, 0.1, 0.1, 0.5, 0.7,  //
      0.5, 0.7, 0.3, 0.5, 0.7, 0.3, 0.5, 0.6;
  const NurbsSurface<3> plane = plane_through(Point3(0, 0, 0), {1, 0, 0}, {0, 1, 0});
  const EdgeCurve edge(plane, NurbsCurve<2>::from_points(KnotVector::clamped_uniform(1, 7), points));
  EXPECT_EQ(edge.feet(Point3(0.5, 0.5, 1e-7), edge.domain(), 1e-6).size(), 3U);
  EXPECT_EQ(edge.feet(Point3(0.9, 0.5, 1e-7), edge.domain(), 1e-6).size(), 1U);
  EXPECT_TRUE(edge.feet(Point3(0.5, 0.8, 0.0), edge.domain(), 1e-6).empty());
}

}  // namespace
}  // namespace isorim::geometry
