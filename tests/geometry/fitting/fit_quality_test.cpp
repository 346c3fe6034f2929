#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/foot_points.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using std::numbers::pi;
using testing::Ends;
using testing::Random;

/// Against the search over the whole curve, from guesses that have nothing to do with the target.
TEST(SegmentedCurve, NearestPointsAreGlobal) {
  Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const int degree = random.integer(1, 8);
    const Ends ends = static_cast<Ends>(random.integer(0, 2));
    const KnotVector knots = testing::random_knots(random, degree, ends, random.integer(1, degree));
    Points<3> points(3, knots.basis_count());
    for (double& x : points.reshaped()) x = random.real(-1, 1);
    const bool closed = ends == Ends::periodic;
    if (closed) points.rightCols(degree) = points.leftCols(degree);
    const NurbsCurve<3> curve = NurbsCurve<3>::from_points(knots, points);
    const SegmentedCurve<3> segments(knots, points, closed);
    for (int i = 0; i < 20; ++i) {
      const Point3 target(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
      const ClosestCurvePoint<3> found = segments.nearest(target, random.inside(knots.domain()));
      EXPECT_NEAR(found.distance, closest_point(curve, target).distance, 1e-13);
      EXPECT_NEAR((evaluate(curve, found.u) - target).norm(), found.distance, 1e-13);
    }
  }
}

TEST(SegmentedCurve, DerivativesAreThoseOfTheCurve) {
  Random random(4);
  for (int trial = 0; trial < 40; ++trial) {
    const KnotVector knots = testing::random_knots(random, random.integer(1, 8));
    Points<2> points(2, knots.basis_count());
    for (double& x : points.reshaped()) x = random.real(-1, 1);
    const NurbsCurve<2> curve = NurbsCurve<2>::from_points(knots, points);
    const SegmentedCurve<2> segments(knots, points, false);
    const double u = random.inside(knots.domain());
    const CurveJet<2> expected = evaluate_jet(curve, u);
    const CurveJet<2> found = segments.jet(u);
    EXPECT_LT((found.point - expected.point).norm(), 1e-14);
    EXPECT_LT((found.du - expected.du).norm(), 1e-12 * (1 + expected.du.norm()));
    EXPECT_LT((found.duu - expected.duu).norm(), 1e-11 * (1 + expected.duu.norm()));
  }
}

/// y = x^2 from -a to a has length L = 2 s(a) and bending int 4 (1 + 4 x^2)^(-5/2) dx.
TEST(FitQuality, BendingEnergyOfAParabola) {
  const double a = 1.5;
  Points<2> points(2, 3);
  points << -a, 0, a, a * a, -a * a, a * a;
  const NurbsCurve<2> curve = NurbsCurve<2>::from_points(KnotVector::bezier(2), points);
  const double length = a * std::sqrt(1 + 4 * a * a) + 0.5 * std::asinh(2 * a);
  const double root = std::sqrt(1 + 4 * a * a);
  const double bending = 8 * (a / root - 4.0 / 3.0 * std::pow(a / root, 3));
  const double by_parts = 8 * (a / (3 * std::pow(root, 3)) + 2 * a / (3 * root));
  EXPECT_NEAR(bending, by_parts, 1e-12);
  const FitQuality<2> quality = fit_quality(curve, points, false);
  EXPECT_NEAR(quality.bending_energy, length * by_parts, 1e-6 * length * by_parts);
  EXPECT_EQ(quality.curvature_sign_changes, 0);
  EXPECT_EQ(quality.worst_point, 1);
}

/// A periodic cubic through many points of a circle.
TEST(FitQuality, BendingEnergyOfACircleIsFourPiSquared) {
  const int count = 200;
  Points<2> points(2, count);
  for (int i = 0; i < count; ++i) points.col(i) << 7 * std::cos(2 * pi * i / count), 7 * std::sin(2 * pi * i / count);
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.control_points = 100;
  const CurveFit<2> fit = fit_points(points, options);
  EXPECT_NEAR(fit.quality.bending_energy, 4 * pi * pi, 1e-4);
  EXPECT_EQ(fit.quality.curvature_sign_changes, 0);
  EXPECT_LT(fit.quality.max_distance, 1e-6);
}

/// A lemniscate turns left on one loop and right on the other; the three-leaved one changes six times.
TEST(FitQuality, CountsSignChangesOfCurvature) {
  const int count = 300;
  const auto changes = [&](const auto& curve) {
    Points<2> points(2, count);
    for (int i = 0; i < count; ++i) points.col(i) = curve(2 * pi * (i + 0.3) / count);
    CurveFitOptions<2> options;
    options.method = FitMethod::fixed_knots;
    options.control_points = 60;
    return fit_points(points, options).quality.curvature_sign_changes;
  };
  EXPECT_EQ(changes([](double t) { return Point2(std::sin(t), std::sin(t) * std::cos(t)); }), 2);
  EXPECT_EQ(changes([](double t) { return Point2((1 + 0.4 * std::cos(3 * t)) * Point2(std::cos(t), std::sin(t))); }),
            6);
  EXPECT_EQ(changes([](double t) { return Point2(3 * std::cos(t), std::sin(t)); }), 0);
}

TEST(FitQuality, IsOfPolynomialCurvesOnly) {
  EXPECT_GEOMETRY_ERROR(fit_quality(testing::circle(1.0, {0, 0}), Points<2>(Points<2>::Zero(2, 1)), true), "rational");
}

}  // namespace
}  // namespace isorim::geometry
