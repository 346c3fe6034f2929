#pragma once

#include <vector>

#include "geometry/vocabulary.h"

/// Bands of noisy points to their middle lines. Private to the sources of this folder.
namespace isorim::geometry {

struct ThinnedPoints {
  /// 2 x n.
  Points<2> points;
  /// Sums of the weights of the points that each stands for.
  std::vector<double> weights;
  /// Which these are, columns of what was given; every column is in one of the lists.
  std::vector<std::vector<int>> members;
};

/// Moves every point onto the middle line of the band that it lies in, and merges them to steps of a sixth of the
/// neighbourhood's radius.
///
/// The neighbourhood of a point is the smallest disc about it in which the standard deviation across the direction of
/// the points is at most 0.3 of that along it (so about six times the standard deviation of the noise), the median of
/// those of its neighbours taken. There the middle line is the parabola of weighted least squares, weights falling to 0
/// at the radius (I.-K. Lee, CAGD 17, 2000). No radius exceeds 1.5 times their median. Where the offsets from that line
/// fall into two heaps, two bands lie side by side, and only the points of the own one count.
ThinnedPoints thin_band(const Points<2>& points, const std::vector<double>& weights);

}  // namespace isorim::geometry
