#include "solver/linear/block_tree.h"

#include <algorithm>
#include <utility>

namespace isorim::solver {

namespace {

bool is_admissible(const Cluster& row, const Cluster& column, const BlockTreeOptions& options) {
  const double distance = row.points.distance(column.supports);
  if (distance <= 0.0 || distance < options.separation * column.largest_support) return false;
  return std::min(row.points.diameter(), column.supports.diameter()) <= options.eta * distance;
}

/// What a cluster is split into; itself if it is a leaf.
std::array<int, 2> parts(const ClusterTree& tree, int number) {
  return tree.cluster(number).is_leaf() ? std::array{number, -1} : tree.cluster(number).children;
}

}  // namespace

BlockTree::BlockTree(std::shared_ptr<const ClusterTree> rows, std::shared_ptr<const ClusterTree> columns,
                     const BlockTreeOptions& options)
    : rows_(std::move(rows)), columns_(std::move(columns)) {
  blocks_.push_back({.row = 0, .column = 0});
  for (std::size_t number = 0; number < blocks_.size(); ++number) {
    Block block = blocks_[number];
    const Cluster& row = row_cluster(block);
    const Cluster& column = column_cluster(block);
    if (is_admissible(row, column, options)) {
      block.kind = BlockKind::low_rank;
    } else if (!row.is_leaf() || !column.is_leaf()) {
      block.kind = BlockKind::subdivided;
      for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
          const Block child{.row = parts(*rows_, block.row)[i], .column = parts(*columns_, block.column)[j]};
          if (child.row < 0 || child.column < 0) continue;
          block.children[i][j] = static_cast<int>(blocks_.size());
          blocks_.push_back(child);
        }
      }
    }
    blocks_[number] = block;
  }
}

}  // namespace isorim::solver
