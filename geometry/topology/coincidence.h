#pragma once

#include "geometry/bezier/element_table.h"

namespace isorim::geometry {

/// The distance up to which points of a boundary within `box` count as the same: `relative` times the diagonal.
/// Throws GeometryError if the box is a point; if its diagonal is outside [1e-60, 1e60], where fifth powers of lengths
/// (moments of inertia) leave the range of double precision; or if the distance is finer than the rounding of the
/// coordinates.
template <int Dim>
double coincidence_tolerance(const BoundingBox<Dim>& box, double relative);

}  // namespace isorim::geometry
