#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/propeller/blade_areas.h"
#include "geometry/propeller/propeller.h"

/// What is known of a propeller besides its boundary, before any transform of the shape.
namespace isorim::io {

struct PropellerFacts {
  geometry::Propeller screw;
  double diameter = 0.0;
  /// Expanded area over the disc's that was asked for; nothing for blades by tables of their own.
  std::optional<double> asked_area_ratio;
  geometry::BladeKnots knots;
  /// Of all blades over the disc's area, outside `hub_radius`: of a hub by its profile, the radius where the generator
  /// line meets it; without a hub that of the first section.
  geometry::BladeAreas area_ratios;
  double hub_radius = 0.0;
  /// If the blades stand on the hub's profile and not on a cylinder.
  std::optional<geometry::ProfileFeet> feet;
  /// The hub alone.
  std::optional<geometry::Boundary<3>> hub;
  /// The whole screw, if the shape of the case is another: moved or cut.
  std::optional<geometry::Boundary<3>> whole;
  std::vector<std::string> warnings;
};

}  // namespace isorim::io
