#include "geometry/nurbs/curve.h"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::circle;
using testing::Random;
using testing::random_curve;
using testing::random_knots;

constexpr int trials = 200;
const double nan = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

/// A curve's point from the long double reference.
template <int Dim>
Point<Dim> reference_point(const NurbsCurve<Dim>& curve, double u) {
  const Eigen::VectorXd value = testing::reference_value({curve.knots(), curve.homogeneous()}, u, 0);
  return value.head<Dim>() / value[Dim];
}

/// The same points at the same parameters (points lie in [-1, 1]^Dim, so the tolerance is relative to the size).
template <int Dim>
void expect_same(const NurbsCurve<Dim>& expected, const NurbsCurve<Dim>& actual, Random& random,
                 double tolerance = 1e-13) {
  for (int i = 0; i < 20; ++i) {
    const double u = random.inside(actual.domain());
    EXPECT_LE((evaluate(actual, u) - reference_point(expected, u)).norm(), tolerance) << "at u = " << u;
  }
}

NurbsCurve<2> polynomial_curve() {
  Points<2> points(2, 4);
  points << 0, 1, 2, 3, 0, 1, 0, 1;
  return NurbsCurve<2>::from_points(KnotVector::clamped_uniform(2, 2), points);
}

TEST(NurbsCurve, CircleIsExact) {
  const NurbsCurve<2> curve = circle(3.0, {0.0, 0.0});
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(evaluate(curve, i / 1000.0).norm(), 3.0, 3.0e-15);
}

TEST(NurbsCurve, CircleHasConstantCurvature) {
  const NurbsCurve<2> curve = circle(2.0, {1.0, -1.0});
  for (int i = 0; i <= 100; ++i) {
    const CurveJet<2> jet = evaluate_jet(curve, i / 100.0);
    const double turning = jet.du[0] * jet.duu[1] - jet.du[1] * jet.duu[0];
    EXPECT_NEAR(turning / std::pow(jet.du.norm(), 3), 0.5, 1e-13);
  }
}

TEST(NurbsCurve, EvaluationMatchesTheReference) {
  Random random(30);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsCurve<3> curve = random_curve<3>(random, random_knots(random, random.integer(1, 8)));
    expect_same(curve, curve, random, 1e-14);
  }
}

TEST(NurbsCurve, DerivativesMatchFiniteDifferences) {
  Random random(31);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const NurbsCurve<3> curve = random_curve<3>(random, knots);
    const int span = knots.find_span(random.inside(knots.domain()));
    const double width = knots[span + 1] - knots[span];
    const double u = knots[span] + width * random.real(0.3, 0.7);
    const CurveJet<3> jet = evaluate_jet(curve, u);
    EXPECT_LE((jet.point - evaluate(curve, u)).norm(), 1e-14);
    // Fourth-order differences: truncation and rounding both stay below 1e-7 of the derivatives' size.
    const double h = 1e-3 * width;
    const auto difference = [&](auto value) -> Vector<3> {
      return (8.0 * (value(u + h) - value(u - h)) - (value(u + 2 * h) - value(u - 2 * h))) / (12.0 * h);
    };
    const Vector<3> du = difference([&](double x) -> Vector<3> { return evaluate(curve, x); });
    const Vector<3> duu = difference([&](double x) -> Vector<3> { return evaluate_jet(curve, x).du; });
    EXPECT_LE((jet.du - du).norm(), 1e-6 * (1 + jet.du.norm() + jet.duu.norm()));
    EXPECT_LE((jet.duu - duu).norm(), 1e-5 * (1 + jet.du.norm() / width + jet.duu.norm()));
  }
}

TEST(NurbsCurve, IsAffineInvariant) {
  Random random(32);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsCurve<3> curve = random_curve<3>(random, random_knots(random, random.integer(1, 8)));
    AffineMap<3> map;
    for (double& entry : map.linear.reshaped()) entry = random.real(-1, 1);
    for (double& entry : map.translation) entry = random.real(-1, 1);
    const NurbsCurve<3> image = transform(curve, map);
    const double u = random.inside(curve.domain());
    EXPECT_LE((evaluate(image, u) - map(evaluate(curve, u))).norm(), 1e-14);
  }
}

TEST(NurbsCurve, InsertionSplittingClampingElevationChangeNothing) {
  Random random(33);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const NurbsCurve<2> curve = random_curve<2>(random, knots);
    const double u = random.inside(curve.domain());
    expect_same(curve, insert_knot(curve, u, random.integer(0, knots.degree() + 1)), random);
    expect_same(curve, clamp(curve), random);
    expect_same(curve, elevate_degree(curve, random.integer(0, 3)), random);
    const auto [left, right] = split(curve, u);
    EXPECT_EQ(left.domain().last, u);
    EXPECT_EQ(right.domain().first, u);
    expect_same(curve, left, random);
    expect_same(curve, right, random);
  }
}

TEST(NurbsCurve, ReversalAndReparametrisationKeepTheShape) {
  Random random(34);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsCurve<2> curve = random_curve<2>(random, random_knots(random, random.integer(1, 8)));
    const Interval old = curve.domain();
    const Interval domain{random.real(-5, 0), random.real(1, 5)};
    const NurbsCurve<2> renamed = reparametrise(curve, domain);
    EXPECT_EQ(renamed.domain().first, domain.first);
    EXPECT_EQ(renamed.domain().last, domain.last);
    const NurbsCurve<2> reversed = reverse(curve);
    for (int i = 0; i < 10; ++i) {
      const double s = random.real(0, 1);
      const double u = old.first + s * old.length();
      const CurveJet<2> jet = evaluate_jet(curve, u);
      const double tolerance = 1e-13 + 1e-14 * jet.du.norm();
      EXPECT_LE((evaluate(renamed, domain.first + s * domain.length()) - jet.point).norm(), tolerance);
      EXPECT_LE((evaluate(reversed, old.first + (old.last - u)) - jet.point).norm(), tolerance);
    }
  }
}

TEST(NurbsCurve, OperationsKeepPolynomialCurvesPolynomial) {
  Random random(35);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    HomogeneousPoints<2> net = testing::random_net<2>(random, knots.basis_count());
    net.row(2).setConstant(0.1);
    const NurbsCurve<2> curve(knots, net);
    const double u = random.inside(knots.domain());
    const NurbsCurve<2> refined = insert_knot(curve, u, knots.degree());
    EXPECT_TRUE(refined.is_polynomial());
    EXPECT_TRUE(remove_knot(refined, u, 1, 1e-9).curve.is_polynomial());
    EXPECT_TRUE(elevate_degree(curve, 2).is_polynomial());
    EXPECT_TRUE(split(curve, u).second.is_polynomial());
    EXPECT_TRUE(clamp(curve).is_polynomial());
  }
  EXPECT_FALSE(circle(1, {0, 0}).is_polynomial());
}

TEST(NurbsCurve, RemovalUndoesInsertion) {
  Random random(36);
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = random_knots(random, random.integer(1, 8));
    const NurbsCurve<2> curve = random_curve<2>(random, knots);
    const double u = random.inside(knots.domain());
    const CurveKnotRemoval<2> result = remove_knot(insert_knot(curve, u, 2), u, 5, 1e-10);
    EXPECT_EQ(result.removed, 2);
    EXPECT_EQ(result.curve.knots(), knots);
    expect_same(curve, result.curve, random, 1e-14 + result.error_bound);
  }
}

TEST(NurbsCurve, RemovalMovesNoPointFurtherThanItsBound) {
  Random random(37);
  int removed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const KnotVector knots = KnotVector::clamped_uniform(random.integer(2, 5), 3);
    const NurbsCurve<2> smooth = insert_knot(random_curve<2>(random, knots), 0.5);
    HomogeneousPoints<2> net = smooth.homogeneous();
    for (double& c : net.reshaped()) c += random.real(-1e-3, 1e-3);
    const NurbsCurve<2> curve(smooth.knots(), net);
    const CurveKnotRemoval<2> result = remove_knot(curve, 0.5, 1, 0.05);
    removed += result.removed;
    EXPECT_LE(result.error_bound, 0.05);
    for (int i = 0; i <= 50; ++i)
      EXPECT_LE((evaluate(curve, i / 50.0) - evaluate(result.curve, i / 50.0)).norm(), result.error_bound + 1e-14);
  }
  EXPECT_GT(removed, trials / 2);
  EXPECT_LT(removed, trials);
}

TEST(NurbsCurve, RemovalRefusesAKnotThatMatters) {
  const CurveKnotRemoval<2> result = remove_knot(circle(1.0, {0, 0}), 0.5, 2, 1e-6);
  EXPECT_EQ(result.removed, 0);
  EXPECT_EQ(result.error_bound, 0.0);
  EXPECT_EQ(result.curve.knots(), circle(1.0, {0, 0}).knots());
}

TEST(NurbsCurve, DiscontinuousCurveJumpsAtItsKnot) {
  Points<2> points(2, 4);
  points << 0, 1, 5, 6, 0, 0, 1, 1;
  const NurbsCurve<2> curve = NurbsCurve<2>::from_points(KnotVector(1, {0, 0, 0.5, 0.5, 1, 1}), points);
  EXPECT_EQ(evaluate(curve, 0.5), Point2(5, 1));
  EXPECT_NEAR(evaluate(curve, std::nextafter(0.5, 0.0))[0], 1.0, 1e-15);
  EXPECT_EQ(elevate_degree(curve, 2).knots().multiplicity(0.5), 4);
  EXPECT_EQ(split(curve, 0.5).first.control_points().col(1), Point2(1, 0));
}

TEST(NurbsCurve, ParametersOutsideTheDomainContinueTheEndSegment) {
  Points<2> points(2, 3);
  points << 0, 0.5, 1, 0, 0, 1;
  const NurbsCurve<2> parabola = NurbsCurve<2>::from_points(KnotVector::bezier(2), points);
  EXPECT_LE((evaluate(parabola, 3.0) - Point2(3, 9)).norm(), 1e-14);
  EXPECT_LE((evaluate(parabola, -2.0) - Point2(-2, 4)).norm(), 1e-14);
}

TEST(NurbsCurve, JoinFollowsItsPieces) {
  const NurbsCurve<2> whole = circle(1.0, {0, 0});
  const auto [first, rest] = split(whole, 0.3);
  Points<2> points(2, 2);
  points << 1, 4, 0, 0;
  const NurbsCurve<2> line = NurbsCurve<2>::from_points(KnotVector::bezier(1), points, std::vector<double>{3.0, 3.0});
  const std::vector<NurbsCurve<2>> pieces{first, rest, line};
  const NurbsCurve<2> joined = join<2>(pieces, 1e-12);
  EXPECT_EQ(joined.degree(), 2);
  EXPECT_EQ(joined.knots().multiplicity(0.3), 2);
  EXPECT_EQ(joined.domain().last, 2.0);
  for (int i = 0; i <= 100; ++i) {
    const double u = i / 100.0;
    EXPECT_LE((evaluate(joined, u) - evaluate(whole, u)).norm(), 2e-15);
    EXPECT_LE((evaluate(joined, 1.0 + u) - Point2(1 + 3 * u, 0)).norm(), 4e-15);
  }
}

TEST(NurbsCurve, JoinedPolynomialCurvesStayPolynomial) {
  const NurbsCurve<2> curve = polynomial_curve();
  AffineMap<2> shift;
  shift.translation = Vector2(3, 1);
  const std::vector<NurbsCurve<2>> pieces{curve, transform(curve, shift)};
  EXPECT_TRUE(join<2>(pieces, 1e-12).is_polynomial());
}

TEST(NurbsCurve, EmbeddingPutsThePlaneAtZeroHeight) {
  const NurbsCurve<2> plane = circle(2.0, {1, 1});
  const NurbsCurve<3> space = embed(plane);
  EXPECT_EQ(evaluate(space, 0.3).head<2>(), evaluate(plane, 0.3));
  EXPECT_EQ(evaluate(space, 0.3)[2], 0.0);
}

TEST(NurbsCurve, RefusesBadInput) {
  const KnotVector knots = KnotVector::bezier(1);
  Points<2> points(2, 2);
  points << 0, 1, 0, 0;
  Points<2> bad = points;
  bad(1, 1) = nan;
  using Curve = NurbsCurve<2>;
  EXPECT_GEOMETRY_ERROR(Curve(knots, HomogeneousPoints<2>::Ones(3, 3)), "3 control points given; 4 knots of degree 1");
  EXPECT_GEOMETRY_ERROR(Curve::from_points(knots, points, std::vector<double>{1.0}), "1 weights given for 2 control");
  EXPECT_GEOMETRY_ERROR(Curve::from_points(knots, points, std::vector<double>{1.0, 0.0}), "weight 1 is 0");
  EXPECT_GEOMETRY_ERROR(Curve::from_points(knots, points, std::vector<double>{-1.0, 1.0}), "weight 0 is -1");
  EXPECT_GEOMETRY_ERROR(Curve::from_points(knots, points, std::vector<double>{1.0, infinity}), "weight 1 is inf");
  EXPECT_GEOMETRY_ERROR(Curve::from_points(knots, points, std::vector<double>{1.0, nan}), "weight 1 is nan");
  EXPECT_GEOMETRY_ERROR(Curve::from_points(knots, bad), "coordinate y of control point 1");
  EXPECT_GEOMETRY_ERROR(split(polynomial_curve(), 0.0), "split parameter 0 is not strictly inside the domain [0, 1]");
  EXPECT_GEOMETRY_ERROR(reparametrise(polynomial_curve(), {1.0, 1.0}), "new domain [1, 1] is no finite interval");
  EXPECT_GEOMETRY_ERROR(insert_knot(polynomial_curve(), 0.5, -1), "-1 times asked for");
  const std::vector<NurbsCurve<2>> apart{polynomial_curve(), polynomial_curve()};
  EXPECT_GEOMETRY_ERROR(join<2>(apart, 1e-6), "the end of curve 0 and the start of curve 1 are 3.16227766016837");
  EXPECT_GEOMETRY_ERROR(join<2>({}, 1e-6), "no curves given");
}

}  // namespace
}  // namespace isorim::geometry
