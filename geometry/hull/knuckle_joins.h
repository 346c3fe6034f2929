#pragma once

#include "geometry/nurbs/surface.h"
#include "geometry/vocabulary.h"

/// Two ways in which surfaces meet along a knuckle, with exact contact and C2 on both sides of it.
namespace isorim::geometry {

/// One surface of two bands of a hull that meet along v = last of the lower and v = first of the upper one, whose knots
/// in u, degrees and control points there are the same: v runs over both domains one after the other, and the knuckle
/// is a knot whose multiplicity is the degree. Throws GeometryError for bands that do not meet so.
NurbsSurface<3> join_bands(const NurbsSurface<3>& lower, const NurbsSurface<3>& upper);

/// The bicubic surface over uniform knots whose control net is `net` (3 x (count_u count_v), u fastest) with every
/// border vertex taken three times: each border is a uniform cubic of its own vertices alone, so two surfaces whose
/// nets have a border in common meet along it exactly. It ends in the corner vertices and lies near the others; taking
/// offsets for the net loses volume. Nițu, Macovei & Dobran, Using B-spline technology in a ship hull design system,
/// IASTED MIC 1993; Barsky 1988. Throws GeometryError if there are fewer than two vertices along a side, or the count
/// is not that of the points.
NurbsSurface<3> triple_vertex_surface(const Points<3>& net, int count_u, int count_v);

}  // namespace isorim::geometry
