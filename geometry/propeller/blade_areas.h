#pragma once

#include <span>

#include "geometry/propeller/blade_section.h"

namespace isorim::geometry {

/// Areas of one blade outside a radius, in the square of the sections' unit; definitions of the ITTC's dictionary of
/// ship hydrodynamics.
struct BladeAreas {
  /// The chords, between the edges along the pitch line, laid off straight: their integral over the radius.
  double expanded = 0.0;
  /// The edges laid off from the generator line along arcs of the pitch helix's radius of curvature r / cos^2 phi
  /// (which goes through the generator line at the radius r).
  double developed = 0.0;
  /// The outline seen along the shaft.
  double projected = 0.0;

  /// All times a factor.
  BladeAreas scaled(double factor) const { return {factor * expanded, factor * developed, factor * projected}; }
};

/// Of the blade through the sections (see blade_surface()) outside the hub's radius: edges, pitch, skew and rake
/// between the sections are cubic splines of the surface's parameter v. Inward of the first section they continue as
/// the polynomials that they are. The integrals are met to 1e-9 of themselves.
///
/// Throws GeometryError as blade_surface() does for the sections' radii, and if the hub covers the blade.
BladeAreas blade_areas(std::span<const BladeSection> sections, double hub_radius);

/// pi D^2 / 4.
double disc_area(double diameter);

}  // namespace isorim::geometry
