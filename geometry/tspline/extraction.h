#pragma once

#include "geometry/boundary.h"
#include "geometry/nurbs/surface.h"
#include "geometry/tspline/extracted_surface.h"

/// Surfaces of other kinds by their extraction.
namespace isorim::geometry {

/// The same surface by the elements of its knot spans, u fastest; its functions are the tensor-product B-splines, in
/// the order of the control points.
ExtractedSurface extracted_surface(const NurbsSurface<3>& surface);

/// The same surface seen from the other side: the first parameter of every element reversed (s becomes -s).
ExtractedSurface reversed(const ExtractedSurface& surface);

/// All patches as one surface, patch by patch, each with functions of its own; those with orientation -1 are reversed,
/// so that every natural normal is the outward one. Throws GeometryError, naming the patch, for a trimmed one.
ExtractedSurface extracted_surface(const Boundary<3>& boundary);

}  // namespace isorim::geometry
