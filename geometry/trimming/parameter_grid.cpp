#include "geometry/trimming/parameter_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isorim::geometry {

GridAxis::GridAxis(const KnotVector& knots)
    : lines_(knots.breakpoints()),
      tolerance_(16.0 * std::numeric_limits<double>::epsilon() *
                 std::max(std::abs(lines_.front()), std::abs(lines_.back()))) {}

GridCoordinate GridAxis::locate(double value) const {
  const int last = span_count();
  if (value <= lines_.front()) return {lines_.front(), 0};
  if (value >= lines_.back()) return {lines_.back(), 2 * last};
  const int above = static_cast<int>(std::upper_bound(lines_.begin(), lines_.end(), value) - lines_.begin());
  const int nearest = value - line(above - 1) <= line(above) - value ? above - 1 : above;
  if (std::abs(value - line(nearest)) <= tolerance_) return {line(nearest), 2 * nearest};
  return {value, 2 * above - 1};
}

}  // namespace isorim::geometry
