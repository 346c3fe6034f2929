#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "quadrature/gauss_legendre.h"
#include "solver/properties.h"
#include "tests/quadrature/regions.h"
#include "tests/quadrature/trimmed_solids.h"

namespace isorim::solver {
namespace {

using geometry::bezier_elements;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using quadrature::Status;
using std::numbers::pi;

TEST(TrimmedProperties, BoxWithARoundHole) {
  const double r = 0.5;
  const double h = 1.5;
  const auto result = geometric_properties(bezier_elements(quadrature::testing::box_with_round_hole(r, h)));
  const double volume = h * (4.0 - pi * r * r);
  const double across = h * (4.0 / 3.0 - pi * std::pow(r, 4) / 4.0);
  const double along = volume * h * h / 12.0;
  EXPECT_NEAR(result.boundary_measure.value, 2.0 * (4.0 - pi * r * r) + 8.0 * h + 2.0 * pi * r * h, 2e-14);
  EXPECT_NEAR(result.domain->measure.value, volume, 1e-14);
  EXPECT_LT((result.domain->centroid - Point3(0.0, 0.0, 0.5 * h)).norm(), 1e-15);
  EXPECT_LT((result.domain->inertia.diagonal() - Vector3(across + along, across + along, 2.0 * across)).norm(), 2e-14);
  EXPECT_LT(result.closure_defect, 1e-15);
  EXPECT_EQ(result.boundary_status, Status::converged);
}

// M. A. Correia, 2016, section 4.3.1. All faces are planes: everything is polynomial, the area too.
TEST(TrimmedProperties, CubeWithASquareBlindHoleIsExact) {
  geometry::Boundary<3> solid = geometry::cube(1.0);
  for (geometry::Patch<3>& patch : solid.patches) {
    if (patch.name != "z_max") continue;
    geometry::Points<2> square(2, 5);
    square << 0.25, 0.25, 0.75, 0.75, 0.25,  //
        0.25, 0.75, 0.75, 0.25, 0.25;
    patch = quadrature::testing::trimmed(patch, {geometry::domain_loop(geometry::surface_of(patch.shape)),
                                                 quadrature::testing::loop(geometry::polyline<2>(square))});
  }
  for (geometry::Patch<3> patch : geometry::cube(0.5, Point3(0.25, 0.25, 0.5)).patches) {
    if (patch.name == "z_max") continue;
    patch.orientation = -patch.orientation;
    patch.name = "hole_" + patch.name;
    solid.patches.push_back(patch);
  }
  const auto result = geometric_properties(bezier_elements(solid));
  EXPECT_NEAR(result.boundary_measure.value, 7.0, 1e-14);
  EXPECT_NEAR(result.domain->measure.value, 0.875, 1e-15);
  EXPECT_LT((result.domain->centroid - Point3(0.5, 0.5, 13.0 / 28.0)).norm(), 1e-15);
  EXPECT_LT(
      (result.domain->inertia.diagonal() - Vector3(0.152529761904761905, 0.152529761904761905, 0.161458333333333333))
          .norm(),
      1e-15);
  EXPECT_EQ(result.boundary_status, Status::exact);
  EXPECT_EQ(result.domain_status, Status::exact);
  EXPECT_LT(result.boundary_measure.error, 1e-13);
}

/// A part of the unit sphere cut out by an ellipse in one octant's parameters, and its area.
struct SpherePatch {
  geometry::ElementTable<3> table;
  double area = 0.0;
};

/// The quarter of a circle that is the arc of two weights 1 with cos(45 degrees) between: angle and sine at s.
struct QuarterArc {
  double angle;
  double sine;
};
QuarterArc quarter_arc(double s) {
  const double middle = std::numbers::sqrt2 * s * (1.0 - s);
  const double x = (1.0 - s) * (1.0 - s) + middle;
  const double y = s * s + middle;
  return {std::atan2(y, x), y / std::hypot(x, y)};
}

/// The derivative of that sine: the cosine times the derivative of the angle, (x y' - y x') / (x^2 + y^2).
double rise(double s) {
  const double x = (1.0 - s) * (1.0 - s) + std::numbers::sqrt2 * s * (1.0 - s);
  const double y = s * s + std::numbers::sqrt2 * s * (1.0 - s);
  const double middle = std::numbers::sqrt2 * (1.0 - 2.0 * s);
  const double turning = (x * (2.0 * s + middle) - y * (middle - 2.0 * (1.0 - s))) / (x * x + y * y);
  return std::cos(quarter_arc(s).angle) * turning;
}

/// The area is the line integral of longitude times dz around the ellipse, which the trapezoidal rule integrates to
/// rounding (the integrand is periodic and analytic).
SpherePatch sphere_patch() {
  const Vector2 radii(0.11, 0.22);
  const Point2 centre(0.125, 0.75);
  const geometry::Patch<3> sphere = geometry::sphere(1.0).patches[0];
  const geometry::Boundary<3> cut{
      {quadrature::testing::trimmed(sphere, {quadrature::testing::loop(geometry::ellipse_curve(radii, centre))})}};
  SpherePatch patch{bezier_elements(cut), 0.0};
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    const double t = 2.0 * pi * i / steps;
    const QuarterArc u = quarter_arc(4.0 * (centre[0] + radii[0] * std::cos(t)));
    const double dz = rise(2.0 * (centre[1] + radii[1] * std::sin(t)) - 1.0);
    patch.area += u.angle * dz * 2.0 * radii[1] * std::cos(t) * 2.0 * pi / steps;
  }
  return patch;
}

TEST(TrimmedProperties, CutOutOfTheSphereToRounding) {
  const SpherePatch patch = sphere_patch();
  PropertyOptions<3> options;
  options.scope = PropertyOptions<3>::Scope::boundary_only;
  const auto result = geometric_properties(patch.table, options);
  EXPECT_NEAR(result.boundary_measure.value, patch.area, 1e-14);
  options.scope = PropertyOptions<3>::Scope::boundary_and_domain;
  options.pole = Point3(0.0, 0.0, 0.0);
  // The cone from the sphere's centre.
  EXPECT_NEAR(geometric_properties(patch.table, options).domain->measure.value, patch.area / 3.0, 1e-14);
}

/// Least-squares slope of y over x.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// The relative errors of the area with fixed rules of 1 to 16 points.
std::vector<double> errors_of_fixed_rules(const SpherePatch& patch) {
  PropertyOptions<3> options;
  options.scope = PropertyOptions<3>::Scope::boundary_only;
  std::vector<double> errors;
  for (int n = 1; n <= 16; ++n) {
    options.integration.fixed_points = n;
    const auto result = geometric_properties(patch.table, options);
    errors.push_back(std::abs(result.boundary_measure.value - patch.area) / patch.area);
    EXPECT_EQ(result.boundary_status, Status::fixed_rule);
  }
  return errors;
}

// The theory says rho^(-2 n) with rho = 5.03 for the whole octant, more for the part that the ellipse's rectangle is.
TEST(TrimmedProperties, ErrorOfATrimmedFaceFallsSpectrally) {
  const std::vector<double> errors = errors_of_fixed_rules(sphere_patch());
  std::vector<double> points;
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i] > 1e-13) {
      points.push_back(static_cast<double>(i) + 1.0);
      logarithms.push_back(std::log10(errors[i]));
    }
    if (i >= 8) {
      EXPECT_LT(errors[i], 1e-13) << i + 1;
    }
  }
  ASSERT_GE(points.size(), 4U);
  EXPECT_LT(slope(points, logarithms), -1.4);
}

TEST(TrimmedProperties, EstimatesOfFixedRulesCoverTheErrorOfATrimmedFace) {
  const SpherePatch patch = sphere_patch();
  PropertyOptions<3> options;
  options.scope = PropertyOptions<3>::Scope::boundary_only;
  for (int n = 1; n <= 16; ++n) {
    options.integration.fixed_points = n;
    const quadrature::Estimate area = geometric_properties(patch.table, options).boundary_measure;
    EXPECT_LE(std::abs(area.value - patch.area), 2.0 * area.error) << n;
  }
}

/// An ellipse over two octants of the sphere, cut where it crosses the knot line between them; or with one of its
/// arcs not cut there.
SpherePatch across_a_knot_line(bool one_crossing_missed) {
  SpherePatch patch{bezier_elements(geometry::sphere(1.0)), 0.0};
  const auto arc = [](double centre_x, double from, double to) {
    quadrature::testing::Curve curve = quadrature::testing::arc({0.0, 0.0}, 1.0, from * pi / 4.0, to * pi / 4.0);
    curve.row(0) = 0.4 * curve.row(0) + centre_x * curve.row(2);
    curve.row(1) = 0.35 * curve.row(1) + 0.5 * curve.row(2);
    return curve;
  };
  geometry::TrimmedRegion left{{arc(1.0, 3, 4), arc(1.0, 4, 6), quadrature::testing::line({1.0, 0.15}, {1.0, 0.85})}};
  geometry::TrimmedRegion right{{arc(0.0, 6, 8), arc(0.0, 0, 1), quadrature::testing::line({0.0, 0.85}, {0.0, 0.15})}};
  left.curves.push_back(arc(1.0, one_crossing_missed ? 1.0 : 2.0, 3));
  if (!one_crossing_missed) right.curves.push_back(arc(0.0, 1, 2));
  patch.table.regions = {left, right};
  // The octants of the northern hemisphere with u in [0, 1/4] and [1/4, 1/2].
  patch.table.elements = {patch.table.elements[4], patch.table.elements[5]};
  for (std::int32_t i = 0; i < 2; ++i) patch.table.elements[static_cast<std::size_t>(i)].region = i;
  const quadrature::Rule& rule = quadrature::gauss_legendre(60);
  for (const double start : {-0.5 * pi, 0.5 * pi}) {
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double t = start + pi * rule.nodes[i];
      const double u =
          start < 0.0 ? 0.5 * pi + quarter_arc(0.4 * std::cos(t)).angle : quarter_arc(1.0 + 0.4 * std::cos(t)).angle;
      patch.area += u * rise(0.5 + 0.35 * std::sin(t)) * 0.35 * std::cos(t) * pi * rule.weights[i];
    }
  }
  return patch;
}

TEST(TrimmedProperties, MissedKnotCrossingIsNoticed) {
  EXPECT_LT(errors_of_fixed_rules(across_a_knot_line(false)).back(), 1e-13);
  for (const double error : errors_of_fixed_rules(across_a_knot_line(true))) EXPECT_GT(error, 1e-4);
}

}  // namespace
}  // namespace isorim::solver
