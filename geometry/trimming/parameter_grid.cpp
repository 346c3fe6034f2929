#include "geometry/trimming/parameter_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace isorim::geometry {

GridAxis::GridAxis(const KnotVector& knots)
    : lines_(knots.breakpoints()),
      tolerance_(16.0 * std::numeric_limits<double>::epsilon() *
                 std::max(std::abs(lines_.front()), std::abs(lines_.back()))) {
  merge_lines();
}

void GridAxis::merge_lines() {
  const std::vector<double> all = std::exchange(lines_, {});
  const double end = all.back();
  spans_.reserve(all.size() - 1);
  lines_.push_back(all.front());
  for (std::size_t i = 1; i < all.size(); ++i) {
    const bool is_nothing = all[i] - all[i - 1] <= 8.0 * tolerance_;
    spans_.push_back(is_nothing ? -1 : static_cast<int>(lines_.size()) - 1);
    if (!is_nothing) lines_.push_back(all[i]);
  }
  // A domain that is nothing altogether keeps one span.
  if (lines_.size() == 1) {
    lines_.push_back(end);
    spans_.back() = 0;
  }
  lines_.back() = end;
}

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
