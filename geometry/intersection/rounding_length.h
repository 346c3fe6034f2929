#pragma once

#include <algorithm>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// The length of which positions are known to a few parts in 1e16: the diagonal of the box of a shape, or, of one that
/// lies farther from the origin than it is large, the largest coordinate.
inline double rounding_length(const Point3& lower, const Point3& upper) {
  return std::max({(upper - lower).norm(), lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()});
}

}  // namespace isorim::geometry
