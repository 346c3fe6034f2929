#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// Points that count as one if they lie within a tolerance: each cluster is represented by its first point. A hash grid
/// finds clusters in constant time.
template <int Dim>
class PointClusters {
 public:
  explicit PointClusters(double tolerance) : tolerance_(tolerance), cell_(8.0 * tolerance) {}

  /// The index of the cluster that holds `point`, a new one if no representative lies within the tolerance.
  int add(const Point<Dim>& point) {
    const auto [low, high] = cells_around(point);
    int nearest = -1;
    double distance = tolerance_;
    for_each_cell(low, high, [&](const Cell& cell) {
      const auto found = grid_.find(cell);
      if (found == grid_.end()) return;
      for (const int index : found->second) {
        const double d = (points_[static_cast<std::size_t>(index)] - point).norm();
        if (d <= distance) {
          distance = d;
          nearest = index;
        }
      }
    });
    if (nearest >= 0) {
      largest_distance_ = std::max(largest_distance_, distance);
      return nearest;
    }
    const int index = static_cast<int>(points_.size());
    points_.push_back(point);
    Cell home;
    for (int i = 0; i < Dim; ++i) home[static_cast<std::size_t>(i)] = coordinate(point(i));
    grid_[home].push_back(index);
    return index;
  }

  const Point<Dim>& operator[](int index) const { return points_[static_cast<std::size_t>(index)]; }
  int size() const { return static_cast<int>(points_.size()); }
  /// The largest distance of a point from its representative.
  double largest_distance() const { return largest_distance_; }

 private:
  using Cell = std::array<std::int64_t, Dim>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
      for (const std::int64_t i : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(i)) * 0xbf58476d1ce4e5b9ULL;
        hash ^= hash >> 31;
      }
      return static_cast<std::size_t>(hash);
    }
  };

  std::int64_t coordinate(double x) const { return static_cast<std::int64_t>(std::floor(x / cell_)); }

  std::pair<Cell, Cell> cells_around(const Point<Dim>& point) const {
    Cell low, high;
    for (int i = 0; i < Dim; ++i) {
      low[static_cast<std::size_t>(i)] = coordinate(point(i) - tolerance_);
      high[static_cast<std::size_t>(i)] = coordinate(point(i) + tolerance_);
    }
    return {low, high};
  }

  template <typename Visit>
  static void for_each_cell(const Cell& low, const Cell& high, const Visit& visit) {
    Cell cell = low;
    while (true) {
      visit(cell);
      std::size_t i = 0;
      while (i < Dim && cell[i] == high[i]) {
        cell[i] = low[i];
        ++i;
      }
      if (i == Dim) return;
      ++cell[i];
    }
  }

  double tolerance_;
  double cell_;
  double largest_distance_ = 0.0;
  std::vector<Point<Dim>> points_;
  std::unordered_map<Cell, std::vector<int>, Hash> grid_;
};

}  // namespace isorim::geometry
