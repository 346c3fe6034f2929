#pragma once

#include <cstddef>

/// Products of small dense matrices, compiled for two instruction sets of which the processor chooses one. Every entry
/// is summed in the same order whatever the sizes of the others, so results do not depend on how work is cut up.
namespace isorim::solver {

/// Doubles in a register: rows of matrices that are run through along their rows are padded to multiples of this.
inline constexpr int product_lanes = 4;
inline constexpr int padded(int count) {
  return (count + product_lanes - 1) / product_lanes * product_lanes;
}

/// A matrix whose entry (i, k) is data[i row_step + k column_step].
struct SteppedMatrix {
  const double* data;
  std::ptrdiff_t row_step;
  std::ptrdiff_t column_step;
};

/// c += a b for a of m x k, b of k x n and c of m x n, b and c row by row at the given distances, which (as n) must be
/// multiples of product_lanes.
void add_product(int m, int n, int k, const SteppedMatrix& a, const double* b, std::ptrdiff_t b_step, double* c,
                 std::ptrdiff_t c_step);

/// c += a b^T for a of m x k, b of n x k and c of m x n, all row by row; sums run along the rows.
void add_product_transposed(int m, int n, int k, const double* a, std::ptrdiff_t a_step, const double* b,
                            std::ptrdiff_t b_step, double* c, std::ptrdiff_t c_step);

/// The degree + 1 Bernstein polynomials at count places of [0, 1]: values[i * step + q] is B_i(places[q]).
void bernstein_values(int degree, int count, const double* places, double* values, std::ptrdiff_t step);

}  // namespace isorim::solver
