#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// Nearest points of the plane by a k-d tree: n log n to build, whatever the points' distribution.
class NeighbourTree {
 public:
  explicit NeighbourTree(Points<2> points) : points_(std::move(points)), order_(std::size_t(points_.cols())) {
    std::iota(order_.begin(), order_.end(), 0);
    build(0, order_.size(), 0);
  }

  const Points<2>& points() const { return points_; }

  /// The `count` nearest points to a place (fewer if there are not as many), nearest first, of equally near ones that
  /// of the smaller index first; `except` (-1: none) is left out.
  std::vector<int> nearest(const Point2& place, int count, int except = -1) const {
    Nearest found{place, static_cast<std::size_t>(std::max(count, 0)), except, {}};
    if (found.count > 0) search(0, order_.size(), 0, found);
    std::vector<int> indices(found.heap.size());
    for (std::size_t i = indices.size(); i-- > 0;) {
      indices[i] = found.heap.top().second;
      found.heap.pop();
    }
    return indices;
  }

  /// Calls visit(index, squared distance) for the points no farther than `radius` from a place, in a fixed order.
  template <typename Visit>
  void for_each_within(const Point2& place, double radius, const Visit& visit) const {
    visit_ball(0, order_.size(), 0, place, radius, visit);
  }

 private:
  /// Squared distance and index.
  using Candidate = std::pair<double, int>;
  struct Nearest {
    Point2 place;
    std::size_t count;
    int except;
    std::priority_queue<Candidate> heap;

    double reach() const { return heap.size() < count ? std::numeric_limits<double>::infinity() : heap.top().first; }
    void offer(const Candidate& candidate) {
      if (candidate.second == except) return;
      if (heap.size() == count) {
        if (!(candidate < heap.top())) return;
        heap.pop();
      }
      heap.push(candidate);
    }
  };

  void build(std::size_t begin, std::size_t end, int axis) {
    if (end - begin < 2) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    const auto before = [&](int a, int b) { return std::pair(points_(axis, a), a) < std::pair(points_(axis, b), b); };
    std::nth_element(at(begin), at(middle), at(end), before);
    build(begin, middle, 1 - axis);
    build(middle + 1, end, 1 - axis);
  }

  void search(std::size_t begin, std::size_t end, int axis, Nearest& found) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const int index = order_[middle];
    const double away = found.place(axis) - points_(axis, index);
    const bool low_first = away <= 0.0;
    low_first ? search(begin, middle, 1 - axis, found) : search(middle + 1, end, 1 - axis, found);
    found.offer({(points_.col(index) - found.place).squaredNorm(), index});
    if (away * away > found.reach()) return;
    low_first ? search(middle + 1, end, 1 - axis, found) : search(begin, middle, 1 - axis, found);
  }

  template <typename Visit>
  void visit_ball(std::size_t begin, std::size_t end, int axis, const Point2& place, double radius,
                  const Visit& visit) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const int index = order_[middle];
    const double away = place(axis) - points_(axis, index);
    if (away <= radius) visit_ball(begin, middle, 1 - axis, place, radius, visit);
    const double squared_distance = (points_.col(index) - place).squaredNorm();
    if (squared_distance <= radius * radius) visit(index, squared_distance);
    if (-away <= radius) visit_ball(middle + 1, end, 1 - axis, place, radius, visit);
  }

  Points<2> points_;
  std::vector<int> order_;
};

}  // namespace isorim::geometry
