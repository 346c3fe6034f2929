#include "geometry/propeller/blade_edit.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/spline/bspline.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;
using Kind = BladeEdit::Kind;

/// A cubic of twelve control points about the shaft on knots of no pattern.
NurbsCurve<3> random_curve() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(0.2, 1.0);
  std::vector<double> knots{0, 0, 0, 0};
  for (int i = 0; i < 8; ++i) knots.push_back(knots.back() + some(random));
  knots.insert(knots.end(), 4, knots.back() + some(random));
  Points<3> points(3, 12);
  for (Eigen::Index i = 0; i < 12; ++i) points.col(i) << some(random), some(random) - 0.6, 2.0 + some(random);
  return NurbsCurve<3>::from_points(KnotVector(3, knots), points);
}

/// Of the third derivative at an inner knot.
double jump(const NurbsCurve<3>& curve, double knot) {
  const auto [before, after] = split(curve, knot);
  const BSpline left{before.knots(), before.control_points()};
  const BSpline right{after.knots(), after.control_points()};
  return (evaluate_derivatives(left, knot, 3).col(3) - evaluate_derivatives(right, knot, 3).col(3)).norm();
}

TEST(BladeEdit, MovesAControlPointAlongTheShaft) {
  const NurbsCurve<3> curve = random_curve();
  const NurbsCurve<3> moved = edited(curve, {Kind::move_along_shaft, 0, 4, 0.25});
  Points<3> expected = curve.control_points();
  expected(0, 4) += 0.25;
  EXPECT_EQ(moved.control_points(), expected);
}

TEST(BladeEdit, MovesAControlPointOnItsCylinder) {
  const NurbsCurve<3> curve = random_curve();
  for (const double by : {0.3, -0.9}) {
    const Point3 before = curve.control_points().col(6);
    const Point3 after = edited(curve, {Kind::move_on_cylinder, 0, 6, by}).control_points().col(6);
    EXPECT_EQ(after.x(), before.x());
    EXPECT_NEAR(after.y(), before.y() + by, 1e-15);
    EXPECT_NEAR(std::hypot(after.y(), after.z()), std::hypot(before.y(), before.z()), 1e-15);
    EXPECT_GT(after.z(), 0.0);
  }
}

TEST(BladeEdit, SmoothingTakesTheJumpOfTheThirdDerivativeAway) {
  const NurbsCurve<3> curve = random_curve();
  for (const int point : {2, 5, 9}) {
    const double knot = curve.knots()[point + 2];
    EXPECT_GT(jump(curve, knot), 0.1);
    const NurbsCurve<3> smooth = edited(curve, {Kind::smooth_at_knot, 0, point, 0.0});
    EXPECT_LE(jump(smooth, knot), 1e-11);
    // So the knot can be removed, and nothing else has moved.
    EXPECT_EQ(remove_knot(smooth, knot, 1, 1e-12).removed, 1);
    Points<3> difference = smooth.control_points() - curve.control_points();
    difference.col(point).setZero();
    EXPECT_EQ(difference.norm(), 0.0);
  }
}

// Equations 6-1 to 6-3 of the thesis, with the knots u counted so that u_j is that of the control point d_j.
TEST(BladeEdit, SmoothingIsThatOfTheThesis) {
  const NurbsCurve<3> curve = random_curve();
  const Points<3> d = curve.control_points();
  const int j = 5;
  const auto u = [&](int i) { return curve.knots()[i + 2]; };
  const Point3 left = ((u(j + 1) - u(j - 3)) * d.col(j - 1) - (u(j + 1) - u(j)) * d.col(j - 2)) / (u(j) - u(j - 3));
  const Point3 right = ((u(j + 3) - u(j - 1)) * d.col(j + 1) - (u(j) - u(j - 1)) * d.col(j + 2)) / (u(j + 3) - u(j));
  const Point3 expected = ((u(j + 2) - u(j)) * left + (u(j) - u(j - 2)) * right) / (u(j + 2) - u(j - 2));
  const Point3 found = edited(curve, {Kind::smooth_at_knot, 0, j, 0.0}).control_points().col(j);
  EXPECT_LE((found - expected).norm(), 1e-13);
}

TEST(BladeEdit, RefusesWhatItCannotMove) {
  std::vector<NurbsCurve<3>> sections{random_curve()};
  const auto refused = [&](const BladeEdit& edit) {
    return refusal([&] { apply_edits(std::vector<BladeEdit>{edit}, sections); });
  };
  EXPECT_THAT(refused({Kind::move_along_shaft, 1, 4, 0.1}), HasSubstr("section 2, control point 5: there are 1"));
  EXPECT_THAT(refused({Kind::move_along_shaft, 0, 0, 0.1}), HasSubstr("expected one from 2 to 11"));
  EXPECT_THAT(refused({Kind::move_along_shaft, 0, 11, 0.1}), HasSubstr("the trailing edge"));
  EXPECT_THAT(refused({Kind::move_on_cylinder, 0, 4, 50.0}), HasSubstr("lies off its cylinder of radius"));
  EXPECT_THAT(refused({Kind::smooth_at_knot, 0, 1, 0.0}), HasSubstr("expected one from 3 to 10"));
}

}  // namespace
}  // namespace isorim::geometry
