#pragma once

#include <vector>

#include "geometry/intersection/element_zero_set.h"

/// For element_zero_set.cpp: the pieces of the zero set in the cells of the subdivision.
namespace isorim::geometry {

struct ZeroArc {
  /// At least two; g is negative on the left.
  std::vector<Point2> points;
  bool singular_start = false;
  bool singular_end = false;
};

std::vector<ZeroArc> zero_arcs(const ElementFunction& function, SideCharts& charts);

}  // namespace isorim::geometry
