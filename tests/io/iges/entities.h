#pragma once

#include <gtest/gtest.h>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "io/iges/parameters.h"

/// Entities read by the letter of the standard, sharing no code with the reader of the geometry.
namespace isorim::io::iges {

inline void expect_same_bits(const geometry::KnotVector& a, const geometry::KnotVector& b) {
  EXPECT_EQ(a, b);
}
template <int Dim>
void expect_same_bits(const geometry::NurbsCurve<Dim>& a, const geometry::NurbsCurve<Dim>& b) {
  EXPECT_EQ(a.knots(), b.knots());
  EXPECT_EQ(a.homogeneous(), b.homogeneous());
}
template <int Dim>
void expect_same_bits(const geometry::NurbsSurface<Dim>& a, const geometry::NurbsSurface<Dim>& b) {
  EXPECT_EQ(a.knots_u(), b.knots_u());
  EXPECT_EQ(a.knots_v(), b.knots_v());
  EXPECT_EQ(a.homogeneous(), b.homogeneous());
}

template <int Dim>
geometry::Points<Dim> read_points(Parameters& parameters, int count) {
  geometry::Points<Dim> points(Dim, count);
  for (int i = 0; i < count; ++i) {
    for (int d = 0; d < 3; ++d) {
      const double x = parameters.real();
      if (d < Dim) points(d, i) = x;
    }
  }
  return points;
}

template <int Dim>
geometry::NurbsCurve<Dim> curve_of_126(const File& file, const Entity& entity) {
  EXPECT_EQ(entity.type, 126);
  Parameters parameters(file, entity);
  const int last = parameters.integer();
  const int degree = parameters.integer();
  parameters.skip(4);
  const std::vector<double> knots = parameters.reals(last + degree + 2);
  const std::vector<double> weights = parameters.reals(last + 1);
  const auto points = read_points<Dim>(parameters, last + 1);
  const geometry::KnotVector knot_vector(degree, knots);
  EXPECT_EQ(parameters.real(), knot_vector.domain().first);
  EXPECT_EQ(parameters.real(), knot_vector.domain().last);
  EXPECT_GE(parameters.remaining(), 3);
  return geometry::NurbsCurve<Dim>::from_points(knot_vector, points, weights);
}

inline geometry::NurbsSurface<3> surface_of_128(const File& file, const Entity& entity) {
  EXPECT_EQ(entity.type, 128);
  Parameters parameters(file, entity);
  const int last_u = parameters.integer();
  const int last_v = parameters.integer();
  const int degree_u = parameters.integer();
  const int degree_v = parameters.integer();
  parameters.skip(5);
  const geometry::KnotVector knots_u(degree_u, parameters.reals(last_u + degree_u + 2));
  const geometry::KnotVector knots_v(degree_v, parameters.reals(last_v + degree_v + 2));
  const int count = (last_u + 1) * (last_v + 1);
  const std::vector<double> weights = parameters.reals(count);
  const auto points = read_points<3>(parameters, count);
  EXPECT_EQ(parameters.real(), knots_u.domain().first);
  EXPECT_EQ(parameters.real(), knots_u.domain().last);
  EXPECT_EQ(parameters.real(), knots_v.domain().first);
  EXPECT_EQ(parameters.real(), knots_v.domain().last);
  return geometry::NurbsSurface<3>::from_points(knots_u, knots_v, points, weights);
}

}  // namespace isorim::io::iges
