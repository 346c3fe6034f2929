#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "solver/linear/hierarchical_matrix.h"
#include "solver/linear/linear_operator.h"

namespace isorim::solver {

struct FactorisationOptions {
  /// Of each truncation, relative to the norm of the block. 1e-3 to 1e-2 for a preconditioner; a direct solver takes
  /// what it wants of the solution.
  double tolerance = 1e-3;
  /// 0: all that OpenMP offers.
  int threads = 0;
};

/// The inverse of a hierarchical matrix by its LU factorisation in truncated arithmetic (Bebendorf, Hierarchical
/// Matrices, 2008, section 2.7), rows exchanged within the dense leaves of the diagonal. A pivot below 1e-5 of its
/// leaf's largest entry is replaced by that entry: so a singular matrix still gives a preconditioner.
class HierarchicalLu final : public LinearOperator {
 public:
  /// Factorises a copy of the matrix, truncated to the tolerance. Throws InputError for a matrix whose rows and columns
  /// are not divided by one tree, NumericalError for one that is not finite. The result does not depend on the number
  /// of threads.
  HierarchicalLu(const HierarchicalMatrix& matrix, const FactorisationOptions& options);

  Eigen::Index rows() const override { return factors_.rows(); }
  Eigen::Index cols() const override { return factors_.cols(); }
  /// result += (L U)^-1 x.
  void add_product(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> result) const override;
  std::size_t memory() const override { return factors_.memory(); }

  /// Pivots that were replaced; not 0 for a matrix that is singular, nearly.
  int replaced_pivots() const { return replaced_pivots_; }
  const HierarchicalMatrix& factors() const { return factors_; }

 private:
  HierarchicalMatrix factors_;
  /// Row exchanges of each dense leaf of the diagonal, by block; empty elsewhere.
  std::vector<Eigen::VectorXi> exchanges_;
  int replaced_pivots_ = 0;
};

}  // namespace isorim::solver
