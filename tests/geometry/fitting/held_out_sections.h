#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/foot_points.h"

namespace isorim::geometry::testing {

/// Closed curves that the rules of the fit were not chosen by, with the points of a scan of them: the truth is known.
/// fit_against_scipy.py says the same in Python.
inline const std::array<std::string, 4> held_out_names{"ellipse", "lobes", "bump", "foil"};

/// t in [0, 1).
inline Point2 held_out_point(std::size_t shape, double t) {
  using std::numbers::pi;
  const double c = std::cos(2 * pi * t);
  const double s = std::sin(2 * pi * t);
  switch (shape) {
    case 0:
      return {1.5 * c, 0.5 * s};
    case 1: {
      const double r = 1.0 + 0.25 * std::cos(6 * pi * t) + 0.1 * std::sin(10 * pi * t);
      return {r * c, r * s};
    }
    case 2: {
      const double r = 1.0 + 0.3 * std::exp(-360.0 * (t - 0.48) * (t - 0.48));
      return {1.4 * r * c, r * s};
    }
    default: {
      const double x = 0.5 * (1.0 + c);
      return {2.0 * x, 0.24 * s * (1.0 - 0.9 * x * x) + 0.1 * std::sin(pi * x)};
    }
  }
}

/// Uneven in t; displaced by what is not related to their order, root mean square `noise` in each coordinate.
inline Points<2> held_out_scan(std::size_t shape, int count, double noise) {
  Points<2> points(2, count);
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.2 * std::sin(7.1 * i)) / count;
    const Vector2 scatter(std::sin(12.9898 * i * i), std::sin(78.233 * i * i));
    points.col(i) = held_out_point(shape, t) + std::numbers::sqrt2 * noise * scatter;
  }
  return points;
}

/// The root mean square distance of the true curve from the fitted one.
inline double distance_from_truth(std::size_t shape, const NurbsCurve<2>& curve) {
  constexpr int samples = 1000;
  const SegmentedCurve<2> segments(curve.knots(), curve.control_points(), true);
  double sum = 0.0;
  double guess = 0.0;
  for (int i = 0; i < samples; ++i) {
    const ClosestCurvePoint<2> nearest =
        segments.nearest(held_out_point(shape, static_cast<double>(i) / samples), guess);
    sum += nearest.distance * nearest.distance;
    guess = nearest.u;
  }
  return std::sqrt(sum / samples);
}

}  // namespace isorim::geometry::testing
