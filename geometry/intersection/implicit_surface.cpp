#include "geometry/intersection/implicit_surface.h"

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/checks.h"

namespace isorim::geometry {
namespace {

Eigen::Vector4d homogeneous(const ImplicitSurface& surface, const Point3& x) {
  return Eigen::Vector4d(x.x() - surface.origin.x(), x.y() - surface.origin.y(), x.z() - surface.origin.z(), 1.0);
}

/// 1 - a a^T for a unit vector.
Eigen::Matrix3d across(const Vector3& axis) {
  return Eigen::Matrix3d::Identity() - axis * axis.transpose();
}

}  // namespace

double evaluate(const ImplicitSurface& surface, const Point3& x) {
  const Eigen::Vector4d d = homogeneous(surface, x);
  return d.dot(surface.form * d);
}

Vector3 gradient(const ImplicitSurface& surface, const Point3& x) {
  return 2.0 * (surface.form * homogeneous(surface, x)).head<3>();
}

ImplicitSurface implicit_plane(const Point3& point, const Vector3& normal) {
  checks::finite("plane", "point", point);
  ImplicitSurface plane{1, point, Eigen::Matrix4d::Zero()};
  plane.form.topRightCorner<3, 1>() = 0.5 * checks::unit<3>("plane", "normal", normal);
  plane.form.bottomLeftCorner<1, 3>() = plane.form.topRightCorner<3, 1>().transpose();
  return plane;
}

ImplicitSurface implicit_sphere(const Point3& centre, double radius) {
  checks::finite("sphere", "centre", centre);
  checks::positive("sphere", "radius", radius);
  ImplicitSurface sphere{2, centre, Eigen::Matrix4d::Identity() / (2.0 * radius)};
  sphere.form(3, 3) = -0.5 * radius;
  return sphere;
}

ImplicitSurface implicit_cylinder(const Point3& point, const Vector3& axis, double radius) {
  checks::finite("cylinder", "point", point);
  checks::positive("cylinder", "radius", radius);
  ImplicitSurface cylinder{2, point, Eigen::Matrix4d::Zero()};
  cylinder.form.topLeftCorner<3, 3>() = across(checks::unit<3>("cylinder", "axis", axis)) / (2.0 * radius);
  cylinder.form(3, 3) = -0.5 * radius;
  return cylinder;
}

ImplicitSurface implicit_cone(const Point3& apex, const Vector3& axis, double half_angle) {
  checks::finite("cone", "apex", apex);
  if (!(half_angle > 0.0 && half_angle < 0.5 * std::numbers::pi))
    throw GeometryError(fmt::format("cone: half_angle is {} rad; it must lie between 0 and pi / 2", half_angle));
  const Vector3 unit = checks::unit<3>("cone", "axis", axis);
  const double cosine = std::cos(half_angle);
  const double sine = std::sin(half_angle);
  ImplicitSurface cone{2, apex, Eigen::Matrix4d::Zero()};
  cone.form.topLeftCorner<3, 3>() =
      (cosine * cosine * across(unit) - sine * sine * unit * unit.transpose()) / (2.0 * sine);
  return cone;
}

ImplicitSurface complement(ImplicitSurface surface) {
  surface.form = -surface.form;
  return surface;
}

BernsteinGrid compose(const ImplicitSurface& surface, const BezierElement<3>& element,
                      const Eigen::Ref<const HomogeneousPoints<3>>& net) {
  const Eigen::Index rows = element.degree[0] + 1;
  const Eigen::Index columns = element.degree[1] + 1;
  const double scale = 1.0 / net.row(3).maxCoeff();
  std::array<BernsteinGrid, 4> coordinates;
  for (int k = 0; k < 4; ++k) {
    const double origin = k < 3 ? surface.origin(k) : 0.0;
    const Eigen::RowVectorXd values = scale * (net.row(k) - origin * net.row(3));
    coordinates[static_cast<std::size_t>(k)] = values.reshaped(rows, columns);
  }
  if (surface.degree == 1) {
    BernsteinGrid sum = surface.form(3, 3) * coordinates[3];
    for (int k = 0; k < 3; ++k) sum += 2.0 * surface.form(k, 3) * coordinates[static_cast<std::size_t>(k)];
    return sum;
  }
  BernsteinGrid sum = BernsteinGrid::Zero(2 * rows - 1, 2 * columns - 1);
  for (int k = 0; k < 4; ++k) {
    BernsteinGrid image = BernsteinGrid::Zero(rows, columns);
    for (int l = 0; l < 4; ++l) image += surface.form(k, l) * coordinates[static_cast<std::size_t>(l)];
    sum += multiply(coordinates[static_cast<std::size_t>(k)], image);
  }
  return sum;
}

}  // namespace isorim::geometry
