#include "solver/bem/hierarchical_space.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/bezier/subdivision.h"
#include "geometry/errors.h"
#include "quadrature/gauss_legendre.h"
#include "solver/bem/point_selection.h"

namespace isorim::solver {

using geometry::BezierElement;
using geometry::Interval;
using geometry::Point;

template <int Dim>
GridCell<Dim> parent(const GridCell<Dim>& cell) {
  GridCell<Dim> result = cell;
  --result.level;
  for (std::int64_t& index : result.index) index /= 2;
  return result;
}

template <int Dim>
CellTree<Dim>::CellTree(std::array<int, Dim - 1> counts, std::vector<GridCell<Dim>> bisected)
    : counts_(counts), bisected_(std::move(bisected)) {
  std::ranges::sort(bisected_);
  bisected_.erase(std::unique(bisected_.begin(), bisected_.end()), bisected_.end());
  for (const GridCell<Dim>& cell : bisected_) {
    if (!is_inside(cell) || !exists(cell))
      throw InputError(fmt::format("local refinement: there is no cell ({}) of level {} to bisect",
                                   fmt::join(cell.index, ", "), cell.level));
    levels_ = std::max(levels_, cell.level + 2);
  }
}

template <int Dim>
bool CellTree<Dim>::is_bisected(const GridCell<Dim>& cell) const {
  return std::ranges::binary_search(bisected_, cell);
}

template <int Dim>
bool CellTree<Dim>::exists(const GridCell<Dim>& cell) const {
  return cell.level == 0 || is_bisected(parent(cell));
}

template <int Dim>
bool CellTree<Dim>::is_inside(const GridCell<Dim>& cell) const {
  for (std::size_t d = 0; d + 1 < Dim; ++d)
    if (cell.index[d] < 0 || cell.index[d] >= std::int64_t{counts_[d]} << cell.level) return false;
  return cell.level >= 0;
}

namespace {

template <int Dim>
std::vector<GridCell<Dim>> children(const GridCell<Dim>& cell) {
  std::vector<GridCell<Dim>> result;
  for (int k = 0; k < 1 << (Dim - 1); ++k) {
    GridCell<Dim> child = cell;
    ++child.level;
    for (std::size_t d = 0; d + 1 < Dim; ++d) child.index[d] = 2 * cell.index[d] + ((k >> d) & 1);
    result.push_back(child);
  }
  return result;
}

template <int Dim>
void add_leaves(const CellTree<Dim>& tree, const GridCell<Dim>& cell, std::vector<GridCell<Dim>>& leaves) {
  if (!tree.is_bisected(cell)) {
    leaves.push_back(cell);
    return;
  }
  for (const GridCell<Dim>& child : children(cell)) add_leaves(tree, child, leaves);
}

/// Cells of one level within `radius` of a cell, in all directions.
template <int Dim>
std::vector<GridCell<Dim>> neighbours(const GridCell<Dim>& cell, int radius) {
  std::vector<GridCell<Dim>> result{cell};
  for (std::size_t d = 0; d + 1 < Dim; ++d) {
    std::vector<GridCell<Dim>> wider;
    for (GridCell<Dim> from : result)
      for (int step = -radius; step <= radius; ++step) {
        GridCell<Dim> to = from;
        to.index[d] += step;
        wider.push_back(to);
      }
    result = std::move(wider);
  }
  return result;
}

}  // namespace

template <int Dim>
std::vector<GridCell<Dim>> CellTree<Dim>::leaves() const {
  std::vector<GridCell<Dim>> result;
  int count = 1;
  for (const int n : counts_) count *= n;
  for (int i = 0; i < count; ++i) {
    GridCell<Dim> cell;
    cell.index[0] = i % counts_[0];
    if constexpr (Dim == 3) cell.index[1] = i / counts_[0];
    add_leaves(*this, cell, result);
  }
  return result;
}

template <int Dim>
std::vector<GridCell<Dim>> graded(const CellTree<Dim>& tree, std::span<const GridCell<Dim>> marked, int radius) {
  std::set<GridCell<Dim>> bisected(tree.bisected().begin(), tree.bisected().end());
  std::vector<GridCell<Dim>> open(marked.begin(), marked.end());
  while (!open.empty()) {
    const GridCell<Dim> cell = open.back();
    open.pop_back();
    if (!bisected.insert(cell).second || cell.level == 0) continue;
    for (const GridCell<Dim>& near : neighbours(cell, radius))
      if (tree.is_inside(near)) open.push_back(parent(near));
  }
  return {bisected.begin(), bisected.end()};
}

namespace {

template <int Dim>
class HierarchyBuilder {
 public:
  HierarchyBuilder(const CellTree<Dim>& tree, std::span<const TensorSpace<Dim>> levels,
                   std::span<const BezierElement<Dim>> elements)
      : tree_(tree), levels_(levels), elements_(elements), leaves_(tree.leaves()) {}

  PatchSpace<Dim> build() {
    find_supports();
    for (std::size_t e = 0; e < leaves_.size(); ++e) append_leaf(e);
    place_points();
    return std::move(result_);
  }

 private:
  /// How far the supports of a function of a level are covered by cells of its level and by bisected ones.
  struct Support {
    bool exists = true;
    bool is_bisected = true;
    bool touches_bisected = false;

    bool is_active() const { return exists && !is_bisected; }
  };

  std::size_t cell_index(const GridCell<Dim>& cell) const {
    std::size_t index = static_cast<std::size_t>(cell.index[0]);
    if constexpr (Dim == 3)
      index += static_cast<std::size_t>(cell.index[1]) *
               levels_[static_cast<std::size_t>(cell.level)].lines[0].elements.size();
    return index;
  }
  void find_supports();
  Eigen::MatrixXd refinement(const CellFunctions& coarse, const CellFunctions& fine, const GridCell<Dim>& child) const;
  void append_leaf(std::size_t e);
  void place_points();
  std::int32_t number(int level, std::int32_t function) {
    return numbers_.try_emplace({level, function}, static_cast<std::int32_t>(numbers_.size())).first->second;
  }

  const CellTree<Dim>& tree_;
  std::span<const TensorSpace<Dim>> levels_;
  std::span<const BezierElement<Dim>> elements_;
  std::vector<GridCell<Dim>> leaves_;
  /// For each level and function.
  std::vector<std::vector<Support>> supports_;
  /// Of active functions by level and number there.
  std::map<std::pair<int, std::int32_t>, std::int32_t> numbers_;
  PatchSpace<Dim> result_;
};

template <int Dim>
void HierarchyBuilder<Dim>::find_supports() {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const TensorSpace<Dim>& space = levels_[l];
    std::vector<Support> supports(space.representative.size());
    const std::size_t columns = space.lines[0].elements.size();
    std::size_t count = columns;
    if constexpr (Dim == 3) count *= space.lines[1].elements.size();
    for (std::size_t i = 0; i < count; ++i) {
      GridCell<Dim> cell;
      cell.level = static_cast<int>(l);
      cell.index[0] = static_cast<std::int64_t>(i % columns);
      if constexpr (Dim == 3) cell.index[1] = static_cast<std::int64_t>(i / columns);
      const bool exists = tree_.exists(cell);
      const bool bisected = exists && tree_.is_bisected(cell);
      for (const std::int32_t f : functions_on<Dim>(space, i)) {
        Support& support = supports[static_cast<std::size_t>(f)];
        support.exists = support.exists && exists;
        support.is_bisected = support.is_bisected && bisected;
        support.touches_bisected = support.touches_bisected || bisected;
      }
    }
    supports_.push_back(std::move(supports));
  }
}

/// The coarse functions on the child by the fine ones there: coarse x fine.
template <int Dim>
Eigen::MatrixXd HierarchyBuilder<Dim>::refinement(const CellFunctions& coarse, const CellFunctions& fine,
                                                  const GridCell<Dim>& child) const {
  Eigen::MatrixXd rows = coarse.rows;
  std::array<int, Dim - 1> degrees;
  for (std::size_t d = 0; d + 1 < Dim; ++d) degrees[d] = levels_[0].lines[d].knots.degree();
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    for (std::size_t d = 0; d + 1 < Dim; ++d) {
      const double half = 0.5 * static_cast<double>(child.index[d] % 2);
      geometry::restrict_net({rows.col(k).data(), static_cast<std::size_t>(rows.rows())}, 1, degrees,
                             static_cast<int>(d), Interval{half, half + 0.5});
    }
  return fine.rows.colPivHouseholderQr().solve(rows).transpose();
}

template <int Dim>
void HierarchyBuilder<Dim>::append_leaf(std::size_t e) {
  std::vector<GridCell<Dim>> path{leaves_[e]};
  while (path.back().level > 0) path.push_back(parent(path.back()));
  std::ranges::reverse(path);
  std::vector<std::int32_t> functions;
  Eigen::MatrixXd shares;
  CellFunctions here;
  for (const GridCell<Dim>& cell : path) {
    const std::size_t l = static_cast<std::size_t>(cell.level);
    CellFunctions next = cell_functions<Dim>(levels_[l], cell_index(cell), elements_[e].polynomial);
    const Eigen::Index count = static_cast<Eigen::Index>(next.functions.size());
    Eigen::MatrixXd fine = l == 0 ? Eigen::MatrixXd(0, count) : Eigen::MatrixXd(shares * refinement(here, next, cell));
    std::vector<Eigen::Index> added;
    for (Eigen::Index k = 0; k < count; ++k) {
      const Support& support = supports_[l][static_cast<std::size_t>(next.functions[static_cast<std::size_t>(k)])];
      if (support.exists) fine.col(k).setZero();
      if (support.is_active()) added.push_back(k);
    }
    shares = Eigen::MatrixXd::Zero(fine.rows() + static_cast<Eigen::Index>(added.size()), count);
    shares.topRows(fine.rows()) = fine;
    for (std::size_t i = 0; i < added.size(); ++i) {
      shares(fine.rows() + static_cast<Eigen::Index>(i), added[i]) = 1.0;
      functions.push_back(number(cell.level, next.functions[static_cast<std::size_t>(added[i])]));
    }
    here = std::move(next);
  }
  FieldElement<Dim>& field = result_.elements.emplace_back();
  for (std::size_t d = 0; d + 1 < Dim; ++d)
    field.degree[d] = static_cast<std::int8_t>(levels_[0].lines[d].knots.degree());
  field.rational = levels_[0].weights.size() > 0 && !elements_[e].polynomial;
  field.first = result_.functions.size();
  field.row = result_.rows.size();
  for (std::size_t k = 0; k < functions.size(); ++k) {
    const auto share = shares.row(static_cast<Eigen::Index>(k));
    // Truncated altogether, but for rounding.
    if (share.cwiseAbs().maxCoeff() < 1e-13) continue;
    const Eigen::VectorXd row = here.rows * share.transpose();
    result_.functions.push_back(functions[k]);
    result_.rows.insert(result_.rows.end(), row.data(), row.data() + row.size());
  }
  field.count = static_cast<int>(result_.functions.size() - field.first);
}

template <int Dim>
void HierarchyBuilder<Dim>::place_points() {
  std::map<GridCell<Dim>, int> leaf_at;
  for (std::size_t e = 0; e < leaves_.size(); ++e) leaf_at[leaves_[e]] = static_cast<int>(e);
  result_.points.resize(numbers_.size());
  std::vector<char> has_point(numbers_.size(), 0);
  for (const auto& [key, number] : numbers_) {
    const auto& [level, function] = key;
    const TensorSpace<Dim>& space = levels_[static_cast<std::size_t>(level)];
    if (supports_[static_cast<std::size_t>(level)][static_cast<std::size_t>(function)].touches_bisected) continue;
    const auto place = collocation_place<Dim>(space, function);
    const int columns = static_cast<int>(space.lines[0].elements.size());
    GridCell<Dim> cell;
    cell.level = level;
    cell.index[0] = place.element % columns;
    if constexpr (Dim == 3) cell.index[1] = place.element / columns;
    const auto leaf = leaf_at.find(cell);
    if (leaf == leaf_at.end()) continue;
    result_.points[static_cast<std::size_t>(number)] = {leaf->second, place.place};
    has_point[static_cast<std::size_t>(number)] = 1;
  }
  require_points<Dim>(result_, std::move(has_point), [this](int e) {
    const auto& degree = result_.elements[static_cast<std::size_t>(e)].degree;
    std::vector<Point<Dim - 1>> places;
    const std::vector<double>& s = quadrature::gauss_legendre(degree[0] + 2).nodes;
    if constexpr (Dim == 2) {
      for (const double u : s) places.emplace_back(u);
    } else {
      for (const double v : quadrature::gauss_legendre(degree[1] + 2).nodes)
        for (const double u : s) places.emplace_back(u, v);
    }
    return places;
  });
}

}  // namespace

template <int Dim>
PatchSpace<Dim> hierarchical_space(const CellTree<Dim>& tree, std::span<const TensorSpace<Dim>> levels,
                                   std::span<const BezierElement<Dim>> elements) {
  return HierarchyBuilder<Dim>(tree, levels, elements).build();
}

template GridCell<2> parent(const GridCell<2>&);
template GridCell<3> parent(const GridCell<3>&);
template class CellTree<2>;
template class CellTree<3>;
template std::vector<GridCell<2>> graded(const CellTree<2>&, std::span<const GridCell<2>>, int);
template std::vector<GridCell<3>> graded(const CellTree<3>&, std::span<const GridCell<3>>, int);
template PatchSpace<3> hierarchical_space(const CellTree<3>&, std::span<const TensorSpace<3>>,
                                          std::span<const BezierElement<3>>);

}  // namespace isorim::solver
