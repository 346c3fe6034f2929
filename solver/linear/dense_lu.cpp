#include "solver/linear/dense_lu.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "quadrature/parallel.h"
#include "solver/linear/small_products.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Columns that are eliminated before the rest is updated.
constexpr Index panel_width = 64;
/// Below this the elimination goes column by column.
constexpr Index least_width = 8;
/// Columns of a packed panel: 64 x 192 numbers stay in the second-level cache.
constexpr Index pack_width = 192;
/// Rows of a task of the update.
constexpr Index task_rows = 128;

Index padded_size(Index size) {
  return (size + product_lanes - 1) / product_lanes * product_lanes;
}

}  // namespace

DenseLu::DenseLu(const Eigen::Ref<const RowMatrix>& matrix, int threads)
    : size_(matrix.rows()),
      factors_(RowMatrix::Identity(padded_size(size_), padded_size(size_))),
      pivots_(static_cast<std::size_t>(padded_size(size_))),
      norm_(size_ > 0 ? matrix.cwiseAbs().colwise().sum().maxCoeff() : 0.0) {
  factors_.topLeftCorner(size_, size_) = matrix;
  const Index n = factors_.rows();
  for (Index first = 0; first < n && regular_; first += panel_width) {
    const Index width = std::min(panel_width, n - first);
    factorise_panel(first, width);
    update(first, width, first + width, n, threads);
  }
}

void DenseLu::swap_rows(Index a, Index b) {
  if (a != b) factors_.row(a).swap(factors_.row(b));
}

/// Columns [first, first + width), all rows from the diagonal on: recursively, so that here too products do the work.
void DenseLu::factorise_panel(Index first, Index width) {
  if (width <= least_width) {
    factorise_columns(first, width);
    return;
  }
  const Index left = (width / 2 + product_lanes - 1) / product_lanes * product_lanes;
  factorise_panel(first, left);
  update(first, left, first + left, first + width, 1);
  factorise_panel(first + left, width - left);
}

void DenseLu::factorise_columns(Index first, Index width) {
  const Index n = factors_.rows();
  for (Index k = first; k < first + width; ++k) {
    Index pivot = k;
    for (Index i = k + 1; i < n; ++i) {
      if (std::abs(factors_(i, k)) > std::abs(factors_(pivot, k))) pivot = i;
    }
    pivots_[static_cast<std::size_t>(k)] = pivot;
    swap_rows(k, pivot);
    const double diagonal = factors_(k, k);
    if (!(std::abs(diagonal) > 0.0) || !std::isfinite(diagonal)) {
      regular_ = false;
      return;
    }
    const double* upper = &factors_(k, 0);
    for (Index i = k + 1; i < n; ++i) {
      double* row = &factors_(i, 0);
      row[k] /= diagonal;
      for (Index j = k + 1; j < first + width; ++j) row[j] -= row[k] * upper[j];
    }
  }
}

/// U = L^-1 A for the rows of a factorised panel, columns [begin, end).
void DenseLu::solve_upper_rows(Index first, Index width, Index begin, Index end) {
  for (Index i = first + 1; i < first + width; ++i) {
    double* row = &factors_(i, 0);
    for (Index k = first; k < i; ++k) {
      const double* upper = &factors_(k, 0);
      const double factor = row[k];
      for (Index j = begin; j < end; ++j) row[j] -= factor * upper[j];
    }
  }
}

/// Takes the panel [first, first + width) out of columns [begin, end), rows below the panel included.
void DenseLu::update(Index first, Index width, Index begin, Index end, int threads) {
  if (begin >= end || !regular_) return;
  const Index rows_begin = first + width;
  const Index rows = factors_.rows() - rows_begin;
  const auto packs = static_cast<std::size_t>((end - begin + pack_width - 1) / pack_width);
  std::vector<double> packed(static_cast<std::size_t>(width * (end - begin)));
  const auto pack_begin = [&](std::size_t pack) { return begin + static_cast<Index>(pack) * pack_width; };
  const auto pack_columns = [&](std::size_t pack) { return std::min(pack_width, end - pack_begin(pack)); };
  const auto pack_data = [&](std::size_t pack) {
    return packed.data() + width * static_cast<Index>(pack) * pack_width;
  };
  quadrature::parallel_for(packs, threads, [&](std::size_t pack, int) {
    const Index from = pack_begin(pack);
    const Index columns = pack_columns(pack);
    solve_upper_rows(first, width, from, from + columns);
    Eigen::Map<RowMatrix>(pack_data(pack), width, columns) = -factors_.block(first, from, width, columns);
  });
  const auto tasks = static_cast<std::size_t>((rows + task_rows - 1) / task_rows);
  quadrature::parallel_for(tasks, threads, [&](std::size_t task, int) {
    const Index row = rows_begin + static_cast<Index>(task) * task_rows;
    const Index count = std::min(task_rows, factors_.rows() - row);
    for (std::size_t pack = 0; pack < packs; ++pack) {
      const Index columns = pack_columns(pack);
      add_product(static_cast<int>(count), static_cast<int>(columns), static_cast<int>(width),
                  {&factors_(row, first), factors_.cols(), 1}, pack_data(pack), columns,
                  &factors_(row, pack_begin(pack)), factors_.cols());
    }
  });
}

VectorXd DenseLu::solve(const Eigen::Ref<const VectorXd>& right) const {
  VectorXd x = VectorXd::Zero(factors_.rows());
  x.head(size_) = right;
  for (std::size_t k = 0; k < pivots_.size(); ++k) std::swap(x[static_cast<Index>(k)], x[pivots_[k]]);
  factors_.triangularView<Eigen::UnitLower>().solveInPlace(x);
  factors_.triangularView<Eigen::Upper>().solveInPlace(x);
  return x.head(size_);
}

VectorXd DenseLu::solve_transposed(const Eigen::Ref<const VectorXd>& right) const {
  VectorXd x = VectorXd::Zero(factors_.rows());
  x.head(size_) = right;
  factors_.transpose().triangularView<Eigen::Lower>().solveInPlace(x);
  factors_.transpose().triangularView<Eigen::UnitUpper>().solveInPlace(x);
  for (std::size_t k = pivots_.size(); k-- > 0;) std::swap(x[static_cast<Index>(k)], x[pivots_[k]]);
  return x.head(size_);
}

double DenseLu::reciprocal_condition() const {
  if (!regular_ || size_ == 0) return 0.0;
  VectorXd x = VectorXd::Constant(size_, 1.0 / static_cast<double>(size_));
  double inverse_norm = 0.0;
  for (int step = 0; step < 5; ++step) {
    const VectorXd y = solve(x);
    const double norm = y.lpNorm<1>();
    if (!std::isfinite(norm)) return 0.0;
    const VectorXd signs = y.unaryExpr([](double value) { return value < 0.0 ? -1.0 : 1.0; });
    const VectorXd z = solve_transposed(signs);
    Index largest = 0;
    const double slope = z.cwiseAbs().maxCoeff(&largest);
    const bool climbs = norm > inverse_norm;
    inverse_norm = std::max(inverse_norm, norm);
    if (!climbs || slope <= z.dot(x)) break;
    x.setZero();
    x[largest] = 1.0;
  }
  VectorXd alternating(size_);
  for (Index i = 0; i < size_; ++i) {
    const double grown = 1.0 + (size_ > 1 ? static_cast<double>(i) / static_cast<double>(size_ - 1) : 0.0);
    alternating[i] = i % 2 == 0 ? grown : -grown;
  }
  inverse_norm = std::max(inverse_norm, 2.0 * solve(alternating).lpNorm<1>() / (3.0 * static_cast<double>(size_)));
  return inverse_norm > 0.0 && norm_ > 0.0 ? 1.0 / (inverse_norm * norm_) : 0.0;
}

}  // namespace isorim::solver
