#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "solver/linear/cluster_tree.h"

namespace isorim::solver {

enum class BlockKind : std::uint8_t {
  subdivided,
  /// Kept entry by entry.
  dense,
  /// Far enough apart for few terms to do.
  low_rank,
};

/// The rows of one cluster and the columns of another.
struct Block {
  /// Numbers of the clusters in their trees.
  int row = 0;
  int column = 0;
  BlockKind kind = BlockKind::dense;
  /// children[i][j], positions in BlockTree::blocks(): child i of the row cluster, child j of the column cluster; -1
  /// where there is none. A cluster that is a leaf stands for its own child 0.
  std::array<std::array<int, 2>, 2> children{{{-1, -1}, {-1, -1}}};
};

struct BlockTreeOptions {
  /// A block is of low rank if min(diameter of the rows' points, diameter of the columns' supports) <= eta * distance.
  /// Larger: fewer and larger blocks of higher rank.
  double eta = 2.0;
  /// Nor may the distance be less than this times the largest support among the columns, so that quadrature rules for
  /// far targets serve all blocks of low rank.
  double separation = 0.5;
};

/// The division of a matrix into blocks: both clusters of a block are split (leaves are not) until it is admissible or
/// both are leaves.
class BlockTree {
 public:
  BlockTree(std::shared_ptr<const ClusterTree> rows, std::shared_ptr<const ClusterTree> columns,
            const BlockTreeOptions& options = {});

  const ClusterTree& rows() const { return *rows_; }
  const ClusterTree& columns() const { return *columns_; }
  /// Rows and columns are divided by one and the same tree, as factorisations require.
  bool is_square() const { return rows_ == columns_; }
  /// Parents before children; the root is the first.
  const std::vector<Block>& blocks() const { return blocks_; }
  const Block& block(int number) const { return blocks_[static_cast<std::size_t>(number)]; }
  const Cluster& row_cluster(const Block& block) const { return rows_->cluster(block.row); }
  const Cluster& column_cluster(const Block& block) const { return columns_->cluster(block.column); }
  /// Scalar rows and columns of a block.
  Eigen::Index row_count(const Block& block) const { return row_cluster(block).count * rows_->components(); }
  Eigen::Index column_count(const Block& block) const { return column_cluster(block).count * columns_->components(); }
  Eigen::Index first_row(const Block& block) const { return row_cluster(block).first * rows_->components(); }
  Eigen::Index first_column(const Block& block) const { return column_cluster(block).first * columns_->components(); }

 private:
  std::shared_ptr<const ClusterTree> rows_;
  std::shared_ptr<const ClusterTree> columns_;
  std::vector<Block> blocks_;
};

}  // namespace isorim::solver
