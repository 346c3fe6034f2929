#pragma once

#include <span>
#include <vector>

#include "geometry/spline/knot_vector.h"

namespace isorim::geometry {

/// The indices of parameters in the order of their spans (a counting sort).
class SpanOrder {
 public:
  SpanOrder(const KnotVector& knots, std::span<const double> parameters);

  /// Those in span p + s, from knot p + s to the next, s = 0 .. n - p - 1.
  std::span<const int> of(int s) const {
    const std::size_t first = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(s)]);
    return std::span<const int>(order_).subspan(
        first, static_cast<std::size_t>(offsets_[static_cast<std::size_t>(s) + 1]) - first);
  }

 private:
  std::vector<int> order_;
  /// Where each span begins, and the end.
  std::vector<int> offsets_;
};

}  // namespace isorim::geometry
