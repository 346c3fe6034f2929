#include "solver/linear/hierarchical_matrix.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/parallel.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows of a band at most, if clusters allow: enough to keep a task busy, few enough to give each thread several.
constexpr Index band_rows = 512;
/// Leaves whose coefficients one task computes.
constexpr std::size_t leaves_per_task = 64;

}  // namespace

void HierarchicalMatrix::Leaf::use_smaller_form() {
  const Index rows = low_rank.u.rows();
  const Index columns = low_rank.v.rows();
  if (is_dense() || low_rank.rank() * (rows + columns) < rows * columns) return;
  dense = low_rank.u * low_rank.v.transpose();
  low_rank = {};
}

HierarchicalMatrix::HierarchicalMatrix(std::shared_ptr<const BlockTree> tree, int threads)
    : tree_(std::move(tree)), leaves_(tree_->blocks().size()), threads_(threads) {
  for (int number = 0; number < static_cast<int>(leaves_.size()); ++number) {
    const Block& block = tree_->block(number);
    if (block.kind == BlockKind::subdivided) continue;
    leaf_blocks_.push_back(number);
    const Index rows = tree_->row_count(block);
    const Index columns = tree_->column_count(block);
    if (block.kind == BlockKind::dense)
      leaf(number).dense = MatrixXd::Zero(rows, columns);
    else
      leaf(number).low_rank = {MatrixXd(rows, 0), MatrixXd(columns, 0)};
  }
  make_bands();
}

void HierarchicalMatrix::make_bands() {
  const ClusterTree& clusters = tree_->rows();
  std::vector<int> open{0};
  while (!open.empty()) {
    const Cluster& cluster = clusters.cluster(open.back());
    open.pop_back();
    if (cluster.is_leaf() || cluster.count * clusters.components() <= band_rows)
      bands_.push_back({cluster.first * clusters.components(), cluster.count * clusters.components(), {}});
    else
      open.insert(open.end(), {cluster.children[1], cluster.children[0]});
  }
  // A stack gives the bands in the order of their rows.
  for (const int number : leaf_blocks_) {
    const Block& block = tree_->block(number);
    const Index first = tree_->first_row(block);
    const Index end = first + tree_->row_count(block);
    auto band =
        std::partition_point(bands_.begin(), bands_.end(), [&](const Band& b) { return b.first + b.count <= first; });
    for (; band != bands_.end() && band->first < end; ++band) band->blocks.push_back(number);
  }
}

void HierarchicalMatrix::add_product(const Eigen::Ref<const VectorXd>& x, Eigen::Ref<VectorXd> result) const {
  const VectorXd ordered = tree_->columns().to_tree_order(x);
  // v^T x of every low-rank leaf, one after the other.
  std::vector<Index> offsets(leaves_.size() + 1, 0);
  for (std::size_t k = 0; k < leaves_.size(); ++k) offsets[k + 1] = offsets[k] + leaves_[k].low_rank.rank();
  VectorXd coefficients(offsets.back());
  const std::size_t tasks = (leaf_blocks_.size() + leaves_per_task - 1) / leaves_per_task;
  quadrature::parallel_for(tasks, threads_, [&](std::size_t task, int) {
    const std::size_t end = std::min((task + 1) * leaves_per_task, leaf_blocks_.size());
    for (std::size_t k = task * leaves_per_task; k < end; ++k) {
      const int number = leaf_blocks_[k];
      const Block& block = tree_->block(number);
      const MatrixXd& v = leaf(number).low_rank.v;
      coefficients.segment(offsets[static_cast<std::size_t>(number)], v.cols()).noalias() =
          v.transpose() * ordered.segment(tree_->first_column(block), v.rows());
    }
  });
  VectorXd sums = VectorXd::Zero(rows());
  quadrature::parallel_for(bands_.size(), threads_, [&](std::size_t task, int) {
    for (const int number : bands_[task].blocks) {
      const std::size_t k = static_cast<std::size_t>(number);
      add_leaf_product(bands_[task], number, ordered, coefficients.segment(offsets[k], offsets[k + 1] - offsets[k]),
                       sums);
    }
  });
  result += tree_->rows().from_tree_order(sums);
}

void HierarchicalMatrix::add_leaf_product(const Band& band, int number, const VectorXd& x,
                                          const Eigen::Ref<const VectorXd>& coefficients, VectorXd& result) const {
  const Block& block = tree_->block(number);
  const Index block_first = tree_->first_row(block);
  const Index first = std::max(band.first, block_first);
  const Index count = std::min(band.first + band.count, block_first + tree_->row_count(block)) - first;
  if (leaf(number).is_dense())
    result.segment(first, count).noalias() += leaf(number).dense.middleRows(first - block_first, count) *
                                              x.segment(tree_->first_column(block), tree_->column_count(block));
  else if (coefficients.size() > 0)
    result.segment(first, count).noalias() +=
        leaf(number).low_rank.u.middleRows(first - block_first, count) * coefficients;
}

HierarchicalMatrix::Statistics HierarchicalMatrix::statistics() const {
  Statistics result;
  for (const int number : leaf_blocks_) {
    const Leaf& held = leaf(number);
    if (held.is_dense()) {
      ++result.dense_blocks;
      result.dense_memory += static_cast<std::size_t>(held.dense.size()) * sizeof(double);
    } else {
      ++result.low_rank_blocks;
      result.low_rank_memory += held.low_rank.memory();
      result.max_rank = std::max(result.max_rank, held.low_rank.rank());
      result.mean_rank += static_cast<double>(held.low_rank.rank());
    }
  }
  if (result.low_rank_blocks > 0) result.mean_rank /= static_cast<double>(result.low_rank_blocks);
  return result;
}

std::size_t HierarchicalMatrix::memory() const {
  const Statistics sums = statistics();
  return sums.dense_memory + sums.low_rank_memory + leaves_.size() * (sizeof(Leaf) + sizeof(Block));
}

double HierarchicalMatrix::norm() const {
  double sum = 0.0;
  for (const int number : leaf_blocks_) {
    const Leaf& held = leaf(number);
    const double part = held.is_dense() ? held.dense.norm() : frobenius_norm(held.low_rank);
    sum += part * part;
  }
  return std::sqrt(sum);
}

MatrixXd HierarchicalMatrix::to_dense() const {
  MatrixXd ordered(rows(), cols());
  for (const int number : leaf_blocks_) {
    const Block& block = tree_->block(number);
    const Leaf& held = leaf(number);
    auto part = ordered.block(tree_->first_row(block), tree_->first_column(block), tree_->row_count(block),
                              tree_->column_count(block));
    if (held.is_dense())
      part = held.dense;
    else
      part = held.low_rank.u * held.low_rank.v.transpose();
  }
  for (Index j = 0; j < cols(); ++j) ordered.col(j) = tree_->rows().from_tree_order(ordered.col(j)).eval();
  for (Index i = 0; i < rows(); ++i)
    ordered.row(i) = tree_->columns().from_tree_order(ordered.row(i).transpose()).transpose().eval();
  return ordered;
}

void HierarchicalMatrix::add_entries(std::int32_t row, std::int32_t column, const Eigen::Ref<const MatrixXd>& entries) {
  const Index row_place = tree_->rows().places()[static_cast<std::size_t>(row)];
  const Index column_place = tree_->columns().places()[static_cast<std::size_t>(column)];
  const auto side = [](const ClusterTree& clusters, int number, Index place) {
    const Cluster& cluster = clusters.cluster(number);
    return !cluster.is_leaf() && place >= clusters.cluster(cluster.children[1]).first ? std::size_t{1} : std::size_t{0};
  };
  int number = 0;
  while (tree_->block(number).kind == BlockKind::subdivided) {
    const Block& block = tree_->block(number);
    number =
        block.children[side(tree_->rows(), block.row, row_place)][side(tree_->columns(), block.column, column_place)];
  }
  const Block& block = tree_->block(number);
  if (block.kind == BlockKind::low_rank)
    throw InputError(fmt::format("the entries of indices {} and {} cannot be changed: they lie in a block of low rank",
                                 row, column));
  leaf(number).dense.block(row_place * tree_->rows().components() - tree_->first_row(block),
                           column_place * tree_->columns().components() - tree_->first_column(block), entries.rows(),
                           entries.cols()) += entries;
}

void HierarchicalMatrix::scale_rows(const Eigen::Ref<const VectorXd>& factors) {
  const VectorXd ordered = tree_->rows().to_tree_order(factors);
  for (const int number : leaf_blocks_) {
    const Block& block = tree_->block(number);
    const auto part = ordered.segment(tree_->first_row(block), tree_->row_count(block)).asDiagonal();
    Leaf& held = leaf(number);
    if (held.is_dense())
      held.dense = part * held.dense;
    else
      held.low_rank.u = part * held.low_rank.u;
  }
}

void HierarchicalMatrix::scale_columns(const Eigen::Ref<const VectorXd>& factors) {
  const VectorXd ordered = tree_->columns().to_tree_order(factors);
  for (const int number : leaf_blocks_) {
    const Block& block = tree_->block(number);
    const auto part = ordered.segment(tree_->first_column(block), tree_->column_count(block)).asDiagonal();
    Leaf& held = leaf(number);
    if (held.is_dense())
      held.dense = held.dense * part;
    else
      held.low_rank.v = part * held.low_rank.v;
  }
}

namespace {

/// The leaves of one kind, those with the same rows together in the order of the tree; the largest groups first, so
/// that no thread is left with a large one at the end.
std::vector<std::vector<int>> leaves_by_rows(const BlockTree& tree, BlockKind kind) {
  std::vector<std::vector<int>> of_cluster(tree.rows().clusters().size());
  std::vector<Index> size(of_cluster.size(), 0);
  for (int number = 0; number < static_cast<int>(tree.blocks().size()); ++number) {
    const Block& block = tree.block(number);
    if (block.kind != kind) continue;
    of_cluster[static_cast<std::size_t>(block.row)].push_back(number);
    size[static_cast<std::size_t>(block.row)] += tree.row_count(block) + tree.column_count(block);
  }
  std::vector<std::size_t> order(of_cluster.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
  std::vector<std::vector<int>> groups;
  for (const std::size_t cluster : order)
    if (!of_cluster[cluster].empty()) groups.push_back(std::move(of_cluster[cluster]));
  return groups;
}

/// Tasks of assemble().
struct Filling {
  HierarchicalMatrix& matrix;
  const MatrixSource& source;

  std::span<const std::int32_t> rows(const Block& block) const {
    return matrix.tree().rows().indices(matrix.tree().row_cluster(block));
  }
  std::span<const std::int32_t> columns(const Block& block) const {
    return matrix.tree().columns().indices(matrix.tree().column_cluster(block));
  }

  void dense(int number, int thread) const {
    const Block& block = matrix.tree().block(number);
    MatrixXd& entries = matrix.leaf(number).dense;
    source.dense_block(rows(block), columns(block), thread, entries);
    if (!entries.allFinite())
      throw NumericalError(fmt::format("a block of the matrix is not finite, at indices near {} and {}", rows(block)[0],
                                       columns(block)[0]));
  }

  void low_rank(int number, const Accuracy& accuracy, int thread) const {
    const Block& block = matrix.tree().block(number);
    const Accuracy source_share{0.3 * accuracy.relative, 0.3 * accuracy.absolute};
    const Accuracy truncation_share{0.7 * accuracy.relative, 0.7 * accuracy.absolute};
    HierarchicalMatrix::Leaf& leaf = matrix.leaf(number);
    leaf.low_rank =
        truncate(source.low_rank_block(rows(block), columns(block), source_share, thread), truncation_share);
    leaf.use_smaller_form();
  }
};

}  // namespace

HierarchicalMatrix assemble(std::shared_ptr<const BlockTree> tree, const MatrixSource& source,
                            const AssemblyOptions& options) {
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0))
    throw InputError(
        fmt::format("the tolerance of the compression must lie between 0 and 1, not {}", options.tolerance));
  HierarchicalMatrix matrix(std::move(tree), options.threads);
  const Filling filling{matrix, source};
  const std::vector<std::vector<int>> near = leaves_by_rows(matrix.tree(), BlockKind::dense);
  const std::vector<std::vector<int>> far = leaves_by_rows(matrix.tree(), BlockKind::low_rank);
  const double near_share = static_cast<double>(near.size()) / static_cast<double>(near.size() + far.size());
  const auto part_of_progress = [&](double first, double share) {
    return options.progress ? [&, first, share](double done) { options.progress(first + share * done); }
                            : std::function<void(double)>{};
  };
  quadrature::parallel_for(
      near.size(), options.threads,
      [&](std::size_t task, int thread) {
        for (const int number : near[task]) filling.dense(number, thread);
      },
      part_of_progress(0.0, near_share));
  const double entry_norm = std::hypot(matrix.norm(), options.norm_to_come) /
                            std::sqrt(static_cast<double>(matrix.rows())) / static_cast<double>(matrix.cols());
  const auto fill_far = [&](int number, int thread) {
    const Block& block = matrix.tree().block(number);
    const double entries =
        static_cast<double>(matrix.tree().row_count(block)) * static_cast<double>(matrix.tree().column_count(block));
    filling.low_rank(number, {options.tolerance, options.tolerance * entry_norm * std::sqrt(entries)}, thread);
  };
  quadrature::parallel_for(
      far.size(), options.threads,
      [&](std::size_t task, int thread) {
        for (const int number : far[task]) fill_far(number, thread);
      },
      part_of_progress(near_share, 1.0 - near_share));
  return matrix;
}

}  // namespace isorim::solver
