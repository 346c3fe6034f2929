#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace isorim::solver {

/// A matrix u v^T: u of its rows, v of its columns, both with as many columns as its rank. Rank 0 is the zero matrix.
struct LowRank {
  Eigen::MatrixXd u;
  Eigen::MatrixXd v;

  Eigen::Index rank() const { return u.cols(); }
  std::size_t memory() const { return static_cast<std::size_t>(u.size() + v.size()) * sizeof(double); }
};

/// How far an approximation may lie from a matrix A in the Frobenius norm: max(relative |A|, absolute).
struct Accuracy {
  double relative = 0.0;
  double absolute = 0.0;

  double allowed(double norm) const { return relative * norm > absolute ? relative * norm : absolute; }
};

/// The matrix of least rank within the accuracy of u v^T: QR of both factors and singular values of the product of the
/// triangles (Bebendorf, Hierarchical Matrices, 2008, section 1.1.3), these by one-sided Jacobi after a QR with column
/// pivoting, so that relative accuracies down to 1e-13 are met. The columns of the result's v are orthonormal. Throws
/// NumericalError for factors that are not finite.
LowRank truncate(const LowRank& matrix, const Accuracy& accuracy);

/// The same for a dense matrix.
LowRank compress(const Eigen::Ref<const Eigen::MatrixXd>& matrix, const Accuracy& accuracy);

/// |u v^T| in the Frobenius norm, in rank^2 (rows + columns) operations; absolute accuracy 1e-8 |u| |v|.
double frobenius_norm(const LowRank& matrix);

}  // namespace isorim::solver
