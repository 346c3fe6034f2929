#pragma once

#include <Eigen/Core>

#include "geometry/propeller/blade_frames.h"
#include "geometry/propeller/profile_lines.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// One profile of a blade on the expanded plane of its cylinder.
struct BladeSection {
  BladeStation station;
  /// Between the leading and the trailing edge along the pitch line.
  double chord = 0.0;
  /// Abscissa of the leading edge; the trailing edge lies at leading_edge - chord.
  double leading_edge = 0.0;
  double max_thickness = 0.0;
  /// 2 x n: from the trailing edge along the back to the leading edge and along the face back. The first point is the
  /// back's trailing edge, the last one the face's; they are equal bit for bit where the edge is sharp.
  Points<2> outline;
  /// Column of the leading edge.
  Eigen::Index leading_edge_point = 0;
};

/// 3 x n points in space.
Points<3> outline_in_space(const BladeSection& section, Hand hand = Hand::right);

/// A section made of a thickness form laid off at right angles to a mean line.
struct ProfileSection {
  BladeStation station;
  double chord = 0.0;
  double max_thickness = 0.0;
  /// Largest distance of the mean line from the chord, towards the back.
  double max_camber = 0.0;
  ThicknessForm thickness = ThicknessForm::naca_66_mod;
  MeanLine camber = MeanLine::naca_a08;
};
/// The section with its middle of chord on the section's origin; `points_a_side` of them on the back and as many on the
/// face, the leading edge counted in both, spaced by the cosine. Throws GeometryError naming the quantity: chord or
/// thickness not positive, camber not finite, fewer than 3 points.
BladeSection profile_section(const ProfileSection& profile, int points_a_side = 25);

}  // namespace isorim::geometry
