#pragma once

#include "geometry/vocabulary.h"
#include "io/fit/fit_facts.h"

namespace isorim::io {

/// Points of space that were measured in one plane, in its coordinates.
struct PlaneOfPoints {
  SectionPlane plane;
  geometry::Points<2> points;
  /// The largest distance of a point from the plane.
  double off_plane = 0.0;
};

/// The plane through the centroid that is nearest to the points in the sense of least squares. The points need no
/// order. Throws GeometryError if they lie within 1e-6 of their size of a line, or farther than a hundredth of it from
/// the plane.
PlaneOfPoints plane_of_points(const geometry::Points<3>& points);

}  // namespace isorim::io
