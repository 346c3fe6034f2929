#pragma once

#include <vector>

#include "geometry/propeller/blade_section.h"
#include "geometry/propeller/radial_law.h"

namespace isorim::geometry {

/// A row of a blade's table; lengths in the unit of the diameter.
struct BladeTableRow {
  double radius_ratio = 0.0;
  double chord = 0.0;
  double pitch = 0.0;
  /// Radians.
  double skew = 0.0;
  double rake = 0.0;
  double max_thickness = 0.0;
  double max_camber = 0.0;
};

/// A blade by a table of its own: sections of one thickness form and mean line, the middle of each chord on the
/// section's origin.
struct TableBlade {
  double diameter = 1.0;
  /// From the root to the tip.
  std::vector<BladeTableRow> rows;
  ThicknessForm thickness = ThicknessForm::naca_66_mod;
  MeanLine camber = MeanLine::naca_a08;
  int points_a_side = 25;
};

/// A section for each row. Where the last row, at r / R = 1, has no chord, the tip is round in outline: two more
/// sections lie between it and the row before (tip_outline.h), of pitch, skew, rake and thickness by RadialLaw and the
/// camber's ratio to the chord, the thickness rounded off; the last section is a point.
///
/// Throws GeometryError, naming the row, for fewer than three rows, radii that do not rise or do not end at 1, what is
/// not finite, a chord or thickness that is not positive (but for a tip without chord).
std::vector<BladeSection> table_sections(const TableBlade& blade);

/// A section by the points of its outline on the expanded plane, 2 x n: from the trailing edge along the back to the
/// leading edge, the point with the largest x, and along the face back. Throws GeometryError for fewer than five
/// points, what is not finite, an outline that runs along the face first, and a leading edge that is an end of it.
BladeSection point_section(const BladeStation& station, Points<2> outline);

}  // namespace isorim::geometry
