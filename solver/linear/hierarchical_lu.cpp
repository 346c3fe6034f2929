#include "solver/linear/hierarchical_lu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"
#include "solver/linear/hierarchical_arithmetic.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXi;

/// Blocks with fewer rows and columns than this together are not worth a task of their own.
constexpr Index task_size = 512;
/// Of a leaf's largest entry: pivots below are taken for zero. Those of a null space are as large as the errors of the
/// matrix and of its factors; divided by them vectors would lose as many digits.
constexpr double smallest_pivot = 1e-5;

/// Gaussian elimination with row exchanges, in place; the number of pivots that were replaced by `scale`.
int eliminate(MatrixXd& matrix, double scale, VectorXi& exchanges) {
  const Index size = matrix.rows();
  exchanges.resize(size);
  int replaced = 0;
  for (Index k = 0; k < size; ++k) {
    Index pivot = 0;
    matrix.col(k).tail(size - k).cwiseAbs().maxCoeff(&pivot);
    pivot += k;
    exchanges[k] = static_cast<int>(pivot);
    matrix.row(k).swap(matrix.row(pivot));
    if (std::abs(matrix(k, k)) <= smallest_pivot * scale) {
      matrix(k, k) = scale > 0.0 ? scale : 1.0;
      ++replaced;
    }
    const Index rest = size - k - 1;
    matrix.col(k).tail(rest) /= matrix(k, k);
    matrix.bottomRightCorner(rest, rest).noalias() -= matrix.col(k).tail(rest) * matrix.row(k).tail(rest);
  }
  return replaced;
}

/// Triangular solves with the factors of a diagonal block, x dense and in the tree's order.
class Solver {
 public:
  Solver(const HierarchicalMatrix& factors, const std::vector<VectorXi>& exchanges)
      : factors_(factors), tree_(factors.tree()), exchanges_(exchanges) {}

  /// x <- L^-1 P x.
  void lower(int diagonal, Eigen::Ref<MatrixXd> x) const {
    const Block& block = tree_.block(diagonal);
    if (block.kind == BlockKind::dense) {
      const VectorXi& exchanges = exchanges_[static_cast<std::size_t>(diagonal)];
      for (Index k = 0; k < exchanges.size(); ++k)
        if (exchanges[k] != k) x.row(k).swap(x.row(exchanges[k]));
      factors_.leaf(diagonal).dense.triangularView<Eigen::UnitLower>().solveInPlace(x);
      return;
    }
    const auto [first, second] = halves(block, x);
    lower(block.children[0][0], first);
    add_block_product(factors_, block.children[1][0], -1.0, first, second);
    lower(block.children[1][1], second);
  }

  /// x <- U^-1 x.
  void upper(int diagonal, Eigen::Ref<MatrixXd> x) const {
    const Block& block = tree_.block(diagonal);
    if (block.kind == BlockKind::dense) {
      factors_.leaf(diagonal).dense.triangularView<Eigen::Upper>().solveInPlace(x);
      return;
    }
    const auto [first, second] = halves(block, x);
    upper(block.children[1][1], second);
    add_block_product(factors_, block.children[0][1], -1.0, second, first);
    upper(block.children[0][0], first);
  }

  /// x <- U^-T x.
  void upper_transposed(int diagonal, Eigen::Ref<MatrixXd> x) const {
    const Block& block = tree_.block(diagonal);
    if (block.kind == BlockKind::dense) {
      factors_.leaf(diagonal).dense.triangularView<Eigen::Upper>().transpose().solveInPlace(x);
      return;
    }
    const auto [first, second] = halves(block, x);
    upper_transposed(block.children[0][0], first);
    add_transposed_block_product(factors_, block.children[0][1], -1.0, first, second);
    upper_transposed(block.children[1][1], second);
  }

 private:
  using Half = Eigen::Ref<MatrixXd>;
  std::pair<Half, Half> halves(const Block& block, Eigen::Ref<MatrixXd> x) const {
    const Index rows = tree_.row_count(tree_.block(block.children[0][0]));
    return {x.topRows(rows), x.bottomRows(x.rows() - rows)};
  }

  const HierarchicalMatrix& factors_;
  const BlockTree& tree_;
  const std::vector<VectorXi>& exchanges_;
};

/// The recursion over the blocks; every block first receives what the blocks before it have left for it.
class Factorisation {
 public:
  Factorisation(HierarchicalMatrix& factors, std::vector<VectorXi>& exchanges, double tolerance)
      : factors_(factors),
        tree_(factors.tree()),
        exchanges_(exchanges),
        tolerance_(tolerance),
        solver_(factors, exchanges),
        replaced_(exchanges.size(), 0) {}

  int run() {
    factorise(0, PendingUpdate(factors_.rows(), factors_.cols(), tolerance_));
    int sum = 0;
    for (const int replaced : replaced_) sum += replaced;
    return sum;
  }

 private:
  using Parts = std::array<std::array<PendingUpdate, 2>, 2>;
  using Tasks = std::vector<std::function<void()>>;

  void run_together(const Block& block, const Tasks& tasks) const {
    if (tree_.row_count(block) + tree_.column_count(block) >= task_size)
      quadrature::together(tasks);
    else
      for (const auto& task : tasks) task();
  }

  /// The updates of the children; of those that are not there, empty.
  Parts parts(const Block& block, const PendingUpdate& update) const {
    Parts result{{{PendingUpdate(0, 0, tolerance_), PendingUpdate(0, 0, tolerance_)},
                  {PendingUpdate(0, 0, tolerance_), PendingUpdate(0, 0, tolerance_)}}};
    Tasks tasks;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
        if (block.children[i][j] >= 0)
          tasks.emplace_back([&, i, j] { result[i][j] = update.part(tree_, block, i, j); });
    run_together(block, tasks);
    return result;
  }

  void factorise(int number, const PendingUpdate& update) {
    const Block& block = tree_.block(number);
    if (block.kind != BlockKind::subdivided) {
      MatrixXd& matrix = factors_.leaf(number).dense;
      const double scale = matrix.cwiseAbs().maxCoeff();
      update.apply_to(factors_.leaf(number), -1.0);
      if (!matrix.allFinite())
        throw NumericalError(fmt::format("the factorisation is not finite in rows {} to {} of the tree's order",
                                         tree_.first_row(block), tree_.first_row(block) + matrix.rows() - 1));
      const std::size_t slot = static_cast<std::size_t>(number);
      replaced_[slot] = eliminate(matrix, scale, exchanges_[slot]);
      return;
    }
    Parts pending = parts(block, update);
    const auto& child = block.children;
    factorise(child[0][0], pending[0][0]);
    run_together(block, {[&] { solve_lower(child[0][0], child[0][1], pending[0][1]); },
                         [&] { solve_upper(child[0][0], child[1][0], pending[1][0]); }});
    pending[1][1].add(factors_, child[1][0], factors_, child[0][1]);
    factorise(child[1][1], pending[1][1]);
  }

  /// The block becomes L^-1 P times itself, L that of a diagonal block over the same rows.
  void solve_lower(int diagonal, int number, const PendingUpdate& update) {
    const Block& block = tree_.block(number);
    if (block.kind != BlockKind::subdivided) {
      HierarchicalMatrix::Leaf& leaf = factors_.leaf(number);
      update.apply_to(leaf, -1.0);
      solver_.lower(diagonal, leaf.is_dense() ? leaf.dense : leaf.low_rank.u);
      return;
    }
    Parts pending = parts(block, update);
    const Block& triangle = tree_.block(diagonal);
    const bool split = triangle.kind == BlockKind::subdivided;
    Tasks tasks;
    for (std::size_t j = 0; j < 2; ++j) {
      if (block.children[0][j] < 0) continue;
      tasks.emplace_back([&, j] {
        const int top = block.children[0][j];
        solve_lower(split ? triangle.children[0][0] : diagonal, top, pending[0][j]);
        if (!split) return;
        pending[1][j].add(factors_, triangle.children[1][0], factors_, top);
        solve_lower(triangle.children[1][1], block.children[1][j], pending[1][j]);
      });
    }
    run_together(block, tasks);
  }

  /// The block becomes itself times U^-1, U that of a diagonal block over the same columns.
  void solve_upper(int diagonal, int number, const PendingUpdate& update) {
    const Block& block = tree_.block(number);
    if (block.kind != BlockKind::subdivided) {
      HierarchicalMatrix::Leaf& leaf = factors_.leaf(number);
      update.apply_to(leaf, -1.0);
      if (leaf.is_dense()) {
        MatrixXd transposed = leaf.dense.transpose();
        solver_.upper_transposed(diagonal, transposed);
        leaf.dense = transposed.transpose();
      } else {
        solver_.upper_transposed(diagonal, leaf.low_rank.v);
      }
      return;
    }
    Parts pending = parts(block, update);
    const Block& triangle = tree_.block(diagonal);
    const bool split = triangle.kind == BlockKind::subdivided;
    Tasks tasks;
    for (std::size_t i = 0; i < 2; ++i) {
      if (block.children[i][0] < 0) continue;
      tasks.emplace_back([&, i] {
        const int left = block.children[i][0];
        solve_upper(split ? triangle.children[0][0] : diagonal, left, pending[i][0]);
        if (!split) return;
        pending[i][1].add(factors_, left, factors_, triangle.children[0][1]);
        solve_upper(triangle.children[1][1], block.children[i][1], pending[i][1]);
      });
    }
    run_together(block, tasks);
  }

  HierarchicalMatrix& factors_;
  const BlockTree& tree_;
  std::vector<VectorXi>& exchanges_;
  double tolerance_;
  Solver solver_;
  /// By block.
  std::vector<int> replaced_;
};

/// A copy with blocks of low rank truncated to the tolerance.
HierarchicalMatrix truncated(const HierarchicalMatrix& matrix, const FactorisationOptions& options) {
  if (!matrix.tree().is_square())
    throw InputError("a matrix can be factorised only if one tree divides its rows and its columns");
  HierarchicalMatrix copy(matrix.shared_tree(), options.threads);
  const Accuracy accuracy{options.tolerance, 0.0};
  quadrature::parallel_for(matrix.tree().blocks().size(), options.threads, [&](std::size_t task, int) {
    const int number = static_cast<int>(task);
    const HierarchicalMatrix::Leaf& from = matrix.leaf(number);
    const BlockKind kind = matrix.tree().block(number).kind;
    if (kind == BlockKind::dense)
      copy.leaf(number).dense = from.dense;
    else if (kind == BlockKind::low_rank)
      copy.leaf(number).low_rank = from.is_dense() ? compress(from.dense, accuracy) : truncate(from.low_rank, accuracy);
  });
  return copy;
}

}  // namespace

HierarchicalLu::HierarchicalLu(const HierarchicalMatrix& matrix, const FactorisationOptions& options)
    : factors_(truncated(matrix, options)), exchanges_(matrix.tree().blocks().size()) {
  quadrature::with_team(options.threads,
                        [&] { replaced_pivots_ = Factorisation(factors_, exchanges_, options.tolerance).run(); });
}

void HierarchicalLu::add_product(const Eigen::Ref<const VectorXd>& x, Eigen::Ref<VectorXd> result) const {
  const ClusterTree& clusters = factors_.tree().rows();
  MatrixXd ordered = clusters.to_tree_order(x);
  const Solver solver(factors_, exchanges_);
  solver.lower(0, ordered);
  solver.upper(0, ordered);
  result += clusters.from_tree_order(ordered.col(0));
}

}  // namespace isorim::solver
