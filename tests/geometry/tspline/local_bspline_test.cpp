#include "geometry/tspline/local_bspline.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;

/// Every function of random knot vectors, degrees 1 to 6, multiplicities up to the degree plus one.
template <class Use>
void for_functions(unsigned seed, Use&& use) {
  Random random(seed);
  for (int trial = 0; trial < 60; ++trial) {
    const KnotVector knots = testing::random_knots(random, random.integer(1, 6));
    for (int i = 0; i < knots.basis_count(); ++i)
      use(random, knots, i,
          knots.knots().subspan(static_cast<std::size_t>(i), static_cast<std::size_t>(knots.degree()) + 2));
  }
}

TEST(LocalBSpline, DerivativesAreThoseOfTheBasisFunction) {
  for_functions(1, [](Random& random, const KnotVector& knots, int i, std::span<const double> own) {
    const double u = random.inside(knots.domain());
    const int piece = piece_at(own, u, Limit::from_right);
    double spacing = 1.0;
    for (int order = 0; order <= 3; ++order, spacing *= 0.1) {
      const double expected =
          static_cast<double>(testing::reference_basis(knots, u, order)[static_cast<std::size_t>(i)]);
      const double value = piece < 0 ? 0.0 : piece_derivative(own, piece, u, order);
      EXPECT_NEAR(value, expected, 1e-12 * knots.degree() * knots.degree() / spacing);
    }
  });
}

TEST(LocalBSpline, PiecesAreChosenByTheLimit) {
  const std::vector<double> knots{0, 1, 1, 2};
  EXPECT_EQ(piece_at(knots, 1.0, Limit::from_right), 2);
  EXPECT_EQ(piece_at(knots, 1.0, Limit::from_left), 0);
  EXPECT_EQ(piece_at(knots, 0.0, Limit::from_right), 0);
  EXPECT_EQ(piece_at(knots, 0.0, Limit::from_left), -1);
  EXPECT_EQ(piece_at(knots, 2.0, Limit::from_right), -1);
  EXPECT_EQ(piece_at(knots, 2.0, Limit::from_left), 2);
  EXPECT_EQ(piece_at(knots, -1.0, Limit::from_right), -1);
  EXPECT_EQ(piece_at(knots, 3.0, Limit::from_left), -1);
}

TEST(LocalBSpline, BlossomIsSymmetricAffineAndTheValueOnTheDiagonal) {
  for_functions(2, [](Random& random, const KnotVector& knots, int, std::span<const double> own) {
    const int piece = piece_at(own, random.inside({own.front(), own.back()}), Limit::from_right);
    if (piece < 0) return;
    std::vector<double> arguments(static_cast<std::size_t>(knots.degree()));
    for (double& x : arguments)
      x = random.real(own[static_cast<std::size_t>(piece)], own[static_cast<std::size_t>(piece) + 1]);
    const double value = blossom(own, piece, arguments);
    std::vector<double> turned(arguments.rbegin(), arguments.rend());
    EXPECT_NEAR(blossom(own, piece, turned), value, 1e-14);
    const double first = arguments.front();
    arguments.front() = first - 0.25;
    const double below = blossom(own, piece, arguments);
    arguments.front() = first + 0.75;
    const double above = blossom(own, piece, arguments);
    EXPECT_NEAR(0.75 * below + 0.25 * above, value, 1e-13 * (1.0 + std::abs(below) + std::abs(above)));
    std::fill(arguments.begin(), arguments.end(), first);
    EXPECT_NEAR(blossom(own, piece, arguments), piece_derivative(own, piece, first, 0), 1e-14);
  });
}

TEST(LocalBSpline, BernsteinCoefficientsReproduceThePiece) {
  for_functions(3, [](Random& random, const KnotVector& knots, int, std::span<const double> own) {
    for (std::size_t k = 0; k + 1 < own.size(); ++k) {
      if (own[k] == own[k + 1]) continue;
      // Also parts of a piece, as T-junctions make them.
      const double middle = random.real(own[k], own[k + 1]);
      for (const Interval range :
           {Interval{own[k], own[k + 1]}, Interval{own[k], middle}, Interval{middle, own[k + 1]}}) {
        BSpline bezier{KnotVector::bezier(knots.degree()), Eigen::MatrixXd(1, knots.degree() + 1)};
        bernstein_coefficients(own, range,
                               {bezier.coefficients.data(), static_cast<std::size_t>(bezier.coefficients.size())});
        EXPECT_GE(bezier.coefficients.minCoeff(), 0.0);
        const double s = random.real(0.0, 1.0);
        const double u = range.first + s * range.length();
        EXPECT_NEAR(evaluate(bezier, s)[0], piece_derivative(own, static_cast<int>(k), u, 0), 1e-13);
      }
    }
    std::vector<double> outside(static_cast<std::size_t>(knots.degree()) + 1, 1.0);
    bernstein_coefficients(own, {own.back(), own.back() + 1.0}, outside);
    EXPECT_EQ(outside, std::vector<double>(outside.size(), 0.0));
  });
}

}  // namespace
}  // namespace isorim::geometry
