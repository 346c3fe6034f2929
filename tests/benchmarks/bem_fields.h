#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/rim.h"

/// Exact fields of the boundary-element benchmarks, and where their errors are looked at.
namespace isorim {

template <int Dim>
using PlaceFunction = std::function<double(const geometry::Point<Dim>&, const geometry::Vector<Dim>&)>;

/// A function of place and outward normal as what conditions are given by.
template <int Dim>
quadrature::IntegrandFactory<Dim> prescribed(PlaceFunction<Dim> function) {
  return [function = std::move(function)]() -> quadrature::Integrand<Dim> {
    return [function](const Eigen::Ref<const geometry::Points<Dim>>& points,
                      const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      for (Eigen::Index q = 0; q < points.cols(); ++q)
        values[static_cast<std::size_t>(q)] = function(points.col(q), normals.col(q));
    };
  };
}

/// The problems that Bembel's authors and users test: u = 4 x^2 - 3 y^2 - z^2 in a sphere, whose mean over the sphere
/// is zero, and a source 0.75 above the torus of radii 2 and 1/2.
inline double saddle(const geometry::Point3& x) {
  return 4 * x[0] * x[0] - 3 * x[1] * x[1] - x[2] * x[2];
}

inline geometry::Vector3 saddle_gradient(const geometry::Point3& x) {
  return {8 * x[0], -6 * x[1], -2 * x[2]};
}

/// 10^3 points in [-1/4, 1/4]^3.
inline geometry::Points<3> sphere_grid() {
  geometry::Points<3> points(3, 1000);
  for (int i = 0; i < 1000; ++i)
    points.col(i) = geometry::Vector3(i % 10, i / 10 % 10, i / 100) / 18.0 - geometry::Vector3::Constant(0.25);
  return points;
}

inline double source_beside_torus(const geometry::Point3& x) {
  return 1.0 / (x - geometry::Point3(2.0, 0.0, 1.25)).norm();
}

/// 64 points on the centre circle.
inline geometry::Points<3> torus_centres() {
  geometry::Points<3> points(3, 64);
  for (int i = 0; i < 64; ++i) {
    const double angle = std::numbers::pi * i / 32.0;
    points.col(i) = 2.0 * geometry::Vector3(std::cos(angle), std::sin(angle), 0.0);
  }
  return points;
}

}  // namespace isorim
