#pragma once

#include <span>

#include "geometry/vocabulary.h"

/// The B-spline function of degree p on p + 2 knots of its own, as T-splines have them: 1 for p = 0 between the two
/// knots, else by the recurrence of Cox and de Boor. A *piece* is the polynomial between the knots k and k + 1, which
/// differ; the function is zero outside its knots.
namespace isorim::geometry {

/// Which limit is meant at a knot.
enum class Limit { from_right, from_left };

/// The piece k with knots[k] <= u < knots[k + 1] (from_right) or knots[k] < u <= knots[k + 1] (from_left); -1 if u is
/// outside the support.
int piece_at(std::span<const double> knots, double u, Limit limit);

/// The polar form (blossom) of piece `piece` at p arguments: symmetric, affine in each, and the polynomial's value
/// where all are equal (Ramshaw, Blossoms are polar forms, CAGD 6, 1989). No cancellation where the arguments lie
/// between the knots of the piece.
double blossom(std::span<const double> knots, int piece, std::span<const double> arguments);

/// The derivative of the given order of piece `piece` at u, anywhere.
double piece_derivative(std::span<const double> knots, int piece, double u, int order);

/// Writes the p + 1 Bernstein coefficients over `range`, which lies inside one piece or outside the support.
void bernstein_coefficients(std::span<const double> knots, Interval range, std::span<double> coefficients);

}  // namespace isorim::geometry
