#pragma once

#include <span>
#include <vector>

namespace isorim::quadrature {

/// A rule int_0^1 f = sum_i weights[i] f(nodes[i]).
struct Rule {
  std::vector<double> nodes;
  std::vector<double> weights;

  int size() const { return static_cast<int>(nodes.size()); }
};

/// Of a rule that is asked for (Options::fixed_points).
inline constexpr int max_fixed_points = 128;
/// Two points more for the rules that judge it, and twice as many for cut elements.
inline constexpr int max_gauss_points = 2 * (max_fixed_points + 2);

/// The n-point Gauss-Legendre rule on [0, 1], nodes increasing and symmetric; exact for degree 2 n - 1. Nodes and
/// weights are correct to the last bit or two (Newton's method on the three-term recurrence in extended precision).
/// Computed once for each n, 1 <= n <= max_gauss_points, and kept; safe to call from any thread.
const Rule& gauss_legendre(int n);

}  // namespace isorim::quadrature
