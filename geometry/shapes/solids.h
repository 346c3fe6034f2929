#pragma once

#include "geometry/boundary.h"
#include "geometry/vocabulary.h"

/// Solids by their exact boundaries; natural normals point outward. All throw GeometryError naming the parameter and
/// its value if a radius, height or size is not positive or a number is not finite.
namespace isorim::geometry {

/// One patch "sphere": a half circle turned about z; u is the longitude, v runs from the south to the north pole. Both
/// v edges are degenerate; eight biquadratic Bézier elements.
Boundary<3> sphere(double radius, const Point3& centre = Point3::Zero());

/// The same sphere without poles: six patches "x_min", "x_max", .. of one biquartic element each, a cube's faces blown
/// up along great circles (Cobb 1988). The weights are alike on common edges, whose parameters agree.
Boundary<3> six_patch_sphere(double radius, const Point3& centre = Point3::Zero());

/// One patch "ellipsoid": the unit sphere stretched to the semi-axes radii along x, y, z.
Boundary<3> ellipsoid(const Vector3& radii, const Point3& centre = Point3::Zero());

/// One patch "torus" about the z axis: u the longitude, v about the tube. Throws also unless minor < major.
Boundary<3> torus(double major_radius, double minor_radius, const Point3& centre = Point3::Zero());

/// The same torus as sixteen patches "torus_1_1", .., "torus_4_4" of one biquadratic element each; the first number
/// counts along the longitude.
Boundary<3> sixteen_patch_torus(double major_radius, double minor_radius, const Point3& centre = Point3::Zero());

/// Patches "bottom", "side", "top", the axis along z; `base` is the centre of the bottom disc. The discs are fans.
Boundary<3> cylinder(double radius, double height, const Point3& base = Point3::Zero());

/// Patches "bottom", "side", "top", the axis along z; `base` is the centre of the bottom disc. One of the two radii may
/// be 0: there the side has a degenerate edge and the disc is absent.
Boundary<3> cone(double base_radius, double top_radius, double height, const Point3& base = Point3::Zero());

/// Patches "x_min", "x_max", "y_min", "y_max", "z_min", "z_max" of degree 1; `corner` is the smallest one.
Boundary<3> box(const Vector3& size, const Point3& corner = Point3::Zero());

/// A box with three equal sides.
Boundary<3> cube(double side, const Point3& corner = Point3::Zero());

}  // namespace isorim::geometry
