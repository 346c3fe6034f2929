#include "geometry/propeller/blade_frames.h"

#include <cmath>
#include <numbers>

namespace isorim::geometry {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// The unit vector along the pitch line: (along the shaft, round it).
Vector2 helix_direction(const BladeStation& station) {
  return Vector2(station.pitch, two_pi * station.radius).normalized();
}

/// Of the section's origin: a skewed section moves along its helix.
double origin_axial(const BladeStation& station) {
  return -(station.rake + station.pitch * station.skew / two_pi);
}

double side_of(Hand hand) {
  return hand == Hand::right ? -1.0 : 1.0;
}

}  // namespace

double BladeStation::pitch_angle() const {
  return std::atan2(pitch, two_pi * radius);
}

CylindricalPoint to_cylinder(const BladeStation& station, const Point2& expanded) {
  const Vector2 along = helix_direction(station);
  const double axial = origin_axial(station) + expanded.x() * along.x() + expanded.y() * along.y();
  const double arc = expanded.x() * along.y() - expanded.y() * along.x();
  return {axial, station.radius, arc / station.radius - station.skew};
}

Point2 to_expanded(const BladeStation& station, const CylindricalPoint& point) {
  const Vector2 along = helix_direction(station);
  const double axial = point.axial - origin_axial(station);
  const double arc = station.radius * std::remainder(point.angle + station.skew, two_pi);
  return {axial * along.x() + arc * along.y(), axial * along.y() - arc * along.x()};
}

Point3 to_space(const CylindricalPoint& point, Hand hand) {
  return {point.axial, side_of(hand) * point.radius * std::sin(point.angle), point.radius * std::cos(point.angle)};
}

CylindricalPoint to_cylinder(const Point3& point, Hand hand) {
  const double across = side_of(hand) * point.y();
  return {point.x(), std::hypot(point.y(), point.z()), std::atan2(across, point.z())};
}

}  // namespace isorim::geometry
