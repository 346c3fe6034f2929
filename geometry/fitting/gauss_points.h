#pragma once

#include <vector>

namespace isorim::geometry {

struct GaussPoint {
  double node = 0.0;
  double weight = 0.0;
};

/// The Gauss-Legendre rule of 1 or more points on [0, 1], to rounding.
std::vector<GaussPoint> gauss_points(int count);

}  // namespace isorim::geometry
