#pragma once

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/trimming/trimmed_surface.h"
#include "geometry/tspline/extracted_surface.h"

namespace isorim::geometry {

/// A piece of the boundary of a solid: a whole surface, a part of one, or a surface by its extraction (a T-spline).
using SurfaceShape = std::variant<NurbsSurface<3>, TrimmedSurface, ExtractedSurface>;

/// What a boundary in Dim dimensions is made of: curves in the plane, surfaces in space.
template <int Dim>
using PatchShape = std::conditional_t<Dim == 2, NurbsCurve<2>, SurfaceShape>;

/// The surface that carries the shape. Throws GeometryError for an extracted surface, which has none: ShapeLoops
/// (topology/shape_loops.h) knows the surface of each of its elements.
const NurbsSurface<3>& surface_of(const SurfaceShape& shape);
/// The loops that bound the shape in the surface's parameters; the domain's rectangle for a whole surface. Throws as
/// surface_of() does.
std::vector<TrimLoop> trim_loops(const SurfaceShape& shape);
SurfaceShape transform(const SurfaceShape& shape, const AffineMap<3>& map);

/// One piece of a boundary. Its outward normal is `orientation` times the natural one: (y', -x') for a plane curve
/// (the domain on its left), S_u x S_v for a surface. The shape itself stays as it was given.
template <int Dim>
struct Patch {
  /// Unique within a boundary; what boundary conditions and messages call it.
  std::string name;
  PatchShape<Dim> shape;
  /// +1 or -1.
  int orientation = 1;
};

/// The boundary of a region of the plane (Dim = 2) or of a solid (Dim = 3).
template <int Dim>
struct Boundary {
  std::vector<Patch<Dim>> patches;
};

}  // namespace isorim::geometry
