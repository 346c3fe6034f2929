#pragma once

#include <span>
#include <vector>

#include "geometry/spline/bspline.h"

/// Blades whose chord goes to nothing at the tip with a rounded outline.
///
/// Near such a tip the edges go as the root of the distance from it, so they are smooth functions of
/// s = sqrt(1 - r / R), and so is the outline as a whole if s is taken negative along the trailing edge.
namespace isorim::geometry {

struct OutlineEdges {
  double leading = 0.0;
  double trailing = 0.0;
};

/// Leading and trailing edge on the expanded plane against r / R, one curve with continuous curvature that runs from
/// the root along the trailing edge round the tip and back along the leading edge: the cubic spline in s through the
/// rows of a table and the tip. The tip lies where the middle of the chord leads to: at r / R = 1 on the polynomial
/// through its last rows, four at most.
class RoundedOutline {
 public:
  /// Throws GeometryError if the counts differ, there are fewer than two rows, or the radii do not rise or reach 1.
  RoundedOutline(std::span<const double> radius_ratios, std::span<const OutlineEdges> edges);

  /// r / R in [0, 1].
  OutlineEdges operator()(double radius_ratio) const;

 private:
  BSpline spline_;
};

/// Radii at which a rounded tip is described beyond the last one of a table, evenly spaced in s; the last is 1.
std::vector<double> tip_radii(double last_radius_ratio);

/// What a blade's thickness, which ends in `tip_thickness` (over R), is multiplied by beyond the last radius of a
/// table, so that the tip is closed: 1 there, 0 at r / R = 1, tanh(s / sqrt(tip_thickness)) between, so that the
/// rounding reaches about as far inward as the tip is thick.
double tip_thickness_factor(double radius_ratio, double last_radius_ratio, double tip_thickness);

}  // namespace isorim::geometry
