#pragma once

#include <span>
#include <vector>

#include "quadrature/element_sums.h"

/// Line integrals along the curves that bound a region of the unit cell.
namespace isorim::quadrature {

/// Points and weights of int f(x, y) dy.
struct LineRule {
  std::vector<double> x;
  std::vector<double> y;
  /// y'(s) times the weight.
  std::vector<double> dy;
};

/// A rational Bezier curve.
struct CurveNet {
  /// 3 x (degree + 1) homogeneous points (w x, w y, w).
  std::span<const double> points;
  int degree = 1;
  /// All weights are 1.
  bool polynomial = false;
};

/// The least number of Gauss-Legendre points known to integrate int F_i(x) q_j(y) dy along the curve to 1e-15 of its
/// extent in y for all i < counts[0], j < counts[1] (see region_moments.h); 0: more than there are. A bound, not an
/// estimate: short curves need few points whatever the polynomials' degrees, and none needs more than is exact.
int points_along_curve(const CurveNet& curve, const Orders<2>& counts);

/// Appends those points; the curve is bisected where it needs more than there are.
void append_curve(const CurveNet& curve, const Orders<2>& counts, LineRule& rule);

}  // namespace isorim::quadrature
