#pragma once

#include <array>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"

namespace isorim::io {

/// The kept part of an element as flat triangles with their vertices on the surface.
struct RegionTriangles {
  /// 2 x n, in the element's unit cell.
  geometry::Points<2> parameters;
  /// 3 x n, on the surface to rounding.
  geometry::Points<3> points;
  /// Counter-clockwise in the unit cell.
  std::vector<std::array<int, 3>> triangles;
};

/// Triangles over the region of a cut element. No edge, and no middle of a triangle, is farther than
/// `chord_tolerance` (in the units of the shape) from the surface; nor is an edge of the region from the curve that it
/// stands for. Neighbouring triangles share their vertices; those of two elements need not.
///
/// The polygons that the region's curves become are filled by vtkContourTriangulator, or where that fails (loops that
/// touch) by trapezoids between all their vertices; then edges are flipped towards Delaunay's condition and bisected
/// until the surface is met (Lawson 1977; red-green refinement, Bank 1983).
RegionTriangles triangulate_region(const geometry::ElementTable<3>& table, const geometry::BezierElement<3>& element,
                                   double chord_tolerance);

}  // namespace isorim::io
