#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geometry/fitting/curve_fit.h"
#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// What is known of a fit besides the shape that came out of it.
namespace isorim::io {

/// The plane of a section with Cartesian coordinates.
struct SectionPlane {
  geometry::Point3 origin = geometry::Point3::Zero();
  geometry::Vector3 first = geometry::Vector3::UnitX();
  geometry::Vector3 second = geometry::Vector3::UnitY();

  geometry::Point3 place(const geometry::Point2& point) const {
    return origin + point.x() * first + point.y() * second;
  }
};

/// A curve and the points that it was fitted to, in the coordinates of the section's plane.
struct FittedCurve {
  /// "contour", "z = 0.5", the file of a section.
  std::string name;
  SectionPlane plane;
  bool closed = true;
  geometry::Points<2> points;
  geometry::CurveFit<2> fit;
};

/// Of a body through sections; see geometry::Body.
struct FittedBody {
  int sections = 0;
  int control_points_along = 0;
  int control_points_across = 0;
  int knots_inserted = 0;
  int knots_removed = 0;
  double uniformisation_error = 0.0;
  /// The largest distance of a point from the plane of its section.
  double off_plane = 0.0;
};

/// Before any transform of the shape. Lengths in its unit.
struct FitFacts {
  std::vector<FittedCurve> curves;
  /// Has no sections if the shape is a region of the plane.
  FittedBody body;
  int points_read = 0;
  /// Points left after the reduction to cells; points_read if there was none.
  int points_reduced = 0;
  /// Reason and number; only reasons that occurred.
  std::vector<std::pair<std::string, int>> dropped;
  /// Some contours were bands of noise and led along their middle lines.
  bool thinned = false;
  /// For the reduction and the order, and for the fits.
  double ordering_seconds = 0.0;
  double seconds = 0.0;
  std::vector<std::string> warnings;

  bool is_body() const { return body.sections > 0; }
};

/// All curves of a fit taken together.
struct FitSummary {
  /// Of all curves.
  int control_points = 0;
  int points = 0;
  double max_distance = 0.0;
  double rms_distance = 0.0;
  /// Sums.
  double bending_energy = 0.0;
  int curvature_sign_changes = 0;
  bool tolerance_met = true;
  /// The point with the largest distance: its curve, its place there (from 0) and in space.
  std::size_t worst_curve = 0;
  int worst_point = 0;
  geometry::Point3 worst_place = geometry::Point3::Zero();
};
FitSummary summarise(const FitFacts& facts);

}  // namespace isorim::io
