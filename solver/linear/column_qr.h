#pragma once

#include <vector>

#include <Eigen/Core>

namespace isorim::solver {

/// a = Q R by Householder's reflections, in panels whose reflections are applied together (Schreiber and Van Loan, A
/// storage-efficient WY representation for products of Householder transformations, 1989): most of the work is in the
/// products of column_products.h. Q is orthogonal to rounding for any a, also one without full rank.
class ColumnQr {
 public:
  explicit ColumnQr(Eigen::MatrixXd matrix);

  /// min(rows, columns) x columns, zero below the diagonal.
  Eigen::MatrixXd triangle() const;
  /// The first columns of Q, as many as the matrix has rows (min(rows, columns) at most), times the matrix.
  Eigen::MatrixXd orthonormal_times(const Eigen::Ref<const Eigen::MatrixXd>& matrix) const;

 private:
  /// I - v t vᵀ on the rows from `first` on.
  struct Panel {
    Eigen::Index first;
    Eigen::MatrixXd v;
    Eigen::MatrixXd t;
  };
  Panel reflect(Eigen::Index first, Eigen::Index width);

  /// R on and above the diagonal.
  Eigen::MatrixXd matrix_;
  std::vector<Panel> panels_;
};

}  // namespace isorim::solver
