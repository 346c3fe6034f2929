#pragma once

#include <string>

#include "geometry/boundary.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/trimming/trimmed_surface.h"

/// Boundaries with trimmed faces, for files.
namespace isorim::io::iges {

/// The net as a file gives it: rounded products of Cartesian points and weights.
inline geometry::NurbsCurve<2> as_from_file(const geometry::NurbsCurve<2>& curve) {
  const Eigen::VectorXd weights = curve.weights();
  return geometry::NurbsCurve<2>::from_points(curve.knots(), curve.control_points(),
                                              {weights.data(), static_cast<std::size_t>(weights.size())});
}

inline geometry::NurbsCurve<2> clockwise_circle(double radius, const geometry::Point2& centre) {
  return as_from_file(reverse(geometry::circle_curve(radius, centre)));
}

/// Appends the patches of `more`, `suffix` behind their names.
inline void append(geometry::Boundary<3>& boundary, geometry::Boundary<3> more, const std::string& suffix) {
  for (auto& patch : more.patches) {
    patch.name += suffix;
    boundary.patches.push_back(std::move(patch));
  }
}

/// [-1, 1] x [-1, 1] x [0, 1] with a round hole of radius 1/2 along z.
inline geometry::Boundary<3> drilled_plate() {
  const auto is_flat = [](const geometry::SurfaceShape& shape) {
    const geometry::Points<3> points = surface_of(shape).control_points();
    return points.row(2).maxCoeff() == points.row(2).minCoeff();
  };
  geometry::Boundary<3> plate = geometry::box({2, 2, 1}, {-1, -1, 0});
  for (auto& patch : plate.patches) {
    if (!is_flat(patch.shape)) continue;
    const geometry::NurbsSurface<3> surface = surface_of(patch.shape);
    patch.shape = geometry::TrimmedSurface(surface, {domain_loop(surface), {{clockwise_circle(0.25, {0.5, 0.5})}}});
  }
  for (auto& patch : geometry::cylinder(0.5, 1.0).patches) {
    if (is_flat(patch.shape)) continue;
    patch.name = "hole";
    plate.patches.push_back(patch);
  }
  return plate;
}

/// A disc of a sphere, bounded by a curve that is no parameter line.
inline geometry::Boundary<3> trimmed_sphere() {
  geometry::Boundary<3> sphere = geometry::sphere(1.0);
  const geometry::NurbsSurface<3> surface = surface_of(sphere.patches[0].shape);
  const geometry::Point2 middle(surface.knots_u().domain().middle(), surface.knots_v().domain().middle());
  const auto circle = as_from_file(geometry::circle_curve(0.1, middle));
  sphere.patches[0].shape = geometry::TrimmedSurface(surface, {{{circle}}});
  return sphere;
}

}  // namespace isorim::io::iges
