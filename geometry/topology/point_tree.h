#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// Points in boxes by a k-d tree: n log n to build, whatever the points' distribution.
class PointTree {
 public:
  explicit PointTree(std::vector<Point3> points) : points_(std::move(points)), order_(points_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    build(0, order_.size(), 0);
  }

  const Point3& operator[](int index) const { return points_[static_cast<std::size_t>(index)]; }

  /// Calls visit(index) for every point in the closed box.
  template <typename Visit>
  void for_each_in_box(const Point3& lower, const Point3& upper, const Visit& visit) const {
    search(0, order_.size(), 0, lower, upper, visit);
  }

 private:
  void build(std::size_t begin, std::size_t end, int axis) {
    if (end - begin < 2) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](int a, int b) { return (*this)[a](axis) < (*this)[b](axis); });
    build(begin, middle, (axis + 1) % 3);
    build(middle + 1, end, (axis + 1) % 3);
  }

  template <typename Visit>
  void search(std::size_t begin, std::size_t end, int axis, const Point3& lower, const Point3& upper,
              const Visit& visit) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const int index = order_[middle];
    const Point3& point = (*this)[index];
    if ((point.array() >= lower.array()).all() && (point.array() <= upper.array()).all()) visit(index);
    const int next = (axis + 1) % 3;
    if (lower(axis) <= point(axis)) search(begin, middle, next, lower, upper, visit);
    if (upper(axis) >= point(axis)) search(middle + 1, end, next, lower, upper, visit);
  }

  std::vector<Point3> points_;
  std::vector<int> order_;
};

}  // namespace isorim::geometry
