#pragma once

#include <span>

#include "geometry/boundary.h"
#include "geometry/hull/hull_surface.h"
#include "geometry/hull/offset_table.h"

namespace isorim::geometry {

/// Closes the port half of a hull (hull_surface()) with its image and plane or ruled surfaces: "port" and "starboard"
/// ("port_1", ... from the keel upwards where there are knuckles); "bottom", "deck", "stern" and "stem" where the
/// half-breadth along the keel, the deck and the ends is not zero, ruled across the ship; with numbers if there are
/// several pieces. Oriented outward. Throws GeometryError if that leaves it open.
Boundary<3> close_hull(std::span<const NurbsSurface<3>> port);

/// The surface through the table's offsets, closed.
Boundary<3> hull_solid(const OffsetTable& table, const HullSurfaceOptions& options = {});

/// The port half of Wigley's hull y = (B / 2) (1 - (2 x / L)^2) (1 - ((z - T) / T)^2), |x| <= L / 2, 0 <= z <= T:
/// biquadratic, exact. Volume 4/9 L B T. Throws GeometryError for lengths that are not positive.
NurbsSurface<3> wigley_surface(double length, double beam, double draught);

/// Its offsets at equally spaced stations and waterlines, x = 0 amidships.
OffsetTable wigley_offsets(double length, double beam, double draught, int stations = 21, int waterlines = 9);

}  // namespace isorim::geometry
