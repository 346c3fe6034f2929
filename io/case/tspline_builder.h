#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/tspline/tspline.h"
#include "io/case/shape_keys.h"

/// From the keys of T-splines to T-splines. Every function throws InputError that begins with file, line
/// and key.
namespace isorim::io {

/// The T-splines of the keys, refined: that of the T-mesh, or one for each patch of `source`, what stands in "from", of
/// the degrees asked for at least. Refuses a trimmed patch and regions that hold no part of any of the surfaces.
std::vector<geometry::TSpline> tsplines(const geometry::Boundary<3>& source, const TSplineKeys& keys);

}  // namespace isorim::io
