#include "geometry/fitting/point_reduction.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"

namespace isorim::geometry {
namespace {

Points<2> random_points(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-3.0, 5.0);
  Points<2> points(2, count);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = coordinate(random);
  return points;
}

TEST(ReducePoints, CentroidsOfCellsByHand) {
  Points<2> points(2, 5);
  points << 0.0, 0.5, 1.5, 0.25, 1.75,  //
      0.0, 0.5, 0.0, 1.5, 0.5;
  const ReducedPoints reduced = reduce_points(points, Vector2(1.0, 1.0));
  ASSERT_EQ(reduced.points.cols(), 3);
  EXPECT_EQ(reduced.points.col(0), Point2(0.25, 0.25));
  EXPECT_EQ(reduced.points.col(1), Point2(1.625, 0.25));
  EXPECT_EQ(reduced.points.col(2), Point2(0.25, 1.5));
  EXPECT_EQ(reduced.counts, (std::vector<int>{2, 2, 1}));
  EXPECT_EQ(reduced.cells[1], Eigen::Vector2i(1, 0));
}

TEST(ReducePoints, KeepsCountAndCentroid) {
  const Points<2> points = random_points(10000, 1);
  const ReducedPoints reduced = reduce_points(points, Vector2(0.3, 0.7));
  EXPECT_EQ(std::accumulate(reduced.counts.begin(), reduced.counts.end(), 0), 10000);
  Point2 sum = Point2::Zero();
  for (Eigen::Index i = 0; i < reduced.points.cols(); ++i) {
    sum += reduced.counts[static_cast<std::size_t>(i)] * reduced.points.col(i);
    const Vector2 within = (reduced.points.col(i) - reduced.origin).cwiseQuotient(reduced.cell_size) -
                           reduced.cells[static_cast<std::size_t>(i)].cast<double>();
    EXPECT_GE(within.minCoeff(), 0.0);
    EXPECT_LE(within.maxCoeff(), 1.0);
  }
  EXPECT_LT((sum / 10000.0 - points.rowwise().mean()).norm(), 1e-13);
}

TEST(ReducePoints, FarFromTheOriginCentroidsKeepTheirDigits) {
  const Points<2> points = random_points(1000, 2);
  const ReducedPoints near = reduce_points(points, Vector2(0.5, 0.5));
  // The shift is exact in binary for coordinates rounded to 2^-20.
  Points<2> rounded = points.unaryExpr([](double x) { return std::ldexp(std::round(std::ldexp(x, 20)), -20); });
  const ReducedPoints here = reduce_points(rounded, Vector2(0.5, 0.5));
  rounded.array() += 1048576.0;
  const ReducedPoints far = reduce_points(rounded, Vector2(0.5, 0.5));
  ASSERT_EQ(far.points.cols(), here.points.cols());
  EXPECT_LT((far.points.array() - 1048576.0 - here.points.array()).abs().maxCoeff(), 1.2e-10);
  EXPECT_EQ(far.counts, here.counts);
  EXPECT_EQ(near.cell_size, here.cell_size);
}

TEST(ReducePoints, RefusesWhatHasNoCells) {
  EXPECT_GEOMETRY_ERROR(reduce_points(Points<2>(2, 0), Vector2(1, 1)), "no points");
  EXPECT_GEOMETRY_ERROR(reduce_points(Points<2>::Zero(2, 2), Vector2(1, 0)), "cell size[1] is 0");
  EXPECT_GEOMETRY_ERROR(reduce_points(Points<2>::Zero(2, 2), Vector2(std::nan(""), 1)), "cell size[0]");
  EXPECT_GEOMETRY_ERROR(reduce_points(random_points(5, 3), Vector2(1e-12, 1)), "too small");
  Points<2> bad = Points<2>::Zero(2, 3);
  bad(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_GEOMETRY_ERROR(reduce_points(bad, Vector2(1, 1)), "point 3 of 3");
}

TEST(AutomaticCellSize, BoundsTheNumberOfCells) {
  const Points<2> points = random_points(50000, 4);
  const Vector2 size = automatic_cell_size(points, 1000);
  EXPECT_LE(reduce_points(points, size).points.cols(), 1000);
  EXPECT_GT(reduce_points(points, size / 2.0).points.cols(), 1000);
  EXPECT_GEOMETRY_ERROR(automatic_cell_size(Points<2>::Zero(2, 4)), "all points coincide");
}

TEST(SliceCloud, SlabsHoldEveryPointOnce) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  Points<3> cloud(3, 2000);
  for (Eigen::Index i = 0; i < cloud.size(); ++i) cloud.data()[i] = coordinate(random);
  for (const int axis : {0, 1, 2}) {
    std::size_t count = 0;
    double before = -10.0;
    for (const Slice& slice : slice_cloud(cloud, axis, 0.25)) {
      EXPECT_GT(slice.position, before);
      before = slice.position;
      count += slice.indices.size();
      for (std::size_t k = 0; k < slice.indices.size(); ++k) {
        const Point3 point = cloud.col(slice.indices[k]);
        EXPECT_LE(std::abs(point(axis) - slice.position), 0.25);
        const Point3 back = in_space(slice.points.col(static_cast<Eigen::Index>(k)), axis, point(axis));
        EXPECT_EQ(back, point);
      }
    }
    EXPECT_EQ(count, 2000U);
  }
}

TEST(SliceCloud, SectionsAtEqualStepsKeepTheirHeights) {
  Points<3> cloud(3, 30);
  for (int i = 0; i < 30; ++i) cloud.col(i) << i, -i, 0.1 * (i / 3);
  const std::vector<Slice> slices = slice_cloud(cloud, 2, 0.1);
  ASSERT_EQ(slices.size(), 10U);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(slices[static_cast<std::size_t>(k)].position, 0.1 * k);
}

TEST(SliceCloud, RefusesBadNumbers) {
  EXPECT_GEOMETRY_ERROR(slice_cloud(Points<3>::Zero(3, 2), 3, 1.0), "the axis is 3");
  EXPECT_GEOMETRY_ERROR(slice_cloud(Points<3>::Zero(3, 2), 2, 0.0), "thickness is 0");
  Points<3> tall = Points<3>::Zero(3, 2);
  tall(2, 1) = 1.0;
  EXPECT_GEOMETRY_ERROR(slice_cloud(tall, 2, 1e-9), "too small");
  tall(0, 0) = std::nan("");
  EXPECT_GEOMETRY_ERROR(slice_cloud(tall, 2, 1.0), "point 1 of 2");
}

}  // namespace
}  // namespace isorim::geometry
