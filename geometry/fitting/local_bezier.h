#pragma once

#include <algorithm>
#include <array>

#include "geometry/spline/knot_vector.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// Up to max_degree + 1 points on the stack.
template <int Dim>
using LocalNet = std::array<Vector<Dim>, KnotVector::max_degree + 1>;

/// The Bézier points of a span from its p + 1 control points; knots[0 .. 2p - 1] are those around the span, which is
/// [knots[p - 1], knots[p]]. Point j is the polar form at p - j starts and j ends, by de Boor's algorithm.
template <int Dim>
void cut_to_bezier(const double* knots, const LocalNet<Dim>& control, int p, LocalNet<Dim>& bezier) {
  LocalNet<Dim> net;
  for (int j = 0; j <= p; ++j) {
    std::copy_n(control.begin(), p + 1, net.begin());
    for (int r = 1; r <= p; ++r) {
      const double x = r <= p - j ? knots[p - 1] : knots[p];
      for (int i = p; i >= r; --i) {
        const std::size_t at = static_cast<std::size_t>(i);
        const double left = knots[i - 1];
        const double share = (x - left) / (knots[i + p - r] - left);
        net[at] = (1.0 - share) * net[at - 1] + share * net[at];
      }
    }
    bezier[static_cast<std::size_t>(j)] = net[static_cast<std::size_t>(p)];
  }
}

}  // namespace isorim::geometry
