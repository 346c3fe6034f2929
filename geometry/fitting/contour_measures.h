#pragma once

#include <algorithm>
#include <utility>

#include "geometry/fitting/contour_ordering.h"
#include "geometry/vocabulary.h"

/// Of polygons. Private to the sources of this folder.
namespace isorim::geometry {

/// Signed: positive if the closed polygon runs counter-clockwise. Taken about the first point.
inline double polygon_area(const Points<2>& points) {
  double twice = 0.0;
  for (Eigen::Index i = 1; i + 1 < points.cols(); ++i) {
    const Vector2 a = points.col(i) - points.col(0);
    const Vector2 b = points.col(i + 1) - points.col(0);
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// Turns a closed contour counter-clockwise, and measures its largest gap.
inline void finish(Contour& contour) {
  if (contour.closed && polygon_area(contour.points) < 0.0) {
    contour.points = contour.points.rowwise().reverse().eval();
    std::ranges::reverse(contour.weights);
  }
  const Eigen::Index count = contour.points.cols();
  contour.largest_gap = 0.0;
  for (Eigen::Index i = contour.closed ? 0 : 1; i < count; ++i) {
    const Eigen::Index before = (i + count - 1) % count;
    contour.largest_gap = std::max(contour.largest_gap, (contour.points.col(i) - contour.points.col(before)).norm());
  }
}

}  // namespace isorim::geometry
