#include "geometry/topology/edge_fan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

namespace isorim::geometry {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Directions nearer than this count as one, in radians.
constexpr double tie = 1e-3;

/// Angles about the first leaf's tangent, in [0, 2 pi).
std::vector<double> angles_about_edge(std::span<const FanLeaf> leaves) {
  const Vector3 axis = leaves.front().tangent;
  const Vector3 x = leaves.front().inward;
  const Vector3 y = axis.cross(x);
  std::vector<double> angles;
  for (const FanLeaf& leaf : leaves) {
    const double angle = std::atan2(leaf.inward.dot(y), leaf.inward.dot(x));
    angles.push_back(angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle);
  }
  return angles;
}

/// From a to b in the sense of rising angles, in [0, 2 pi).
double turn(double a, double b) {
  return b >= a ? b - a : b - a + 2.0 * std::numbers::pi;
}

bool are_consistent(const FanLeaf& a, const FanLeaf& b) {
  const int same_way = a.tangent.dot(b.tangent) > 0.0 ? 1 : -1;
  return a.sign * b.sign * same_way < 0;
}

/// Leaves of one component in the order of their angles, paired with the next one, starting from `first`; the sum of
/// the angles between them.
double pair_neighbours(const std::vector<int>& order, std::size_t first, const std::vector<double>& angles,
                       Pairs& pairs) {
  double sum = 0.0;
  for (std::size_t i = first; i < order.size() + first; i += 2) {
    const int a = order[i % order.size()];
    const int b = order[(i + 1) % order.size()];
    pairs.emplace_back(a, b);
    sum += turn(angles[static_cast<std::size_t>(a)], angles[static_cast<std::size_t>(b)]);
  }
  return sum;
}

bool all_consistent(const Pairs& pairs, std::span<const FanLeaf> leaves) {
  return std::ranges::all_of(pairs, [&](const std::pair<int, int>& pair) {
    return are_consistent(leaves[static_cast<std::size_t>(pair.first)], leaves[static_cast<std::size_t>(pair.second)]);
  });
}

/// Whether one leaf of `other` lies between those of `pair` and one does not.
bool cross(const std::pair<int, int>& pair, const std::pair<int, int>& other, const std::vector<double>& angles) {
  const auto angle = [&](int leaf) { return angles[static_cast<std::size_t>(leaf)]; };
  const double width = turn(angle(pair.first), angle(pair.second));
  int inside = 0;
  int outside = 0;
  for (const int leaf : {other.first, other.second}) {
    const double from_first = turn(angle(pair.first), angle(leaf));
    if (from_first > tie && from_first < width - tie) ++inside;
    if (from_first > width + tie && from_first < 2.0 * std::numbers::pi - tie) ++outside;
  }
  return inside == 1 && outside == 1;
}

}  // namespace

std::optional<Pairs> pair_fan(std::span<const FanLeaf> leaves) {
  const std::vector<double> angles = angles_about_edge(leaves);
  std::map<int, std::vector<int>> by_component;
  for (std::size_t i = 0; i < leaves.size(); ++i) by_component[leaves[i].component].push_back(static_cast<int>(i));
  Pairs result;
  std::vector<int> single;
  for (auto& [component, order] : by_component) {
    if (order.size() == 1) {
      single.push_back(order.front());
      continue;
    }
    if (order.size() % 2 != 0) return std::nullopt;
    std::ranges::sort(order, {}, [&](int leaf) { return angles[static_cast<std::size_t>(leaf)]; });
    Pairs even;
    Pairs odd;
    const bool even_is_smaller = pair_neighbours(order, 0, angles, even) <= pair_neighbours(order, 1, angles, odd);
    const Pairs& better = even_is_smaller ? even : odd;
    if (!all_consistent(better, leaves)) return std::nullopt;
    result.insert(result.end(), better.begin(), better.end());
  }
  if (single.size() == 2) result.emplace_back(single[0], single[1]);
  if (single.size() == 1 || single.size() > 2) return std::nullopt;
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t k = i + 1; k < result.size(); ++k) {
      if (cross(result[i], result[k], angles)) return std::nullopt;
    }
  }
  return result;
}

std::optional<Pairs> pair_touching_faces(std::span<const FanLeaf> leaves) {
  if (leaves.size() != 4) return std::nullopt;
  std::vector<std::pair<int, int>> ties;
  for (int i = 0; i < 4; ++i) {
    for (int k = i + 1; k < 4; ++k) {
      const FanLeaf& a = leaves[static_cast<std::size_t>(i)];
      const FanLeaf& b = leaves[static_cast<std::size_t>(k)];
      if (a.component == b.component) return std::nullopt;
      if ((a.inward - b.inward).norm() < tie) ties.emplace_back(i, k);
    }
  }
  if (ties.size() != 1) return std::nullopt;
  std::vector<int> others;
  for (int i = 0; i < 4; ++i) {
    if (i != ties[0].first && i != ties[0].second) others.push_back(i);
  }
  return Pairs{{ties[0].first, others[0]}, {ties[0].second, others[1]}};
}

}  // namespace isorim::geometry
