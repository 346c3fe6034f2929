#pragma once

#include <span>
#include <vector>

#include "geometry/hull/offset_table.h"
#include "geometry/nurbs/surface.h"

namespace isorim::geometry {

/// The port half of a hull with a bulb (sections with HullSection::is_in_bulb), from sections in the order of
/// hull_sections(): the hull below the line that runs aft from the notch between bulb and stem, the bulb ahead of the
/// notch, the hull above the line, and the bands above the knuckles.
///
/// Every full section is one C2 spline from keel to first knuckle (or deck), split where the last full section has the
/// height of the notch: the bulb's sections go on from the lower parts, the stem ends the upper ones. Along the ship
/// the lower parts are C2 through the bulb; the line itself has a corner at the notch, where the hull has one. Lower
/// part, bulb and upper part meet bit for bit; across the line they are smooth at every station, and between stations
/// up to what the rows on both sides differ, which fades out within a few stations abaft of the notch. u is x at the
/// stations and at the notch. The surface leaves the bulb's contour square to the centre plane: the nose is round.
///
/// Throws GeometryError if the notch does not lie between the ends of the last full section, or points coincide.
std::vector<NurbsSurface<3>> bulb_hull_surface(std::span<const HullSection> sections, bool uses_heights);

}  // namespace isorim::geometry
