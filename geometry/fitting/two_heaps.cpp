#include "geometry/fitting/two_heaps.h"

#include <algorithm>
#include <cstddef>

namespace isorim::geometry {

std::optional<double> split_of_heaps(std::vector<double> values, double least_share) {
  constexpr std::size_t fewest = 24;
  constexpr double smallest_part = 0.1;
  const std::size_t count = values.size();
  if (count < fewest) return std::nullopt;
  std::ranges::sort(values);
  const double n = static_cast<double>(count);
  double sum = 0.0;
  for (const double value : values) sum += value;
  double variance = 0.0;
  for (const double value : values) variance += (value - sum / n) * (value - sum / n) / n;
  double below = 0.0;
  double best = 0.0;
  std::size_t first_above = 0;
  for (std::size_t i = 1; i < count; ++i) {
    below += values[i - 1];
    const double part = static_cast<double>(i) / n;
    const double distance = (sum - below) / (n - static_cast<double>(i)) - below / static_cast<double>(i);
    const double between = part * (1.0 - part) * distance * distance;
    if (between <= best) continue;
    best = between;
    first_above = i;
  }
  const double smaller = static_cast<double>(std::min(first_above, count - first_above)) / n;
  if (!(best > least_share * variance) || smaller < smallest_part) return std::nullopt;
  return 0.5 * (values[first_above - 1] + values[first_above]);
}

}  // namespace isorim::geometry
