#include "solver/linear/low_rank.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "solver/linear/cross_approximation.h"
#include "tests/solver/linear/kernel_matrix.h"

namespace isorim::solver {
namespace {

using namespace testing;

MatrixXd random_matrix(Index rows, Index columns, unsigned seed) {
  return Eigen::Map<const MatrixXd>(random_vector(rows * columns, seed).data(), rows, columns);
}

MatrixXd random_orthonormal(Index rows, Index columns, unsigned seed) {
  return Eigen::HouseholderQR<MatrixXd>(random_matrix(rows, columns, seed)).householderQ() *
         MatrixXd::Identity(rows, columns);
}

MatrixXd product(const LowRank& factors) {
  return factors.u * factors.v.transpose();
}

TEST(Truncate, FindsTheLeastRankWithinTheAccuracy) {
  // Singular values 1, 1/2, 1/4, ... mixed by an ill-conditioned change of factors.
  const Index rank = 30;
  const VectorXd values = VectorXd::NullaryExpr(rank, [](Index k) { return std::ldexp(1.0, -static_cast<int>(k)); });
  const MatrixXd mix = random_matrix(rank, rank, 5);
  const LowRank factors{random_orthonormal(80, rank, 1) * values.asDiagonal() * mix,
                        random_orthonormal(60, rank, 2) * mix.inverse().transpose()};
  for (const double relative : {1e-1, 1e-3, 1e-6, 1e-8}) {
    const LowRank result = truncate(factors, {relative, 0.0});
    EXPECT_LE((product(result) - product(factors)).norm(), relative * values.norm());
    Index least = 0;
    while (values.tail(rank - least).norm() > relative * values.norm()) ++least;
    EXPECT_LE(result.rank(), least + 1) << relative;
    EXPECT_GE(result.rank(), least) << relative;
    const MatrixXd gram = result.v.transpose() * result.v;
    EXPECT_LT((gram - MatrixXd::Identity(gram.rows(), gram.cols())).norm(), std::max(1e-13, 0.1 * relative));
  }
}

TEST(Truncate, KeepsToAccuraciesNearRounding) {
  const auto points = random_points(90, 8);
  KernelMatrix matrix(newton(points));
  const MatrixXd block = matrix.dense(90, 90);
  for (const double relative : {1e-10, 1e-12, 1e-13})
    EXPECT_LE(relative_error(product(compress(block, {relative, 0.0})), block), relative);
}

TEST(Truncate, HandlesDegenerateFactors) {
  const Accuracy accuracy{1e-10, 0.0};
  EXPECT_EQ(truncate({MatrixXd(5, 0), MatrixXd(4, 0)}, accuracy).rank(), 0);
  EXPECT_EQ(truncate({MatrixXd::Zero(5, 3), MatrixXd::Ones(4, 3)}, accuracy).rank(), 0);
  // More columns than rows; equal columns.
  const LowRank wide{MatrixXd::Ones(3, 10), random_matrix(2, 10, 3)};
  const LowRank result = truncate(wide, accuracy);
  EXPECT_EQ(result.rank(), 1);
  EXPECT_LT((product(result) - product(wide)).norm(), 1e-14);
  // Two terms that cancel.
  MatrixXd u(6, 2);
  u << random_matrix(6, 1, 4), random_matrix(6, 1, 4);
  MatrixXd v(5, 2);
  v << random_matrix(5, 1, 6), -random_matrix(5, 1, 6);
  EXPECT_LT(product(truncate({u, v}, {1e-10, 1e-12})).norm(), 1e-12);
  EXPECT_EQ(truncate({u, MatrixXd::Ones(5, 2)}, {0.0, 1e6}).rank(), 0);
}

TEST(Truncate, NamesNumbersThatAreNotFinite) {
  MatrixXd u = MatrixXd::Ones(4, 2);
  u(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(truncate({u, MatrixXd::Ones(4, 2)}, {1e-3, 0.0}), NumericalError);
  EXPECT_THROW(compress(u, {1e-3, 0.0}), NumericalError);
}

TEST(FrobeniusNorm, IsThatOfTheProduct) {
  const LowRank factors{random_matrix(20, 4, 1), random_matrix(30, 4, 2)};
  EXPECT_NEAR(frobenius_norm(factors), product(factors).norm(), 1e-13 * product(factors).norm());
}

std::vector<std::int32_t> range(std::int32_t first, std::int32_t end) {
  std::vector<std::int32_t> indices;
  for (std::int32_t i = first; i < end; ++i) indices.push_back(i);
  return indices;
}

MatrixXd dense(const KernelMatrix& matrix, const std::vector<std::int32_t>& rows,
               const std::vector<std::int32_t>& columns) {
  MatrixXd block(std::ssize(rows) * matrix.components, std::ssize(columns) * matrix.components);
  matrix.dense_block(rows, columns, 0, block);
  return block;
}

TEST(CrossApproximation, MeetsTheAccuracyWithFewRowsAndColumns) {
  // Targets in one cube, nodes in another at the distance of its side.
  Matrix3Xd points = random_points(420, 11);
  points.rightCols(300).row(0).array() += 2.0;
  Matrix3Xd normals = random_points(420, 12).array() - 0.5;
  normals.colwise().normalize();
  const auto rows = range(0, 120);
  const auto columns = range(120, 420);
  for (const KernelMatrix& matrix :
       {KernelMatrix(newton(points)), KernelMatrix(logarithm(points)), KernelMatrix(double_layer(points, normals)),
        KernelMatrix(kelvin(points), 3), KernelMatrix(kelvin_traction(points, normals), 3)}) {
    const MatrixXd exact = dense(matrix, rows, columns);
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      KernelBlock block(matrix, rows, columns);
      const LowRank factors = cross_approximation(block, {tolerance, 0.0});
      EXPECT_LE(relative_error(product(factors), exact), tolerance);
      const LowRank least = truncate(factors, {tolerance, 0.0});
      EXPECT_TRUE(factors.rank() == exact.rows() || factors.rank() <= 3 * least.rank() + 12) << tolerance;
    }
  }
}

TEST(RowInterpolation, ServesSourcesBetweenThoseOfTheSample) {
  // Charges and dipoles in one cube, targets in another; the weights come from one set of sources, and serve another.
  Matrix3Xd points = random_points(720, 31);
  points.rightCols(600).row(0).array() += 2.0;
  Matrix3Xd normals = random_points(720, 32).array() - 0.5;
  normals.colwise().normalize();
  const auto rows = range(0, 120);
  const auto columns = range(120, 420);
  for (const KernelMatrix& matrix : {KernelMatrix(double_layer(points, normals)), KernelMatrix(kelvin(points), 3)}) {
    const MatrixXd sample = dense(matrix, rows, columns);
    const MatrixXd others = dense(matrix, rows, range(420, 720));
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
      KernelBlock block(matrix, rows, columns);
      const RowInterpolation found = interpolate_rows(block, {tolerance, 0.0});
      ASSERT_EQ(found.weights.cols(), std::ssize(found.rows));
      const MatrixXd at_rows = found.weights(found.rows, Eigen::all);
      // Rounding over the last pivots.
      EXPECT_LT((at_rows - MatrixXd::Identity(at_rows.rows(), at_rows.cols())).cwiseAbs().maxCoeff(),
                1e-15 / tolerance * 100.0);
      EXPECT_LE(relative_error(found.weights * sample(found.rows, Eigen::all), sample), tolerance);
      EXPECT_LE(relative_error(found.weights * others(found.rows, Eigen::all), others), tolerance);
      EXPECT_TRUE(tolerance < 1e-4 || 2 * std::ssize(found.rows) < sample.rows()) << found.rows.size();
    }
  }
}

TEST(RowInterpolation, TakesAllRowsWhereTheRankIsFull) {
  const KernelMatrix identity([](Index i, Index j, Eigen::Ref<MatrixXd> block) { block(0, 0) = i == j ? 1.0 : 0.0; });
  const auto rows = range(0, 40);
  KernelBlock block(identity, rows, rows);
  const RowInterpolation found = interpolate_rows(block, {1e-10, 0.0});
  EXPECT_EQ(std::ssize(found.rows), 40);
  EXPECT_EQ(found.weights, MatrixXd::Identity(40, 40));
}

TEST(CrossApproximation, SeesPartsThatKnowNothingOfEachOther) {
  // Targets and nodes on two planes each; only what does not share a plane interacts, so [0 A; B 0]. The second part is
  // three of 103 targets: only the groups tell of it.
  const Index major = 100;
  const Index minor = 3;
  Matrix3Xd points = random_points(2 * (major + minor), 21);
  Matrix3Xd normals = Matrix3Xd::Zero(3, points.cols());
  KernelMatrix matrix{Kernel{}};
  for (Index i = 0; i < points.cols(); ++i) {
    const bool first = i % (major + minor) < major;
    points(0, i) = i < major + minor ? 0.0 : 3.0;
    if (first)
      points(2, i) = 0.0;
    else
      points(1, i) = 0.0;
    normals(first ? 2 : 1, i) = 1.0;
    matrix.groups.push_back(first ? 0 : 1);
  }
  // The nodes' planes are those of the targets.
  points.rightCols(major + minor).row(0) += random_vector(major + minor, 3).transpose();
  matrix.kernel = double_layer(points, normals);
  const auto rows = range(0, 103);
  const auto columns = range(103, 206);
  const MatrixXd exact = dense(matrix, rows, columns);
  ASSERT_EQ(exact.topLeftCorner(major, major).norm(), 0.0);
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    KernelBlock block(matrix, rows, columns);
    EXPECT_LE(relative_error(product(cross_approximation(block, {tolerance, 0.0})), exact), tolerance);
  }
}

TEST(CrossApproximation, ZeroBlocksCostLittleAndHaveRankZero) {
  const KernelMatrix matrix([](Index, Index, Eigen::Ref<MatrixXd> block) { block.setZero(); }, 2);
  const auto rows = range(0, 300);
  KernelBlock block(matrix, rows, rows);
  EXPECT_EQ(cross_approximation(block, {1e-8, 0.0}).rank(), 0);
  EXPECT_LE(block.evaluations, 20 * 300);
}

TEST(CrossApproximation, RoundingBelowTheAbsoluteAccuracyIsLeftOut) {
  std::mt19937 random(3);
  const KernelMatrix matrix(
      [&](Index, Index, Eigen::Ref<MatrixXd> block) { block(0, 0) = 1e-17 * static_cast<double>(random() % 7); });
  const auto rows = range(0, 100);
  KernelBlock block(matrix, rows, rows);
  EXPECT_EQ(truncate(cross_approximation(block, {1e-8, 1e-10}), {1e-8, 1e-10}).rank(), 0);
  EXPECT_LE(block.evaluations, 22 * 100);
}

TEST(CrossApproximation, TakesFullRankAsItIs) {
  const KernelMatrix identity([](Index i, Index j, Eigen::Ref<MatrixXd> block) { block(0, 0) = i == j ? 1.0 : 0.0; });
  const auto rows = range(0, 40);
  KernelBlock block(identity, rows, rows);
  EXPECT_LT((product(cross_approximation(block, {1e-10, 0.0})) - MatrixXd::Identity(40, 40)).norm(), 1e-14);
}

TEST(CrossApproximation, HandlesSingleTargetsAndNodes) {
  const KernelMatrix matrix(newton(random_points(60, 2)));
  const auto one = range(0, 1);
  const auto many = range(1, 60);
  KernelBlock row(matrix, one, many);
  EXPECT_LT(relative_error(product(cross_approximation(row, {1e-12, 0.0})), dense(matrix, one, many)), 1e-15);
  KernelBlock column(matrix, many, one);
  EXPECT_LT(relative_error(product(cross_approximation(column, {1e-12, 0.0})), dense(matrix, many, one)), 1e-15);
  KernelBlock none(matrix, {}, many);
  EXPECT_EQ(cross_approximation(none, {1e-12, 0.0}).rank(), 0);
}

TEST(CrossApproximation, NamesWhereTheKernelIsNotFinite) {
  const KernelMatrix matrix(
      [](Index, Index j, Eigen::Ref<MatrixXd> block) { block(0, 0) = 1.0 / static_cast<double>(j - 17); });
  const auto rows = range(0, 40);
  KernelBlock block(matrix, rows, rows);
  EXPECT_THROW(cross_approximation(block, {1e-6, 0.0}), NumericalError);
}

}  // namespace
}  // namespace isorim::solver
