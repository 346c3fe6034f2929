#pragma once

#include <string>
#include <vector>

#include "geometry/propeller/blade_section.h"
#include "geometry/propeller/radial_law.h"

namespace isorim::geometry {

enum class BladeSeries {
  /// The ducted Ka series.
  kaplan,
  /// Wageningen B (Troost).
  wageningen_b,
};

/// A blade of a systematic series. Lengths are in the units of the diameter.
struct SeriesBlade {
  BladeSeries series = BladeSeries::kaplan;
  double diameter = 1.0;
  int blades = 4;
  /// Expanded area of all blades over the area of the disc.
  double area_ratio = 0.6;
  /// Pitch over diameter.
  RadialLaw pitch_ratio{1.0};
  /// Length, positive aft.
  RadialLaw rake{};
  /// Radians, added to what the series' outline has.
  RadialLaw skew{};
  /// Multiplies the pitch by the reduction towards the root that the four-bladed Wageningen B screws had.
  bool has_reduced_root_pitch = false;
};

/// Kaplan: the sections at r / R = 0.2, 0.3, .., 1.0, 25 points each. Wageningen B: those at 0.2, 0.3, .., 0.9, 39
/// points each, and beyond them three of the rounded tip (tip_outline.h), the last one a point as often as the others
/// have points. The series' tables leave the place of the tip open; their thickness there, 0.003 D, is rounded off, by
/// 1 % at 0.955 R and 12 % at 0.989 R. Edges are sharp.
///
/// Throws GeometryError naming the quantity if a length is not positive, the series has no table for the number of
/// blades (Kaplan 3 to 7, Wageningen B 3 to 7), or the reduced pitch is asked of another screw.
std::vector<BladeSection> series_sections(const SeriesBlade& blade);

/// What lies outside the range in which the series was tested (blades, area ratio, pitch ratio); empty: nothing.
std::vector<std::string> outside_tested_range(const SeriesBlade& blade);

}  // namespace isorim::geometry
