#pragma once

#include <string>
#include <vector>

#include "geometry/fitting/curve_fit.h"

namespace isorim::geometry {

/// The points of one section of a body, in order, in the coordinates of its plane.
struct SectionPoints {
  /// What messages call it.
  std::string name;
  Points<2> points;
  /// Of the weights, those of this section.
  CurveFitOptions<2> options;
};

/// Closed curves through the sections of a body, each of one contour, aligned so that they start in corresponding
/// points: on common knots, so that nothing has to be merged when they are skinned.
///
/// Every section is fitted by itself first; the common knots are the means of theirs, and the curves are fitted anew on
/// those. The number of control points is the one asked for, else the largest that a section takes; with a tolerance it
/// grows until that is met on the common knots. Where corners differ by number or place, and with method pereira, the
/// sections keep their own knots.
///
/// The options of all sections are the same but for point_weights. Throws as fit_points() does, with the name of the
/// section. Costs about two fits a section, more with a tolerance.
std::vector<CurveFit<2>> fit_sections(const std::vector<SectionPoints>& sections);

}  // namespace isorim::geometry
