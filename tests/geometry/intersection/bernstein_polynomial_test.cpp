#include "geometry/intersection/bernstein_polynomial.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/intersection/chebyshev_fit.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;

BernsteinGrid random_grid(Random& random, Eigen::Index p, Eigen::Index q) {
  BernsteinGrid grid(p + 1, q + 1);
  for (double& c : grid.reshaped()) c = random.real(-1.0, 1.0);
  return grid;
}

TEST(BernsteinPolynomial, OperationsAgreeWithValues) {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    const BernsteinGrid a = random_grid(random, random.integer(0, 5), random.integer(1, 5));
    const BernsteinGrid b = random_grid(random, random.integer(1, 5), random.integer(0, 5));
    const Point2 at(random.real(0, 1), random.real(0, 1));
    EXPECT_NEAR(evaluate(multiply(a, b), at), evaluate(a, at) * evaluate(b, at), 1e-14);
    EXPECT_NEAR(evaluate(elevate(a, 7, 6), at), evaluate(a, at), 1e-14);
    const GridJet jet = evaluate_jet(a, at);
    EXPECT_NEAR(jet.value, evaluate(a, at), 1e-14);
    EXPECT_NEAR(jet.gradient.x(), evaluate(derivative_u(a), at), 1e-13);
    EXPECT_NEAR(jet.gradient.y(), evaluate(derivative_v(a), at), 1e-13);
    EXPECT_NEAR(jet.hessian(0, 1), evaluate(derivative_v(derivative_u(a)), at), 1e-12);
    EXPECT_NEAR(jet.hessian(0, 0), evaluate(derivative_u(derivative_u(a)), at), 1e-12);
    const Interval u{0.2, 0.7};
    const Interval v{0.1, 0.4};
    EXPECT_NEAR(evaluate(restrict_to(a, u, v), at),
                evaluate(a, Point2(u.first + at.x() * u.length(), v.first + at.y() * v.length())), 1e-14);
    EXPECT_NEAR(evaluate(along_v(a, at.x()), at.y()), evaluate(a, at), 1e-14);
    EXPECT_NEAR(evaluate(along_u(a, at.y()), at.x()), evaluate(a, at), 1e-14);
  }
}

/// The Bernstein coefficients of a product of linear factors t - r.
BernsteinCoefficients with_roots(const std::vector<double>& roots) {
  BernsteinGrid product = BernsteinGrid::Ones(1, 1);
  for (const double root : roots) {
    BernsteinGrid factor(2, 1);
    factor << -root, 1.0 - root;
    product = multiply(product, factor);
  }
  return product.col(0);
}

TEST(SignChart, HasTheSimpleRoots) {
  const SignChart chart = sign_chart(with_roots({0.1, 0.35, 0.36, 0.9, 1.7, -0.3}), 1e-15);
  ASSERT_EQ(chart.roots.size(), 4U);
  EXPECT_NEAR(chart.roots[0], 0.1, 1e-14);
  EXPECT_NEAR(chart.roots[1], 0.35, 1e-12);
  EXPECT_NEAR(chart.roots[2], 0.36, 1e-12);
  EXPECT_NEAR(chart.roots[3], 0.9, 1e-14);
  EXPECT_EQ(chart.signs, (std::vector<int>{-1, 1, -1, 1, -1}));
  EXPECT_EQ(chart.sign_between(0.1, 0.3), 1);
  EXPECT_EQ(chart.sign_between(0.9, 1.0), -1);
}

TEST(SignChart, FindsRootsWhereItBisects) {
  for (const double middle : {0.5, 0.25, 0.75, 0.375})
    for (int k = 1; k < 200; ++k) {
      const double other = 0.005 * k + 1e-4;
      if (std::abs(other - middle) < 1e-3) continue;
      const SignChart chart = sign_chart(0.37 * with_roots({middle, other, -0.4, 1.9}), 1e-15);
      ASSERT_EQ(chart.roots.size(), 2U) << middle << " " << other;
      EXPECT_NEAR(chart.roots[other < middle ? 1 : 0], middle, 1e-13);
    }
}

TEST(SignChart, PassesOverDoubleRootsAndEnds) {
  EXPECT_TRUE(sign_chart(with_roots({0.4, 0.4}), 1e-14).roots.empty());
  EXPECT_TRUE(sign_chart(with_roots({0.4, 0.4 + 1e-8}), 1e-14).roots.empty());
  EXPECT_EQ(sign_chart(with_roots({0.4, 0.4 + 1e-5}), 1e-14).roots.size(), 2U);
  const SignChart triple = sign_chart(with_roots({0.4, 0.4, 0.4}), 1e-14);
  ASSERT_EQ(triple.roots.size(), 1U);
  EXPECT_NEAR(triple.roots[0], 0.4, 1e-4);
  EXPECT_TRUE(sign_chart(with_roots({0.0}), 1e-14).roots.empty());
  EXPECT_EQ(sign_chart(with_roots({0.0}), 1e-14).signs, std::vector<int>{1});
  EXPECT_EQ(sign_chart(BernsteinCoefficients::Zero(4), 1e-14).signs, std::vector<int>{0});
}

TEST(SignChart, OfAnalyticFunctions) {
  const SignChart chart = sign_chart([](double t) { return std::sin(30.0 * t + 0.1) / (1.1 - t); }, 1e-14);
  ASSERT_EQ(chart.roots.size(), 9U);
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_NEAR(chart.roots[k], (static_cast<double>(k + 1) * 3.14159265358979324 - 0.1) / 30.0, 1e-13);
  EXPECT_EQ(sign_chart([](double t) { return 1e-16 * std::cos(40.0 * t); }, 1e-14).signs, std::vector<int>{0});
}

TEST(FitCurve, MeetsSmoothCurvesToRounding) {
  const auto spiral = [](double t) { return Point2(std::exp(t) * std::cos(7.0 * t), std::exp(t) * std::sin(7.0 * t)); };
  const std::vector<NurbsCurve<2>> pieces = fit_curve(spiral, 4e-15);
  ASSERT_GE(pieces.size(), 2U);
  EXPECT_EQ(evaluate(pieces.front(), 0.0), spiral(0.0));
  EXPECT_LE((evaluate(pieces.back(), 1.0) - spiral(1.0)).norm(), 1e-15);
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k)
    EXPECT_LE((evaluate(pieces[k], 1.0) - evaluate(pieces[k + 1], 0.0)).norm(), 1e-15);
  // On the curve: its polar angle and radius belong together.
  for (const NurbsCurve<2>& piece : pieces)
    for (int k = 0; k <= 50; ++k) {
      const Point2 x = evaluate(piece, k / 50.0);
      const double t = std::log(x.norm());
      EXPECT_LE((x - spiral(t)).norm(), 5e-14);
    }
}

TEST(BernsteinPolynomial, SlopesAreThoseOfTheJet) {
  for (const auto& [p, q] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{3, 2}, std::pair{7, 11}}) {
    BernsteinGrid grid(p + 1, q + 1);
    for (Eigen::Index i = 0; i < grid.size(); ++i) grid(i) = std::sin(1.0 + 2.7 * static_cast<double>(i));
    for (const Point2& at : {Point2(0.3, 0.8), Point2(0.0, 1.0), Point2(1.1, -0.2)}) {
      const GridJet jet = evaluate_jet(grid, at);
      const GridSlope slope = evaluate_slope(grid, at);
      const double scale = 1.0 + std::abs(jet.value) + jet.gradient.norm();
      EXPECT_NEAR(slope.value, jet.value, 1e-13 * scale);
      EXPECT_LT((slope.gradient - jet.gradient).norm(), 1e-13 * scale);
      EXPECT_NEAR(evaluate(grid, at), jet.value, 1e-13 * scale);
    }
  }
}

}  // namespace
}  // namespace isorim::geometry
