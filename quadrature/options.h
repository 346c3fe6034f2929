#pragma once

#include <cstdint>
#include <functional>

#include "quadrature/estimate.h"

namespace isorim::quadrature {

/// How to integrate over a boundary.
struct Options {
  /// Relative to the quantity itself (lengths, areas, volumes, moments, integrals); 1e-12 leaves three digits above
  /// rounding for the error estimate to be meaningful.
  double tolerance = 1e-12;
  /// n > 0: the n-point Gauss-Legendre rule in every direction of every element (knot span) and no adaptivity, as
  /// in the thesis of Correia (2016, chapter 6); at most max_fixed_points. 0: adaptive.
  int fixed_points = 0;
  /// Number of threads; 0: all that OpenMP offers. The result has the same bits for any number.
  int threads = 0;
  /// Bisections of one element in a row before it is left as it is (and the missed tolerance reported).
  int max_depth = 24;
  /// Bisections in all, shared out among tasks of a few elements (each may make some hundred): enough for sharp peaks
  /// and cusps, and a bound on the time that a hopeless integrand takes.
  int max_bisections = 5000;
  /// Called now and then from one thread with the finished fraction in [0, 1]; may be empty.
  std::function<void(double)> progress;
};

/// What an estimated error says: `allowed` by the tolerance, `rounding` the part that no rule can lower.
inline Status judge(double error, double allowed, double rounding, const Options& options) {
  if (options.fixed_points > 0) return Status::fixed_rule;
  if (error <= allowed) return Status::converged;
  return error <= allowed + rounding ? Status::limited_by_rounding : Status::tolerance_not_reached;
}

}  // namespace isorim::quadrature
