#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/fitting/curve_fit.h"
#include "geometry/spline/bspline.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using std::numbers::pi;
using testing::Random;

Point3 helix(double t) {
  return {std::cos(t), std::sin(t), 0.3 * t};
}

Points<3> helix_points(int count) {
  Points<3> points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) = helix(2 * pi * i / (count - 1));
  return points;
}

CurveFitOptions<3> open_options(int degree, int control_points) {
  CurveFitOptions<3> options;
  options.method = FitMethod::fixed_knots;
  options.closed = false;
  options.degree = degree;
  options.control_points = control_points;
  return options;
}

TEST(OpenFit, ReproducesASplineOnItsKnots) {
  Random random(6);
  for (int trial = 0; trial < 60; ++trial) {
    const int degree = random.integer(1, 7);
    const int spans = random.integer(1, 12);
    std::vector<double> breakpoints{0.0};
    for (int i = 0; i < spans; ++i) breakpoints.push_back(breakpoints.back() + random.real(0.4, 1.0));
    for (double& u : breakpoints) u /= breakpoints.back();
    breakpoints.back() = 1.0;
    const KnotVector knots = KnotVector::clamped(degree, breakpoints);
    Points<3> control(3, knots.basis_count());
    for (double& x : control.reshaped()) x = random.real(-1, 1);
    const NurbsCurve<3> curve = NurbsCurve<3>::from_points(knots, control);
    const int count = 6 * knots.basis_count();
    Points<3> points(3, count);
    for (int i = 0; i < count; ++i) points.col(i) = evaluate(curve, static_cast<double>(i) / (count - 1));
    CurveFitOptions<3> options = open_options(degree, 0);
    options.parameters = FitParameters::uniform;
    options.knots = FitKnots::given;
    options.breakpoints = breakpoints;
    for (const FitEnd end : {FitEnd::free, FitEnd::interpolated}) {
      options.start = options.end = end;
      const CurveFit<3> fit = fit_points(points, options);
      EXPECT_LT((fit.curve.control_points() - control).cwiseAbs().maxCoeff(), 1e-11) << degree;
      EXPECT_LT(fit.quality.max_distance, 1e-13);
    }
  }
}

TEST(OpenFit, InterpolatesWithAnyDegreeAndEnds) {
  const Points<3> points = helix_points(17);
  for (int degree = 2; degree <= 6; ++degree)
    for (const FitEnd start : {FitEnd::free, FitEnd::interpolated, FitEnd::natural, FitEnd::tangent})
      for (const FitEnd end : {FitEnd::free, FitEnd::interpolated, FitEnd::natural, FitEnd::tangent}) {
        const auto extra = [](FitEnd e) { return e == FitEnd::natural || e == FitEnd::tangent ? 1 : 0; };
        CurveFitOptions<3> options = open_options(degree, 17 + extra(start) + extra(end));
        options.start = start;
        options.end = end;
        options.start_tangent = Vector3(0, 2, 0.6);
        options.end_tangent = Vector3(0, 1, 0.3);
        const CurveFit<3> fit = fit_points(points, options);
        EXPECT_LT(fit.quality.max_distance, 1e-12) << degree << static_cast<int>(start) << static_cast<int>(end);
      }
}

/// Without a number of control points half as many as there are points are taken, whatever rounding makes of their
/// turns and wherever the ends are.
TEST(OpenFit, TakesHalfAsManyControlPointsOnLinesAndWhereTheEndsMeet) {
  Points<2> line(2, 30);
  Points<2> circle(2, 41);
  for (Eigen::Index i = 0; i < line.cols(); ++i)
    line.col(i) << 0.1 * static_cast<double>(i), 0.3 * static_cast<double>(i);
  for (Eigen::Index i = 0; i < circle.cols(); ++i) {
    const double angle = 2.0 * pi * static_cast<double>(i % 40) / 40.0;
    circle.col(i) << std::cos(angle), std::sin(angle);
  }
  CurveFitOptions<2> options;
  options.closed = false;
  const CurveFit<2> of_line = fit_points<2>(line, options);
  EXPECT_EQ(of_line.control_points, 15);
  EXPECT_LT(of_line.quality.max_distance, 1e-14);
  const CurveFit<2> of_circle = fit_points<2>(circle, options);
  EXPECT_EQ(of_circle.control_points, 20);
  EXPECT_LT(of_circle.quality.max_distance, 2e-4);
}

TEST(OpenFit, MeetsItsEnds) {
  const Points<3> points = helix_points(60);
  for (int degree = 2; degree <= 6; ++degree) {
    CurveFitOptions<3> options = open_options(degree, 14);
    options.start = FitEnd::natural;
    options.end = FitEnd::tangent;
    options.end_tangent = Vector3(0, 5, 1.5);
    const CurveFit<3> fit = fit_points(points, options);
    EXPECT_EQ(evaluate(fit.curve, 0.0), points.col(0));
    EXPECT_EQ(evaluate(fit.curve, 1.0), points.col(59));
    EXPECT_LT(evaluate_jet(fit.curve, 0.0).duu.norm(), 1e-9);
    const Vector3 tangent = evaluate_jet(fit.curve, 1.0).du;
    EXPECT_LT((tangent.normalized() - options.end_tangent.normalized()).norm(), 1e-12);
    double length = 0.0;
    for (int i = 1; i < 60; ++i) length += (points.col(i) - points.col(i - 1)).norm();
    EXPECT_NEAR(tangent.norm(), length, 1e-11 * length);
  }
}

/// A natural cubic spline through the points is the solution of the classical tridiagonal system for the second
/// derivatives (Press et al., Numerical Recipes, section 3.3).
TEST(OpenFit, TheNaturalCubicIsTheClassicalOne) {
  const int n = 9;
  const double h = 1.0 / (n - 1);
  Points<2> points(2, n);
  for (int i = 0; i < n; ++i) points.col(i) << std::sin(5.0 * i * h), std::exp(-2.0 * i * h);
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.closed = false;
  options.control_points = n + 2;
  options.parameters = FitParameters::uniform;
  options.start = options.end = FitEnd::natural;
  options.knots = FitKnots::given;
  for (int i = 0; i < n; ++i) options.breakpoints.push_back(i == n - 1 ? 1.0 : i * h);
  const CurveFit<2> fit = fit_points(points, options);

  for (int d = 0; d < 2; ++d) {
    std::vector<double> second(n, 0.0);
    std::vector<double> ratio(n, 0.0);
    for (int i = 1; i < n - 1; ++i) {
      const std::size_t s = static_cast<std::size_t>(i);
      const double pivot = 4.0 - ratio[s - 1];
      ratio[s] = 1.0 / pivot;
      second[s] = (6.0 * (points(d, i + 1) - 2.0 * points(d, i) + points(d, i - 1)) / (h * h) - second[s - 1]) / pivot;
    }
    for (int i = n - 3; i > 0; --i)
      second[static_cast<std::size_t>(i)] -=
          ratio[static_cast<std::size_t>(i)] * second[static_cast<std::size_t>(i) + 1];
    for (int i = 0; i < n; ++i)
      EXPECT_NEAR(evaluate_jet(fit.curve, options.breakpoints[static_cast<std::size_t>(i)]).duu[d],
                  second[static_cast<std::size_t>(i)], 1e-9);
  }
}

/// The error of approximation falls with the power degree + 1 of the number of spans.
TEST(OpenFit, ConvergesWithItsOrder) {
  const Points<3> points = helix_points(2001);
  for (int degree = 2; degree <= 5; ++degree) {
    std::vector<double> errors;
    for (const int spans : {8, 16, 32}) {
      const CurveFit<3> fit = fit_points(points, open_options(degree, spans + degree));
      errors.push_back(fit.quality.max_distance);
    }
    const double order = std::log2(errors[0] / errors[2]) / 2.0;
    EXPECT_GT(order, degree + 0.5) << degree;
  }
}

TEST(OpenFit, FindsCorners) {
  Points<2> points(2, 11);
  for (int i = 0; i < 11; ++i) points.col(i) << 0.1 * i, std::abs(0.1 * i - 0.5);
  CurveFitOptions<2> options;
  options.closed = false;
  options.corner_angle = 60;
  options.control_points = 9;
  const CurveFit<2> fit = fit_points(points, options);
  EXPECT_EQ(fit.corners, std::vector<int>{5});
  EXPECT_LT(fit.quality.max_distance, 1e-14);
  EXPECT_EQ(fit.curve.knots().multiplicity(0.5), 3);
}

}  // namespace
}  // namespace isorim::geometry
