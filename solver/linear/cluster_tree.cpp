#include "solver/linear/cluster_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::solver {

namespace {

using Eigen::Index;

void check(const IndexPlaces& places, int leaf_size) {
  const Index count = places.points.cols();
  if (count == 0) throw InputError("a matrix without indices cannot be divided into clusters");
  if (count > std::numeric_limits<std::int32_t>::max())
    throw InputError(fmt::format("{} indices are too many for a cluster tree", count));
  if (places.components < 1 || leaf_size < 1)
    throw InputError(fmt::format("a cluster tree needs components and leaf size of at least 1, not {} and {}",
                                 places.components, leaf_size));
  if (places.lower.cols() != count || places.upper.cols() != count)
    throw InputError(fmt::format("{} points of indices, but {} and {} corners of their boxes", count,
                                 places.lower.cols(), places.upper.cols()));
  for (Index i = 0; i < count; ++i) {
    const auto finite = [i](const Eigen::Matrix3Xd& m) { return m.col(i).allFinite(); };
    if (!finite(places.points) || !finite(places.lower) || !finite(places.upper))
      throw InputError(fmt::format("index {} has a place that is not finite", i));
    if ((places.lower.col(i).array() > places.upper.col(i).array()).any())
      throw InputError(fmt::format("the box of index {} has a lower corner above its upper one", i));
  }
}

Box bounds(const Eigen::Matrix3Xd& lower, const Eigen::Matrix3Xd& upper, std::span<const std::int32_t> indices) {
  Box box{lower.col(indices[0]), upper.col(indices[0])};
  for (const std::int32_t i : indices) {
    box.lower = box.lower.cwiseMin(lower.col(i));
    box.upper = box.upper.cwiseMax(upper.col(i));
  }
  return box;
}

/// Puts the indices in an order such that the first so many, the number returned, are one child, the rest the other.
std::ptrdiff_t bisect(const Eigen::Matrix3Xd& points, const Box& box, std::span<std::int32_t> indices) {
  Index axis = 0;
  (box.upper - box.lower).maxCoeff(&axis);
  const double middle = 0.5 * (box.lower[axis] + box.upper[axis]);
  const auto cut =
      std::stable_partition(indices.begin(), indices.end(), [&](std::int32_t i) { return points(axis, i) < middle; });
  const std::ptrdiff_t count = std::ssize(indices);
  const std::ptrdiff_t left = cut - indices.begin();
  if (16 * std::min(left, count - left) >= count) return left;
  std::sort(indices.begin(), indices.end(), [&](std::int32_t i, std::int32_t j) {
    return points(axis, i) != points(axis, j) ? points(axis, i) < points(axis, j) : i < j;
  });
  return count / 2;
}

}  // namespace

ClusterTree::ClusterTree(const IndexPlaces& places, int leaf_size) : components_(places.components) {
  check(places, leaf_size);
  order_.resize(static_cast<std::size_t>(places.points.cols()));
  std::iota(order_.begin(), order_.end(), 0);
  const Index leaf_count = std::max<Index>(1, leaf_size / components_);
  clusters_.push_back({.first = 0, .count = places.points.cols()});
  for (std::size_t number = 0; number < clusters_.size(); ++number) {
    Cluster cluster = clusters_[number];
    const std::span<std::int32_t> members{order_.data() + cluster.first, static_cast<std::size_t>(cluster.count)};
    cluster.points = bounds(places.points, places.points, members);
    cluster.supports = bounds(places.lower, places.upper, members);
    for (const std::int32_t i : members)
      cluster.largest_support = std::max(cluster.largest_support, (places.upper.col(i) - places.lower.col(i)).norm());
    if (cluster.count > leaf_count) {
      const Index left = bisect(places.points, cluster.points, members);
      cluster.children = {static_cast<int>(clusters_.size()), static_cast<int>(clusters_.size()) + 1};
      clusters_.push_back({.first = cluster.first, .count = left});
      clusters_.push_back({.first = cluster.first + left, .count = cluster.count - left});
    }
    clusters_[number] = cluster;
  }
  places_.resize(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k)
    places_[static_cast<std::size_t>(order_[k])] = static_cast<std::int32_t>(k);
}

Eigen::VectorXd ClusterTree::to_tree_order(const Eigen::Ref<const Eigen::VectorXd>& vector) const {
  Eigen::VectorXd result(dimension());
  for (Index k = 0; k < std::ssize(order_); ++k)
    result.segment(k * components_, components_) =
        vector.segment(Index{order_[static_cast<std::size_t>(k)]} * components_, components_);
  return result;
}

Eigen::VectorXd ClusterTree::from_tree_order(const Eigen::Ref<const Eigen::VectorXd>& vector) const {
  Eigen::VectorXd result(dimension());
  for (Index k = 0; k < std::ssize(order_); ++k)
    result.segment(Index{order_[static_cast<std::size_t>(k)]} * components_, components_) =
        vector.segment(k * components_, components_);
  return result;
}

}  // namespace isorim::solver
