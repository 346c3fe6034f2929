#include "geometry/intersection/angle_gap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace isorim::geometry {

double angle_in_widest_gap(std::vector<double> angles, double period) {
  constexpr double share = 0.4637;
  for (double& angle : angles) angle -= period * std::floor(angle / period);
  std::ranges::sort(angles);
  angles.push_back(angles.front() + period);
  double widest = 0.0;
  double seam = 0.0;
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    const double gap = angles[i + 1] - angles[i];
    if (gap <= widest) continue;
    widest = gap;
    seam = angles[i] + share * gap;
  }
  return seam;
}

}  // namespace isorim::geometry
