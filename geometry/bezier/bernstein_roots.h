#pragma once

#include <span>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// All roots in [0, 1] of the polynomial sum_i coefficients[i] B_i(t) of degree coefficients.size() - 1, in increasing
/// order; a multiple root, or a cluster that rounding cannot resolve, comes once.
///
/// A coefficient not larger than its tolerance counts as zero: tolerances are the Bernstein coefficients of a positive
/// function that bounds the error of the polynomial (for the numerator of a rational function, its accuracy times the
/// weights). A simple root is found to the last digits that the coefficients allow, first == last. A longer interval is
/// a stretch on which the polynomial is zero within the tolerance; [0, 1] if it is zero altogether.
///
/// The number of roots is certain beyond the tolerance: parts without a change of sign among their coefficients are
/// left out, parts with one have one root (variation diminution; Lane & Riesenfeld, BIT 21, 1981), which Newton's
/// method finds inside its bracket; all others are bisected. Throws GeometryError for no coefficient, unequal counts or
/// a coefficient that is not finite.
std::vector<Interval> bernstein_roots(std::span<const double> coefficients, std::span<const double> tolerances);
/// The same tolerance for all coefficients.
std::vector<Interval> bernstein_roots(std::span<const double> coefficients, double tolerance);

}  // namespace isorim::geometry
