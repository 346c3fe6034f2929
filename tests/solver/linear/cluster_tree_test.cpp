#include "solver/linear/cluster_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "solver/linear/block_tree.h"
#include "tests/solver/linear/kernel_matrix.h"

namespace isorim::solver {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Children divide their parents, boxes hold their points, leaves are small; returns the depth.
int expect_valid(const ClusterTree& tree, const IndexPlaces& places, int leaf_size) {
  std::vector<int> depth(tree.clusters().size(), 0);
  for (std::size_t k = 0; k < tree.clusters().size(); ++k) {
    const Cluster& cluster = tree.clusters()[k];
    for (const std::int32_t i : tree.indices(cluster)) {
      const Box point{places.points.col(i), places.points.col(i)};
      EXPECT_EQ(point.distance(cluster.points), 0.0);
      EXPECT_EQ((Box{places.lower.col(i), places.lower.col(i)}).distance(cluster.supports), 0.0);
      EXPECT_EQ((Box{places.upper.col(i), places.upper.col(i)}).distance(cluster.supports), 0.0);
    }
    if (cluster.is_leaf()) {
      EXPECT_LE(cluster.count, std::max(1, leaf_size / tree.components()));
      continue;
    }
    const Cluster& left = tree.cluster(cluster.children[0]);
    const Cluster& right = tree.cluster(cluster.children[1]);
    EXPECT_EQ(left.first, cluster.first);
    EXPECT_EQ(right.first, left.first + left.count);
    EXPECT_EQ(left.count + right.count, cluster.count);
    EXPECT_GT(std::min(left.count, right.count), 0);
    for (const int child : cluster.children) depth[static_cast<std::size_t>(child)] = depth[k] + 1;
  }
  std::vector<std::int32_t> sorted = tree.order();
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::int32_t> all(sorted.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
  return *std::max_element(depth.begin(), depth.end());
}

TEST(ClusterTree, DividesIndicesForEveryPlacement) {
  Matrix3Xd graded(3, 400);
  for (Index i = 0; i < 400; ++i) graded.col(i) << std::pow(0.9, static_cast<double>(i)), 0.0, 0.0;
  const Matrix3Xd line = Vector3d(1.0, 2.0, 3.0) * Eigen::RowVectorXd::LinSpaced(300, 0.0, 1.0);
  for (const Matrix3Xd& points : {sphere_points(1000), random_points(777, 1), line, graded,
                                  Matrix3Xd(Matrix3Xd::Ones(3, 500)), Matrix3Xd(Matrix3Xd::Zero(3, 1))}) {
    for (const int components : {1, 3}) {
      IndexPlaces places = testing::places(points, components);
      places.lower.array() -= 0.01;
      places.upper.array() += 0.02;
      const ClusterTree tree(places, 24);
      // 16 / 15 per level at the least.
      EXPECT_LE(expect_valid(tree, places, 24), 60) << points.cols();
      EXPECT_EQ(tree.dimension(), points.cols() * components);
    }
  }
}

TEST(ClusterTree, GradedPointsDoNotMakeItDeep) {
  // Halving the box splits off one point at a time.
  Matrix3Xd points = Matrix3Xd::Zero(3, 1000);
  for (Index i = 0; i < 1000; ++i) points(0, i) = std::ldexp(1.0, -static_cast<int>(i));
  const IndexPlaces places = testing::places(points);
  EXPECT_LE(expect_valid(ClusterTree(places, 16), places, 16), 12);
}

TEST(ClusterTree, OrdersGoThereAndBack) {
  const ClusterTree tree(places(random_points(100, 3), 3), 10);
  const VectorXd vector = random_vector(300, 4);
  const VectorXd ordered = tree.to_tree_order(vector);
  EXPECT_EQ(tree.from_tree_order(ordered), vector);
  for (Index k = 0; k < 100; ++k) {
    const Index i = tree.order()[static_cast<std::size_t>(k)];
    EXPECT_EQ(ordered.segment(3 * k, 3), vector.segment(3 * i, 3));
    EXPECT_EQ(tree.places()[static_cast<std::size_t>(i)], k);
  }
}

TEST(ClusterTree, RefusesWhatHasNoPlace) {
  const auto build = [](const IndexPlaces& places) { return [&places] { ClusterTree(places, 10); }; };
  IndexPlaces bad = places(Matrix3Xd(3, 0));
  EXPECT_THAT(build(bad), ThrowsMessage<InputError>(HasSubstr("without indices")));
  bad = places(random_points(5, 1));
  bad.points(1, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(build(bad), ThrowsMessage<InputError>(HasSubstr("index 3 has a place that is not finite")));
  bad = places(random_points(5, 1));
  bad.lower(0, 2) = bad.upper(0, 2) + 1.0;
  EXPECT_THAT(build(bad), ThrowsMessage<InputError>(HasSubstr("the box of index 2")));
  bad = places(random_points(5, 1));
  bad.upper = random_points(4, 1);
  EXPECT_THAT(build(bad), ThrowsMessage<InputError>(HasSubstr("5 points of indices, but 5 and 4")));
}

TEST(BlockTree, LeavesCoverTheMatrixOnceAndFarOnesAreFar) {
  for (const Index count : {Index{1}, Index{50}, Index{600}}) {
    IndexPlaces places = testing::places(sphere_points(count));
    places.lower.array() -= 0.05;
    places.upper.array() += 0.05;
    const auto clusters = std::make_shared<const ClusterTree>(places, 16);
    const BlockTreeOptions options{.eta = 1.5, .separation = 0.7};
    const BlockTree tree(clusters, clusters, options);
    Eigen::MatrixXi covered = Eigen::MatrixXi::Zero(count, count);
    for (const Block& block : tree.blocks()) {
      if (block.kind == BlockKind::subdivided) continue;
      covered.block(tree.first_row(block), tree.first_column(block), tree.row_count(block), tree.column_count(block))
          .array() += 1;
      const Cluster& row = tree.row_cluster(block);
      const Cluster& column = tree.column_cluster(block);
      const double distance = row.points.distance(column.supports);
      const bool admissible = distance > 0.0 && distance >= 0.7 * column.largest_support &&
                              std::min(row.points.diameter(), column.supports.diameter()) <= 1.5 * distance;
      EXPECT_EQ(block.kind == BlockKind::low_rank, admissible);
      EXPECT_TRUE(admissible || (row.is_leaf() && column.is_leaf()));
    }
    EXPECT_TRUE((covered.array() == 1).all());
  }
}

}  // namespace
}  // namespace isorim::solver
