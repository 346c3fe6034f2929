#pragma once

#include <string>

#include "io/drawing/drawing.h"
#include "io/propeller/propeller_facts.h"

/// The drawing that shows a propeller as a whole.
namespace isorim::io {

struct OverviewOptions {
  /// Of the case's lengths.
  double millimetres = 1.0;
  /// The drawing's lengths are the propeller's over this. 0: the first of 1, 1.5, 2, 2.5, 3, 4, 5, 7.5, 10, ... with
  /// which the sheet is no larger than A3.
  double scale = 0.0;
};

struct Overview {
  drawing::Sheet sheet;
  /// True lengths over those on the sheet.
  double scale = 1.0;
};

/// The five views of tradition side by side (Garcia 1999, figure 4.1), of the first blade, radii upwards from the shaft
/// in all of them: profile (from starboard: edges of the blade, generator line with the greatest thickness laid off on
/// both sides of it, hub), transverse view (from astern), expanded outline with the sections on it, and pitch over
/// radius; below them a table of the sections, a scale bar and the title block. Curves between the sections are the
/// blade's own edges, or cubic splines of the parameter v. Throws InputError if the scale is negative or not finite.
Overview propeller_overview(const PropellerFacts& facts, const std::string& title, const OverviewOptions& options = {});

}  // namespace isorim::io
