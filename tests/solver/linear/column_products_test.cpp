#include "solver/linear/column_products.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/linear/column_qr.h"
#include "tests/solver/linear/kernel_matrix.h"

namespace isorim::solver {
namespace {

using namespace testing;

MatrixXd random_matrix(Index rows, Index columns, unsigned seed) {
  return MatrixXd(Eigen::Map<const MatrixXd>(random_vector(rows * columns, seed).data(), rows, columns));
}

constexpr double rounding = 1e-13;

TEST(ColumnProducts, AgreeWithEigenForSizesThatFillNoRegister) {
  for (const Index rows : {1, 3, 4, 5, 12, 19, 50}) {
    for (const Index columns : {1, 2, 4, 7, 33}) {
      for (const Index depth : {0, 1, 3, 8, 41}) {
        const MatrixXd a = random_matrix(rows, depth, 1);
        const MatrixXd b = random_matrix(depth, columns, 2);
        const MatrixXd start = random_matrix(rows, columns, 3);
        for (const double factor : {1.0, -1.0, 0.3}) {
          const MatrixXd expected = start + factor * a * b;
          MatrixXd plain = start;
          add_product(factor, a, b, plain);
          EXPECT_LE((plain - expected).norm(), rounding * expected.norm());
          MatrixXd right_transposed = start;
          add_product_with_transposed(factor, a, b.transpose().eval(), right_transposed);
          EXPECT_LE((right_transposed - expected).norm(), rounding * expected.norm());
          MatrixXd left_transposed = start;
          add_transposed_product(factor, a.transpose().eval(), b, left_transposed);
          EXPECT_LE((left_transposed - expected).norm(), rounding * expected.norm());
        }
      }
    }
  }
}

TEST(ColumnProducts, TouchNothingBesideTheirBlock) {
  const MatrixXd a = random_matrix(20, 20, 4);
  const MatrixXd b = random_matrix(20, 20, 5);
  MatrixXd whole = MatrixXd::Constant(20, 20, 7.0);
  MatrixXd expected = whole;
  expected.block(2, 3, 11, 9) += a.block(1, 2, 11, 5) * b.block(4, 1, 5, 9);
  add_product(1.0, a.block(1, 2, 11, 5), b.block(4, 1, 5, 9), whole.block(2, 3, 11, 9));
  EXPECT_LE((whole - expected).cwiseAbs().maxCoeff(), rounding);
}

MatrixXd orthonormal(const ColumnQr& qr, Index columns) {
  return qr.orthonormal_times(MatrixXd::Identity(columns, columns));
}

TEST(ColumnQr, FactorsAreOrthonormalAndTriangular) {
  for (const Index rows : {1, 5, 30, 100}) {
    for (const Index columns : {1, 7, 8, 9, 30, 64}) {
      const MatrixXd matrix = random_matrix(rows, columns, 6);
      const ColumnQr qr(matrix);
      const MatrixXd q = orthonormal(qr, std::min(rows, columns));
      const MatrixXd r = qr.triangle();
      EXPECT_LE((q.transpose() * q - MatrixXd::Identity(q.cols(), q.cols())).norm(), rounding);
      EXPECT_LE((q * r - matrix).norm(), rounding * matrix.norm());
      EXPECT_EQ(MatrixXd(r.triangularView<Eigen::StrictlyLower>()).norm(), 0.0);
    }
  }
}

TEST(ColumnQr, StaysOrthonormalWithoutFullRank) {
  MatrixXd matrix = random_matrix(40, 3, 7) * random_matrix(3, 20, 8);
  matrix.col(5).setZero();
  matrix.col(11) *= 1e-150;
  const ColumnQr qr(matrix);
  const MatrixXd q = orthonormal(qr, 20);
  EXPECT_LE((q.transpose() * q - MatrixXd::Identity(20, 20)).norm(), rounding);
  EXPECT_LE((q * qr.triangle() - matrix).norm(), rounding * matrix.norm());
}

TEST(ColumnQr, TakesMatricesOfZeros) {
  const ColumnQr qr(MatrixXd::Zero(9, 4));
  EXPECT_EQ(qr.triangle().norm(), 0.0);
  EXPECT_LE((orthonormal(qr, 4) - MatrixXd::Identity(9, 4)).norm(), rounding);
}

}  // namespace
}  // namespace isorim::solver
