#include "geometry/propeller/blade_section.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"

namespace isorim::geometry {
namespace {

/// On the back (side = 1) or the face (side = -1), x from the nose in chords.
Point2 profile_point(const ProfileSection& profile, double x, double side) {
  const MeanLinePoint line = mean_line(profile.camber, x);
  const double half = half_thickness(profile.thickness, x) * profile.max_thickness;
  const Vector2 normal = Vector2(-line.slope * profile.max_camber / profile.chord, 1.0).normalized();
  const double along = x * profile.chord + side * half * normal.x();
  return {0.5 * profile.chord - along, line.camber * profile.max_camber + side * half * normal.y()};
}

}  // namespace

Points<3> outline_in_space(const BladeSection& section, Hand hand) {
  Points<3> points(3, section.outline.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = to_space(section.station, section.outline.col(i), hand);
  return points;
}

BladeSection profile_section(const ProfileSection& profile, int points_a_side) {
  checks::positive("blade section", "chord", profile.chord);
  checks::positive("blade section", "thickness", profile.max_thickness);
  checks::finite("blade section", "camber", profile.max_camber);
  if (points_a_side < 3)
    throw GeometryError(fmt::format("blade section: {} points a side, at least 3 are needed", points_a_side));
  const Eigen::Index last = points_a_side - 1;
  BladeSection section{
      profile.station, profile.chord, 0.5 * profile.chord, profile.max_thickness, Points<2>(2, 2 * last + 1), last};
  for (Eigen::Index i = 0; i <= last; ++i) {
    // cos(pi) may miss -1 by rounding only where it does not matter: the ends are set exactly.
    const double x =
        i == last ? 1.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(last)));
    section.outline.col(last - i) = profile_point(profile, x, 1.0);
    section.outline.col(last + i) = profile_point(profile, x, -1.0);
  }
  return section;
}

}  // namespace isorim::geometry
