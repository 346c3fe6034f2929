#include "io/iges/curves.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"

namespace isorim::io::iges {
namespace {

using geometry::AffineMap;
using geometry::Interval;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

constexpr double pi = std::numbers::pi;

/// Calls check(t, point) at many parameters of the curve, ends included.
template <class Check>
void sample(const ParametrisedCurve& curve, const Check& check) {
  const Interval range = parameter_range(curve);
  constexpr int count = 64;
  for (int i = 0; i <= count; ++i) {
    const double t = i == count ? range.last : range.first + range.length() * i / count;
    check(t, evaluate_at(curve, t));
  }
}

Point2 on_circle(const Point2& centre, double radius, double angle) {
  return centre + radius * Point2(std::cos(angle), std::sin(angle));
}

TEST(IgesCurves, ArcsHaveTheirAngleAsParameter) {
  const Point2 centre(1.5, -0.25);
  constexpr double radius = 2.0;
  for (const double first : {0.0, 0.3, 0.5 * pi, 2.0, 4.0, 6.2})
    for (const double sweep : {1e-3, 0.1, 0.5 * pi, 2.0, pi, 4.5, 6.2}) {
      const Point2 start = on_circle(centre, radius, first);
      const ParametrisedCurve curve = arc(0.75, centre, start, on_circle(centre, radius, first + sweep));
      EXPECT_NEAR(parameter_range(curve).first, first, 2e-15);
      EXPECT_NEAR(parameter_range(curve).length(), sweep, 4e-15);
      EXPECT_EQ(evaluate(curve.curve, curve.curve.domain().first).head<2>(), start);
      sample(curve, [&](double t, const Point3& point) {
        const Point2 expected = on_circle(centre, radius, t);
        // The angle itself is known to half its last bit.
        EXPECT_LE((point - Point3(expected.x(), expected.y(), 0.75)).norm(), 2e-15 + 2.3e-16 * radius * t)
            << first << " " << sweep << " " << t;
      });
    }
}

TEST(IgesCurves, AnArcWhoseEndsCoincideIsTheWholeCircle) {
  const ParametrisedCurve curve = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0});
  EXPECT_EQ(parameter_range(curve).first, 0.0);
  EXPECT_EQ(parameter_range(curve).last, 2.0 * pi);
  EXPECT_EQ(curve.parameters.period(), 2.0 * pi);
  EXPECT_LE((evaluate_at(curve, 1.25) - Point3(std::cos(1.25), std::sin(1.25), 0.0)).norm(), 1e-15);
  // As rounding programs write it.
  const ParametrisedCurve rounded = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {1.0, 2.4e-16});
  EXPECT_NEAR(parameter_range(rounded).length(), 2.0 * pi, 1e-15);
  const ParametrisedCurve below = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {1.0, -2.4e-16});
  EXPECT_NEAR(parameter_range(below).length(), 2.0 * pi, 1e-15);
}

TEST(IgesCurves, ArcsWithoutRadiusAreRefused) {
  EXPECT_GEOMETRY_ERROR(arc(0.0, {1.0, 1.0}, {1.0, 1.0}, {2.0, 1.0}), "0 apart");
}

TEST(IgesCurves, EllipsesHaveTheEccentricAngleAsParameter) {
  constexpr double a = 3.0;
  constexpr double b = 0.5;
  const auto at = [](double t) { return Point2(a * std::cos(t), b * std::sin(t)); };
  for (const double first : {0.0, 1.0, 3.5})
    for (const double sweep : {0.2, 0.5 * pi, 3.0, 5.5}) {
      // The scale of the coefficients means nothing, nor does their sign.
      const double scale = -7.0;
      const Conic conic{.a = scale / (a * a), .c = scale / (b * b), .f = -scale};
      const ParametrisedCurve curve = conic_arc(conic, -1.0, at(first), at(first + sweep));
      EXPECT_NEAR(parameter_range(curve).first, first, 4e-15);
      EXPECT_NEAR(parameter_range(curve).length(), sweep, 8e-15);
      sample(curve, [&](double t, const Point3& point) {
        EXPECT_LE((point.head<2>() - at(t)).norm(), 1e-14);
        EXPECT_NEAR(point.z(), -1.0, 1e-15);
      });
    }
}

/// The conic a x^2 + .. = 0 after its plane has been moved.
Conic moved(const Conic& q, double angle, const Point2& centre) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Conic r;
  r.a = q.a * c * c + q.c * s * s - q.b * c * s;
  r.b = 2.0 * (q.a - q.c) * c * s + q.b * (c * c - s * s);
  r.c = q.a * s * s + q.c * c * c + q.b * c * s;
  const double d = q.d * c - q.e * s;
  const double e = q.d * s + q.e * c;
  const double x = centre.x();
  const double y = centre.y();
  r.d = d - 2.0 * r.a * x - r.b * y;
  r.e = e - r.b * x - 2.0 * r.c * y;
  r.f = q.f + r.a * x * x + r.b * x * y + r.c * y * y - d * x - e * y;
  return r;
}

double residual(const Conic& q, const Point3& p) {
  return q.a * p.x() * p.x() + q.b * p.x() * p.y() + q.c * p.y() * p.y() + q.d * p.x() + q.e * p.y() + q.f;
}

TEST(IgesCurves, ConicsElsewhereThanInStandardPositionAreOnTheirEquation) {
  const Point2 centre(0.7, -1.1);
  const AffineMap<2> map = [&] {
    AffineMap<2> result;
    result.linear << std::cos(0.6), -std::sin(0.6), std::sin(0.6), std::cos(0.6);
    result.translation = centre;
    return result;
  }();
  struct Case {
    Conic conic;
    Point2 start;
    Point2 end;
  };
  const std::vector<Case> cases{{{.a = 0.25, .c = 1.0, .f = -1.0}, {2.0, 0.0}, {0.0, 1.0}},
                                {{.a = 1.0, .c = -1.0, .f = -1.0}, {std::sqrt(2.0), -1.0}, {std::sqrt(5.0), 2.0}},
                                {{.a = -1.0, .c = 1.0, .f = -1.0}, {-1.0, std::sqrt(2.0)}, {2.0, std::sqrt(5.0)}},
                                {{.a = 1.0, .e = -1.0}, {-1.0, 1.0}, {2.0, 4.0}},
                                {{.c = 1.0, .d = 2.0}, {-0.5, 1.0}, {-2.0, -2.0}}};
  for (const Case& c : cases) {
    const Conic conic = moved(c.conic, 0.6, centre);
    const ParametrisedCurve curve = conic_arc(conic, 0.0, map(c.start), map(c.end));
    const Interval range = parameter_range(curve);
    EXPECT_LE((evaluate_at(curve, range.first).head<2>() - map(c.start)).norm(), 1e-13);
    EXPECT_LE((evaluate_at(curve, range.last).head<2>() - map(c.end)).norm(), 1e-13);
    sample(curve, [&](double, const Point3& point) { EXPECT_NEAR(residual(conic, point), 0.0, 1e-13); });
  }
}

TEST(IgesCurves, HyperbolasHaveTheAngleOfTheStandardAsParameter) {
  constexpr double a = 1.5;
  constexpr double b = 0.8;
  const auto along_x = [](double t) { return Point2(a / std::cos(t), b * std::tan(t)); };
  const auto along_y = [](double t) { return Point2(b * std::tan(t), a / std::cos(t)); };
  const Conic open_x{.a = 1.0 / (a * a), .c = -1.0 / (b * b), .f = -1.0};
  const Conic open_y{.a = -1.0 / (b * b), .c = 1.0 / (a * a), .f = -1.0};
  for (const Interval range : {Interval{-1.2, 1.4}, Interval{0.3, 0.9}, Interval{-1.3, -0.1}}) {
    sample(conic_arc(open_x, 0.0, along_x(range.first), along_x(range.last)),
           [&](double t, const Point3& p) { EXPECT_LE((p.head<2>() - along_x(t)).norm(), 1e-14 * p.norm()); });
    sample(conic_arc(open_y, 0.0, along_y(range.first), along_y(range.last)),
           [&](double t, const Point3& p) { EXPECT_LE((p.head<2>() - along_y(t)).norm(), 1e-14 * p.norm()); });
    // From the end to the start: the parameter is -t.
    const ParametrisedCurve back = conic_arc(open_x, 0.0, along_x(range.last), along_x(range.first));
    EXPECT_NEAR(parameter_range(back).first, -range.last, 2e-15);
    sample(back, [&](double t, const Point3& p) { EXPECT_LE((p.head<2>() - along_x(-t)).norm(), 1e-14 * p.norm()); });
    // The other branch.
    sample(conic_arc(open_x, 0.0, -along_x(range.first), -along_x(range.last)), [&](double, const Point3& p) {
      EXPECT_LT(p.x(), 0.0);
      EXPECT_NEAR(residual(open_x, p), 0.0, 1e-13 * p.squaredNorm());
    });
  }
}

TEST(IgesCurves, ParabolasHaveACoordinateAsParameter) {
  // y = 2 x^2, and x = -0.5 y^2.
  const Conic upwards{.a = 2.0, .e = -1.0};
  const Conic leftwards{.c = 1.0, .d = 2.0};
  sample(conic_arc(upwards, 0.0, {-1.0, 2.0}, {1.5, 4.5}),
         [](double t, const Point3& p) { EXPECT_LE((p - Point3(t, 2.0 * t * t, 0.0)).norm(), 1e-15); });
  sample(conic_arc(upwards, 0.0, {1.5, 4.5}, {-1.0, 2.0}),
         [](double t, const Point3& p) { EXPECT_LE((p - Point3(-t, 2.0 * t * t, 0.0)).norm(), 1e-15); });
  sample(conic_arc(leftwards, 0.0, {-0.5, -1.0}, {-2.0, 2.0}),
         [](double t, const Point3& p) { EXPECT_LE((p - Point3(-0.5 * t * t, t, 0.0)).norm(), 1e-15); });
  sample(conic_arc(leftwards, 0.0, {-2.0, 2.0}, {-0.5, -1.0}),
         [](double t, const Point3& p) { EXPECT_LE((p - Point3(-0.5 * t * t, -t, 0.0)).norm(), 1e-15); });
  EXPECT_TRUE(conic_arc(upwards, 0.0, {-1.0, 2.0}, {1.5, 4.5}).curve.is_polynomial());
}

TEST(IgesCurves, WhatIsNoConicIsRefused) {
  EXPECT_GEOMETRY_ERROR(conic_arc({}, 0.0, {0.0, 0.0}, {1.0, 0.0}), "describe no conic");
  EXPECT_GEOMETRY_ERROR(conic_arc({.a = 1.0, .c = 1.0, .f = 1.0}, 0.0, {0.0, 0.0}, {1.0, 0.0}), "no real ellipse");
  EXPECT_GEOMETRY_ERROR(conic_arc({.a = 1.0, .f = 1.0}, 0.0, {0.0, 0.0}, {1.0, 0.0}), "no parabola");
}

TEST(IgesCurves, LinearPathsHaveUnitStepsAsParameter) {
  Points<3> points(3, 4);
  points << 0.0, 1.0, 1.0, 4.0, 0.0, 0.0, 2.0, 2.0, 0.0, 1.0, 1.0, 0.0;
  const ParametrisedCurve path = linear_path(points);
  EXPECT_EQ(parameter_range(path).last, 3.0);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(evaluate_at(path, i), points.col(i));
  EXPECT_LE((evaluate_at(path, 2.25) - Point3(1.75, 2.0, 0.75)).norm(), 1e-15);
  EXPECT_GEOMETRY_ERROR(linear_path(points.leftCols(1)), "1 point(s)");
}

TEST(IgesCurves, ParametricSplinesAreTheirPolynomials) {
  for (const int degree : {1, 2, 3}) {
    const std::vector<double> breakpoints{-1.0, 0.5, 3.0};
    std::vector<Eigen::Matrix<double, 3, 4>> pieces(2, Eigen::Matrix<double, 3, 4>::Zero());
    pieces[0].col(0) << 1.0, 2.0, -1.0;
    for (int k = 1; k <= degree; ++k) pieces[0].col(k) << 0.3 * k, -0.7 / k, 0.2 + k;
    const auto at = [&](std::size_t i, double t) {
      const double s = t - breakpoints[i];
      return Point3(pieces[i] * Eigen::Vector4d(1.0, s, s * s, s * s * s));
    };
    pieces[1].col(0) = at(0, breakpoints[1]);
    pieces[1].col(degree) << 1.0, 1.0, -0.5;
    const ParametrisedCurve curve = parametric_spline(breakpoints, pieces);
    EXPECT_EQ(curve.curve.degree(), degree);
    EXPECT_TRUE(curve.curve.is_polynomial());
    sample(curve, [&](double t, const Point3& p) {
      const Point3 expected = at(t < breakpoints[1] ? 0 : 1, t);
      EXPECT_LE((p - expected).norm(), 2e-14 * (1.0 + expected.norm()));
    });
    pieces[1].col(0).x() += 0.1;
    EXPECT_GEOMETRY_ERROR(parametric_spline(breakpoints, pieces), "pieces 1 and 2 are 0.1");
  }
}

BSplineCurveData quadratic() {
  BSplineCurveData data;
  data.degree = 2;
  data.knots = {0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0};
  data.weights = {1.0, 0.7, 1.3, 1.0};
  data.points.resize(3, 4);
  data.points << 0.1, 1.0 / 3.0, 2.0, 3.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.5, 0.5, 1.0;
  data.range = {0.0, 1.0};
  return data;
}

TEST(IgesCurves, BSplinesArriveBitForBit) {
  const BSplineCurveData data = quadratic();
  Remark remark;
  const ParametrisedCurve curve = b_spline(data, remark);
  EXPECT_FALSE(remark);
  EXPECT_TRUE(std::ranges::equal(curve.curve.knots().knots(), data.knots));
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(curve.curve.weights()(i), data.weights[static_cast<std::size_t>(i)]);
    EXPECT_LE((curve.curve.control_points().col(i) - data.points.col(i)).norm(), 2.3e-16);
  }
}

TEST(IgesCurves, APartOfTheKnotsMayBeMeant) {
  BSplineCurveData data = quadratic();
  Remark remark;
  const ParametrisedCurve whole = b_spline(data, remark);
  data.range = {0.2, 0.9};
  const ParametrisedCurve part = b_spline(data, remark);
  EXPECT_FALSE(remark);
  EXPECT_EQ(part.curve.domain().first, 0.2);
  EXPECT_EQ(part.curve.domain().last, 0.9);
  for (const double t : {0.2, 0.3, 0.55, 0.9}) EXPECT_LE((evaluate_at(part, t) - evaluate_at(whole, t)).norm(), 1e-15);
}

TEST(IgesCurves, RangesThatContradictTheKnotsAreTold) {
  BSplineCurveData data = quadratic();
  Remark remark;
  data.range = {0.0, 0.0};
  EXPECT_EQ(b_spline(data, remark).curve.domain().last, 1.0);
  EXPECT_THAT(remark.value_or(""), ::testing::HasSubstr("no part of the knots"));
  remark.reset();
  data.range = {-5.0, 0.5};
  EXPECT_EQ(b_spline(data, remark).curve.domain().last, 0.5);
  EXPECT_THAT(remark.value_or(""), ::testing::HasSubstr("reaches beyond"));
}

TEST(IgesCurves, UnclampedKnotsAreKept) {
  BSplineCurveData data = quadratic();
  data.knots = {-0.4, -0.1, 0.0, 0.3, 1.0, 1.5, 2.0};
  Remark remark;
  const ParametrisedCurve curve = b_spline(data, remark);
  EXPECT_FALSE(remark);
  EXPECT_TRUE(std::ranges::equal(curve.curve.knots().knots(), data.knots));
}

TEST(IgesCurves, WeightsThatAreNotPositiveAreRefused) {
  BSplineCurveData data = quadratic();
  Remark remark;
  data.weights[2] = 0.0;
  EXPECT_GEOMETRY_ERROR(b_spline(data, remark), "weight 2 is 0");
  data.weights[2] = -1.0;
  EXPECT_GEOMETRY_ERROR(b_spline(data, remark), "weight 2 is -1");
}

TEST(IgesCurves, CompositesKeepTheParametersOfTheirPieces) {
  const ParametrisedCurve first = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0});
  const ParametrisedCurve second = line({0.0, 1.0, 0.0}, {-2.0, 1.0, 0.0});
  const ParametrisedCurve third = arc(0.0, {-2.0, 0.0}, {-2.0, 1.0}, {-3.0, 0.0});
  const ParametrisedCurve whole = composite(std::vector{first, second, third}, 1e-12);
  EXPECT_NEAR(parameter_range(whole).last, pi + 1.0, 1e-15);
  for (const double t : {0.0, 0.4, 1.2, 0.5 * pi})
    EXPECT_LE((evaluate_at(whole, t) - evaluate_at(first, t)).norm(), 1e-15);
  EXPECT_LE((evaluate_at(whole, 0.5 * pi + 0.25) - Point3(-0.5, 1.0, 0.0)).norm(), 1e-15);
  for (const double t : {0.1, 0.4, 1.2})
    EXPECT_LE((evaluate_at(whole, 0.5 * pi + 1.0 + t) - evaluate_at(third, 0.5 * pi + t)).norm(), 2e-15);
  EXPECT_GEOMETRY_ERROR(composite(std::vector{first, third}, 1e-3), "2 apart");
}

TEST(IgesCurves, PiecesThatRunBackwardsAreTurned) {
  const ParametrisedCurve first = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0});
  const ParametrisedCurve second = line({0.0, 1.0, 0.0}, {-2.0, 1.0, 0.0});
  const ParametrisedCurve expected = composite(std::vector{first, second}, 1e-12);
  const ParametrisedCurve last_turned = composite(std::vector{first, reverse(second)}, 1e-12);
  const ParametrisedCurve first_turned = composite(std::vector{reverse(first), second}, 1e-12);
  for (const double t : {0.0, 0.4, 1.0, 1.7, 2.5}) {
    EXPECT_LE((evaluate_at(last_turned, t) - evaluate_at(expected, t)).norm(), 2e-15);
    EXPECT_LE((evaluate_at(first_turned, t) - evaluate_at(expected, t)).norm(), 2e-15);
  }
}

TEST(IgesCurves, ReversedCurvesKeepTheirRange) {
  const ParametrisedCurve curve = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {-1.0, 1e-3});
  const ParametrisedCurve back = reverse(curve);
  const Interval range = parameter_range(curve);
  EXPECT_EQ(parameter_range(back).first, range.first);
  for (const double t : {0.0, 0.3, 1.9, 2.9})
    EXPECT_LE((evaluate_at(back, range.first + t) - evaluate_at(curve, range.last - t)).norm(), 2e-15);
}

TEST(IgesCurves, OffsetsOfCirclesAndEllipsesAreWhereTheyShouldBe) {
  const ParametrisedCurve circle = arc(0.0, {1.0, 0.0}, {3.0, 0.0}, {1.0, -2.0});
  OffsetCurveData data;
  data.distance = [](double) { return 0.5; };
  data.range = {0.25, 4.0};
  const ParametrisedCurve inner = offset_curve(circle, data, 1e-12);
  EXPECT_LE(inner.deviation, 1e-12);
  EXPECT_EQ(parameter_range(inner).first, 0.25);
  // normal x tangent points to the centre of what runs counter-clockwise about the normal.
  sample(inner, [](double t, const Point3& p) {
    EXPECT_LE((p - Point3(1.0 + 1.5 * std::cos(t), 1.5 * std::sin(t), 0.0)).norm(), 2e-12);
  });
  const ParametrisedCurve ellipse = conic_arc({.a = 0.25, .c = 1.0, .f = -1.0}, 0.0, {2.0, 0.0}, {2.0, 0.0});
  data.distance = [](double t) { return 0.1 + 0.02 * t; };
  data.range = {0.0, 2.0 * pi};
  const ParametrisedCurve tapered = offset_curve(ellipse, data, 1e-11);
  sample(tapered, [](double t, const Point3& p) {
    const Vector3 tangent = Vector3(-2.0 * std::sin(t), std::cos(t), 0.0).normalized();
    const Point3 base(2.0 * std::cos(t), std::sin(t), 0.0);
    EXPECT_LE((p - (base + (0.1 + 0.02 * t) * Vector3(-tangent.y(), tangent.x(), 0.0))).norm(), 2e-11);
  });
}

TEST(IgesCurves, OffsetsOfCornersAreRefused) {
  const ParametrisedCurve corner =
      composite(std::vector{line({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}), line({1.0, 0.0, 0.0}, {1.0, 1.0, 0.0})}, 1e-12);
  OffsetCurveData data;
  data.distance = [](double) { return 0.1; };
  data.range = {0.0, 2.0};
  EXPECT_GEOMETRY_ERROR(offset_curve(corner, data, 1e-9), "corner");
  data.range = {3.0, 4.0};
  EXPECT_GEOMETRY_ERROR(offset_curve(corner, data, 1e-9), "no part of the base curve's");
}

TEST(IgesCurves, CurvesInTheirOwnParameterAreFittedOnlyIfTheyMustBe) {
  const ParametrisedCurve straight = in_own_parameter(line({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}), {0.0, 2.0}, 1e-12);
  EXPECT_EQ(straight.tolerance, 0.0);
  EXPECT_EQ(straight.curve.degree(), 1);
  const ParametrisedCurve round = in_own_parameter(arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {-1.0, 1e-3}), {0.0, 1.0}, 1e-13);
  EXPECT_LE(round.deviation, 1e-13);
  const double sweep = std::atan2(1e-3, -1.0);
  sample(round, [&](double t, const Point3& p) {
    EXPECT_LE((p - Point3(std::cos(sweep * t), std::sin(sweep * t), 0.0)).norm(), 1e-12);
  });
}

}  // namespace
}  // namespace isorim::io::iges
