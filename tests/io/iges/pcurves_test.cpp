#include "io/iges/pcurves.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "tests/geometry/expect_error.h"

namespace isorim::io::iges {
namespace {

using geometry::Interval;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;

constexpr double pi = std::numbers::pi;
constexpr Interval unit{0.0, 1.0};

/// The angle of a circle's point at a parameter of the NURBS: what the map inverts.
double angle_at(const NurbsCurve<2>& arc, double u) {
  const Point2 p = evaluate(arc, u);
  return std::atan2(p.y(), p.x());
}

TEST(IgesParameterMap, FollowsTheAngleOfRationalArcs) {
  for (const double sweep : {0.1, 0.5 * pi, 3.0, 2.0 * pi}) {
    const NurbsCurve<2> arc = geometry::unit_arc(0.3, 0.3 + sweep);
    const int pieces = static_cast<int>(arc.homogeneous().cols() - 1) / 2;
    const ParameterMap map = ParameterMap::arc({0.3, 0.3 + sweep}, pieces);
    for (int i = 0; i <= 50; ++i) {
      const double angle = i == 50 ? 0.3 + sweep : 0.3 + sweep * i / 50;
      const double u = map(angle);
      EXPECT_NEAR(std::remainder(angle_at(arc, u) - angle, 2.0 * pi), 0.0, 2e-15);
      const double step = 1e-6;
      if (i > 0 && i < 50) {
        EXPECT_NEAR(map.derivative(angle), (map(angle + step) - map(angle - step)) / (2.0 * step), 1e-6);
      }
    }
    EXPECT_EQ(map(0.3), 0.0);
    EXPECT_EQ(map(0.3 + sweep), 1.0);
  }
}

TEST(IgesParameterMap, IsExactAtQuarterTurnsInDegrees) {
  const ParameterMap map = ParameterMap::arc({0.0, 360.0}, 4, pi / 180.0, true);
  for (int i = 0; i <= 4; ++i) EXPECT_EQ(map(90.0 * i), 0.25 * i);
  EXPECT_NEAR(map(45.0), 0.125, 1e-16);
  EXPECT_EQ(map(-90.0), -0.25);
  EXPECT_EQ(map(450.0), 1.25);
}

TEST(IgesParameterMap, ContinuesStraightWhereItIsNotPeriodic) {
  const ParameterMap map = ParameterMap::arc({0.0, 1.0}, 1);
  EXPECT_NEAR(map(1.0 + 1e-9), 1.0 + 1e-9 * map.derivative(1.0), 1e-16);
  EXPECT_NEAR(map(-1e-9), -1e-9 * map.derivative(0.0), 1e-16);
}

TEST(IgesParameterMap, CanBeShiftedAndMovedOntoAnotherInterval) {
  const ParameterMap map = ParameterMap::arc({1.5 * pi, 2.5 * pi}, 2);
  const ParameterMap shifted = map.shifted(2.0 * pi);
  const ParameterMap relative = map.over({0.0, 1.0});
  for (const double part : {0.0, 0.1, 0.5, 0.7, 1.0}) {
    EXPECT_NEAR(shifted(-0.5 * pi + part * pi), map(1.5 * pi + part * pi), 1e-15);
    EXPECT_NEAR(relative(part), map(1.5 * pi + part * pi), 1e-15);
  }
  EXPECT_EQ(shifted.breakpoints({-2.0, 2.0}).size(), 3U);
  EXPECT_GEOMETRY_ERROR(ParameterMap().over({0.0, 1.0}), "identity");
}

TEST(IgesParameterMap, BreakpointsFollowTheTurns) {
  const ParameterMap map = ParameterMap::arc({0.0, 360.0}, 4, pi / 180.0, true);
  EXPECT_EQ(map.breakpoints({-100.0, 190.0}), (std::vector<double>{-90.0, 0.0, 90.0, 180.0}));
  EXPECT_GEOMETRY_ERROR(map.breakpoints({0.0, 1e9}), "more than 64 turns");
}

NurbsCurve<2> segment(const Point2& from, const Point2& to) {
  return geometry::line_segment<2>(from, to);
}

TEST(IgesPcurves, IdentityKeepsEveryBit) {
  Points<2> points(2, 3);
  points << 0.1, 0.4, 0.9, 1.0 / 3.0, 0.7, 0.2;
  const NurbsCurve<2> curve =
      NurbsCurve<2>::from_points(KnotVector::bezier(2), points, std::vector<double>{1.0, 0.37, 1.1});
  const MappedPcurve mapped = map_pcurve(curve, {}, {}, unit, unit);
  EXPECT_EQ(mapped.curve.homogeneous(), curve.homogeneous());
  EXPECT_EQ(mapped.deviation, 0.0);
}

TEST(IgesPcurves, AffineMapsAreExactForRationalCurves) {
  const NurbsCurve<2> circle = geometry::circle_curve(0.2, {0.5, 0.5});
  const ParameterMap half = ParameterMap::affine({0.0, 1.0}, {0.0, 4.0});
  const MappedPcurve mapped = map_pcurve(circle, half, {}, {0.0, 4.0}, unit);
  EXPECT_EQ(mapped.deviation, 0.0);
  EXPECT_EQ(mapped.curve.degree(), 2);
  for (const double s : {0.0, 0.3, 0.8}) {
    const Point2 p = evaluate(circle, s);
    EXPECT_LE((evaluate(mapped.curve, s) - Point2(4.0 * p.x(), p.y())).norm(), 1e-15);
  }
}

TEST(IgesPcurves, LinesAtAConstantParameterStayLines) {
  const ParameterMap angle = ParameterMap::arc({0.0, 2.0 * pi}, 4, 1.0, true);
  const MappedPcurve along = map_pcurve(segment({0.25, 0.0}, {0.25, 2.0 * pi}), {}, angle, unit, unit);
  EXPECT_EQ(along.deviation, 0.0);
  EXPECT_EQ(along.curve.degree(), 1);
  EXPECT_EQ(along.curve.control_points().col(0), Point2(0.25, 0.0));
  EXPECT_EQ(along.curve.control_points().col(1), Point2(0.25, 1.0));
  const MappedPcurve across = map_pcurve(segment({1.0, 0.5 * pi}, {0.0, 0.5 * pi}), {}, angle, unit, unit);
  EXPECT_EQ(across.deviation, 0.0);
  EXPECT_EQ(across.curve.control_points().col(0), Point2(1.0, 0.25));
  EXPECT_EQ(across.curve.control_points().col(1), Point2(0.0, 0.25));
  // Constant but for the rounding of the program that wrote it.
  const MappedPcurve nearly = map_pcurve(segment({1e-15, 0.0}, {0.0, 2.0 * pi}), {}, angle, unit, unit);
  EXPECT_EQ(nearly.curve.degree(), 1);
  EXPECT_EQ(nearly.deviation, 0.0);
}

TEST(IgesPcurves, OtherCurvesAreFittedToThirteenDigits) {
  const ParameterMap angle_u = ParameterMap::arc({-0.5 * pi, 0.5 * pi}, 2);
  const ParameterMap angle_v = ParameterMap::arc({0.0, 2.0 * pi}, 4, 1.0, true);
  Points<2> points(2, 4);
  points << -1.2, 0.0, 1.5, 0.3, 0.1, 3.0, 5.0, 6.5;
  const std::vector<NurbsCurve<2>> curves{
      segment({-1.0, 0.3}, {1.4, 6.0}), segment({0.0, 0.5 * pi}, {0.5, pi}),
      NurbsCurve<2>::from_points(KnotVector::bezier(3), points),
      NurbsCurve<2>::from_points(KnotVector::bezier(3), points, std::vector<double>{1.0, 0.3, 2.0, 1.0}),
      geometry::circle_curve(1.0, {0.2, 3.0})};
  for (const NurbsCurve<2>& curve : curves) {
    const MappedPcurve mapped = map_pcurve(curve, angle_u, angle_v, unit, unit);
    EXPECT_LE(mapped.deviation, pcurve_tolerance);
    const Interval domain = curve.domain();
    EXPECT_EQ(mapped.curve.domain().first, domain.first);
    for (int i = 0; i <= 1000; ++i) {
      const double s = domain.first + domain.length() * i / 1000;
      const Point2 t = evaluate(curve, s);
      EXPECT_LE((evaluate(mapped.curve, s) - Point2(angle_u(t.x()), angle_v(t.y()))).norm(), 2.0 * pcurve_tolerance);
    }
  }
}

TEST(IgesPcurves, FitsAreSplitWhereTheMapsChange) {
  const ParameterMap angle = ParameterMap::arc({0.0, 2.0 * pi}, 4, 1.0, true);
  const MappedPcurve mapped = map_pcurve(segment({0.0, 0.25 * pi}, {1.0, 1.25 * pi}), {}, angle, unit, unit);
  const std::vector<double> knots = mapped.curve.knots().breakpoints();
  // pi / 2 and pi lie at 1/4 and 3/4 of the line; the pieces between are smooth and need few.
  EXPECT_TRUE(std::ranges::any_of(knots, [](double s) { return std::abs(s - 0.25) < 1e-12; }));
  EXPECT_TRUE(std::ranges::any_of(knots, [](double s) { return std::abs(s - 0.75) < 1e-12; }));
  EXPECT_LE(knots.size(), 7U);
}

}  // namespace
}  // namespace isorim::io::iges
