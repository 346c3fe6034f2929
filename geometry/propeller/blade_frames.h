#pragma once

#include "geometry/vocabulary.h"

/// The three systems in which a propeller blade is described (Garcia 1999, section 4.1 and eqs. 4-1 to 4-7), with maps
/// both ways.
///
/// Space: X along the shaft, forward; Z along the blade's generator line; Y = Z x X. Cylinder: X, the distance from the
/// shaft, and the angle from Z about X, positive towards the leading edge. Expanded plane: what lies on one cylinder,
/// unrolled; x along the pitch line, positive towards the leading edge, y towards the back (the suction side, forward);
/// the origin is the foot of the generator line, moved by rake and skew.
namespace isorim::geometry {

/// The sense of rotation, seen from astern, when the ship goes ahead.
enum class Hand { right, left };

/// Where a blade section lies: on the cylinder of a radius, along a helix.
struct BladeStation {
  double radius = 1.0;
  /// How far the helix advances in a turn.
  double pitch = 0.0;
  /// Radians; positive: the section lags behind the generator line, along its helix.
  double skew = 0.0;
  /// Length; positive aft. What the skew adds along the helix is not part of it.
  double rake = 0.0;

  /// Between the pitch line and the plane across the shaft.
  double pitch_angle() const;
};

struct CylindricalPoint {
  double axial = 0.0;
  double radius = 0.0;
  /// Radians.
  double angle = 0.0;
};

CylindricalPoint to_cylinder(const BladeStation& station, const Point2& expanded);
/// The inverse; of the angles that mean the same the one within half a turn of the section's origin is taken. The
/// point's radius is not looked at: points near the cylinder are projected along their radius.
Point2 to_expanded(const BladeStation& station, const CylindricalPoint& point);

Point3 to_space(const CylindricalPoint& point, Hand hand = Hand::right);
/// The angle in (-pi, pi]; 0 on the shaft.
CylindricalPoint to_cylinder(const Point3& point, Hand hand = Hand::right);

inline Point3 to_space(const BladeStation& station, const Point2& expanded, Hand hand = Hand::right) {
  return to_space(to_cylinder(station, expanded), hand);
}
inline Point2 to_expanded(const BladeStation& station, const Point3& point, Hand hand = Hand::right) {
  return to_expanded(station, to_cylinder(point, hand));
}

}  // namespace isorim::geometry
