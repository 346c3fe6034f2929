#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/nurbs/curve.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using std::numbers::pi;
using testing::circle;
using testing::Random;

NurbsCurve<2> parabola() {
  Points<2> points(2, 3);
  points << 0, 0.5, 1, 0, 0, 1;
  return NurbsCurve<2>::from_points(KnotVector::bezier(2), points);
}

/// Length of y = x^2 from 0 to x.
double parabola_length(double x) {
  return 0.5 * x * std::sqrt(1 + 4 * x * x) + 0.25 * std::asinh(2 * x);
}

void expect_length(const ArcLength& length, double expected, double tolerance) {
  EXPECT_LE(std::abs(length.value - expected), tolerance * expected);
  EXPECT_LE(std::abs(length.value - expected), 2.0 * length.error);
  EXPECT_LE(length.error, 1e-13 * expected);
}

TEST(ArcLength, OfTheCircle) {
  expect_length(arc_length(circle(2.0, {1, 1}), {0, 1}), 4 * pi, 2e-15);
}

TEST(ArcLength, OfAQuarterOfTheCircle) {
  expect_length(arc_length(circle(2.0, {1, 1}), {0.25, 0.5}), pi, 2e-15);
  expect_length(arc_length(circle(2.0, {1, 1}), {0.125, 0.375}), pi, 2e-15);
}

TEST(ArcLength, OfTheParabola) {
  for (const double x : {1e-3, 0.3, 1.0}) expect_length(arc_length(parabola(), {0, x}), parabola_length(x), 4e-15);
}

TEST(ArcLength, OfTheEllipse) {
  AffineMap<2> map;
  map.linear << 2, 0, 0, 1;
  expect_length(arc_length(transform(circle(1.0, {0, 0}), map), {0, 1}), 9.68844822054767620, 4e-15);
}

TEST(ArcLength, OfACuspIsExactToItsEstimate) {
  // (t^2, t^3) over [-1, 1]: the speed |t| sqrt(4 + 9 t^2) has a kink inside the segment, at an uneven place.
  Points<2> points(2, 4);
  points << 1, -1.0 / 3, -1.0 / 3, 1, -1, 1, -1, 1;
  const NurbsCurve<2> cusp = NurbsCurve<2>::from_points(KnotVector::bezier(3), points);
  const auto from_zero = [](double t) { return (std::pow(4 + 9 * t * t, 1.5) - 8) / 27; };
  const ArcLength length = arc_length(cusp, {0.1, 1.0});
  const double expected = from_zero(0.8) + from_zero(1.0);
  EXPECT_LE(std::abs(length.value - expected), 2.0 * length.error);
  EXPECT_LE(length.error, 1e-12);
}

TEST(ArcLength, EstimateIsNeverBelowHalfTheError) {
  Random random(90);
  for (int trial = 0; trial < 100; ++trial) {
    const NurbsCurve<2> curve = testing::random_curve<2>(random, testing::random_knots(random, random.integer(1, 6)));
    const ArcLength best = arc_length(curve, curve.domain());
    for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-9}) {
      const ArcLength coarse = arc_length(curve, curve.domain(), tolerance);
      EXPECT_LE(std::abs(coarse.value - best.value), 2.0 * coarse.error + best.error);
      EXPECT_LE(coarse.error, tolerance * coarse.value * (1 + 1e-10) + 1e-14 * coarse.value);
    }
  }
}

TEST(ArcLength, IsAdditiveAndInvariantUnderReversal) {
  Random random(91);
  for (int trial = 0; trial < 50; ++trial) {
    const NurbsCurve<3> curve = testing::random_curve<3>(random, testing::random_knots(random, random.integer(1, 6)));
    const double u = random.inside(curve.domain());
    const double whole = arc_length(curve, curve.domain()).value;
    const double parts =
        arc_length(curve, {curve.domain().first, u}).value + arc_length(curve, {u, curve.domain().last}).value;
    EXPECT_NEAR(parts, whole, 1e-13 * whole);
    EXPECT_NEAR(arc_length(reverse(curve), curve.domain()).value, whole, 1e-13 * whole);
  }
}

TEST(ArcLength, OfAnEmptyPieceIsZero) {
  EXPECT_EQ(arc_length(parabola(), {0.5, 0.5}).value, 0.0);
}

TEST(ArcLength, ParameterAtLengthInvertsIt) {
  Random random(92);
  for (int trial = 0; trial < 50; ++trial) {
    const NurbsCurve<2> curve = testing::random_curve<2>(random, testing::random_knots(random, random.integer(1, 6)));
    const double whole = arc_length(curve, curve.domain()).value;
    const double length = random.real(0, whole);
    const double u = parameter_at_length(curve, length);
    EXPECT_NEAR(arc_length(curve, {curve.domain().first, u}).value, length, 1e-12 * whole);
  }
}

TEST(ArcLength, ParameterAtLengthIsClippedToTheDomain) {
  EXPECT_EQ(parameter_at_length(parabola(), -1.0), 0.0);
  EXPECT_EQ(parameter_at_length(parabola(), 0.0), 0.0);
  EXPECT_EQ(parameter_at_length(parabola(), 10.0), 1.0);
  EXPECT_NEAR(parameter_at_length(circle(1.0, {0, 0}), pi), 0.5, 1e-15);
}

TEST(ArcLength, RefusesBadInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GEOMETRY_ERROR(arc_length(parabola(), {0.0, 2.0}), "[0, 2] is no interval inside the domain [0, 1]");
  EXPECT_GEOMETRY_ERROR(arc_length(parabola(), {0.7, 0.2}), "[0.7, 0.2] is no interval");
  EXPECT_GEOMETRY_ERROR(arc_length(parabola(), {0.0, 1.0}, -1.0), "tolerance -1 is negative");
  EXPECT_GEOMETRY_ERROR(parameter_at_length(parabola(), nan), "the length asked for is nan");
}

}  // namespace
}  // namespace isorim::geometry
