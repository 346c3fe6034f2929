#include "solver/bem/line_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "geometry/spline/local_basis.h"
#include "quadrature/gauss_legendre.h"

namespace isorim::solver {
namespace {

using geometry::Interval;
using geometry::KnotVector;

/// `elements` equal elements, continuous alone (multiplicity p) at the middle one if asked for.
KnotVector equal_elements(int degree, int elements, bool kink = false) {
  std::vector<double> breakpoints{0.0};
  for (int i = 1; i < elements; ++i)
    breakpoints.insert(breakpoints.end(), kink && i == elements / 2 ? static_cast<std::size_t>(degree) : 1u,
                       static_cast<double>(i) / elements);
  breakpoints.push_back(1.0);
  return KnotVector::clamped(degree, breakpoints);
}

std::vector<double> parameters(const LineSpace& space) {
  std::vector<double> result;
  for (const LinePoint& point : space.points) {
    const Interval domain = space.elements[static_cast<std::size_t>(point.element)].domain;
    result.push_back(domain.first + point.place * domain.length());
  }
  return result;
}

Eigen::VectorXd functions(const LineSpace& space, double u) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(space.function_count());
  const auto basis = geometry::local_basis<0>(space.knots, u);
  for (int j = 0; j <= space.knots.degree(); ++j) values(space.number(basis.first + j)) += basis.table(j, 0);
  return values;
}

Eigen::MatrixXd collocation(const LineSpace& space) {
  Eigen::MatrixXd matrix(space.function_count(), space.function_count());
  const std::vector<double> points = parameters(space);
  for (std::size_t i = 0; i < points.size(); ++i)
    matrix.row(static_cast<Eigen::Index>(i)) = functions(space, points[i]).transpose();
  return matrix;
}

/// The norm of interpolation at the points, in the maximum norm.
double lebesgue_constant(const LineSpace& space) {
  const Eigen::MatrixXd inverse = collocation(space).inverse();
  double largest = 0.0;
  const int samples = 40 * space.function_count();
  for (int i = 0; i <= samples; ++i)
    largest =
        std::max(largest, (functions(space, static_cast<double>(i) / samples).transpose() * inverse).cwiseAbs().sum());
  return largest;
}

TEST(GaussPoints, AreGaussLegendresOnOneElement) {
  for (int p = 1; p <= 15; ++p) {
    const std::vector<double> points = gauss_points(KnotVector::bezier(p));
    const std::vector<double>& expected = quadrature::gauss_legendre(p + 1).nodes;
    ASSERT_EQ(points.size(), expected.size());
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(points[i], expected[i], 1e-9) << p;
  }
}

TEST(GaussPoints, TendToGrevillesAmongEqualElements) {
  for (const int p : {1, 2, 3, 4, 5, 8}) {
    const KnotVector knots = equal_elements(p, 64);
    const std::vector<double> points = gauss_points(knots);
    const std::vector<double> greville = knots.greville_abscissae();
    ASSERT_EQ(points.size(), greville.size());
    EXPECT_NEAR(points[points.size() / 2], greville[greville.size() / 2], 1e-6 / 64.0) << p;
  }
}

TEST(GaussPoints, AreSymmetricIncreasingAndInside) {
  for (const int p : {1, 2, 3, 6, 12})
    for (const int elements : {1, 2, 5, 33}) {
      const std::vector<double> points = gauss_points(equal_elements(p, elements, elements == 2));
      EXPECT_GT(points.front(), 0.0);
      EXPECT_LT(points.back(), 1.0);
      for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(points[i - 1], points[i]);
      for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(points[i] + points[points.size() - 1 - i], 1.0, 1e-9) << p << " " << elements;
    }
}

// Greville's abscissae reach 89 on one element of degree 12, and with ends moved inwards 458.
TEST(LineSpace, LebesgueConstantsAreSmallForAllDegrees) {
  for (int p = 1; p <= 15; ++p)
    for (const int elements : {1, 2, 4, 16})
      for (const bool kink : {false, true})
        EXPECT_LT(lebesgue_constant(line_space(equal_elements(p, elements, kink), false)), 1.6 + 0.55 * p)
            << p << " " << elements << " " << kink;
}

TEST(LineSpace, IsAsWellConditionedAsGrevillesPointsWithTheEnds) {
  for (const int p : {1, 2, 3, 4, 5, 8, 12})
    for (const int elements : {1, 2, 4, 16}) {
      const LineSpace space = line_space(equal_elements(p, elements), false);
      LineSpace with_ends = space;
      const std::vector<double> greville = space.knots.greville_abscissae();
      Eigen::MatrixXd reference(space.function_count(), space.function_count());
      for (Eigen::Index i = 0; i < reference.rows(); ++i)
        reference.row(i) = functions(space, greville[static_cast<std::size_t>(i)]).transpose();
      const auto norm_of_inverse = [](const Eigen::MatrixXd& a) {
        return a.inverse().cwiseAbs().rowwise().sum().maxCoeff();
      };
      EXPECT_LT(norm_of_inverse(collocation(space)), 1.8 * norm_of_inverse(reference)) << p << " " << elements;
    }
}

TEST(LineSpace, ConditionDoesNotGrowWithTheElements) {
  for (const int p : {1, 2, 3, 4, 5}) {
    const double coarse = lebesgue_constant(line_space(equal_elements(p, 16), false));
    EXPECT_NEAR(lebesgue_constant(line_space(equal_elements(p, 128), false)), coarse, 0.01 * coarse) << p;
  }
}

TEST(LineSpace, PointsKeepAwayFromInnerBreakpoints) {
  for (const int p : {1, 2, 3, 4, 5, 7})
    for (const bool kink : {false, true}) {
      const LineSpace space = line_space(equal_elements(p, 16, kink), false);
      for (std::size_t i = 0; i < space.points.size(); ++i) {
        const auto [element, place] = space.points[i];
        EXPECT_TRUE(element == 0 || place > 0.02) << p << " " << i;
        EXPECT_TRUE(element == 15 || place < 0.98) << p << " " << i;
      }
    }
}

TEST(LineSpace, SurvivesVeryUnequalElements) {
  std::vector<double> breakpoints{0.0};
  for (int i = 30; i >= 0; --i) breakpoints.push_back(std::pow(0.5, i));
  for (const int p : {1, 2, 3, 5}) {
    const LineSpace space = line_space(KnotVector::clamped(p, breakpoints), false);
    EXPECT_LT(collocation(space).inverse().cwiseAbs().rowwise().sum().maxCoeff(), 100.0) << p;
  }
}

TEST(LineSpace, OfAClosedLineHasOneFunctionLessAndNoEnds) {
  for (const int p : {1, 2, 3, 4, 5})
    for (const int elements : {1, 2, 4, 9}) {
      const KnotVector knots = equal_elements(p, elements);
      if (knots.basis_count() < 3) continue;
      const LineSpace space = line_space(knots, true);
      EXPECT_EQ(space.function_count(), knots.basis_count() - 1);
      EXPECT_LT(lebesgue_constant(space), 1.6 + 0.55 * p) << p << " " << elements;
      std::vector<double> points = parameters(space);
      std::ranges::sort(points);
      EXPECT_GT(points.front(), 0.0);
      EXPECT_GT(points.front() + 1.0 - points.back(), 0.1 / (elements * p)) << p << " " << elements;
    }
}

TEST(LineSpace, PiecesBetweenJumpsStandAlone) {
  const std::vector<double> breakpoints{0.0, 0.25, 0.5, 0.5, 0.5, 0.75, 1.0};
  const LineSpace space = line_space(KnotVector::clamped(2, breakpoints), false);
  const LineSpace half = line_space(KnotVector::clamped(2, std::vector<double>{0.0, 0.25, 0.5}), false);
  EXPECT_EQ(space.piece, (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1}));
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(space.points[i].element, half.points[i % 4].element + (i < 4 ? 0 : 2));
    EXPECT_NEAR(space.points[i].place, half.points[i % 4].place, 1e-13);
  }
}

TEST(LineSpace, OnePieceGoesOnAcrossTheSeam) {
  const std::vector<double> breakpoints{0.0, 0.25, 0.25, 0.25, 0.5, 0.75, 1.0};
  const LineSpace space = line_space(KnotVector::clamped(2, breakpoints), true);
  EXPECT_EQ(space.piece, std::vector<int>(7, 0));
  EXPECT_LT(lebesgue_constant(space), 2.6);
}

}  // namespace
}  // namespace isorim::solver
