#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>

#include "quadrature/gauss_legendre.h"

/// Gauss-Legendre rules for integrands with known nearest singularities: maps of the unit interval that move these
/// away, and the number of points that a tolerance needs, both from Bernstein ellipses.
namespace isorim::quadrature {

/// log rho of the Bernstein ellipse about [0, 1] that passes through z: Chebyshev coefficients of a function that is
/// analytic inside it fall like rho^-k.
double log_ellipse(std::complex<double> z);
/// Its hyperbolic cosine, at least 1: the sum of the distances of z from both ends, which is cheaper to compare.
double ellipse_sum(std::complex<double> z);

/// The interval [0, 1] mapped to itself by u(g) = centre + scale sinh(t0 + g (t1 - t0)), which turns integrands with
/// singularities at centre +- i scale into ones that are analytic in a strip of half the width pi (Johnston & Elliott,
/// A sinh transformation for evaluating nearly singular boundary element integrals, IJNME 62 (2005) 564-578); or not
/// mapped.
class SinhMap {
 public:
  /// u = g.
  SinhMap() = default;
  /// Towards a singularity near the interval: it need not be known exactly. Not mapped if it lies so far off that the
  /// map would gain nothing.
  static SinhMap towards(std::complex<double> singularity);
  /// scale > 0; the centre may lie anywhere.
  SinhMap(double centre, double scale);

  bool is_identity() const { return scale_ == 0.0; }
  struct Value {
    double place;
    double derivative;
  };
  Value at(double g) const;
  std::complex<double> at(std::complex<double> g) const;
  /// log_ellipse of that preimage of u which lies nearest to the interval.
  double log_ellipse_of(std::complex<double> u) const;
  /// Its hyperbolic cosine.
  double ellipse_sum_of(std::complex<double> u) const;

 private:
  double centre_ = 0.0;
  double scale_ = 0.0;
  double first_ = 0.0;
  double length_ = 1.0;
};

/// log of how fast functions of a kind may grow away from [0, 1]: on the ellipse of log rho = l they are at most
/// exp(growth(l)) times as large as on the interval. Convex, 0 at 0.
class Growth {
 public:
  /// Polynomials of a degree.
  explicit Growth(double degree = 0.0);
  /// Functions whose Chebyshev coefficients have these sizes (relative to the largest value), times polynomials.
  Growth(std::span<const double> coefficients, double degree);

  double operator()(double log_rho) const;

 private:
  static constexpr double step = 0.25;
  std::array<float, 17> values_{};
};

/// The number of points of a Gauss-Legendre rule in g for an integrand with the given log_ellipse_of its nearest
/// singularity, times factors that grow like exp(growth(u)), u = map.at(g), to the tolerance (relative to the size of
/// the integrand on the interval). Any singularity weaker than the inverse cube of the distance.
template <class GrowthAt>
int gauss_points(const SinhMap& map, double log_rho, double tolerance, const GrowthAt& growth) {
  // What the theorem of Gauss's rule has beside rho^(-2 n), for singularities up to the inverse cube.
  constexpr double constant = 7.0;
  constexpr double shrink = 0.72;
  constexpr int most_ellipses = 10;
  const double digits = constant - std::log(tolerance);
  double least = max_gauss_points;
  double l = std::clamp(log_rho, 0.01, 4.0);
  for (int k = 0; k < most_ellipses; ++k, l *= shrink) {
    // The ends of the ellipse about [0, 1], and its top.
    const double half = 0.5 * std::cosh(l);
    const double grown = std::max({0.0, growth(map.at({0.5 + half, 0.0})), growth(map.at({0.5, 0.5 * std::sinh(l)})),
                                   growth(map.at({0.5 - half, 0.0}))});
    const double points = (digits + grown) / (2.0 * l);
    if (points > least) break;
    least = points;
  }
  return std::max(2, static_cast<int>(std::ceil(least)));
}

}  // namespace isorim::quadrature
