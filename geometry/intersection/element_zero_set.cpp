#include "geometry/intersection/element_zero_set.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/zero_arcs.h"
#include "geometry/topology/point_clusters.h"

namespace isorim::geometry {
namespace {

/// Ends of arcs that lie within this distance, in the unit square, are the same.
constexpr double vertex_tolerance = 1e-9;

bool is_on_side(const Point2& point) {
  return point.minCoeff() == 0.0 || point.maxCoeff() == 1.0;
}

/// Arcs joined end to start through ordinary vertices.
class ArcChainer {
 public:
  explicit ArcChainer(std::vector<ZeroArc> arcs) : vertices_(vertex_tolerance) {
    for (ZeroArc& arc : arcs) {
      const int from = vertices_.add(arc.points.front());
      const int to = vertices_.add(arc.points.back());
      // What leaves a cell by less than the tolerance is no arc.
      if (from == to && arc_length(arc) < 10.0 * vertex_tolerance) continue;
      arcs_.push_back({std::move(arc), from, to, false});
    }
    const auto count = static_cast<std::size_t>(vertices_.size());
    leaving_.resize(count);
    entering_.resize(count);
    is_singular_.resize(count);
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      leaving_[static_cast<std::size_t>(arcs_[i].from)].push_back(i);
      ++entering_[static_cast<std::size_t>(arcs_[i].to)];
      if (arcs_[i].arc.singular_start) is_singular_[static_cast<std::size_t>(arcs_[i].from)] = true;
      if (arcs_[i].arc.singular_end) is_singular_[static_cast<std::size_t>(arcs_[i].to)] = true;
    }
  }

  std::vector<ZeroChain> chains() {
    require_balance();
    std::vector<ZeroChain> result;
    for (std::size_t i = 0; i < arcs_.size(); ++i)
      if (!is_ordinary(arcs_[i].from)) result.push_back(follow(i));
    for (std::size_t i = 0; i < arcs_.size(); ++i)
      if (!arcs_[i].used) result.push_back(follow(i));
    return result;
  }

 private:
  struct Linked {
    ZeroArc arc;
    int from;
    int to;
    bool used;
  };

  static double arc_length(const ZeroArc& arc) {
    double length = 0.0;
    for (std::size_t i = 1; i < arc.points.size(); ++i) length += (arc.points[i] - arc.points[i - 1]).norm();
    return length;
  }

  bool is_ordinary(int vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return leaving_[v].size() == 1 && entering_[v] == 1 && !is_singular_[v] && !is_on_side(vertices_[vertex]);
  }

  void require_balance() const {
    for (int v = 0; v < vertices_.size(); ++v) {
      const Point2& place = vertices_[v];
      const bool near_side = place.minCoeff() <= vertex_tolerance || place.maxCoeff() >= 1.0 - vertex_tolerance;
      const auto i = static_cast<std::size_t>(v);
      if (near_side || static_cast<int>(leaving_[i].size()) == entering_[i]) continue;
      throw GeometryError(
          fmt::format("the curve of intersection breaks off at ({:.9g}, {:.9g}) of an element", place.x(), place.y()));
    }
  }

  ZeroChain follow(std::size_t first) {
    ZeroChain chain;
    std::size_t i = first;
    chain.points.push_back(arcs_[i].arc.points.front());
    while (true) {
      arcs_[i].used = true;
      chain.points.insert(chain.points.end(), arcs_[i].arc.points.begin() + 1, arcs_[i].arc.points.end());
      if (!is_ordinary(arcs_[i].to)) break;
      const std::size_t next = leaving_[static_cast<std::size_t>(arcs_[i].to)].front();
      if (arcs_[next].used) break;
      i = next;
    }
    if (arcs_[i].to == arcs_[first].from) chain.points.back() = chain.points.front();
    return chain;
  }

  PointClusters<2> vertices_;
  std::vector<Linked> arcs_;
  std::vector<std::vector<std::size_t>> leaving_;
  std::vector<int> entering_;
  std::vector<bool> is_singular_;
};

/// f / u, f / (1 - v), ...: `columns` has v along its rows.
Eigen::MatrixXd divide_first_row(const Eigen::MatrixXd& rows) {
  const Eigen::Index degree = rows.rows() - 1;
  Eigen::MatrixXd quotient(degree, rows.cols());
  for (Eigen::Index i = 0; i < degree; ++i)
    quotient.row(i) = rows.row(i + 1) * static_cast<double>(degree) / static_cast<double>(i + 1);
  return quotient;
}

Eigen::MatrixXd divide_side(const BernsteinGrid& grid, Side side) {
  switch (side) {
    case Side::left:
      return divide_first_row(grid);
    case Side::right:
      return divide_first_row(grid.colwise().reverse()).colwise().reverse();
    case Side::bottom:
      return divide_first_row(grid.transpose()).transpose();
    default:
      return divide_first_row(grid.rowwise().reverse().transpose()).colwise().reverse().transpose();
  }
}

double largest_on(const BernsteinGrid& grid, Side side) {
  switch (side) {
    case Side::left:
      return grid.row(0).cwiseAbs().maxCoeff();
    case Side::right:
      return grid.row(grid.rows() - 1).cwiseAbs().maxCoeff();
    case Side::bottom:
      return grid.col(0).cwiseAbs().maxCoeff();
    default:
      return grid.col(grid.cols() - 1).cwiseAbs().maxCoeff();
  }
}

}  // namespace

ElementFunction divide_out_sides(const BernsteinGrid& grid, double coincidence) {
  ElementFunction function;
  function.whole = function.grid = grid;
  function.coincidence = coincidence;
  function.noise = 1e-15 * grid.cwiseAbs().maxCoeff();
  if (grid.cwiseAbs().maxCoeff() <= coincidence) {
    function.vanishes = true;
    return function;
  }
  bool divided = true;
  while (divided) {
    divided = false;
    for (const Side side : {Side::bottom, Side::right, Side::top, Side::left}) {
      const bool across_v = side == Side::bottom || side == Side::top;
      if ((across_v ? function.grid.cols() : function.grid.rows()) < 2) continue;
      if (largest_on(function.grid, side) > coincidence) continue;
      function.grid = divide_side(function.grid, side);
      ++function.multiplicity[static_cast<std::size_t>(side)];
      divided = true;
    }
  }
  function.magnitude = function.grid.cwiseAbs();
  return function;
}

std::vector<ZeroChain> zero_chains(const ElementFunction& function, SideCharts& charts) {
  if (function.vanishes) return {};
  return ArcChainer(zero_arcs(function, charts)).chains();
}

}  // namespace isorim::geometry
