#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "solver/linear/hierarchical_matrix.h"
#include "solver/linear/low_rank.h"

/// Sums and products of hierarchical matrices, each result truncated to an accuracy relative to its own norm. Trees of
/// the operands must be one and the same where their clusters meet.
namespace isorim::solver {

/// a += factor b, over one and the same block tree. Throws InputError otherwise.
void add(HierarchicalMatrix& a, double factor, const HierarchicalMatrix& b, double tolerance);

/// matrix += u v^T, rows in the caller's order.
void add(HierarchicalMatrix& matrix, const LowRank& update, double tolerance);

/// c += factor a b. Throws InputError for trees that do not fit.
void add_product(HierarchicalMatrix& c, double factor, const HierarchicalMatrix& a, const HierarchicalMatrix& b,
                 double tolerance, int threads = 0);

/// result += factor M_b x or factor M_b^T x for one block of the matrix; rows in the tree's order.
void add_block_product(const HierarchicalMatrix& matrix, int block, double factor,
                       const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> result);
void add_transposed_block_product(const HierarchicalMatrix& matrix, int block, double factor,
                                  const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> result);

/// What has yet to be added to a block: u v^T and products of blocks. Products are carried down the block tree and
/// become numbers only where an operand or the block itself is a leaf, so that each block is truncated a few times, not
/// once for every product (accumulators: Börm & Christophersen, arXiv:1703.09085). What is for a dense leaf is not
/// truncated at all.
class PendingUpdate {
 public:
  /// For a block of so many scalar rows and columns; `accuracy` of each truncation, relative.
  PendingUpdate(Eigen::Index rows, Eigen::Index columns, double tolerance);

  /// Adds the product of block a of one matrix and block b of another.
  void add(const HierarchicalMatrix& left, int a, const HierarchicalMatrix& right, int b);

  /// The parts that concern child (i, j) of a block of the tree.
  PendingUpdate part(const BlockTree& tree, const Block& block, std::size_t i, std::size_t j) const;

  /// Adds `factor` times everything to a leaf.
  void apply_to(HierarchicalMatrix::Leaf& leaf, double factor) const;

 private:
  struct Product {
    const HierarchicalMatrix* left;
    int a;
    const HierarchicalMatrix* right;
    int b;
  };
  void append(const LowRank& term);
  LowRank collected() const;
  LowRank leaf_product(const Product& product) const;

  Eigen::Index rows_;
  Eigen::Index columns_;
  double tolerance_;
  LowRank sum_;
  /// Rank of the sum after it was last truncated.
  Eigen::Index settled_ = 0;
  /// The block is a dense leaf: all products wait until they are added to its entries.
  bool for_dense_leaf_ = false;
  /// Both operands subdivided, or the block a dense leaf.
  std::vector<Product> products_;
};

}  // namespace isorim::solver
