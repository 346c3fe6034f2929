#include "solver/linear/hierarchical_arithmetic.h"

#include <algorithm>
#include <array>
#include <functional>

#include "geometry/errors.h"
#include "quadrature/parallel.h"
#include "solver/linear/column_products.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Blocks with fewer rows and columns than this together are not worth a task of their own.
constexpr Index task_size = 512;

LowRank concatenated(const LowRank& a, const LowRank& b) {
  LowRank sum{MatrixXd(a.u.rows(), a.rank() + b.rank()), MatrixXd(a.v.rows(), a.rank() + b.rank())};
  sum.u << a.u, b.u;
  sum.v << a.v, b.v;
  return sum;
}

bool is_leaf(const HierarchicalMatrix& matrix, int block) {
  return matrix.tree().block(block).kind != BlockKind::subdivided;
}

/// Calls visit(child, row offset, column offset) for the children of a block.
template <class Visit>
void for_each_child(const BlockTree& tree, const Block& block, const Visit& visit) {
  for (const auto& children : block.children) {
    for (const int child : children) {
      if (child < 0) continue;
      visit(child, tree.first_row(tree.block(child)) - tree.first_row(block),
            tree.first_column(tree.block(child)) - tree.first_column(block));
    }
  }
}

/// result += M_a M_b, dense.
void add_dense_product(const HierarchicalMatrix& left, int a, const HierarchicalMatrix& right, int b,
                       Eigen::Ref<MatrixXd> result) {
  const BlockTree& tree = left.tree();
  if (is_leaf(left, a)) {
    const HierarchicalMatrix::Leaf& leaf = left.leaf(a);
    if (leaf.is_dense()) {
      MatrixXd transposed = MatrixXd::Zero(result.cols(), result.rows());
      add_transposed_block_product(right, b, 1.0, leaf.dense.transpose(), transposed);
      result += transposed.transpose();
    } else if (leaf.low_rank.rank() > 0) {
      MatrixXd transposed = MatrixXd::Zero(result.cols(), leaf.low_rank.rank());
      add_transposed_block_product(right, b, 1.0, leaf.low_rank.v, transposed);
      add_product_with_transposed(1.0, leaf.low_rank.u, transposed, result);
    }
    return;
  }
  if (is_leaf(right, b)) {
    const HierarchicalMatrix::Leaf& leaf = right.leaf(b);
    if (leaf.is_dense()) {
      add_block_product(left, a, 1.0, leaf.dense, result);
    } else if (leaf.low_rank.rank() > 0) {
      MatrixXd columns = MatrixXd::Zero(result.rows(), leaf.low_rank.rank());
      add_block_product(left, a, 1.0, leaf.low_rank.u, columns);
      add_product_with_transposed(1.0, columns, leaf.low_rank.v, result);
    }
    return;
  }
  const Block& block = tree.block(a);
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        const int a_child = block.children[i][k];
        const int b_child = right.tree().block(b).children[k][j];
        if (a_child < 0 || b_child < 0) continue;
        const Block& rows = tree.block(a_child);
        const Block& columns = right.tree().block(b_child);
        add_dense_product(
            left, a_child, right, b_child,
            result.block(tree.first_row(rows) - tree.first_row(block),
                         right.tree().first_column(columns) - right.tree().first_column(right.tree().block(b)),
                         tree.row_count(rows), right.tree().column_count(columns)));
      }
    }
  }
}

}  // namespace

void add_block_product(const HierarchicalMatrix& matrix, int number, double factor, const Eigen::Ref<const MatrixXd>& x,
                       Eigen::Ref<MatrixXd> result) {
  if (is_leaf(matrix, number)) {
    const HierarchicalMatrix::Leaf& leaf = matrix.leaf(number);
    if (leaf.is_dense()) {
      add_product(factor, leaf.dense, x, result);
    } else if (leaf.low_rank.rank() > 0) {
      MatrixXd inner = MatrixXd::Zero(leaf.low_rank.rank(), x.cols());
      add_transposed_product(factor, leaf.low_rank.v, x, inner);
      add_product(1.0, leaf.low_rank.u, inner, result);
    }
    return;
  }
  const BlockTree& tree = matrix.tree();
  for_each_child(tree, tree.block(number), [&](int child, Index row, Index column) {
    add_block_product(matrix, child, factor, x.middleRows(column, tree.column_count(tree.block(child))),
                      result.middleRows(row, tree.row_count(tree.block(child))));
  });
}

void add_transposed_block_product(const HierarchicalMatrix& matrix, int number, double factor,
                                  const Eigen::Ref<const MatrixXd>& x, Eigen::Ref<MatrixXd> result) {
  if (is_leaf(matrix, number)) {
    const HierarchicalMatrix::Leaf& leaf = matrix.leaf(number);
    if (leaf.is_dense()) {
      add_transposed_product(factor, leaf.dense, x, result);
    } else if (leaf.low_rank.rank() > 0) {
      MatrixXd inner = MatrixXd::Zero(leaf.low_rank.rank(), x.cols());
      add_transposed_product(factor, leaf.low_rank.u, x, inner);
      add_product(1.0, leaf.low_rank.v, inner, result);
    }
    return;
  }
  const BlockTree& tree = matrix.tree();
  for_each_child(tree, tree.block(number), [&](int child, Index row, Index column) {
    add_transposed_block_product(matrix, child, factor, x.middleRows(row, tree.row_count(tree.block(child))),
                                 result.middleRows(column, tree.column_count(tree.block(child))));
  });
}

PendingUpdate::PendingUpdate(Index rows, Index columns, double tolerance)
    : rows_(rows), columns_(columns), tolerance_(tolerance), sum_{MatrixXd(rows, 0), MatrixXd(columns, 0)} {}

void PendingUpdate::add(const HierarchicalMatrix& left, int a, const HierarchicalMatrix& right, int b) {
  const Product product{&left, a, &right, b};
  if (!for_dense_leaf_ && (is_leaf(left, a) || is_leaf(right, b)))
    append(leaf_product(product));
  else
    products_.push_back(product);
}

void PendingUpdate::append(const LowRank& term) {
  if (term.rank() == 0) return;
  sum_ = concatenated(sum_, term);
  if (sum_.rank() <= 2 * settled_ + 24) return;
  sum_ = truncate(sum_, {tolerance_, 0.0});
  settled_ = sum_.rank();
}

LowRank PendingUpdate::leaf_product(const Product& product) const {
  const auto from_left = [&](const MatrixXd& u, const MatrixXd& v) {
    LowRank result{u, MatrixXd::Zero(columns_, v.cols())};
    add_transposed_block_product(*product.right, product.b, 1.0, v, result.v);
    return result;
  };
  const auto from_right = [&](const MatrixXd& u, const MatrixXd& v) {
    LowRank result{MatrixXd::Zero(rows_, u.cols()), v};
    add_block_product(*product.left, product.a, 1.0, u, result.u);
    return result;
  };
  const auto leaf_of = [](const HierarchicalMatrix& matrix, int block) {
    return is_leaf(matrix, block) ? &matrix.leaf(block) : nullptr;
  };
  const HierarchicalMatrix::Leaf* first = leaf_of(*product.left, product.a);
  const HierarchicalMatrix::Leaf* second = leaf_of(*product.right, product.b);
  if (first != nullptr && !first->is_dense() &&
      (second == nullptr || second->is_dense() || first->low_rank.rank() <= second->low_rank.rank()))
    return from_left(first->low_rank.u, first->low_rank.v);
  if (second != nullptr && !second->is_dense()) return from_right(second->low_rank.u, second->low_rank.v);
  // One operand is dense: the rank is at most its smaller side.
  if (first != nullptr) {
    const MatrixXd& dense = first->dense;
    if (dense.rows() <= dense.cols()) return from_left(MatrixXd::Identity(rows_, rows_), dense.transpose());
    return from_left(dense, MatrixXd::Identity(dense.cols(), dense.cols()));
  }
  const MatrixXd& dense = second->dense;
  if (dense.cols() <= dense.rows()) return from_right(dense, MatrixXd::Identity(columns_, columns_));
  return from_right(MatrixXd::Identity(dense.rows(), dense.rows()), dense.transpose());
}

PendingUpdate PendingUpdate::part(const BlockTree& tree, const Block& block, std::size_t i, std::size_t j) const {
  const Block& child = tree.block(block.children[i][j]);
  const Index rows = tree.row_count(child);
  const Index columns = tree.column_count(child);
  PendingUpdate result(rows, columns, tolerance_);
  result.for_dense_leaf_ = child.kind == BlockKind::dense;
  result.sum_ = {sum_.u.middleRows(tree.first_row(child) - tree.first_row(block), rows),
                 sum_.v.middleRows(tree.first_column(child) - tree.first_column(block), columns)};
  result.settled_ = sum_.rank();
  for (const auto& [left, a, right, b] : products_) {
    for (std::size_t k = 0; k < 2; ++k) {
      const int a_child = left->tree().block(a).children[i][k];
      const int b_child = right->tree().block(b).children[k][j];
      if (a_child >= 0 && b_child >= 0) result.add(*left, a_child, *right, b_child);
    }
  }
  return result;
}

LowRank PendingUpdate::collected() const {
  if (products_.empty()) return sum_;
  // A leaf of the result may still be divided in its operands: collect the parts and put them together.
  const HierarchicalMatrix& left = *products_.front().left;
  const HierarchicalMatrix& right = *products_.front().right;
  const Block& rows = left.tree().block(products_.front().a);
  const Block& columns = right.tree().block(products_.front().b);
  LowRank result = sum_;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      const int a_child = rows.children[i][0];
      const int b_child = columns.children[0][j];
      if (a_child < 0 || b_child < 0) continue;
      const Block& row_child = left.tree().block(a_child);
      const Block& column_child = right.tree().block(b_child);
      PendingUpdate child(left.tree().row_count(row_child), right.tree().column_count(column_child), tolerance_);
      for (const auto& [l, a, r, b] : products_) {
        for (std::size_t k = 0; k < 2; ++k) {
          const int inner_left = l->tree().block(a).children[i][k];
          const int inner_right = r->tree().block(b).children[k][j];
          if (inner_left >= 0 && inner_right >= 0) child.add(*l, inner_left, *r, inner_right);
        }
      }
      const LowRank part = child.collected();
      LowRank padded{MatrixXd::Zero(rows_, part.rank()), MatrixXd::Zero(columns_, part.rank())};
      padded.u.middleRows(left.tree().first_row(row_child) - left.tree().first_row(rows), child.rows_) = part.u;
      padded.v.middleRows(right.tree().first_column(column_child) - right.tree().first_column(columns),
                          child.columns_) = part.v;
      result = concatenated(result, padded);
    }
  }
  return truncate(result, {tolerance_, 0.0});
}

void PendingUpdate::apply_to(HierarchicalMatrix::Leaf& leaf, double factor) const {
  if (leaf.is_dense()) {
    add_product_with_transposed(factor, sum_.u, sum_.v, leaf.dense);
    if (products_.empty()) return;
    MatrixXd sum = MatrixXd::Zero(rows_, columns_);
    for (const auto& [left, a, right, b] : products_) add_dense_product(*left, a, *right, b, sum);
    leaf.dense += factor * sum;
    return;
  }
  LowRank sum = collected();
  if (sum.rank() == 0) return;
  sum.u *= factor;
  leaf.low_rank = truncate(concatenated(leaf.low_rank, sum), {tolerance_, 0.0});
}

void add(HierarchicalMatrix& a, double factor, const HierarchicalMatrix& b, double tolerance) {
  if (a.shared_tree() != b.shared_tree()) throw InputError("matrices over different block trees cannot be added");
  const BlockTree& tree = a.tree();
  for (int number = 0; number < static_cast<int>(tree.blocks().size()); ++number) {
    if (is_leaf(a, number)) {
      HierarchicalMatrix::Leaf& sum = a.leaf(number);
      const HierarchicalMatrix::Leaf& term = b.leaf(number);
      if (!sum.is_dense() && term.is_dense()) {
        sum.dense = sum.low_rank.u * sum.low_rank.v.transpose();
        sum.low_rank = {};
      }
      if (sum.is_dense() && term.is_dense()) {
        sum.dense += factor * term.dense;
      } else if (sum.is_dense()) {
        sum.dense.noalias() += factor * term.low_rank.u * term.low_rank.v.transpose();
      } else {
        sum.low_rank =
            truncate(concatenated(sum.low_rank, {factor * term.low_rank.u, term.low_rank.v}), {tolerance, 0.0});
      }
    }
  }
}

void add(HierarchicalMatrix& matrix, const LowRank& update, double tolerance) {
  const BlockTree& tree = matrix.tree();
  LowRank ordered{MatrixXd(update.u.rows(), update.rank()), MatrixXd(update.v.rows(), update.rank())};
  for (Index k = 0; k < update.rank(); ++k) {
    ordered.u.col(k) = tree.rows().to_tree_order(update.u.col(k));
    ordered.v.col(k) = tree.columns().to_tree_order(update.v.col(k));
  }
  for (int number = 0; number < static_cast<int>(tree.blocks().size()); ++number) {
    if (!is_leaf(matrix, number)) continue;
    const Block& block = tree.block(number);
    HierarchicalMatrix::Leaf& leaf = matrix.leaf(number);
    const LowRank part{ordered.u.middleRows(tree.first_row(block), tree.row_count(block)),
                       ordered.v.middleRows(tree.first_column(block), tree.column_count(block))};
    if (leaf.is_dense())
      leaf.dense.noalias() += part.u * part.v.transpose();
    else
      leaf.low_rank = truncate(concatenated(leaf.low_rank, part), {tolerance, 0.0});
  }
}

namespace {

void apply(HierarchicalMatrix& matrix, int number, const PendingUpdate& update, double factor) {
  if (is_leaf(matrix, number)) return update.apply_to(matrix.leaf(number), factor);
  const BlockTree& tree = matrix.tree();
  const Block& block = tree.block(number);
  std::vector<std::function<void()>> tasks;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      if (block.children[i][j] < 0) continue;
      tasks.emplace_back([&, i, j] { apply(matrix, block.children[i][j], update.part(tree, block, i, j), factor); });
    }
  }
  if (tree.row_count(block) + tree.column_count(block) >= task_size)
    quadrature::together(tasks);
  else
    for (const auto& task : tasks) task();
}

}  // namespace

void add_product(HierarchicalMatrix& c, double factor, const HierarchicalMatrix& a, const HierarchicalMatrix& b,
                 double tolerance, int threads) {
  if (&c.tree().rows() != &a.tree().rows() || &c.tree().columns() != &b.tree().columns() ||
      &a.tree().columns() != &b.tree().rows())
    throw InputError("the clusters of the matrices do not fit for a product");
  PendingUpdate update(c.rows(), c.cols(), tolerance);
  update.add(a, 0, b, 0);
  quadrature::with_team(threads, [&] { apply(c, 0, update, factor); });
}

}  // namespace isorim::solver
