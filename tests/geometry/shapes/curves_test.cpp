#include "geometry/shapes/curves.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;
constexpr double pi = std::numbers::pi;

TEST(CircleCurve, HasTheNetOfTheThesis) {
  const NurbsCurve<2> circle = circle_curve(0.5, Point2(1.0, 1.0));
  const std::vector<double> knots(circle.knots().knots().begin(), circle.knots().knots().end());
  EXPECT_EQ(knots, (std::vector<double>{0, 0, 0, .25, .25, .5, .5, .75, .75, 1, 1, 1}));
  HomogeneousPoints<2> expected(3, 9);
  const double c = 1.0606601717798214;
  const double d = 0.3535533905932738;
  const double w = 0.7071067811865476;
  expected << 1.5, c, 1.0, d, 0.5, d, 1.0, c, 1.5,  //
      1.0, c, 1.5, c, 1.0, d, 0.5, d, 1.0,          //
      1.0, w, 1.0, w, 1.0, w, 1.0, w, 1.0;
  EXPECT_LE((circle.homogeneous() - expected).cwiseAbs().maxCoeff(), 3e-16);
  EXPECT_EQ(circle.weights()(1), 0.5 * std::numbers::sqrt2);
}

TEST(CircularArc, LiesOnTheCircleAndMeetsItsEnds) {
  const Point2 centre(3.0, -2.0);
  for (const double from : {-7.0, -pi, 0.0, 0.3, 2.0}) {
    for (const double sweep : {1e-3, 0.5 * pi, 2.0, pi, 4.0, 6.2, 2.0 * pi, -0.7, -5.0}) {
      const NurbsCurve<2> arc = circular_arc(2.5, centre, from, from + sweep);
      for (int i = 0; i <= 200; ++i) {
        const Vector2 arm = evaluate(arc, i / 200.0) - centre;
        ASSERT_NEAR(arm.norm(), 2.5, 3e-15) << from << " " << sweep << " " << i;
      }
      const Vector2 last(std::cos(from + sweep), std::sin(from + sweep));
      EXPECT_LE((evaluate(arc, 1.0) - centre - 2.5 * last).norm(), 1e-14);
      EXPECT_EQ(arc.knots().basis_count(), 2 * std::ceil(std::abs(sweep) / (0.5 * pi) - 1e-9) + 1);
    }
  }
}

TEST(CircularArc, FullTurnEndsWhereItStarts) {
  const NurbsCurve<2> circle = circular_arc(1.3, Point2(0.1, 0.2), 0.4, 0.4 + 2.0 * pi);
  EXPECT_EQ(evaluate(circle, 0.0), evaluate(circle, 1.0));
}

TEST(EllipseArc, LiesOnTheTurnedEllipse) {
  const Vector2 radii(3.0, 0.5);
  const Point2 centre(-1.0, 4.0);
  const NurbsCurve<2> arc = ellipse_arc(radii, centre, 0.6, -0.4, 3.9);
  Eigen::Matrix2d back;
  back << std::cos(0.6), std::sin(0.6), -std::sin(0.6), std::cos(0.6);
  for (int i = 0; i <= 100; ++i) {
    const Vector2 local = (back * (evaluate(arc, i / 100.0) - centre)).cwiseQuotient(radii);
    ASSERT_NEAR(local.norm(), 1.0, 5e-15);
  }
  const Vector2 first = (back * (evaluate(arc, 0.0) - centre)).cwiseQuotient(radii);
  EXPECT_NEAR(std::atan2(first.y(), first.x()), -0.4, 1e-14);
}

TEST(Polyline, PassesThroughItsPoints) {
  Points<3> points(3, 4);
  points << 0, 1, 1, 2, 0, 0, 3, 3, 0, 0, 0, 1;
  const NurbsCurve<3> line = polyline<3>(points);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(evaluate(line, i / 3.0), Point3(points.col(i)));
}

TEST(Curves, RefuseWhatIsNoCurve) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal([] { circle_curve(-1.0); }), HasSubstr("circle: radius is -1, it must be positive"));
  EXPECT_THAT(refusal([] { circle_curve(0.0); }), HasSubstr("radius is 0"));
  EXPECT_THAT(refusal([&] { circle_curve(nan); }), HasSubstr("radius is nan"));
  EXPECT_THAT(refusal([&] { circle_curve(1.0, Point2(0.0, nan)); }), HasSubstr("centre[1] is nan"));
  EXPECT_THAT(refusal([] { circular_arc(1.0, Point2::Zero(), 1.0, 1.0); }), HasSubstr("are the same"));
  EXPECT_THAT(refusal([] { circular_arc(1.0, Point2::Zero(), 0.0, 7.0); }), HasSubstr("more than a full turn"));
  EXPECT_THAT(refusal([] { ellipse_curve(Vector2(1.0, -2.0)); }), HasSubstr("ellipse: radii[1] is -2"));
  EXPECT_THAT(refusal([] { line_segment<2>(Point2(1, 2), Point2(1, 2)); }), HasSubstr("both ends are (1, 2)"));
  EXPECT_THAT(refusal([] { polyline<2>(Points<2>::Zero(2, 1)); }), HasSubstr("1 points"));
  EXPECT_THAT(refusal([] { polyline<2>(Points<2>::Zero(2, 3)); }), HasSubstr("points 0 and 1 are both (0, 0)"));
}

}  // namespace
}  // namespace isorim::geometry
