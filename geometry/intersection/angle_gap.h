#pragma once

#include <vector>

namespace isorim::geometry {

/// An angle for the seam of a surface of revolution: in the widest gap between `angles` (radians, in any order, taken
/// modulo `period`), near its middle but not on it, so that symmetric drawings do not meet the seam in their vertices.
/// In [0, 2 period). `angles` must not be empty.
double angle_in_widest_gap(std::vector<double> angles, double period);

}  // namespace isorim::geometry
