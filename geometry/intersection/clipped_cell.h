#pragma once

#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/intersection/clipped_face.h"
#include "geometry/intersection/implicit_surface.h"
#include "geometry/intersection/implicit_trace.h"
#include "geometry/vocabulary.h"

/// Bézier elements cut by planes and quadrics one by one, for integrals over what is left of them: no faces, loops or
/// caps are made.
namespace isorim::geometry {

/// The part of an element's unit cell on the side where F is negative.
struct ClippedCell {
  enum class Extent { nothing, part, everything };
  Extent extent = Extent::nothing;
  /// What bounds a part, what is left on the left of each curve.
  TrimmedRegion region;
  /// The edges of what is left along which F vanishes, 3 x (p + 1) homogeneous points in the unit cell; sides of the
  /// element among them.
  std::vector<HomogeneousPoints<2>> cuts;
};

/// Of an element that is not cut already. Elements (and sides) on which F vanishes do not count as left. `options.size`
/// is that of the boundary; it must be positive. Some 50 microseconds for a bicubic element that a plane cuts. Throws
/// GeometryError, with the place in the unit cell, for singular points that ImplicitTrace refuses.
ClippedCell clip_cell(const ElementTable<3>& table, const BezierElement<3>& element, const ImplicitSurface& implicit,
                      const TraceOptions& options);

/// A cut element as a face of its own over the unit square.
CuttableFace cuttable_cell(const ElementTable<3>& table, const BezierElement<3>& element);

/// Of a cut element, as made by cuttable_cell().
ClippedCell clip_cell(const CuttableFace& cell, const ImplicitSurface& implicit, const TraceOptions& options);

}  // namespace isorim::geometry
