#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "solver/linear/linear_operator.h"

namespace isorim::solver {

/// The few dense columns and rows about a matrix A of n x n: [A, columns; rows, corner], as Lagrange multipliers of
/// null spaces and extra unknowns bring them.
struct Border {
  /// n x e, e x n and e x e.
  Eigen::MatrixXd columns;
  Eigen::MatrixXd rows;
  Eigen::MatrixXd corner;

  Eigen::Index size() const { return corner.rows(); }
};

/// The bordered matrix; holds the border, refers to A.
class BorderedMatrix final : public LinearOperator {
 public:
  /// Throws InputError for sizes that disagree.
  BorderedMatrix(const LinearOperator& matrix, Border border);

  Eigen::Index rows() const override { return matrix_.rows() + border_.size(); }
  Eigen::Index cols() const override { return rows(); }
  void add_product(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> result) const override;
  std::size_t memory() const override;

 private:
  const LinearOperator& matrix_;
  Border border_;
};

/// The inverse of a bordered matrix by block elimination with the Schur complement corner - rows A^-1 columns; as good
/// an inverse as that of A is.
///
/// Where A is singular and the border makes up for it, give instead of A^-1 the inverse of A + weight columns rows,
/// which is not (add() of a LowRank puts it into a hierarchical matrix): adding weight * columns times the last rows of
/// the system to the first ones changes no solution.
class BorderedInverse final : public LinearOperator {
 public:
  /// Throws InputError for sizes that disagree, NumericalError if the Schur complement is singular: the border does not
  /// determine the null space.
  BorderedInverse(const LinearOperator& inverse, Border border, double weight = 0.0);

  Eigen::Index rows() const override { return inverse_.rows() + border_.size(); }
  Eigen::Index cols() const override { return rows(); }
  void add_product(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> result) const override;
  std::size_t memory() const override;

 private:
  const LinearOperator& inverse_;
  Border border_;
  double weight_;
  /// inverse (columns + weight columns corner).
  Eigen::MatrixXd solved_columns_;
  Eigen::MatrixXd schur_inverse_;
};

}  // namespace isorim::solver
