#pragma once

#include <cmath>
#include <limits>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// The root of a continuous function between two places where it has different signs, to rounding of the places:
/// inverse quadratic interpolation where the last three values allow it, bisection elsewhere (Chandrupatla, Advances in
/// Engineering Software 28, 1997, pp. 145-149). Where the signs are the same, the end with the smaller value.
template <class Function>
double bracketed_root(const Function& f, Interval bracket) {
  double a = bracket.first;
  double b = bracket.last;
  double fa = f(a);
  double fb = f(b);
  if (fa == 0.0 || (fa > 0.0) == (fb > 0.0)) return std::abs(fa) <= std::abs(fb) ? a : b;
  double part = 0.5;
  constexpr int most_steps = 200;
  for (int step = 0; step < most_steps; ++step) {
    const double t = a + part * (b - a);
    const double ft = f(t);
    double c = a;
    double fc = fa;
    if ((ft > 0.0) != (fa > 0.0)) {
      c = b;
      fc = fb;
      b = a;
      fb = fa;
    }
    a = t;
    fa = ft;
    const double nearest = std::abs(fa) < std::abs(fb) ? a : b;
    const double least = std::numeric_limits<double>::epsilon() * std::abs(nearest) + 1e-300;
    const double least_part = least / std::abs(b - a);
    if (least_part >= 0.5 || fa == 0.0 || fb == 0.0) return nearest;
    const double xi = (a - b) / (c - b);
    const double phi = (fa - fb) / (fc - fb);
    const bool interpolates = 1.0 - std::sqrt(1.0 - xi) < phi && phi < std::sqrt(xi);
    part = interpolates ? fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb) : 0.5;
    part = std::fmin(1.0 - least_part, std::fmax(least_part, part));
  }
  return a;
}

}  // namespace isorim::geometry
