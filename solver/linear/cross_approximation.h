#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "solver/linear/low_rank.h"

namespace isorim::solver {

/// A matrix that tells its rows and columns when asked; it belongs to one thread at a time. Rows come in groups of
/// row_components() (the components at one target), columns in groups of column_components() (those at one node), and
/// are told together, since a kernel yields them together. A typical source holds the pointwise kernel, targets x
/// quadrature nodes times weights; what it is approximated by, u v^T, is then contracted to functions by
/// v <- basis^T v.
class CrossSource {
 public:
  virtual ~CrossSource() = default;
  /// Targets and nodes; scalar rows and columns are these times the components.
  virtual Eigen::Index targets() const = 0;
  virtual Eigen::Index nodes() const = 0;
  virtual int row_components() const { return 1; }
  virtual int column_components() const { return 1; }
  /// The rows of a target as columns of values: (nodes() * column_components()) x row_components(), entry
  /// (node * column_components() + b, a) for the target's component a and the node's b.
  virtual void row(Eigen::Index target, Eigen::Ref<Eigen::MatrixXd> values) = 0;
  /// The columns of a node: (targets() * row_components()) x column_components(), entry
  /// (target * row_components() + a, b).
  virtual void column(Eigen::Index node, Eigen::Ref<Eigen::MatrixXd> values) = 0;
  /// The smooth piece (patch) that a target or node lies on. Across pieces a kernel with normals falls into parts that
  /// know nothing of each other; one target and one node of each piece are therefore always looked at.
  virtual std::int32_t target_group(Eigen::Index /*target*/) const { return 0; }
  virtual std::int32_t node_group(Eigen::Index /*node*/) const { return 0; }
};

/// u v^T within the accuracy of the source, by adaptive cross approximation (Bebendorf 2000; Bebendorf & Rjasanow,
/// Computing 70, 2003): crosses of residual rows and columns, pivots by the largest entry among all rows of a target.
///
/// Plain partial pivoting stops too early where the matrix has structure (blocks of zeros, as double layers over plane
/// faces have). Here the crosses end only when the residual, estimated from rows and columns that are spread over the
/// targets, the nodes and their groups and take no part in the pivoting, is within the accuracy; else they go on from
/// the worst of those. The estimate is of statistical nature: the error aimed at is a third of the accuracy.
///
/// A matrix whose rank comes to half of its rows or columns is taken as it is.
///
/// Cost: about (rank + checks) rows and columns of the source and rank^2 (rows + columns) operations. Neither factor is
/// orthogonal nor is the rank minimal: see truncate(). Throws NumericalError for an entry that is not finite.
LowRank cross_approximation(CrossSource& source, const Accuracy& accuracy);

/// All rows of a matrix from a few of them: A is about weights A(rows, :).
struct RowInterpolation {
  /// Scalar rows, in the order of the columns of `weights`.
  std::vector<Eigen::Index> rows;
  /// The identity at `rows`, but for rounding over the accuracy.
  Eigen::MatrixXd weights;
};

/// The rows through which the crosses go, and how the others follow from them: A is about u v^T, so A(rows, :) about
/// u(rows, :) v^T, and weights = u u(rows, :)^-1 (the row interpolation of hybrid cross approximation: Boerm &
/// Grasedyck, Numerische Mathematik 101, 2005). The weights serve any columns that depend on the rows as the source's
/// do, the source's being a fine enough sample of them; all rows come back if their number is not much above the rank.
RowInterpolation interpolate_rows(CrossSource& source, const Accuracy& accuracy);

}  // namespace isorim::solver
