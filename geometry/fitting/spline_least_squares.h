#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/spline/knot_vector.h"

namespace isorim::geometry {

/// The splines among which a fit is sought: those on `knots`, the last `shared` coefficients of which are the first
/// ones again. A closed curve shares p coefficients on a periodic knot vector, one on a clamped one (its ends meet in
/// a corner); an open one shares none.
struct FitSpace {
  KnotVector knots;
  int shared = 0;

  int unknowns() const { return knots.basis_count() - shared; }
};

/// Linear least squares in a FitSpace: minimises the sum of |sum_i row_i c_i - rhs|^2 over coefficients c in R^k.
///
/// QR factorisation by Givens rotations, row by row, so the condition of the matrix is not squared and memory is
/// O(unknowns) for any number of rows (M. G. Cox, The least squares solution of overdetermined linear equations having
/// band or augmented band structure, IMA J. Numer. Anal. 1, 1981). The shared coefficients form a border of the band,
/// so a closed curve costs little more than an open one: O(rows p (p + k)) when rows come in the order of their spans.
class SplineLeastSquares {
 public:
  /// k = dimension >= 1. Closed spaces need at least p + 1 unknowns.
  SplineLeastSquares(const FitSpace& space, int dimension);

  /// Adds the row sum_j values[j] c_{first_function + j} = rhs: p + 1 values, k right-hand sides, both multiplied by
  /// the square root of the weight. Fast if first_function does not fall from call to call.
  void add(int first_function, std::span<const double> values, std::span<const double> rhs);

  /// The coefficients of all functions, shared ones repeated: k x basis_count. Empty if the rows do not determine them
  /// (a diagonal element below 1e-13 of the largest one).
  Eigen::MatrixXd solve() const;

 private:
  double* band_row(int i) { return band_.data() + static_cast<std::ptrdiff_t>(i) * stride_; }
  const double* band_row(int i) const { return band_.data() + static_cast<std::ptrdiff_t>(i) * stride_; }
  double* border_row(int i) { return border_.data() + static_cast<std::ptrdiff_t>(i) * border_stride_; }
  const double* border_row(int i) const { return border_.data() + static_cast<std::ptrdiff_t>(i) * border_stride_; }
  void add_to_border();

  int degree_;
  int shared_;
  int dimension_;
  int basis_count_;
  int band_count_;
  int stride_;
  int border_stride_;
  /// Row i: the p + 1 elements from the diagonal on, the border, the right-hand sides. A zero diagonal: no row yet.
  std::vector<double> band_;
  /// The border's own upper triangle, stored as full rows, with right-hand sides.
  std::vector<double> border_;
  /// The last band column that row i reaches.
  std::vector<int> reach_;
  std::vector<double> work_;
};

}  // namespace isorim::geometry
