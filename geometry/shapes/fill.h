#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/surface.h"

namespace isorim::geometry {

/// Exact patches that cover a plane region once, each with positive Jacobian (zero at its pole): what caps of extruded
/// and revolved solids are made of.
///
/// A loop without holes that is star-shaped becomes one fan() a curve from a point of its kernel. The kernel is found
/// for certain: (C - a) x C' is linear in the apex a, so each of its Bernstein coefficients gives a half-plane, and the
/// apex is the centroid of their intersection. Other regions are cut into curved triangles: the curves in monotone
/// Bézier pieces, holes bridged to the outer loop, ears (two pieces and a straight diagonal that meets no other piece)
/// clipped, shortest diagonal first, each ear being filled as a star-shaped loop; where that comes to a halt the curved
/// pieces are halved and it starts again.
///
/// Throws GeometryError as orient() does, if the region is open, and if loops touch or run so close that the cutting
/// does not succeed after a few halvings (the message gives the place).
std::vector<NurbsSurface<2>> fill(const Boundary<2>& region);

}  // namespace isorim::geometry
