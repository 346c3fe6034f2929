#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace isorim::solver {

/// Where the indices of a matrix's rows and columns lie. Lengths in the unit of the shape; in the plane the third
/// coordinate is 0.
struct IndexPlaces {
  /// 3 x n: the point of each index, which places it in the tree and at which the index's row is evaluated.
  Eigen::Matrix3Xd points;
  /// 3 x n each: corners of the box of each index's function (its support), over which the index's column integrates.
  Eigen::Matrix3Xd lower;
  Eigen::Matrix3Xd upper;
  /// Scalar rows and columns that an index stands for; kept together: entry index * components + component.
  int components = 1;
};

/// The smallest box about points or supports.
struct Box {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();

  double diameter() const { return (upper - lower).norm(); }
  /// 0 where boxes touch or overlap.
  double distance(const Box& other) const {
    return (lower - other.upper).cwiseMax(other.lower - upper).cwiseMax(0.0).norm();
  }
};

/// A set of indices that lie together: count of them from `first` in the tree's order.
struct Cluster {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
  /// Positions in ClusterTree::clusters(); -1 for a leaf.
  std::array<int, 2> children{-1, -1};
  Box points{};
  Box supports{};
  /// Diagonal of the largest box of a single index.
  double largest_support = 0.0;

  bool is_leaf() const { return children[0] < 0; }
};

/// Binary tree over indices by bisection of the boxes of their points: the longest side is halved; where a half would
/// hold less than a sixteenth of the indices (graded or coincident points), the median cuts instead. So the depth is of
/// the order of log n for every input, and the tree depends on nothing but the input.
class ClusterTree {
 public:
  /// Leaves hold at most leaf_size scalar rows (but one index at least). Throws InputError for no index, for sizes that
  /// disagree, and for a place that is not finite or a box turned inside out.
  ClusterTree(const IndexPlaces& places, int leaf_size);

  /// Parents before children; the root is the first.
  const std::vector<Cluster>& clusters() const { return clusters_; }
  const Cluster& cluster(int number) const { return clusters_[static_cast<std::size_t>(number)]; }
  /// The caller's index at each place of the tree's order.
  const std::vector<std::int32_t>& order() const { return order_; }
  /// The place in the tree's order of each of the caller's indices.
  const std::vector<std::int32_t>& places() const { return places_; }
  std::span<const std::int32_t> indices(const Cluster& cluster) const {
    return {order_.data() + cluster.first, static_cast<std::size_t>(cluster.count)};
  }
  int components() const { return components_; }
  /// Scalar rows.
  Eigen::Index dimension() const { return static_cast<Eigen::Index>(order_.size()) * components_; }

  /// Entries of a vector of dimension() from the caller's order to the tree's, and back.
  Eigen::VectorXd to_tree_order(const Eigen::Ref<const Eigen::VectorXd>& vector) const;
  Eigen::VectorXd from_tree_order(const Eigen::Ref<const Eigen::VectorXd>& vector) const;

 private:
  std::vector<Cluster> clusters_;
  std::vector<std::int32_t> order_;
  std::vector<std::int32_t> places_;
  int components_;
};

}  // namespace isorim::solver
