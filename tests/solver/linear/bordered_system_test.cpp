#include "solver/linear/bordered_system.h"

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "solver/linear/gmres.h"
#include "solver/linear/hierarchical_arithmetic.h"
#include "solver/linear/hierarchical_lu.h"
#include "tests/solver/linear/kernel_matrix.h"

namespace isorim::solver {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

MatrixXd bordered(const MatrixXd& matrix, const Border& border) {
  MatrixXd result(matrix.rows() + border.size(), matrix.cols() + border.size());
  result << matrix, border.columns, border.rows, border.corner;
  return result;
}

MatrixXd random_matrix(Index rows, Index columns, unsigned seed) {
  return Eigen::Map<const MatrixXd>(random_vector(rows * columns, seed).data(), rows, columns);
}

TEST(BorderedSystem, MatrixAndInverseAreThoseOfTheWhole) {
  const Matrix3Xd points = sphere_points(300);
  const HierarchicalMatrix matrix =
      assemble(block_tree(points), KernelMatrix(newton(points)), {.tolerance = 1e-11, .threads = 1});
  const HierarchicalLu inverse(matrix, {.tolerance = 1e-11, .threads = 1});
  const Border border{random_matrix(300, 3, 1), random_matrix(3, 300, 2), random_matrix(3, 3, 3)};
  const MatrixXd whole = bordered(matrix.to_dense(), border);
  const VectorXd x = random_vector(303, 4);
  const BorderedMatrix operation(matrix, border);
  EXPECT_LT((operation.product(x) - whole * x).norm(), 1e-12 * (whole * x).norm());
  EXPECT_LT((BorderedInverse(inverse, border).product(whole * x) - x).norm(), 1e-7 * x.norm());
  // The inverse of A + w B C serves as well.
  HierarchicalMatrix changed = matrix;
  add(changed, {0.3 * border.columns, border.rows.transpose()}, 1e-11);
  const HierarchicalLu changed_inverse(changed, {.tolerance = 1e-11, .threads = 1});
  EXPECT_LT((BorderedInverse(changed_inverse, border, 0.3).product(whole * x) - x).norm(), 1e-7 * x.norm());
}

TEST(BorderedSystem, NullSpacesAreRemovedByMultipliers) {
  // Rows that sum to zero, the mean of the solution prescribed.
  const CubePoints cube = cube_points(12);
  const Index n = cube.points.cols();
  const KernelMatrix layer(double_layer(cube.points, cube.normals));
  const VectorXd sums = layer.dense(n, n).rowwise().sum();
  const KernelMatrix source([&](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    layer.kernel(i, j, block);
    if (i == j) block(0, 0) = -sums[i];
  });
  const HierarchicalMatrix matrix = assemble(block_tree(cube.points), source, {.tolerance = 1e-9, .threads = 1});
  const double scale = matrix.norm() / std::sqrt(static_cast<double>(n));
  const Border border{MatrixXd::Constant(n, 1, scale), MatrixXd::Constant(1, n, scale), MatrixXd::Zero(1, 1)};
  const double weight = 1.0 / (scale * static_cast<double>(n));
  HierarchicalMatrix regular = matrix;
  add(regular, {weight * border.columns, border.rows.transpose()}, 1e-4);
  const HierarchicalLu inverse(regular, {.tolerance = 1e-3, .threads = 1});
  const BorderedMatrix operation(matrix, border);
  const BorderedInverse preconditioner(inverse, border, weight);
  VectorXd b = random_vector(n + 1, 5);
  b[n] = 3.0 * scale * static_cast<double>(n);
  const GmresResult result = gmres(operation, b, {.tolerance = 1e-11}, &preconditioner);
  EXPECT_EQ(result.status, GmresStatus::converged);
  EXPECT_LE(result.iterations, 10);
  const VectorXd expected = bordered(matrix.to_dense(), border).partialPivLu().solve(b);
  EXPECT_LT((result.x - expected).norm(), 1e-8 * expected.norm());
  EXPECT_NEAR(result.x.head(n).mean(), 3.0, 1e-8);
}

TEST(BorderedSystem, RefusesBordersThatDoNotFitOrDetermineNothing) {
  const Matrix3Xd points = sphere_points(50);
  const HierarchicalMatrix matrix =
      assemble(block_tree(points), KernelMatrix(newton(points)), {.tolerance = 1e-6, .threads = 1});
  const HierarchicalLu inverse(matrix, {});
  EXPECT_THAT(
      [&] {
        BorderedMatrix(matrix, {MatrixXd::Ones(49, 1), MatrixXd::Ones(1, 50), MatrixXd::Zero(1, 1)});
      },
      ThrowsMessage<InputError>(HasSubstr("49 x 1, 1 x 50 and 1 x 1 does not fit")));
  EXPECT_THAT(
      [&] {
        BorderedInverse(inverse, {MatrixXd::Ones(50, 2), MatrixXd::Ones(2, 50), MatrixXd::Zero(2, 2)});
      },
      ThrowsMessage<NumericalError>(HasSubstr("rank 1 of the Schur complement")));
}

}  // namespace
}  // namespace isorim::solver
