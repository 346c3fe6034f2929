#pragma once

#include <optional>
#include <vector>

#include "geometry/hull/fairness.h"
#include "geometry/hull/offset_table.h"
#include "geometry/nurbs/surface.h"

namespace isorim::io {

/// What `fair` has done to a table of offsets.
struct HullFairing {
  double tolerance = 0.0;
  /// Half-breadths, and the largest move.
  int moved = 0;
  double largest_move = 0.0;
  /// As geometry::FairedOffsets has them.
  double roughness_before = 0.0;
  double roughness = 0.0;
  /// Of the surface through the table as it was.
  geometry::HullFairness before;
};

/// What is known of a hull besides its boundary; before any transform of the shape. Lengths in its unit.
struct HullFacts {
  /// As it was built, scaled, faired and shifted; of "wigley" offsets at 21 stations and 9 waterlines.
  geometry::OffsetTable table;
  /// The port half, from the keel upwards.
  std::vector<geometry::NurbsSurface<3>> port;
  /// Of the curve of sectional areas up to the design draught.
  double prismatic = 0.0;
  /// Forward of amidships, over the length.
  double buoyancy_centre = 0.0;
  /// The largest distance of an offset, as it was before fairing, from the surface.
  double offset_distance = 0.0;
  geometry::HullFairness fairness;
  std::optional<HullFairing> fairing;
};

}  // namespace isorim::io
