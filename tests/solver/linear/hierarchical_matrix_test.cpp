#include "solver/linear/hierarchical_matrix.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/solver/linear/kernel_matrix.h"

namespace isorim::solver {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// The error of the assembled matrix against the dense one, over the tolerance.
double error_share(const KernelMatrix& matrix, const Matrix3Xd& points, double tolerance) {
  const auto tree = block_tree(points, matrix.components, 24);
  const HierarchicalMatrix compressed = assemble(tree, matrix, {.tolerance = tolerance, .threads = 1});
  return relative_error(compressed.to_dense(), matrix.dense(points.cols(), points.cols())) / tolerance;
}

TEST(HierarchicalMatrix, HonoursItsToleranceForEveryKernel) {
  const Matrix3Xd sphere = sphere_points(400);
  const CubePoints cube = cube_points(7);
  Matrix3Xd far_apart = random_points(300, 4);
  far_apart.leftCols(130).row(1).array() += 50.0;
  Matrix3Xd screen = random_points(400, 5);
  screen.row(2).setZero();
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    EXPECT_LE(error_share(KernelMatrix(newton(sphere)), sphere, tolerance), 1.0);
    EXPECT_LE(error_share(KernelMatrix(logarithm(sphere)), sphere, tolerance), 1.0);
    EXPECT_LE(error_share(KernelMatrix(newton(far_apart)), far_apart, tolerance), 1.0);
    EXPECT_LE(error_share(KernelMatrix(logarithm(screen)), screen, tolerance), 1.0);
    EXPECT_LE(error_share(KernelMatrix(kelvin(far_apart), 3), far_apart, tolerance), 1.0);
    EXPECT_LE(error_share(KernelMatrix(double_layer(cube.points, cube.normals)), cube.points, tolerance), 1.0);
    EXPECT_LE(error_share(KernelMatrix(kelvin_traction(cube.points, cube.normals), 3), cube.points, tolerance), 1.0);
  }
}

TEST(HierarchicalMatrix, HonoursItsToleranceForDegeneratePlacements) {
  const Matrix3Xd line = Vector3d(1.0, -2.0, 0.5) * Eigen::RowVectorXd::LinSpaced(300, 0.0, 1.0);
  Matrix3Xd pairs = sphere_points(300);
  pairs.rightCols(150) = pairs.leftCols(150).eval();
  Matrix3Xd heap = sphere_points(300);
  heap.leftCols(200).colwise() = Vector3d(0.0, 0.0, 1.0);
  for (const Matrix3Xd& points :
       {line, pairs, heap, Matrix3Xd(Matrix3Xd::Ones(3, 100)), Matrix3Xd(Matrix3Xd::Ones(3, 1))})
    for (const double tolerance : {1e-3, 1e-9})
      EXPECT_LE(error_share(KernelMatrix(newton(points)), points, tolerance), 1.0);
}

TEST(HierarchicalMatrix, TheUnitOfLengthChangesNothing) {
  const Matrix3Xd points = sphere_points(600);
  const KernelMatrix metres(newton(points));
  const KernelMatrix millimetres([points](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    const double r = (1000.0 * points.col(i) - 1000.0 * points.col(j)).norm();
    block(0, 0) = r > 0.0 ? 1.0 / r : std::sqrt(600.0) / 1000.0;
  });
  const AssemblyOptions options{.tolerance = 1e-6, .threads = 1};
  const auto a = assemble(block_tree(points), metres, options).statistics();
  const auto b = assemble(block_tree(1000.0 * points), millimetres, options).statistics();
  EXPECT_EQ(a.low_rank_memory, b.low_rank_memory);
  EXPECT_EQ(a.dense_memory, b.dense_memory);
}

TEST(HierarchicalMatrix, ProductsAgreeWithDenseOnes) {
  for (const int components : {1, 3}) {
    const Matrix3Xd points = sphere_points(components == 1 ? 1500 : 500);
    const KernelMatrix matrix(components == 1 ? newton(points) : kelvin(points), components);
    const HierarchicalMatrix compressed =
        assemble(block_tree(points, components), matrix, {.tolerance = 1e-3, .threads = 2});
    const MatrixXd dense = compressed.to_dense();
    const VectorXd x = random_vector(dense.cols(), 7);
    VectorXd y = random_vector(dense.rows(), 8);
    const VectorXd expected = y + dense * x;
    compressed.add_product(x, y);
    EXPECT_LT((y - expected).norm(), 1e-13 * expected.norm());
    EXPECT_NEAR(compressed.norm(), dense.norm(), 1e-12 * dense.norm());
    EXPECT_LT(compressed.memory(), sizeof(double) * static_cast<std::size_t>(dense.size()) * 3 / 4);
  }
}

TEST(HierarchicalMatrix, HasTheSameBitsForAnyNumberOfThreads) {
  const Matrix3Xd points = sphere_points(1200);
  const KernelMatrix matrix(newton(points));
  const auto tree = block_tree(points);
  const HierarchicalMatrix one = assemble(tree, matrix, {.tolerance = 1e-7, .threads = 1});
  const HierarchicalMatrix four = assemble(tree, matrix, {.tolerance = 1e-7, .threads = 4});
  const VectorXd x = random_vector(1200, 9);
  EXPECT_EQ(one.product(x), four.product(x));
  EXPECT_EQ(one.to_dense(), four.to_dense());
}

TEST(HierarchicalMatrix, BlocksOfRoundingVanish) {
  // A double layer between nodes of one plane whose normals are off by rounding, and a diagonal.
  Matrix3Xd points = random_points(600, 14);
  points.row(2).setZero();
  const KernelMatrix matrix([points](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    block(0, 0) =
        i == j ? 0.5
               : 1e-17 * std::sin(static_cast<double>(i * 7 + j * j)) / (points.col(i) - points.col(j)).squaredNorm();
  });
  const auto compressed = assemble(block_tree(points), matrix, {.tolerance = 1e-6, .threads = 1});
  EXPECT_EQ(compressed.statistics().max_rank, 0);
}

TEST(HierarchicalMatrix, RowsAndColumnsMayBeDividedByDifferentTrees) {
  // Three components a row, one a column, over points that have nothing to do with each other.
  const Matrix3Xd targets = sphere_points(200);
  const Matrix3Xd nodes = 1.5 * random_points(310, 3);
  struct Source final : MatrixSource {
    const Matrix3Xd& targets;
    const Matrix3Xd& nodes;
    Source(const Matrix3Xd& t, const Matrix3Xd& n) : targets(t), nodes(n) {}
    void dense_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns, int,
                     Eigen::Ref<MatrixXd> block) const override {
      for (Index j = 0; j < std::ssize(columns); ++j)
        for (Index i = 0; i < std::ssize(rows); ++i) {
          const Vector3d d =
              nodes.col(columns[static_cast<std::size_t>(j)]) - targets.col(rows[static_cast<std::size_t>(i)]);
          block.block(3 * i, j, 3, 1) = d / std::pow(d.norm() + 1e-3, 3);
        }
    }
    LowRank low_rank_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                           const Accuracy& accuracy, int) const override {
      struct Cross final : CrossSource {
        const Source& source;
        std::span<const std::int32_t> rows, columns;
        Cross(const Source& s, std::span<const std::int32_t> r, std::span<const std::int32_t> c)
            : source(s), rows(r), columns(c) {}
        Index targets() const override { return std::ssize(rows); }
        Index nodes() const override { return std::ssize(columns); }
        int row_components() const override { return 3; }
        void row(Index target, Eigen::Ref<MatrixXd> values) override {
          MatrixXd block(3, std::ssize(columns));
          source.dense_block(rows.subspan(static_cast<std::size_t>(target), 1), columns, 0, block);
          values = block.transpose();
        }
        void column(Index node, Eigen::Ref<MatrixXd> values) override {
          source.dense_block(rows, columns.subspan(static_cast<std::size_t>(node), 1), 0, values);
        }
      } cross(*this, rows, columns);
      return cross_approximation(cross, accuracy);
    }
  };
  const auto row_tree = std::make_shared<const ClusterTree>(places(targets, 3), 20);
  const auto column_tree = std::make_shared<const ClusterTree>(places(nodes), 20);
  const auto tree = std::make_shared<const BlockTree>(row_tree, column_tree);
  const Source source(targets, nodes);
  const HierarchicalMatrix compressed = assemble(tree, source, {.tolerance = 1e-6, .threads = 1});
  EXPECT_GT(compressed.statistics().low_rank_blocks, 0U);
  std::vector<std::int32_t> rows(200);
  std::vector<std::int32_t> columns(310);
  std::iota(rows.begin(), rows.end(), 0);
  std::iota(columns.begin(), columns.end(), 0);
  MatrixXd dense(600, 310);
  source.dense_block(rows, columns, 0, dense);
  EXPECT_LE(relative_error(compressed.to_dense(), dense), 1e-6);
  const VectorXd x = random_vector(310, 1);
  EXPECT_LE((compressed.product(x) - dense * x).norm(), 1e-6 * dense.norm() * x.norm());
}

TEST(HierarchicalMatrix, NearEntriesAndScalesCanBeChanged) {
  const Matrix3Xd points = sphere_points(400);
  const KernelMatrix matrix(kelvin(points), 3);
  HierarchicalMatrix compressed = assemble(block_tree(points, 3), matrix, {.tolerance = 1e-4, .threads = 1});
  MatrixXd expected = compressed.to_dense();
  const MatrixXd change = MatrixXd::Random(3, 3);
  for (const std::int32_t i : {0, 57, 399}) {
    compressed.add_entries(i, i, change);
    expected.block(3 * i, 3 * i, 3, 3) += change;
  }
  const VectorXd rows = random_vector(1200, 2);
  const VectorXd columns = random_vector(1200, 3);
  compressed.scale_rows(rows);
  compressed.scale_columns(columns);
  expected = rows.asDiagonal() * expected * columns.asDiagonal();
  EXPECT_LT(relative_error(compressed.to_dense(), expected), 1e-14);
  // The poles of the sphere.
  EXPECT_THAT([&] { compressed.add_entries(0, 399, change); },
              ThrowsMessage<InputError>(HasSubstr("indices 0 and 399")));
}

TEST(HierarchicalMatrix, RefusesBadTolerancesAndBlocks) {
  const Matrix3Xd points = sphere_points(300);
  const auto tree = block_tree(points);
  const KernelMatrix matrix(newton(points));
  for (const double tolerance : {0.0, 1.0, -1e-3, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT([&] { assemble(tree, matrix, {.tolerance = tolerance}); },
                ThrowsMessage<InputError>(HasSubstr("between 0 and 1")));
  const KernelMatrix bad([](Index i, Index j, Eigen::Ref<MatrixXd> block) {
    block(0, 0) = i == j ? std::numeric_limits<double>::quiet_NaN() : 1.0;
  });
  EXPECT_THAT([&] { assemble(tree, bad, {.tolerance = 1e-3}); },
              ThrowsMessage<NumericalError>(HasSubstr("not finite")));
}

}  // namespace
}  // namespace isorim::solver
