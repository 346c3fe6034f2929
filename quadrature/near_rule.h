#pragma once

#include "quadrature/element_shape.h"
#include "quadrature/target_rules.h"

/// Places and weights on the unit cell for targets on an element or close to it.
namespace isorim::quadrature {

/// A target and what is asked for it.
template <int Dim>
struct NearRequest {
  const ElementShape<Dim>* shape = nullptr;
  geometry::Point<Dim> target;
  /// The target is the element's point at `place`.
  bool is_own = false;
  geometry::Point<Dim - 1> place;
  double tolerance = 1e-12;
  double field_degree = 2.0;
};

/// The plain tensor Gauss-Legendre rule over the whole cell that serves the target; 0 points: none of at most `most`
/// points in each direction does.
template <int Dim>
std::array<int, Dim - 1> plain_orders(const NearRequest<Dim>& request, const NearestPlace<Dim>& nearest, int most);

/// Sets `place`, `cell_weight` and `size` of the nodes.
///
/// Off the element: Gauss-Legendre rules with a sinh map in each direction, or, where that needs fewer points, polar
/// coordinates about the nearest place in the metric of the surface there, with sinh maps along rays and angles. On the
/// element: the same polar coordinates about the place, without a map along the rays; lines are split at the place and
/// get rules for logarithms. Cells over which the metric changes much, as near a degenerate edge, are bisected first.
/// Numbers of points come from the Bernstein ellipses of the singularities in the complex planes of the parameters (A.
/// af Klinteberg, C. Sorgentone, A.-K. Tornberg, Quadrature error estimates for layer potentials evaluated near curved
/// surfaces in three dimensions, Comput. Math. Appl. 111 (2022) 1-19).
template <int Dim>
void near_rule(const NearRequest<Dim>& request, const NearestPlace<Dim>& nearest, NodeBuffer<Dim>& nodes);

}  // namespace isorim::quadrature
