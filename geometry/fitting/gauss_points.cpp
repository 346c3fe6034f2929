#include "geometry/fitting/gauss_points.h"

#include <cmath>
#include <numbers>

namespace isorim::geometry {

namespace {

/// By Newton's method on the Legendre polynomials.
std::vector<GaussPoint> gauss_rule(int count) {
  std::vector<GaussPoint> rule(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 20; ++step) {
      double before = 1.0;
      double value = x;
      for (int k = 2; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
      }
      slope = count * (x * value - before) / (x * x - 1.0);
      const double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    rule[static_cast<std::size_t>(i)] = {0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)};
  }
  return rule;
}

}  // namespace

std::vector<GaussPoint> gauss_points(int count) {
  switch (count) {
    case 1:
      return {{0.5, 1.0}};
    case 2:
      return {{0.21132486540518712, 0.5}, {0.78867513459481288, 0.5}};
    case 3:
      return {{0.11270166537925831, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.88729833462074169, 5.0 / 18.0}};
    default:
      return gauss_rule(count);
  }
}

}  // namespace isorim::geometry
