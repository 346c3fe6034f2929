#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "solver/linear/block_tree.h"
#include "solver/linear/linear_operator.h"
#include "solver/linear/low_rank.h"

namespace isorim::solver {

/// Makes the blocks of a hierarchical matrix. Called from several threads at once, each with its own `thread` in
/// [0, quadrature::thread_count(threads)). Blocks of one kind with the same rows are asked for one after the other by
/// one thread, in the order of the tree; all dense ones come before those of low rank. R and C stand for the components
/// of rows and columns.
class MatrixSource {
 public:
  virtual ~MatrixSource() = default;
  /// Sets the (rows.size() * R) x (columns.size() * C) block: entry (i * R + a, j * C + b) for component a of index
  /// rows[i] and component b of index columns[j].
  virtual void dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns, int thread,
                           Eigen::Ref<Eigen::MatrixXd> block) const = 0;
  /// u v^T within the accuracy of the same block, for clusters far apart; the rank need not be minimal. See
  /// cross_approximation().
  virtual LowRank low_rank_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                                 const Accuracy& accuracy, int thread) const = 0;
};

/// A matrix of dense and low-rank blocks (Hackbusch, Hierarchical Matrices, 2015). Vectors are in the caller's order of
/// indices.
class HierarchicalMatrix final : public LinearOperator {
 public:
  /// What a leaf of the block tree holds, in one of two forms. A leaf of dense kind is dense; one of low-rank kind
  /// too if its factors would take more room.
  struct Leaf {
    Eigen::MatrixXd dense;
    LowRank low_rank;

    bool is_dense() const { return dense.size() > 0; }
    void use_smaller_form();
  };

  struct Statistics {
    std::size_t dense_blocks = 0;
    std::size_t low_rank_blocks = 0;
    /// Bytes.
    std::size_t dense_memory = 0;
    std::size_t low_rank_memory = 0;
    Eigen::Index max_rank = 0;
    double mean_rank = 0.0;
  };

  /// The zero matrix. Products use up to `threads` threads (0: all that OpenMP offers).
  explicit HierarchicalMatrix(std::shared_ptr<const BlockTree> tree, int threads = 0);

  Eigen::Index rows() const override { return tree_->rows().dimension(); }
  Eigen::Index cols() const override { return tree_->columns().dimension(); }
  /// The same bits for any number of threads.
  void add_product(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> result) const override;
  std::size_t memory() const override;

  Statistics statistics() const;
  /// In the Frobenius norm.
  double norm() const;
  /// All entries, in the caller's order; for tests and small matrices.
  Eigen::MatrixXd to_dense() const;

  /// Adds an R x C block of components at a pair of indices. Throws InputError if the pair lies in a block of low rank.
  void add_entries(std::int32_t row, std::int32_t column, const Eigen::Ref<const Eigen::MatrixXd>& entries);
  /// Multiplies every row or column by its factor, in the caller's order.
  void scale_rows(const Eigen::Ref<const Eigen::VectorXd>& factors);
  void scale_columns(const Eigen::Ref<const Eigen::VectorXd>& factors);

  const BlockTree& tree() const { return *tree_; }
  const std::shared_ptr<const BlockTree>& shared_tree() const { return tree_; }
  Leaf& leaf(int block) { return leaves_[static_cast<std::size_t>(block)]; }
  const Leaf& leaf(int block) const { return leaves_[static_cast<std::size_t>(block)]; }
  int threads() const { return threads_; }

 private:
  /// Rows whose results one task sums, and the leaves that reach into them, in order.
  struct Band {
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    std::vector<int> blocks;
  };
  void make_bands();
  void add_leaf_product(const Band& band, int block, const Eigen::VectorXd& x,
                        const Eigen::Ref<const Eigen::VectorXd>& coefficients, Eigen::VectorXd& result) const;

  std::shared_ptr<const BlockTree> tree_;
  std::vector<Leaf> leaves_;
  std::vector<int> leaf_blocks_;
  std::vector<Band> bands_;
  int threads_;
};

struct AssemblyOptions {
  /// |A - A_H| <= tolerance |A| in the Frobenius norm; in (0, 1).
  double tolerance = 1e-6;
  /// 0: all that OpenMP offers.
  int threads = 0;
  /// Of what the caller will add to the dense part: counts as a part of the norm |D| below.
  double norm_to_come = 0.0;
  /// Called with the finished fraction.
  std::function<void(double)> progress{};
};

/// Fills the blocks: dense ones first, then those of low rank, 0.3 of the tolerance for the source's approximation and
/// 0.7 for truncation to the least rank. Each block is held to the tolerance by itself, |A_b - u v^T| <= tolerance
/// |A_b|, but no closer than tolerance |D| sqrt(rows_b columns_b) / (columns sqrt(rows)), D the dense part: so blocks
/// that are zero but for rounding vanish, and the whole keeps to the tolerance in either case. The result does not
/// depend on the number of threads.
HierarchicalMatrix assemble(std::shared_ptr<const BlockTree> tree, const MatrixSource& source,
                            const AssemblyOptions& options);

}  // namespace isorim::solver
