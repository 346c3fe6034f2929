#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "quadrature/rim.h"
#include "tests/quadrature/trimmed_solids.h"

namespace isorim::quadrature {
namespace {

using geometry::bezier_elements;
using geometry::ElementTable;
using geometry::Point3;
using geometry::Vector3;
using std::numbers::pi;
constexpr double catalan = 0.915965594177219015;

IntegrandFactory<3> integrand(const std::function<double(const Point3&, const Vector3&)>& f) {
  return [f] {
    return [f](const Eigen::Ref<const geometry::Points<3>>& points,
               const Eigen::Ref<const geometry::Points<3>>& normals, std::span<double> values) {
      for (Eigen::Index i = 0; i < points.cols(); ++i)
        values[static_cast<std::size_t>(i)] =
            f(points.col(i), normals.cols() > 0 ? Vector3(normals.col(i)) : Vector3::Zero());
    };
  };
}

void expect_integral(const IntegralResult& result, double exact, double tolerance) {
  const double error = std::abs(result.integral.value - exact);
  EXPECT_LE(error, tolerance);
  EXPECT_LE(error, 2.0 * result.integral.error + 1e-15 * std::abs(exact));
  EXPECT_EQ(result.status, Status::converged);
}

/// The patches of that name alone.
ElementTable<3> patch_of(const geometry::Boundary<3>& solid, const std::string& name) {
  geometry::Boundary<3> alone;
  for (const geometry::Patch<3>& patch : solid.patches) {
    if (patch.name == name) alone.patches.push_back(patch);
  }
  return bezier_elements(alone);
}

TEST(CutBoundaryIntegral, ExponentialOverAPlateWithARoundHole) {
  // int exp(a x) over a disc of radius r is 2 pi r I_1(a r) / a; over the square (2 sinh(a) / a) 2.
  const auto plate = patch_of(testing::box_with_round_hole(0.5, 1.0), "z_max");
  const double a = 1.3;
  const auto f = integrand([=](const Point3& x, const Vector3& n) { return std::exp(a * x[0]) * n[2]; });
  const double exact = 4.0 * std::sinh(a) / a - pi * std::cyl_bessel_i(1.0, 0.5 * a) / a;
  expect_integral(integrate_over_boundary<3>(plate, f, {}), exact, 1e-13);
}

// Singular in the hole, where the rule has points: bisection leaves them out.
TEST(CutBoundaryIntegral, SingularityInAHole) {
  const auto plate = patch_of(testing::box_with_round_hole(0.5, 1.0), "z_max");
  const auto f = integrand([](const Point3& x, const Vector3&) { return 1.0 / (x[0] * x[0] + x[1] * x[1]); });
  const IntegralResult result = integrate_over_boundary<3>(plate, f, {});
  expect_integral(result, 4.0 * pi * std::log(2.0) - 4.0 * catalan, 1e-12);
  EXPECT_LT(result.evaluations, 2'000'000);
}

// A disc of radius a = 1/4 cut out of a plane, and sqrt(a^2 + e - r^2), which is defined on little more than that.
TEST(CutBoundaryIntegral, IntegrandDefinedOnWhatIsKeptOnly) {
  geometry::Boundary<3> disc;
  disc.patches.push_back(testing::trimmed(geometry::box({1.0, 1.0, 1.0}).patches.back(),
                                          {testing::loop(geometry::circle_curve(0.25, geometry::Point2(0.6, 0.6)))}));
  const auto table = bezier_elements(disc);
  const Point3 centre = Point3(0.6, 0.6, 1.0);
  const double e = 1e-3;
  const auto f =
      integrand([=](const Point3& x, const Vector3&) { return std::sqrt(0.0625 + e - (x - centre).squaredNorm()); });
  // 2 pi / 3 ((a^2 + e)^(3/2) - e^(3/2)).
  const double exact = 2.0 * pi / 3.0 * (std::pow(0.0625 + e, 1.5) - std::pow(e, 1.5));
  expect_integral(integrate_over_boundary<3>(table, f, {}), exact, 1e-12);
}

// Nor are there rays that avoid the place where this is undefined.
TEST(CutBoundaryIntegral, UndefinedIntegrandIsNoticed) {
  const auto plate = patch_of(testing::box_with_round_hole(0.5, 1.0), "z_max");
  const auto f = integrand([](const Point3& x, const Vector3&) { return std::sqrt(x.head<2>().norm() - 0.49); });
  try {
    integrate_over_boundary<3>(plate, f, {});
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("the integrand is nan at ("));
  }
}

TEST(CutDomainIntegral, PolynomialAndExponentialOverABoxWithAHole) {
  const auto solid = bezier_elements(testing::box_with_round_hole(0.5, 1.5));
  // int x^2 z: 1.125 (4/3 - pi / 64).
  const auto polynomial = integrand([](const Point3& x, const Vector3&) { return x[0] * x[0] * x[2]; });
  expect_integral(integrate_over_domain<3>(solid, polynomial, std::nullopt, {}), 1.125 * (4.0 / 3.0 - pi / 64.0),
                  2e-13);
  const double a = 1.3;
  const auto exponential = integrand([=](const Point3& x, const Vector3&) { return std::exp(a * x[0] - x[2]); });
  const double exact = (4.0 * std::sinh(a) / a - pi * std::cyl_bessel_i(1.0, 0.5 * a) / a) * (1.0 - std::exp(-1.5));
  for (const Point3& pole : {Point3(0.0, 0.0, 0.7), Point3(-0.3, 2.0, -1.0)})
    expect_integral(integrate_over_domain<3>(solid, exponential, pole, {}), exact, 1e-12);
}

TEST(CutDomainIntegral, SameBitsForAnyNumberOfThreads) {
  const auto solid = bezier_elements(testing::box_with_round_hole(0.5, 1.5));
  const auto f = integrand([](const Point3& x, const Vector3&) { return std::sin(x[0] + 2.0 * x[1]) + x[2]; });
  Options options;
  options.threads = 1;
  const IntegralResult one = integrate_over_domain<3>(solid, f, std::nullopt, options);
  options.threads = 3;
  const IntegralResult many = integrate_over_domain<3>(solid, f, std::nullopt, options);
  EXPECT_EQ(one.integral.value, many.integral.value);
  EXPECT_EQ(one.integral.error, many.integral.error);
}

// Only what is kept of a surface counts: the inner half of a torus looks away from its centre, the outer half does not.
TEST(CutStarShape, IsJudgedByWhatIsKept) {
  const geometry::Patch<3> torus = geometry::torus(1.0, 0.4).patches[0];
  const geometry::NurbsSurface<3>& surface = geometry::surface_of(torus.shape);
  const auto strip = [&](double first, double last) {
    geometry::Points<2> corners(2, 5);
    corners << 0.1, 0.9, 0.9, 0.1, 0.1,  //
        first, first, last, last, first;
    return bezier_elements(
        geometry::Boundary<3>{{testing::trimmed(torus, {testing::loop(geometry::polyline<2>(corners))})}});
  };
  const double middle_v = 0.5;
  const bool middle_is_outer = evaluate(surface, geometry::Point2(0.3, middle_v)).head<2>().norm() > 1.0;
  EXPECT_EQ(is_star_shaped_about<3>(strip(0.4, 0.6), Point3(0, 0, 0)), middle_is_outer);
  EXPECT_EQ(is_star_shaped_about<3>(strip(0.01, 0.1), Point3(0, 0, 0)), !middle_is_outer);
}

}  // namespace
}  // namespace isorim::quadrature
