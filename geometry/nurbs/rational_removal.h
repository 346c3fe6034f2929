#pragma once

#include "geometry/spline/bspline.h"

namespace isorim::geometry {

/// Knot removal for a spline whose coefficient columns are stacks of homogeneous points (Dim + 1 rows each): one for
/// a curve, a whole row of the net for a surface. No point moves by more than `tolerance` in space, and weights stay
/// positive. Piegl & Tiller, eq. 5.30, with the smallest weight before and after.
template <int Dim>
KnotRemoval remove_rational_knot(BSpline spline, double u, int times, double tolerance);

}  // namespace isorim::geometry
