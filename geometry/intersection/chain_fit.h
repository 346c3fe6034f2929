#pragma once

#include <vector>

#include "geometry/intersection/element_zero_set.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// Polynomial Bézier curves (2 x (n + 1) control points in the unit square, n <= largest_fit_degree) along a chain.
///
/// Each curve is a graph over its chord: P + s (Q - P) + h(s) n with h a polynomial through zeros of g, found by Newton
/// across the chord at Chebyshev points. Between these the distance from the zero set is at most 4e-15 of the square
/// or what the rounding of g allows; otherwise the degree is raised, then the chain cut. The ends are the chain's own
/// bit for bit. Throws GeometryError, with the place, if a piece cannot be followed however short.
std::vector<Points<2>> fit_chain(const ElementFunction& function, const ZeroChain& chain);

}  // namespace isorim::geometry
