#pragma once

#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/trimming/trimmed_surface.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// Chains directed curves into loops with the region on their left: each end is joined with a start within `tolerance`
/// in each coordinate, after division by `scale`. Where several curves leave a place, the one that turns most to the
/// left follows, so loops touch but do not cross. Ends that differ by at most `closing` (in the same measure) are made
/// equal. Curves that are shorter than the tolerance are
/// left out but where they lead exactly from one end to the next start.
///
/// Throws GeometryError, with the place, if some end has no start to go on with, or the other way round.
std::vector<TrimLoop> chain_directed_curves(const std::vector<NurbsCurve<2>>& curves, const Vector2& scale,
                                            double tolerance, double closing);

/// Twice the area that a loop encloses, counter-clockwise positive, to within rounding of its extent.
double doubled_area(const TrimLoop& loop);

}  // namespace isorim::geometry
