#pragma once

#include <vector>

#include <Eigen/Core>

namespace isorim::geometry {

/// A symmetric positive definite matrix with a band and, as on closed curves, last rows that couple with everything:
/// element (i, j), i >= j, may differ from zero if i - j <= half_width or i >= size - border. The Cholesky factor has
/// the same places, so memory is O(size (half_width + border)) and time O(size (half_width + border)^2).
class BorderedCholesky {
 public:
  BorderedCholesky(int size, int half_width, int border);

  int size() const { return size_; }
  /// Adds to elements (i, j) and (j, i), which must be among the places named above.
  void add(int i, int j, double value) { *place(i, j) += value; }
  double diagonal(int i) const { return *place(i, i); }

  /// Replaces the matrix by its factor; false if it is not positive definite to rounding.
  bool factorise();
  /// After factorise(): the solution of matrix x = rhs.
  Eigen::VectorXd solve(Eigen::VectorXd rhs) const;

 private:
  const double* place(int i, int j) const;
  double* place(int i, int j) { return const_cast<double*>(static_cast<const BorderedCholesky*>(this)->place(i, j)); }
  /// The first column of row i that is stored.
  int first_column(int i) const;

  int size_;
  int half_width_;
  int band_rows_;
  std::vector<double> values_;
};

}  // namespace isorim::geometry
