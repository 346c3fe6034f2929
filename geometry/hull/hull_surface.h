#pragma once

#include <span>
#include <vector>

#include "geometry/hull/offset_table.h"
#include "geometry/nurbs/surface.h"

namespace isorim::geometry {

/// Where along a section its points lie in the surface's parameter v.
enum class SectionParameters {
  /// Heights where no section between two points leans over by more than 2 in half-breadth to 1 in height, else chord
  /// lengths.
  automatic,
  heights,
  chord_lengths,
};

struct HullSurfaceOptions {
  SectionParameters parameters = SectionParameters::automatic;
};

/// The port half of a hull between its keel and its deck: one surface for each band between knuckles, from the keel
/// upwards. u is x at every station (and the mean of x along a contour), v runs over [0, 1] upwards; bicubic and C2
/// where there are points enough. The natural normal points inward.
///
/// All points of the sections lie on it to rounding. Neighbouring bands have the knuckle in common bit for bit, control
/// point by control point. Parts that the table has as flat are exactly flat: where three or more successive points
/// of a station, or stations of a row of control points, have one half-breadth, the surface keeps it; at the ends of
/// the hull, the keel and the deck two half-breadths of 0 do. Along the ship the surface does not go beyond the centre
/// plane where points come near it: control points that would are put on it. What the points leave open is as smooth as
/// possible (SmoothestSpline), first along the sections, then across. A biquadratic y(x, z) is reproduced.
///
/// Where there is a bulb the lowest band is three surfaces: the hull below the line that runs aft from the notch
/// between bulb and stem, the bulb ahead of the notch, and the hull above the line (bulb_hull_surface()).
///
/// Throws GeometryError for fewer than two sections, sections whose mean x do not rise, points that coincide.
std::vector<NurbsSurface<3>> hull_surface(std::span<const HullSection> sections,
                                          const HullSurfaceOptions& options = {});

/// The parameters u of the sections.
std::vector<double> section_parameters(std::span<const HullSection> sections);

}  // namespace isorim::geometry
