#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"

/// Curves in space that lie in one plane, as curves of the plane.
namespace isorim::io {

/// Where a flat drawing lies: a point (x, y) of the plane is origin + x x_axis + y y_axis in space.
struct DrawingPlane {
  geometry::Point3 origin = geometry::Point3::Zero();
  geometry::Vector3 x_axis = geometry::Vector3::UnitX();
  geometry::Vector3 y_axis = geometry::Vector3::UnitY();
  /// The largest distance of a control point from the plane, and the diagonal of the box that holds all of them.
  double deviation = 0.0;
  double size = 0.0;
};

/// The plane of the curves. Planes z = const keep x and y as they are. In others x runs horizontally (towards positive
/// x, or y) and y upwards, and the origin is the point nearest to that of space.
///
/// Throws GeometryError if a control point lies farther from the plane than `tolerance` times the diagonal of their
/// bounding box, naming the distance, or if the curves lie on one straight line.
DrawingPlane drawing_plane(std::span<const geometry::NurbsCurve<3>> curves, double tolerance);

/// Whether all surfaces of the boundary lie in one plane, to the same tolerance.
bool is_flat(const geometry::Boundary<3>& boundary, double tolerance);

/// The curve's image under the perpendicular projection onto the plane, in the plane's coordinates; bit for bit its x
/// and y if the plane has the axes of space.
geometry::NurbsCurve<2> project(const geometry::NurbsCurve<3>& curve, const DrawingPlane& plane);

/// The edges of a flat face as curves in space, loop by loop, those of no length left out: exact, for surfaces that
/// are affine images of their parameters. Throws GeometryError for other surfaces, with their distance from being so.
std::vector<geometry::NurbsCurve<3>> flat_face_edges(const geometry::SurfaceShape& face);

}  // namespace isorim::io
