#pragma once

#include <vector>

namespace isorim::solver {

/// A Gauss-Legendre rule on [0, 1] with what panels of rays need beside it.
struct RayRule {
  std::vector<double> nodes;
  std::vector<double> weights;
  /// Of int_0^1 f(s) s (-ln s) ds at the same nodes: exact for polynomials of a degree below the number of nodes.
  std::vector<double> log_weights;
  /// 2 x nodes, row-major: the last two Legendre coefficients of the interpolating polynomial from its values.
  std::vector<double> tail;

  int size() const { return static_cast<int>(nodes.size()); }
};

/// The rule of n >= 2 points, made once and kept; safe from any thread.
const RayRule& ray_rule(int n);

}  // namespace isorim::solver
