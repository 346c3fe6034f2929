#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/contour_measures.h"
#include "geometry/fitting/contour_ordering.h"

namespace isorim::geometry {
namespace {

enum class CellState { free, chosen, passed_over };

/// The walk over the cells.
class DensityWalk {
 public:
  DensityWalk(const ReducedPoints& cells, int reach)
      : cells_(cells), reach_(reach), states_(cells.counts.size(), CellState::free) {
    for (std::size_t i = 0; i < cells.cells.size(); ++i) {
      index_of_[{cells.cells[i].y(), cells.cells[i].x()}] = static_cast<int>(i);
    }
  }

  /// Indices of the chosen cells in order; whether the walk came back is `closed()`.
  std::vector<int> run() {
    const auto densest = std::ranges::max_element(cells_.counts);
    std::vector<int> path{static_cast<int>(densest - cells_.counts.begin())};
    states_[static_cast<std::size_t>(path.front())] = CellState::chosen;
    while (true) {
      const int reference = path.back();
      const std::vector<int> around = neighbourhood(reference);
      const int next = best_of(around, reference);
      for (const int i : around) {
        CellState& state = states_[static_cast<std::size_t>(i)];
        if (state == CellState::free) state = CellState::passed_over;
      }
      if (next < 0) {
        closed_ = path.size() > 3 && cells_apart(reference, path.front()) <= 2 * reach_;
        break;
      }
      states_[static_cast<std::size_t>(next)] = CellState::chosen;
      path.push_back(next);
    }
    return path;
  }

  bool closed() const { return closed_; }
  CellState state(std::size_t i) const { return states_[i]; }

 private:
  std::vector<int> neighbourhood(int reference) const {
    const Eigen::Vector2i centre = cells_.cells[static_cast<std::size_t>(reference)];
    std::vector<int> around;
    for (int row = centre.y() - reach_; row <= centre.y() + reach_; ++row) {
      const auto end = index_of_.upper_bound({row, centre.x() + reach_});
      for (auto it = index_of_.lower_bound({row, centre.x() - reach_}); it != end; ++it) {
        if (it->second != reference) around.push_back(it->second);
      }
    }
    return around;
  }

  int cells_apart(int a, int b) const {
    return (cells_.cells[static_cast<std::size_t>(a)] - cells_.cells[static_cast<std::size_t>(b)])
        .cwiseAbs()
        .maxCoeff();
  }

  int best_of(const std::vector<int>& around, int reference) const {
    int best = -1;
    double largest = -1.0;
    for (const int i : around) {
      if (states_[static_cast<std::size_t>(i)] != CellState::free) continue;
      const double product =
          cells_.counts[static_cast<std::size_t>(i)] * (cells_.points.col(i) - cells_.points.col(reference)).norm();
      if (product > largest) {
        largest = product;
        best = i;
      }
    }
    return best;
  }

  const ReducedPoints& cells_;
  int reach_;
  std::vector<CellState> states_;
  /// By row and column.
  std::map<std::pair<int, int>, int> index_of_;
  bool closed_ = false;
};

}  // namespace

OrderedContours order_by_density(const ReducedPoints& cells, const DensityWalkOptions& options) {
  if (options.reach < 1) {
    throw GeometryError(fmt::format("ordering: the reach is {} cells, it must be at least 1", options.reach));
  }
  if (cells.counts.empty()) throw GeometryError("ordering: there are no points");
  DensityWalk walk(cells, options.reach);
  const std::vector<int> path = walk.run();
  OrderedContours result;
  Contour contour;
  contour.closed = walk.closed();
  contour.points.resize(2, static_cast<Eigen::Index>(path.size()));
  for (std::size_t k = 0; k < path.size(); ++k) {
    contour.points.col(static_cast<Eigen::Index>(k)) = cells.points.col(path[k]);
    contour.weights.push_back(cells.counts[static_cast<std::size_t>(path[k])]);
  }
  finish(contour);
  result.contours.push_back(std::move(contour));
  for (std::size_t i = 0; i < cells.counts.size(); ++i) {
    if (walk.state(i) == CellState::chosen) continue;
    const DropReason reason =
        walk.state(i) == CellState::passed_over ? DropReason::passed_over : DropReason::not_reached;
    result.dropped.push_back({static_cast<int>(i), reason});
  }
  return result;
}

}  // namespace isorim::geometry
