#pragma once

#include <optional>
#include <vector>

namespace isorim::geometry {

/// The middle of the gap between two heaps of values: the split with the largest variance between its parts (N. Otsu,
/// A threshold selection method from gray-level histograms, IEEE Trans. Syst. Man Cybern. 9, 1979). Nothing if that is
/// at most `least_share` of the whole variance (0.64 for one normal heap, 0.75 for an even one, 0.86 for two normal
/// ones five standard deviations apart), if a part holds less than a tenth of the values, or for less than 24 values.
std::optional<double> split_of_heaps(std::vector<double> values, double least_share);

}  // namespace isorim::geometry
