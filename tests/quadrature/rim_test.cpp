#include "quadrature/rim.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "tests/quadrature/hollow.h"

namespace isorim::quadrature {
namespace {

using geometry::bezier_elements;
using geometry::ElementTable;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using std::numbers::pi;
using ::testing::HasSubstr;

/// An integrand from a function of one point (and normal).
template <int Dim>
IntegrandFactory<Dim> integrand(std::function<double(const geometry::Point<Dim>&, const geometry::Vector<Dim>&)> f) {
  return [f] {
    return [f](const Eigen::Ref<const geometry::Points<Dim>>& points,
               const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const geometry::Vector<Dim> n =
            normals.cols() > 0 ? geometry::Vector<Dim>(normals.col(i)) : geometry::Vector<Dim>::Zero();
        values[static_cast<std::size_t>(i)] = f(points.col(i), n);
      }
    };
  };
}

IntegrandFactory<3> in_space(const std::function<double(const Point3&)>& f) {
  return integrand<3>([f](const Point3& x, const Point3&) { return f(x); });
}
IntegrandFactory<2> in_plane(const std::function<double(const Point2&)>& f) {
  return integrand<2>([f](const Point2& x, const Point2&) { return f(x); });
}

ElementTable<2> annulus(double inner, double outer) {
  return testing::hollow(geometry::disc(outer), geometry::disc(inner));
}

/// G. B. Folland, Amer. Math. Monthly 108, 2001: the integral of a monomial over the unit ball.
double folland_ball(int a, int b, int c) {
  if (a % 2 != 0 || b % 2 != 0 || c % 2 != 0) return 0.0;
  const auto gamma = [](int k) { return std::tgamma(0.5 * (k + 1)); };
  return 2.0 * gamma(a) * gamma(b) * gamma(c) / std::tgamma(0.5 * (a + b + c + 3)) / (a + b + c + 3);
}

void expect_integral(const IntegralResult& result, double exact, double scale, const std::string& what) {
  const double error = std::abs(result.integral.value - exact);
  EXPECT_LE(error, 2e-13 * scale) << what;
  EXPECT_LE(error, 2.0 * result.integral.error + 1e-15 * scale) << what;
  EXPECT_EQ(result.status, Status::converged) << what;
}

TEST(DomainIntegral, MonomialsOverTheBall) {
  const ElementTable<3> ball = bezier_elements(geometry::sphere(1.0));
  for (int a = 0; a <= 4; a += 1) {
    for (int b = 0; b <= 4; b += 2) {
      for (int c = 0; c <= 2; ++c) {
        const auto f =
            in_space([=](const Point3& x) { return std::pow(x[0], a) * std::pow(x[1], b) * std::pow(x[2], c); });
        expect_integral(integrate_over_domain<3>(ball, f, std::nullopt, {}), folland_ball(a, b, c), 1.0,
                        std::to_string(a) + std::to_string(b) + std::to_string(c));
      }
    }
  }
}

TEST(DomainIntegral, ExponentialOverTheBall) {
  // int exp(k z) over the unit ball = 4 pi (k cosh k - sinh k) / k^3.
  const ElementTable<3> ball = bezier_elements(geometry::sphere(1.0));
  for (const double k : {0.5, 1.0, 4.0, 20.0}) {
    const double exact = 4.0 * pi * (k * std::cosh(k) - std::sinh(k)) / (k * k * k);
    const auto f = in_space([=](const Point3& x) { return std::exp(k * x[2]); });
    expect_integral(integrate_over_domain<3>(ball, f, std::nullopt, {}), exact, exact, std::to_string(k));
  }
}

TEST(DomainIntegral, SharpGaussianIsFoundByBisection) {
  // A Gaussian of width 1/30 in the middle of the ball: what lies outside it is below rounding.
  const ElementTable<3> ball = bezier_elements(geometry::sphere(1.0));
  const double alpha = 900.0;
  const auto f = in_space([=](const Point3& x) { return std::exp(-alpha * x.squaredNorm()); });
  const double exact = std::pow(pi / alpha, 1.5);
  expect_integral(integrate_over_domain<3>(ball, f, std::nullopt, {}), exact, exact, "gaussian");
}

TEST(DomainIntegral, WeakSingularityAtThePoleCancels) {
  // 1 / |x| over the unit ball is 2 pi; in the plane 1 / |x| over the unit disc is 2 pi as well.
  const auto f3 = in_space([](const Point3& x) { return 1.0 / x.norm(); });
  expect_integral(integrate_over_domain<3>(bezier_elements(geometry::sphere(1.0)), f3, Point3(0, 0, 0), {}), 2.0 * pi,
                  2.0 * pi, "ball");
  const auto f2 = in_plane([](const Point2& x) { return 1.0 / x.norm(); });
  expect_integral(integrate_over_domain<2>(bezier_elements(geometry::disc(1.0)), f2, Point2(0, 0), {}), 2.0 * pi,
                  2.0 * pi, "disc");
}

TEST(DomainIntegral, DoesNotDependOnThePole) {
  const ElementTable<3> torus = bezier_elements(geometry::torus(1.0, 0.5));
  const auto f = in_space([](const Point3& x) { return std::cos(x[0]) * std::exp(0.5 * x[2]) + x[1] * x[1]; });
  const double reference = integrate_over_domain<3>(torus, f, Point3(0, 0, 0), {}).integral.value;
  for (const Point3& pole : {Point3(1, 0, 0), Point3(0.2, -0.3, 0.1), Point3(3, 3, 3)}) {
    const IntegralResult result = integrate_over_domain<3>(torus, f, pole, {});
    expect_integral(result, reference, std::abs(reference), "torus");
  }
}

TEST(DomainIntegral, SameBitsForAnyNumberOfThreads) {
  const ElementTable<3> torus = bezier_elements(geometry::torus(1.0, 0.5));
  const auto f = in_space([](const Point3& x) { return std::sin(x[0] + 2.0 * x[1]) + 2.0; });
  Options options;
  options.threads = 1;
  const IntegralResult one = integrate_over_domain<3>(torus, f, std::nullopt, options);
  for (const int threads : {2, 3}) {
    options.threads = threads;
    const IntegralResult many = integrate_over_domain<3>(torus, f, std::nullopt, options);
    EXPECT_EQ(one.integral.value, many.integral.value);
    EXPECT_EQ(one.integral.error, many.integral.error);
  }
}

TEST(DomainIntegral, UndefinedIntegrandOutsideTheDomainIsNoticedAndSaid) {
  // Defined on the annulus 0.5 < r < 1, not inside r < 0.4.
  const auto f = in_plane([](const Point2& x) { return std::sqrt(x.squaredNorm() - 0.16); });
  try {
    integrate_over_domain<2>(annulus(0.5, 1.0), f, std::nullopt, {});
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nan at ("));
    EXPECT_THAT(error.what(), HasSubstr("not star-shaped"));
    EXPECT_THAT(error.what(), HasSubstr("another pole"));
  }
}

TEST(DomainIntegral, SingularIntegrandOutsideTheDomainMissesTheTolerance) {
  // 1 / r^2 is not integrable over the hole, which the rays cross.
  const auto f = in_plane([](const Point2& x) { return 1.0 / x.squaredNorm(); });
  const IntegralResult result = integrate_over_domain<2>(annulus(0.5, 1.0), f, std::nullopt, {});
  EXPECT_EQ(result.status, Status::tolerance_not_reached);
}

TEST(DomainIntegral, StepIntegrandEndsSoonAndTellsItsError) {
  const auto f = in_space([](const Point3& x) { return x[0] > 0.3 ? 1.0 : 0.0; });
  const IntegralResult result = integrate_over_domain<3>(bezier_elements(geometry::sphere(1.0)), f, std::nullopt, {});
  const double cap = pi * 0.49 * (3.0 - 0.7) / 3.0;
  EXPECT_EQ(result.status, Status::tolerance_not_reached);
  EXPECT_LE(std::abs(result.integral.value - cap), 2.0 * result.integral.error);
  EXPECT_LE(std::abs(result.integral.value - cap), 1e-2 * cap);
  EXPECT_LT(result.evaluations, 200'000'000);
}

TEST(DomainIntegral, PoleInTheKernelIsChosenForAnLShape) {
  // sqrt(2.2 - x - y) is undefined beyond the notch's corner (1, 1) but defined on the L.
  geometry::Points<2> corners(2, 6);
  corners << 0, 2, 2, 1, 1, 0,  //
      0, 0, 0.15, 0.15, 1, 1;
  const ElementTable<2> shape = bezier_elements(geometry::polygon(corners));
  const auto f = in_plane([](const Point2& x) { return std::sqrt(2.2 - x[0] - x[1]); });
  const auto antiderivative = [](double s) { return 4.0 / 15.0 * std::pow(s, 2.5); };
  const auto box = [&](double x0, double x1, double y0, double y1) {
    return antiderivative(2.2 - x0 - y0) - antiderivative(2.2 - x1 - y0) - antiderivative(2.2 - x0 - y1) +
           antiderivative(2.2 - x1 - y1);
  };
  const double exact = box(0, 2, 0, 0.15) + box(0, 1, 0.15, 1);
  expect_integral(integrate_over_domain<2>(shape, f, std::nullopt, {}), exact, exact, "L");
}

TEST(DomainIntegral, FixedRuleReportsItself) {
  Options options;
  options.fixed_points = 5;
  const auto f = in_plane([](const Point2& x) { return std::exp(x[0]); });
  const IntegralResult result =
      integrate_over_domain<2>(bezier_elements(geometry::rectangle(Vector2(2, 1))), f, std::nullopt, options);
  EXPECT_EQ(result.status, Status::fixed_rule);
  EXPECT_NEAR(result.integral.value, std::exp(2.0) - 1.0, 2.0 * result.integral.error + 1e-15);
  EXPECT_EQ(result.evaluations, 4 * (25 + 36 + 49));
}

TEST(BoundaryIntegral, DivergenceTheorem) {
  // int F.n dS = int div F dV, F = (x^3, y z^2, exp(z)): div F = 3 x^2 + z^2 + exp(z).
  const ElementTable<3> torus = bezier_elements(geometry::torus(1.0, 0.4));
  const auto flux = integrand<3>([](const Point3& x, const Point3& n) {
    return std::pow(x[0], 3) * n[0] + x[1] * x[2] * x[2] * n[1] + std::exp(x[2]) * n[2];
  });
  const auto divergence = in_space([](const Point3& x) { return 3 * x[0] * x[0] + x[2] * x[2] + std::exp(x[2]); });
  const IntegralResult surface = integrate_over_boundary<3>(torus, flux, {});
  const IntegralResult volume = integrate_over_domain<3>(torus, divergence, std::nullopt, {});
  expect_integral(surface, volume.integral.value, volume.integral.value, "flux");
}

TEST(BoundaryIntegral, LineIntegralOnTheCircle) {
  // int x^2 ds over the circle of radius 2 is pi 8.
  const auto f = in_plane([](const Point2& x) { return x[0] * x[0]; });
  expect_integral(integrate_over_boundary<2>(bezier_elements(geometry::disc(2.0)), f, {}), 8.0 * pi, 8.0 * pi,
                  "circle");
}

TEST(BoundaryIntegral, VanishingIntegralConverges) {
  const auto f = in_space([](const Point3& x) { return x[0] * x[1] * x[2]; });
  const IntegralResult result = integrate_over_boundary<3>(bezier_elements(geometry::sphere(1.0)), f, {});
  expect_integral(result, 0.0, 1.0, "odd");
}

TEST(BoundaryIntegral, NormalsAreOutwardUnitVectors) {
  const ElementTable<3> ball = bezier_elements(geometry::sphere(3.0, Point3(1, 2, 3)));
  const auto f = integrand<3>([](const Point3& x, const Point3& n) {
    EXPECT_LT((n - (x - Point3(1, 2, 3)) / 3.0).norm(), 1e-13);
    return 1.0;
  });
  expect_integral(integrate_over_boundary<3>(ball, f, {}), 36.0 * pi, 36.0 * pi, "area");
}

}  // namespace
}  // namespace isorim::quadrature
