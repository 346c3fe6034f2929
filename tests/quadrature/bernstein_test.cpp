#include "quadrature/bernstein.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "quadrature/gauss_legendre.h"

namespace isorim::quadrature {
namespace {

double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

TEST(BernsteinTable, ValuesAreTheBernsteinPolynomials) {
  for (const int degree : {1, 2, 3, 5, 8}) {
    const BernsteinTable& table = bernstein_table(degree, 7);
    for (int a = 0; a < 7; ++a) {
      const double u = gauss_legendre(7).nodes[static_cast<std::size_t>(a)];
      for (int i = 0; i <= degree; ++i) {
        const double expected = binomial(degree, i) * std::pow(u, i) * std::pow(1.0 - u, degree - i);
        EXPECT_NEAR(table.values_at(a)[i], expected, 1e-15) << degree << " " << i;
      }
    }
  }
}

TEST(BernsteinTable, DerivativesReproduceThoseOfLinearAndQuadraticFunctions) {
  for (const int degree : {2, 3, 7, 30}) {
    const BernsteinTable& table = bernstein_table(degree, 9);
    for (int a = 0; a < 9; ++a) {
      const double u = gauss_legendre(9).nodes[static_cast<std::size_t>(a)];
      double constant = 0.0;
      double linear = 0.0;
      double quadratic = 0.0;
      for (int i = 0; i <= degree; ++i) {
        const double slope = table.derivatives_at(a)[i];
        constant += slope;
        linear += slope * i / degree;
        quadratic += slope * i * (i - 1.0) / (degree * (degree - 1.0));
      }
      EXPECT_NEAR(constant, 0.0, 2e-14);
      EXPECT_NEAR(linear, 1.0, 2e-14);
      EXPECT_NEAR(quadratic, 2.0 * u, 4e-14);
    }
  }
}

}  // namespace
}  // namespace isorim::quadrature
