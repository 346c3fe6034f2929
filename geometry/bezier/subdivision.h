#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// The control nets of the two halves of a Bézier element, cut at `fraction` in (0, 1) of one direction (de
/// Casteljau; Piegl & Tiller, A1.5 and A1.7). The net is column-major with `rows` homogeneous coordinates a point and
/// the first direction fastest, as in ElementTable::nets; degrees.size() is 1 or 2.
std::pair<std::vector<double>, std::vector<double>> subdivide(std::span<const double> net, int rows,
                                                              std::span<const int> degrees, int direction,
                                                              double fraction = 0.5);

/// Replaces the net of a Bézier element by that of its part over `piece` (within [0, 1]) of one direction. Equal
/// coordinates stay equal bit for bit.
void restrict_net(std::span<double> net, int rows, std::span<const int> degrees, int direction, Interval piece);

}  // namespace isorim::geometry
