#pragma once

#include "geometry/boundary.h"
#include "geometry/vocabulary.h"

/// Affine maps and what they do to whole boundaries. Angles in radians; a rotation about an axis follows the right
/// hand. All throw GeometryError for numbers that are not finite and for zero directions.
namespace isorim::geometry {

/// A straight line in space. The direction need not be of unit length.
struct Axis {
  Point3 point = Point3::Zero();
  Vector3 direction = Vector3::UnitZ();
};

template <int Dim>
AffineMap<Dim> translation(const Vector<Dim>& by);

/// Counter-clockwise about a point of the plane.
AffineMap<2> rotation(const Point2& centre, double angle);
/// Right-handed about an axis. Exact to the bit for multiples of a quarter turn about coordinate axes.
AffineMap<3> rotation(const Axis& axis, double angle);

/// Multiplies the distances from `centre` along each axis. A factor may be negative (that mirrors) but not zero.
template <int Dim>
AffineMap<Dim> scaling(const Vector<Dim>& factors, const Point<Dim>& centre = Point<Dim>::Zero());

/// The mirror image in the line (Dim = 2) or plane (Dim = 3) through `point` with the normal `normal`.
template <int Dim>
AffineMap<Dim> mirroring(const Point<Dim>& point, const Vector<Dim>& normal);

/// First `inner`, then `outer`.
template <int Dim>
AffineMap<Dim> compose(const AffineMap<Dim>& outer, const AffineMap<Dim>& inner);

/// Every patch moved. A map with negative determinant turns natural normals round, so it flips the orientations:
/// outward stays outward. Throws GeometryError if the map is singular.
template <int Dim>
Boundary<Dim> transform(const Boundary<Dim>& boundary, const AffineMap<Dim>& map);

}  // namespace isorim::geometry
