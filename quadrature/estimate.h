#pragma once

#include <cstdint>

namespace isorim::quadrature {

/// A number and our own estimate of its absolute error. The estimate contains the rounding of the sum.
struct Estimate {
  double value = 0.0;
  double error = 0.0;
};

/// How an integration ended. Not reaching the tolerance is a result, not an exception.
enum class Status {
  /// The rule integrates the polynomials at hand exactly: the error is rounding alone.
  exact,
  /// The estimated error met the tolerance.
  converged,
  /// The estimated error is above the tolerance because of rounding alone: no quadrature does better with these data.
  limited_by_rounding,
  /// A fixed rule was asked for: no tolerance was aimed at.
  fixed_rule,
  /// The estimated error is above the tolerance; see Estimate::error.
  tolerance_not_reached,
};

}  // namespace isorim::quadrature
