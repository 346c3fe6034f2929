#pragma once

#include <span>

#include "geometry/tspline/tmesh.h"

namespace isorim::geometry {

/// A part of the knot line u = knot or v = knot, by the range of the other parameter.
struct PartialLine {
  double knot = 0.0;
  Interval range;
};

/// The T-mesh drawn by its lines: those of knots that stand in a list are there over the ranges given with the knot,
/// all others run through. Where a knot is repeated all of its lines have the same parts; a part that ends at a
/// repeated knot ends at the nearest of its lines.
///
/// Throws GeometryError for a knot or an end of a range that is no knot of the domain (the knot: strictly inside), an
/// empty range, an end that no line crosses, a corner of two lines, and as TMesh does.
TMesh mesh_of_lines(const KnotVector& knots_u, const KnotVector& knots_v, std::span<const PartialLine> lines_u,
                    std::span<const PartialLine> lines_v);

}  // namespace isorim::geometry
