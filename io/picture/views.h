#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace isorim::io::picture {

/// From where a shape is seen, in parallel projection.
struct View {
  /// What stands below the picture on a sheet.
  std::string name;
  /// Unit vector from the shape to the eye.
  Eigen::Vector3d towards_eye;
  /// Unit vector at right angles to it that points up in the picture.
  Eigen::Vector3d up;

  Eigen::Vector3d right() const;
};

/// Standard views, z being up and the front facing -y: iso (from the front, right and above), iso_back, front, back,
/// left, right, top, bottom; all (iso, front, top, left); or two angles "azimuth,elevation" in degrees, azimuth from
/// the front towards the right, elevation above the horizon. Throws InputError for another text.
std::vector<View> views_from(const std::string& text);

/// The view of the plane z = 0, x to the right and y up.
View plane_view();

}  // namespace isorim::io::picture
