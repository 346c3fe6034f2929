#pragma once

#include <utility>
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
  const double* place(int i, int j) const {
    if (i < j) std::swap(i, j);
    return column(j) + (i < band_rows_ ? i - j : half_width_ + 1 + i - band_rows_);
  }
  double* place(int i, int j) { return const_cast<double*>(static_cast<const BorderedCholesky*>(this)->place(i, j)); }
  const double* column(int j) const { return values_.data() + static_cast<std::ptrdiff_t>(j) * stride_; }
  double* column(int j) { return values_.data() + static_cast<std::ptrdiff_t>(j) * stride_; }
  int border() const { return size_ - band_rows_; }

  int size_;
  int half_width_;
  int band_rows_;
  int stride_;
  /// Columns one after the other: the diagonal, half_width elements below it, and the border's rows. Columns of the
  /// border use the latter only.
  std::vector<double> values_;
};

}  // namespace isorim::geometry
