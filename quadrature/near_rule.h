#pragma once

#include <array>

#include "quadrature/direction_rule.h"
#include "quadrature/near_request.h"

/// Places and weights on the unit cell for targets on an element or close to it.
namespace isorim::quadrature {

/// Of a target off the element: the rules along each direction of the whole cell, mapped where that helps. Where none
/// is mapped the tensor rule of their points serves the target.
template <int Dim>
std::array<DirectionRule, Dim - 1> direction_rules(const NearRequest<Dim>& request, const NearestPlace<Dim>& nearest);

/// Sets `place`, `cell_weight` and `size` of the nodes. `known`: direction_rules() of a target off the element, or
/// null.
///
/// Off the element: Gauss-Legendre rules with a sinh map in each direction, or, where that needs fewer points, polar
/// coordinates about the nearest place in the metric of the surface there, with sinh maps along rays and angles. On the
/// element: the same polar coordinates about the place, without a map along the rays; lines are split at the place and
/// get rules for logarithms. On cut elements always polar, about the nearest
/// place of the whole cell. Cells over which the
/// metric changes much, as near a degenerate edge, are bisected first. Numbers of points come from the Bernstein
/// ellipses of the singularities in the complex planes of the parameters (L. af Klinteberg, C. Sorgentone, A.-K.
/// Tornberg, Quadrature error estimates for layer potentials evaluated near curved surfaces in three dimensions,
/// Comput. Math. Appl. 111 (2022) 1-19).
template <int Dim>
void near_rule(const NearRequest<Dim>& request, const NearestPlace<Dim>& nearest,
               const std::array<DirectionRule, Dim - 1>* known, NodeBuffer<Dim>& nodes);

}  // namespace isorim::quadrature
