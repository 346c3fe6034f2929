#pragma once

#include "geometry/boundary.h"
#include "geometry/tspline/tspline.h"
#include "io/case/shape_keys.h"

/// From the keys of T-splines to T-splines. Every function throws InputError that begins with file, line
/// and key.
namespace isorim::io {

/// The T-spline that the knots, lines and points describe, refined.
geometry::TSpline mesh_tspline(const TSplineKeys& keys);

/// A NURBS patch as a T-spline, of the degrees asked for at least, refined. Refuses a trimmed patch.
geometry::TSpline as_tspline(const geometry::Patch<3>& patch, const TSplineKeys& keys);

}  // namespace isorim::io
