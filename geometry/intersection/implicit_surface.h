#pragma once

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/intersection/bernstein_polynomial.h"
#include "geometry/vocabulary.h"

/// Planes and quadrics as the zero sets of polynomials F, negative on the side that is meant to be kept.
namespace isorim::geometry {

/// F(x) = (d, 1)^T form (d, 1) with d = x - origin; the form is symmetric. The origin lies on or near the surface's
/// middle, so that little is lost to cancellation.
struct ImplicitSurface {
  /// 1 (plane: no products of coordinates in the form) or 2.
  int degree = 2;
  Point3 origin = Point3::Zero();
  Eigen::Matrix4d form = Eigen::Matrix4d::Zero();
};

double evaluate(const ImplicitSurface& surface, const Point3& x);
Vector3 gradient(const ImplicitSurface& surface, const Point3& x);

/// The distance from the plane, positive on the side to which the normal points. The normal need not be of unit length.
/// This and the next three throw GeometryError if a direction is zero, a radius is not positive or a number is not
/// finite.
ImplicitSurface implicit_plane(const Point3& point, const Vector3& normal);
/// Negative inside; near the surface about the distance from it.
ImplicitSurface implicit_sphere(const Point3& centre, double radius);
ImplicitSurface implicit_cylinder(const Point3& point, const Vector3& axis, double radius);
/// The double cone about the axis, negative inside both nappes; the half angle in radians, in (0, pi / 2). Near the
/// surface about the distance from it times that from the plane across the axis through the apex.
ImplicitSurface implicit_cone(const Point3& apex, const Vector3& axis, double half_angle);

/// The same surface with the other side kept.
ImplicitSurface complement(ImplicitSurface surface);

/// w^degree F on a Bézier element, w its weight function over its largest weight: a polynomial with the signs of F,
/// degree times those of the element.
BernsteinGrid compose(const ImplicitSurface& surface, const BezierElement<3>& element,
                      const Eigen::Ref<const HomogeneousPoints<3>>& net);

}  // namespace isorim::geometry
