#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"

/// Polynomials of one and two variables in Bernstein form: their coefficients bound them, so signs can be told for
/// certain.
namespace isorim::geometry {

/// sum_ij coefficients(i, j) B_i^p(u) B_j^q(v) on the unit square: (p + 1) x (q + 1).
using BernsteinGrid = Eigen::MatrixXd;
/// sum_i coefficients(i) B_i^p(t) on [0, 1].
using BernsteinCoefficients = Eigen::VectorXd;

struct GridJet {
  double value = 0.0;
  Vector2 gradient = Vector2::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

struct GridSlope {
  double value = 0.0;
  Vector2 gradient = Vector2::Zero();
};

double evaluate(const BernsteinCoefficients& polynomial, double t);
double evaluate(const BernsteinGrid& grid, const Point2& uv);
/// With first derivatives; some 30 ns for a bicubic.
GridSlope evaluate_slope(const BernsteinGrid& grid, const Point2& uv);
/// With first and second derivatives. Parameters outside the unit square continue the polynomial.
GridJet evaluate_jet(const BernsteinGrid& grid, const Point2& uv);

/// The product; degrees add up.
BernsteinGrid multiply(const BernsteinGrid& a, const BernsteinGrid& b);
/// The same polynomial with degrees not below (p, q).
BernsteinGrid elevate(const BernsteinGrid& grid, Eigen::Index p, Eigen::Index q);
BernsteinGrid derivative_u(const BernsteinGrid& grid);
BernsteinGrid derivative_v(const BernsteinGrid& grid);

/// The polynomial on a part of the unit interval (square), over the unit interval (square) again.
BernsteinCoefficients restrict_to(const BernsteinCoefficients& polynomial, Interval part);
BernsteinGrid restrict_to(const BernsteinGrid& grid, Interval u, Interval v);
/// v -> grid(u, v) and u -> grid(u, v).
BernsteinCoefficients along_v(const BernsteinGrid& grid, double u);
BernsteinCoefficients along_u(const BernsteinGrid& grid, double v);

/// Where a polynomial changes its sign on [0, 1].
struct SignChart {
  /// Increasing, strictly inside (0, 1).
  std::vector<double> roots;
  /// -1 or +1 before, between and after the roots: one more than there are roots; a single 0 if the polynomial
  /// vanishes.
  std::vector<int> signs;

  /// The sign just beside t, on the side of larger parameters if `after`.
  int sign_between(double from, double to) const;
};

/// The sign chart of a polynomial known to within `noise`. Stretches on which it does not exceed the noise take the
/// sign of their surroundings, so double roots (and pairs of roots that the noise may have made) do not show. Roots are
/// isolated by the signs of the coefficients, under bisection, and found to rounding.
SignChart sign_chart(const BernsteinCoefficients& polynomial, double noise);

}  // namespace isorim::geometry
