#pragma once

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"

namespace isorim::quadrature {

/// How often the region's boundary runs round a place of the cell: 1 inside, 0 outside; about a half on the boundary.
/// Exact but for rounding: a curve is bisected until its control points are seen within a half turn.
double winding_number(const geometry::TrimmedRegion& region, const geometry::Point2& place);

}  // namespace isorim::quadrature
