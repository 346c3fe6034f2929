#include "geometry/fitting/bordered_cholesky.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;

/// The solution, put back into the matrix, gives the right-hand side.
TEST(BorderedCholesky, SolvesWhatItIsGiven) {
  Random random(9);
  for (int trial = 0; trial < 100; ++trial) {
    const int size = random.integer(1, 40);
    const int half_width = random.integer(0, 8);
    const int border = random.integer(0, std::min(size, 10));
    BorderedCholesky matrix(size, half_width, border);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < size; ++i)
      for (int j = 0; j <= i; ++j) {
        if (i - j > half_width && i < size - border) continue;
        const double value = i == j ? 30.0 + random.real(0, 1) : random.real(-1, 1);
        if (random.integer(0, 1) == 0)
          matrix.add(i, j, value);
        else
          matrix.add(j, i, value);
        dense(i, j) = dense(j, i) = value;
      }
    Eigen::VectorXd rhs(size);
    for (double& x : rhs) x = random.real(-1, 1);
    ASSERT_TRUE(matrix.factorise());
    EXPECT_LT((dense * matrix.solve(rhs) - rhs).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(BorderedCholesky, TellsAnIndefiniteMatrix) {
  BorderedCholesky matrix(3, 1, 0);
  for (int i = 0; i < 3; ++i) matrix.add(i, i, 1.0);
  matrix.add(1, 0, 0.5);
  matrix.add(2, 1, 2.0);
  EXPECT_FALSE(matrix.factorise());
}

}  // namespace
}  // namespace isorim::geometry
