#include "geometry/fitting/contour_ordering.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/fitting/contour_measures.h"
#include "geometry/fitting/point_reduction.h"
#include "tests/geometry/expect_error.h"

namespace isorim::geometry {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// A closed curve over [0, 1).
using Curve = std::function<Point2(double)>;

Curve circle(double radius, const Point2& centre = Point2::Zero()) {
  return [=](double t) { return Point2(centre + radius * Point2(std::cos(two_pi * t), std::sin(two_pi * t))); };
}

/// Five tips: the polygon through 10 points at distances 1 and 1/2.
Point2 star(double t) {
  const int side = static_cast<int>(10.0 * t);
  const auto corner = [](int i) { return circle(i % 2 == 0 ? 1.0 : 0.5)(0.1 * i); };
  const double part = 10.0 * t - side;
  return (1.0 - part) * corner(side) + part * corner(side + 1);
}

/// Bounded by the unit circle and that of radius 0.8 about (0.4, 0), which meet at sharp tips.
Point2 crescent(double t) {
  const double outer = std::acos((1.0 + 0.16 - 0.64) / 0.8);
  const double inner = std::acos((1.0 - 0.64 - 0.16) / 0.64);
  if (t < 0.6) return circle(1.0)((outer + (two_pi - 2.0 * outer) * t / 0.6) / two_pi);
  return circle(0.8, {0.4, 0.0})((two_pi - inner - (two_pi - 2.0 * inner) * (t - 0.6) / 0.4) / two_pi);
}

/// Evenly spaced points of the curve outside [0, gap), noise added, in random order.
Points<2> scan(const Curve& curve, int count, double noise, double gap, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count;
    if (t < gap) continue;
    const Point2 point = curve(t);
    points.emplace_back(point + noise * Point2(normal(random), normal(random)));
  }
  std::ranges::shuffle(points, random);
  Points<2> matrix(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  return matrix;
}

Points<2> joined(const Points<2>& a, const Points<2>& b) {
  Points<2> all(2, a.cols() + b.cols());
  all << a, b;
  return all;
}

/// Each point of the contour is that of the curve at a parameter that rises, but for one step, all along.
void expect_in_order(const Contour& contour, const Curve& curve, int count) {
  std::vector<int> places;
  for (Eigen::Index k = 0; k < contour.points.cols(); ++k) {
    int nearest = 0;
    for (int i = 1; i < count; ++i) {
      const auto distance = [&](int j) { return (curve((j + 0.5) / count) - contour.points.col(k)).norm(); };
      if (distance(i) < distance(nearest)) nearest = i;
    }
    places.push_back(nearest);
  }
  int falls = 0;
  for (std::size_t k = 0; k < places.size(); ++k) falls += places[k] < places[(k + places.size() - 1) % places.size()];
  EXPECT_EQ(std::min<int>(falls, static_cast<int>(places.size()) - falls), 1);
}

class Shapes : public testing::TestWithParam<std::pair<const char*, Curve>> {};

TEST_P(Shapes, CleanPointsComeInTheOrderOfTheCurve) {
  std::mt19937 random(7);
  const Curve& curve = GetParam().second;
  for (const double gap : {0.0, 0.05}) {
    for (const int count : {100, 400}) {
      SCOPED_TRACE(std::to_string(count) + " points, gap " + std::to_string(gap));
      const Points<2> points = scan(curve, count, 0.0, gap, random);
      const OrderedContours ordered = order_contours(points);
      ASSERT_EQ(ordered.contours.size(), 1U);
      const Contour& contour = ordered.contours.front();
      EXPECT_TRUE(contour.closed);
      EXPECT_FALSE(ordered.thinned);
      EXPECT_TRUE(ordered.dropped.empty());
      ASSERT_EQ(contour.points.cols(), points.cols());
      EXPECT_GT(polygon_area(contour.points), 0.0);
      expect_in_order(contour, curve, count);
    }
  }
}

TEST_P(Shapes, NoiseUpToTwoPercentLeavesTheArea) {
  std::mt19937 random(11);
  const Curve& curve = GetParam().second;
  Points<2> exact(2, 20000);
  for (Eigen::Index i = 0; i < exact.cols(); ++i) exact.col(i) = curve(static_cast<double>(i) / 20000.0);
  const double area = std::abs(polygon_area(exact));
  for (const double noise : {0.001, 0.005, 0.01, 0.02}) {
    for (const int count : {200, 2000}) {
      SCOPED_TRACE(std::to_string(count) + " points, noise " + std::to_string(noise));
      const OrderedContours ordered = order_contours(scan(curve, count, noise, 0.0, random));
      ASSERT_EQ(ordered.contours.size(), 1U);
      EXPECT_TRUE(ordered.contours.front().closed);
      EXPECT_NEAR(polygon_area(ordered.contours.front().points), area, (0.002 + 1.5 * noise) * area);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OrderContours, Shapes,
                         testing::Values(std::pair<const char*, Curve>("circle", circle(1.0)),
                                         std::pair<const char*, Curve>("star", star),
                                         std::pair<const char*, Curve>("crescent", crescent)),
                         [](const auto& shape) { return shape.param.first; });

TEST(OrderContours, ThinWallsAreNotCrossed) {
  std::mt19937 random(3);
  const Curve blade = [](double t) { return Point2(std::cos(two_pi * t), 0.03 * std::sin(two_pi * t)); };
  const OrderedContours ordered = order_contours(scan(blade, 400, 0.0, 0.0, random));
  ASSERT_EQ(ordered.contours.size(), 1U);
  expect_in_order(ordered.contours.front(), blade, 400);
}

TEST(OrderContours, NestedLoopsComeApart) {
  std::mt19937 random(5);
  for (const double noise : {0.0, 0.01, 0.02}) {
    const Points<2> points =
        joined(scan(circle(1.0), 1200, noise, 0.05, random), scan(circle(0.6), 800, noise, 0.0, random));
    const OrderedContours ordered = order_contours(points);
    ASSERT_EQ(ordered.contours.size(), 2U);
    for (const Contour& contour : ordered.contours) EXPECT_TRUE(contour.closed);
    EXPECT_NEAR(polygon_area(ordered.contours[0].points), 3.1294, 0.02);
    EXPECT_NEAR(polygon_area(ordered.contours[1].points), 1.1310, 0.01);
  }
}

TEST(OrderContours, LoopsThatNearlyTouchComeApart) {
  std::mt19937 random(5);
  // Steps are 0.0126, the loops 0.02 apart.
  const Points<2> points =
      joined(scan(circle(1.0), 500, 0.0, 0.0, random), scan(circle(1.0, {2.02, 0.0}), 500, 0.0, 0.0, random));
  const OrderedContours ordered = order_contours(points);
  ASSERT_EQ(ordered.contours.size(), 2U);
  for (const Contour& contour : ordered.contours) {
    EXPECT_TRUE(contour.closed);
    EXPECT_EQ(contour.points.cols(), 500);
  }
}

/// Two noisy circles, one in the other: from eight standard deviations of the noise on each is met; nearer ones are
/// told of, down to where the points are one heap; and where all is well nothing is told.
TEST(OrderContours, NoisyNeighboursComeApartOrAreToldOf) {
  for (const double noise : {0.005, 0.01}) {
    for (const double distance : {4.5, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 12.0, 16.0}) {
      SCOPED_TRACE(std::to_string(noise) + " x " + std::to_string(distance));
      std::mt19937 random(11);
      const double outer = 1.0 + distance * noise;
      const Points<2> inner_points = scan(circle(1.0), 1500, noise, 0.0, random);
      const Points<2> outer_points = scan(circle(outer), 1500, noise, 0.0, random);
      Points<2> points(2, 3000);
      points << inner_points, outer_points;
      const OrderedContours ordered = order_contours(points);
      EXPECT_TRUE(ordered.thinned);
      if (distance < 7.5) {
        EXPECT_GT(ordered.doubtful_share, 0.1);
        EXPECT_NEAR(ordered.doubtful_place.norm(), 0.5 * (1.0 + outer), distance * noise);
        continue;
      }
      ASSERT_EQ(ordered.contours.size(), 2U);
      for (const Contour& contour : ordered.contours) {
        EXPECT_TRUE(contour.closed);
        const double radius = contour.points.colwise().norm().mean();
        EXPECT_LE(std::min(std::abs(radius - 1.0), std::abs(radius - outer)), 0.3 * noise);
      }
      EXPECT_LE(ordered.doubtful_share, distance > 9.5 ? 0.01 : 1.0);
    }
    std::mt19937 random(12);
    EXPECT_EQ(order_contours(scan(circle(1.0), 1500, noise, 0.0, random)).doubtful_share, 0.0);
  }
}

/// Cells smaller than the noise: their centroids are a band as well, thinned with their counts.
TEST(OrderContours, CellsOfANoisyCloudAreThinned) {
  std::mt19937 random(13);
  const ReducedPoints cells = reduce_points(scan(circle(1.0), 40000, 0.01, 0.0, random), {0.01, 0.01});
  ASSERT_GT(cells.points.cols(), 2000);
  const OrderedContours ordered = order_contours(cells.points, cells.counts);
  EXPECT_TRUE(ordered.thinned);
  EXPECT_EQ(ordered.doubtful_share, 0.0);
  ASSERT_EQ(ordered.contours.size(), 1U);
  const Eigen::VectorXd radii = ordered.contours[0].points.colwise().norm();
  EXPECT_NEAR(radii.mean(), 1.0, 1e-3);
  EXPECT_LE(std::sqrt((radii.array() - radii.mean()).square().mean()), 2e-3);
}

TEST(OrderContours, OpenContoursStayOpen) {
  std::mt19937 random(9);
  const Curve half = [](double t) { return circle(1.0)(0.5 * t); };
  const Curve line = [](double t) { return Point2(t, 0.1 * t * t); };
  for (const Curve& curve : {half, line}) {
    for (const double noise : {0.0, 0.01}) {
      const OrderedContours ordered = order_contours(scan(curve, 1000, noise, 0.0, random));
      ASSERT_EQ(ordered.contours.size(), 1U);
      const Contour& contour = ordered.contours.front();
      EXPECT_FALSE(contour.closed);
      const Point2 first = contour.points.col(0);
      const Point2 last = contour.points.col(contour.points.cols() - 1);
      EXPECT_NEAR((first - last).norm(), (curve(0.0) - curve(1.0)).norm(), 3.0 * noise + 0.01);
    }
  }
}

TEST(OrderContours, EndsAreForcedOrLeft) {
  std::mt19937 random(9);
  const Points<2> half = scan([](double t) { return circle(1.0)(0.5 * t); }, 200, 0.0, 0.0, random);
  EXPECT_TRUE(order_contours(half, {}, {.ends = ContourEnds::closed}).contours.front().closed);
  EXPECT_TRUE(order_contours(half, {}, {.largest_gap = 0.7}).contours.front().closed);
  const Points<2> whole = scan(circle(1.0), 200, 0.0, 0.0, random);
  const OrderedContours open = order_contours(whole, {}, {.ends = ContourEnds::open});
  EXPECT_FALSE(open.contours.front().closed);
  EXPECT_EQ(open.contours.front().points.cols(), 200);
}

TEST(OrderContours, DuplicatesOutliersAndSpikesAreReported) {
  std::mt19937 random(2);
  const Points<2> clean = scan(circle(1.0), 200, 0.0, 0.0, random);
  Points<2> extra(2, 3);
  extra << clean(0, 17), 3.0, 1.09, clean(1, 17), 3.0, 0.015;
  const OrderedContours ordered = order_contours(joined(clean, extra));
  ASSERT_EQ(ordered.contours.size(), 1U);
  EXPECT_EQ(ordered.contours.front().points.cols(), 200);
  ASSERT_EQ(ordered.dropped.size(), 3U);
  EXPECT_EQ(ordered.dropped[0].index, 200);
  EXPECT_EQ(ordered.dropped[0].reason, DropReason::duplicate);
  EXPECT_EQ(ordered.dropped[1].index, 201);
  EXPECT_EQ(ordered.dropped[1].reason, DropReason::outlier);
  EXPECT_EQ(ordered.dropped[2].index, 202);
  EXPECT_EQ(ordered.dropped[2].reason, DropReason::spike);
  const auto weight = [&] {
    double sum = 0.0;
    for (const double w : ordered.contours.front().weights) sum += w;
    return sum;
  };
  EXPECT_EQ(weight(), 201.0);
}

TEST(OrderContours, EveryPointIsCountedOnce) {
  std::mt19937 random(4);
  for (const double noise : {0.0, 0.01, 0.02}) {
    const Points<2> points = scan(star, 3000, noise, 0.05, random);
    const OrderedContours ordered = order_contours(points);
    double sum = static_cast<double>(ordered.dropped.size());
    for (const Contour& contour : ordered.contours) {
      for (const double w : contour.weights) sum += w;
    }
    EXPECT_EQ(sum, static_cast<double>(points.cols()));
  }
}

TEST(OrderContours, TheOrderOfTheInputPlaysNoPart) {
  std::mt19937 random(6);
  Points<2> points = scan(crescent, 500, 0.003, 0.0, random);
  const OrderedContours first = order_contours(points);
  points = points.rowwise().reverse().eval();
  const OrderedContours second = order_contours(points);
  ASSERT_EQ(second.contours.size(), first.contours.size());
  EXPECT_EQ(second.contours.front().points, first.contours.front().points);
}

TEST(OrderContours, RefusesWhatIsNoSection) {
  Points<2> few(2, 3);
  few << 0, 1, 2, 0, 1, 0;
  EXPECT_GEOMETRY_ERROR(order_contours(few), "no group of at least 6 points among the 3");
  few(0, 0) = std::nan("");
  EXPECT_GEOMETRY_ERROR(order_contours(few), "not a number");
  EXPECT_GEOMETRY_ERROR(order_contours(Points<2>::Zero(2, 9), std::vector<int>{1}), "1 counts for 9 points");
  EXPECT_GEOMETRY_ERROR(order_contours(Points<2>::Zero(2, 1), std::vector<int>{0}), "a count is 0");
  OrderingOptions gaping;
  gaping.largest_gap = 2.0;
  EXPECT_GEOMETRY_ERROR(order_contours(Points<2>::Random(2, 9), {}, gaping), "the largest gap is 2");
}

// --- The thesis's rule ----------------------------------------------------------------------------------------

TEST(OrderByDensity, FollowsTheProductOfCountAndDistance) {
  // A 4 x 4 ring of cells; the corner (3, 3) is the densest. From there (3, 2) and (2, 3) are equally near; (2, 3) has
  // the larger count.
  ReducedPoints cells;
  cells.points.resize(2, 12);
  const int ring[12][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2},
                           {3, 3}, {2, 3}, {1, 3}, {0, 3}, {0, 2}, {0, 1}};
  for (int i = 0; i < 12; ++i) {
    cells.points.col(i) << ring[i][0], ring[i][1];
    cells.cells.emplace_back(ring[i][0], ring[i][1]);
    cells.counts.push_back(i == 6 ? 9 : i == 7 ? 3 : 2);
  }
  const OrderedContours ordered = order_by_density(cells);
  ASSERT_EQ(ordered.contours.size(), 1U);
  EXPECT_TRUE(ordered.contours.front().closed);
  // (3, 2) lies in the first neighbourhood and is dropped; corners are cut where the diagonal neighbour is farther.
  ASSERT_FALSE(ordered.dropped.empty());
  EXPECT_THAT(ordered.dropped, testing::Contains(testing::Field(&DroppedPoint::index, 5)));
  for (const DroppedPoint& point : ordered.dropped) EXPECT_EQ(point.reason, DropReason::passed_over);
  EXPECT_EQ(static_cast<std::size_t>(ordered.contours.front().points.cols()) + ordered.dropped.size(), 12U);
}

TEST(OrderByDensity, WalksRoundAScannedCircle) {
  std::mt19937 random(8);
  const ReducedPoints cells = reduce_points(scan(circle(1.0), 20000, 0.002, 0.0, random), Vector2::Constant(0.05));
  const OrderedContours ordered = order_by_density(cells);
  EXPECT_TRUE(ordered.contours.front().closed);
  EXPECT_NEAR(polygon_area(ordered.contours.front().points), std::numbers::pi, 0.02);
}

TEST(OrderByDensity, StopsAtAGapAndAtASecondLoop) {
  std::mt19937 random(8);
  const Points<2> points =
      joined(scan(circle(1.0), 20000, 0.0, 0.0, random), scan(circle(0.5), 3000, 0.0, 0.0, random));
  const OrderedContours two = order_by_density(reduce_points(points, Vector2::Constant(0.05)));
  EXPECT_TRUE(std::ranges::any_of(two.dropped, [](const auto& p) { return p.reason == DropReason::not_reached; }));
  const ReducedPoints gap = reduce_points(scan(circle(1.0), 20000, 0.0, 0.05, random), Vector2::Constant(0.05));
  EXPECT_FALSE(order_by_density(gap).contours.front().closed);
  EXPECT_GEOMETRY_ERROR(order_by_density(gap, DensityWalkOptions{.reach = 0}), "the reach is 0");
  EXPECT_GEOMETRY_ERROR(order_by_density(ReducedPoints{}), "no points");
}

}  // namespace
}  // namespace isorim::geometry
