#pragma once

#include <vector>

#include "geometry/hull/fairness.h"
#include "geometry/hull/offset_table.h"
#include "geometry/nurbs/surface.h"

namespace isorim::io {

/// What is known of a hull besides its boundary; before any transform of the shape. Lengths in its unit.
struct HullFacts {
  /// As it was built, scaled and shifted; of "wigley" offsets at 21 stations and 9 waterlines.
  geometry::OffsetTable table;
  /// The port half, from the keel upwards.
  std::vector<geometry::NurbsSurface<3>> port;
  /// Of the curve of sectional areas up to the design draught.
  double prismatic = 0.0;
  /// Forward of amidships, over the length.
  double buoyancy_centre = 0.0;
  /// The largest distance of an offset from the surface.
  double offset_distance = 0.0;
  geometry::HullFairness fairness;
};

}  // namespace isorim::io
