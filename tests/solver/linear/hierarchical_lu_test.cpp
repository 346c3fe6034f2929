#include "solver/linear/hierarchical_lu.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "solver/linear/gmres.h"
#include "solver/linear/hierarchical_arithmetic.h"
#include "tests/solver/linear/kernel_matrix.h"

namespace isorim::solver {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

HierarchicalMatrix assembled(const KernelMatrix& matrix, const Matrix3Xd& points, double tolerance, int leaf = 24) {
  return assemble(block_tree(points, matrix.components, leaf), matrix, {.tolerance = tolerance, .threads = 1});
}

/// Unsymmetric and well conditioned: 1 on the diagonal, a double layer elsewhere.
KernelMatrix second_kind(const CubePoints& cube) {
  const Kernel layer = double_layer(cube.points, cube.normals);
  const double weight = 1.0 / static_cast<double>(cube.points.cols());
  return KernelMatrix([layer, weight](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    layer(i, j, block);
    block *= weight;
    if (i == j) block(0, 0) = 1.0;
  });
}

TEST(HierarchicalArithmetic, SumsAndProductsAreThoseOfDenseMatrices) {
  // Points that crowd together, so that leaves lie on different levels.
  Matrix3Xd points = random_points(500, 31);
  points.leftCols(300) *= 0.01;
  const Index n = 500;
  for (const double tolerance : {1e-3, 1e-7, 1e-11}) {
    const auto tree = block_tree(points, 1, 20);
    const AssemblyOptions options{.tolerance = tolerance, .threads = 1};
    const HierarchicalMatrix a = assemble(tree, KernelMatrix(newton(points)), options);
    const HierarchicalMatrix b = assemble(tree, KernelMatrix(logarithm(points)), options);
    ASSERT_GT(a.statistics().low_rank_blocks, 0U);
    const MatrixXd dense_a = a.to_dense();
    const MatrixXd dense_b = b.to_dense();
    HierarchicalMatrix sum = a;
    add(sum, -2.0, b, tolerance);
    EXPECT_LE(relative_error(sum.to_dense(), dense_a - 2.0 * dense_b), tolerance);
    HierarchicalMatrix product = a;
    add_product(product, 0.5, a, b, tolerance, 2);
    EXPECT_LE(relative_error(product.to_dense(), dense_a + 0.5 * dense_a * dense_b), 3.0 * tolerance);
    HierarchicalMatrix updated = b;
    const LowRank update{MatrixXd::Ones(n, 1), random_vector(n, 2)};
    add(updated, update, tolerance);
    EXPECT_LE(relative_error(updated.to_dense(), dense_b + update.u * update.v.transpose()), tolerance);
  }
}

TEST(HierarchicalArithmetic, RefusesTreesThatDoNotFit) {
  const Matrix3Xd points = random_points(100, 1);
  HierarchicalMatrix a = assembled(KernelMatrix(newton(points)), points, 1e-3);
  const HierarchicalMatrix b = assembled(KernelMatrix(newton(points)), points, 1e-3);
  EXPECT_THROW(add(a, 1.0, b, 1e-3), InputError);
  EXPECT_THROW(add_product(a, 1.0, a, b, 1e-3), InputError);
}

/// The kernel with `shift` times its number of points on the diagonal, which keeps the elimination from growing.
KernelMatrix shifted(const Kernel& kernel, const Matrix3Xd& points, double shift, int components = 1) {
  const double entry = shift * static_cast<double>(points.cols());
  return KernelMatrix(
      [kernel, entry](Index i, Index j, Eigen::Ref<MatrixXd> block) {
        kernel(i, j, block);
        if (i == j) block.diagonal().array() += entry;
      },
      components);
}

TEST(HierarchicalLu, SolvesToItsTolerance) {
  const Matrix3Xd sphere = sphere_points(700);
  const CubePoints cube = cube_points(9);
  Matrix3Xd crowded = random_points(600, 32);
  crowded.leftCols(400) *= 0.02;
  Matrix3Xd screen = random_points(250, 33);
  screen.row(2).setZero();
  struct Case {
    KernelMatrix matrix;
    Matrix3Xd points;
  };
  for (const Case& test : {Case{KernelMatrix(newton(sphere)), sphere}, Case{second_kind(cube), cube.points},
                           Case{shifted(logarithm(crowded), crowded, 2.0), crowded},
                           Case{shifted(kelvin(screen), screen, 8.0, 3), screen}}) {
    EXPECT_GT(assembled(test.matrix, test.points, 1e-3).statistics().low_rank_blocks, 0U);
    for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
      const HierarchicalMatrix matrix = assembled(test.matrix, test.points, 0.1 * tolerance);
      const HierarchicalLu inverse(matrix, {.tolerance = tolerance, .threads = 1});
      EXPECT_EQ(inverse.replaced_pivots(), 0);
      const VectorXd b = random_vector(matrix.rows(), 5);
      EXPECT_LE((matrix.product(inverse.product(b)) - b).norm(), 5.0 * tolerance * b.norm());
    }
  }
}

TEST(HierarchicalLu, HandlesDegeneratePlacements) {
  const Matrix3Xd line = Vector3d(1.0, 2.0, 3.0) * Eigen::RowVectorXd::LinSpaced(200, 0.0, 1.0);
  Matrix3Xd far_apart = random_points(200, 4);
  far_apart.leftCols(90).row(1).array() += 50.0;
  for (const Matrix3Xd& points : {line, far_apart, Matrix3Xd(Matrix3Xd::Zero(3, 1)), Matrix3Xd(sphere_points(10))}) {
    const double n = static_cast<double>(points.cols());
    const KernelMatrix matrix([&](Index i, Index j, Eigen::Ref<MatrixXd> block) {
      block(0, 0) = i == j ? 4.0 * n : 1.0 / (points.col(i) - points.col(j)).norm();
    });
    const HierarchicalMatrix compressed = assembled(matrix, points, 1e-9);
    const HierarchicalLu inverse(compressed, {.tolerance = 1e-9, .threads = 1});
    const VectorXd x = random_vector(points.cols(), 6);
    EXPECT_LE((inverse.product(compressed.product(x)) - x).norm(), 1e-7 * x.norm());
  }
}

TEST(HierarchicalLu, HasTheSameBitsForAnyNumberOfThreads) {
  const Matrix3Xd points = sphere_points(1500);
  const HierarchicalMatrix matrix = assembled(KernelMatrix(newton(points)), points, 1e-4);
  const HierarchicalLu one(matrix, {.tolerance = 1e-3, .threads = 1});
  const HierarchicalLu four(matrix, {.tolerance = 1e-3, .threads = 4});
  const VectorXd b = random_vector(1500, 8);
  EXPECT_EQ(one.product(b), four.product(b));
}

TEST(HierarchicalLu, KeepsIterationsFlat) {
  // Collocation of a single layer with constant panels of equal area: its condition number grows with the root of n.
  std::vector<int> preconditioned;
  std::vector<int> plain;
  for (const Index n : {500, 2000, 8000}) {
    const Matrix3Xd points = sphere_points(n);
    const HierarchicalMatrix matrix = assembled(KernelMatrix(newton(points)), points, 1e-6, 64);
    const HierarchicalLu inverse(matrix, {.tolerance = 1e-2});
    const VectorXd b = random_vector(n, 9);
    const GmresResult result = gmres(matrix, b, {.tolerance = 1e-10}, &inverse);
    EXPECT_EQ(result.status, GmresStatus::converged);
    EXPECT_LE((matrix.product(result.x) - b).norm(), 1.01e-10 * b.norm());
    preconditioned.push_back(result.iterations);
    plain.push_back(gmres(matrix, b, {.tolerance = 1e-10}).iterations);
  }
  // Of 500 rows hardly any block is truncated.
  EXPECT_LE(preconditioned.front(), 3);
  EXPECT_LE(preconditioned[2], preconditioned[1] + 3);
  EXPECT_LE(preconditioned.back(), 12);
  EXPECT_GT(plain.back(), plain.front() + 10);
}

TEST(HierarchicalLu, SingularMatricesStillGivePreconditioners) {
  // Rows that sum to zero, as of a body without supports: the constant is in the null space.
  for (const Index n : {Index{3}, Index{10}, Index{18}}) {
    const CubePoints cube = cube_points(n);
    const Index count = cube.points.cols();
    const KernelMatrix layer(double_layer(cube.points, cube.normals));
    const VectorXd sums = layer.dense(count, count).rowwise().sum();
    const KernelMatrix matrix([&](Index i, Index j, Eigen::Ref<MatrixXd> block) {
      layer.kernel(i, j, block);
      if (i == j) block(0, 0) = -sums[i];
    });
    const HierarchicalMatrix compressed = assembled(matrix, cube.points, 1e-8, 64);
    const HierarchicalLu inverse(compressed, {.tolerance = 1e-3});
    // In a single leaf the zero pivot is seen; truncation hides it in several.
    EXPECT_EQ(inverse.replaced_pivots(), count <= 64 ? 1 : 0);
    const VectorXd b = compressed.product(random_vector(count, 10));
    const GmresResult result = gmres(compressed, b, {.tolerance = 1e-10}, &inverse);
    EXPECT_EQ(result.status, GmresStatus::converged) << count;
    EXPECT_LE(result.iterations, 12) << count;
  }
}

TEST(HierarchicalLu, RefusesRectanglesAndNumbersThatAreNotFinite) {
  const auto rows = std::make_shared<const ClusterTree>(places(random_points(50, 1)), 10);
  const auto columns = std::make_shared<const ClusterTree>(places(random_points(50, 2)), 10);
  const HierarchicalMatrix rectangle(std::make_shared<const BlockTree>(rows, columns));
  EXPECT_THAT([&] { HierarchicalLu(rectangle, {}); }, ThrowsMessage<InputError>(HasSubstr("one tree")));
  const Matrix3Xd points = sphere_points(200);
  HierarchicalMatrix matrix = assembled(KernelMatrix(newton(points)), points, 1e-3);
  matrix.add_entries(7, 7, MatrixXd::Constant(1, 1, std::numeric_limits<double>::infinity()));
  EXPECT_THAT([&] { HierarchicalLu(matrix, {}); }, ThrowsMessage<NumericalError>(HasSubstr("not finite")));
}

}  // namespace
}  // namespace isorim::solver
