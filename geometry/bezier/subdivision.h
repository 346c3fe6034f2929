#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace isorim::geometry {

/// The control nets of the two halves of a Bézier element, cut at `fraction` in (0, 1) of one direction (de
/// Casteljau; Piegl & Tiller, A1.5 and A1.7). The net is column-major with `rows` homogeneous coordinates a point and
/// the first direction fastest, as in ElementTable::nets; degrees.size() is 1 or 2.
std::pair<std::vector<double>, std::vector<double>> subdivide(std::span<const double> net, int rows,
                                                              std::span<const int> degrees, int direction,
                                                              double fraction = 0.5);

}  // namespace isorim::geometry
