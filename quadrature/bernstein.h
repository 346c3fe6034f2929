#pragma once

#include <vector>

namespace isorim::quadrature {

/// The Bernstein polynomials of one degree and their derivatives at the nodes of a Gauss-Legendre rule, shared by
/// all elements of that degree.
struct BernsteinTable {
  int degree = 0;
  int points = 0;
  /// points x (degree + 1), row-major: B_i(node a) is values[a (degree + 1) + i].
  std::vector<double> values;
  std::vector<double> derivatives;

  const double* values_at(int node) const { return values.data() + node * (degree + 1); }
  const double* derivatives_at(int node) const { return derivatives.data() + node * (degree + 1); }
};

/// The degree + 1 Bernstein polynomials and their derivatives at u.
struct BernsteinValues {
  std::vector<double> values;
  std::vector<double> derivatives;
};
BernsteinValues bernstein_polynomials(int degree, double u);

/// The table for the n-point rule on [0, 1]; 1 <= degree <= 30. Computed once and kept; safe from any thread.
const BernsteinTable& bernstein_table(int degree, int points);

}  // namespace isorim::quadrature
