#include "quadrature/gauss_legendre.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

namespace isorim::quadrature {
namespace {

double integrate_power(const Rule& rule, int exponent) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], exponent);
  return sum;
}

TEST(GaussLegendre, IntegratesMonomialsUpToDegreeTwoNMinusOne) {
  for (int n = 1; n <= max_gauss_points; ++n) {
    const Rule& rule = gauss_legendre(n);
    ASSERT_EQ(rule.size(), n);
    for (int k = 0; k <= 2 * n - 1; ++k) EXPECT_NEAR(integrate_power(rule, k) * (k + 1), 1.0, 1e-14) << n << " " << k;
  }
}

TEST(GaussLegendre, IsNotExactBeyondItsDegree) {
  for (int n = 1; n <= 8; ++n)
    EXPECT_GT(std::abs(integrate_power(gauss_legendre(n), 2 * n) * (2 * n + 1) - 1.0), 1e-10);
}

TEST(GaussLegendre, NodesAreIncreasingSymmetricAndInside) {
  for (int n = 1; n <= max_gauss_points; ++n) {
    const Rule& rule = gauss_legendre(n);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const std::size_t mirror = rule.nodes.size() - 1 - i;
      EXPECT_GT(rule.nodes[i], i == 0 ? 0.0 : rule.nodes[i - 1]);
      EXPECT_LT(rule.nodes[i], 1.0);
      EXPECT_NEAR(rule.nodes[i] + rule.nodes[mirror], 1.0, 2 * std::numeric_limits<double>::epsilon());
      EXPECT_EQ(rule.weights[i], rule.weights[mirror]);
    }
  }
}

// Abramowitz & Stegun, table 25.4, moved from [-1, 1] to [0, 1].
TEST(GaussLegendre, AgreesWithPublishedRule) {
  const Rule& rule = gauss_legendre(5);
  const double outer = 0.9061798459386639927976;
  const double inner = 0.5384693101056830910363;
  EXPECT_DOUBLE_EQ(rule.nodes[4], 0.5 * (1.0 + outer));
  EXPECT_DOUBLE_EQ(rule.nodes[3], 0.5 * (1.0 + inner));
  EXPECT_EQ(rule.nodes[2], 0.5);
  EXPECT_DOUBLE_EQ(rule.weights[4], 0.5 * 0.2369268850561890875143);
  EXPECT_DOUBLE_EQ(rule.weights[3], 0.5 * 0.4786286704993664680413);
  EXPECT_DOUBLE_EQ(rule.weights[2], 0.5 * 0.5688888888888888888889);
}

}  // namespace
}  // namespace isorim::quadrature
