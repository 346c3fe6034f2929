#pragma once

#include <span>
#include <vector>

#include "quadrature/element_sums.h"
#include "quadrature/line_rule.h"

/// Quadrature over a part D of the unit cell by its moments
///
///   m_ij = int_D q_i(x) q_j(y) dx dy,
///
/// q_i the Legendre polynomials that are orthonormal on [0, 1]. What D is to an integrand is these numbers: with the
/// tensor Gauss-Legendre nodes x_a, y_b and weights w_a, w_b of the whole cell,
///
///   int_D g ~ sum_ab W_ab g(x_a, y_b),   W_ab = w_a w_b sum_ij m_ij q_i(x_a) q_j(y_b),
///
/// is the integral over D of the polynomial that interpolates g at the nodes: exact for polynomials of a degree below
/// the number of nodes in each direction, spectrally accurate for what is analytic on the cell, whatever D is. (Product
/// integration: Sloan & Smith 1978; moments from the boundary: Sommariva & Vianello 2009; Gunderman, Weiss & Evans
/// 2021; see the README.)
namespace isorim::quadrature {

/// The moments m_ij of a region, i < counts[0], j < counts[1].
struct RegionMoments {
  Orders<2> counts{};
  /// m_ij at i counts[1] + j.
  std::vector<double> values;
  /// The sum of the absolute values of the terms of m_00: what rounding is relative to.
  double absolute = 0.0;

  double area() const { return values.front(); }
  /// Rounding of an integral over the region, relative to what it is where nothing cancels.
  double amplification() const;
};

/// Adds int F_i(x) q_j(y) dy to the moments, F_i the integral of q_i from 0 to x: summed over the boundary of a region
/// that runs round it counter-clockwise these are its moments (Green). With parallel rays instead of rays from a pole
/// it is the radial integration method, whose inner integral is known here.
void add_moments(const LineRule& rule, RegionMoments& moments);

/// The same for what lies to the left of a straight line along x = 1 from y = first to y = last.
void add_moments_of_strip(double first, double last, RegionMoments& moments);

/// The weights W_ab of one region, nodes[0] x nodes[1] with a fastest; nodes must not exceed the moments' counts.
void region_weights(const RegionMoments& moments, const Orders<2>& nodes, std::vector<double>& weights);

/// nodes x nodes, row-major: w_a q_i(x_a) at a nodes + i. Computed once and kept; safe from any thread.
const std::vector<double>& legendre_at_nodes(int nodes);

}  // namespace isorim::quadrature
