#include "solver/linear/gmres.h"

#include <limits>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/solver/linear/kernel_matrix.h"

namespace isorim::solver {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

struct Dense final : LinearOperator {
  MatrixXd matrix;
  explicit Dense(MatrixXd m) : matrix(std::move(m)) {}
  Index rows() const override { return matrix.rows(); }
  Index cols() const override { return matrix.cols(); }
  void add_product(const Eigen::Ref<const VectorXd>& x, Eigen::Ref<VectorXd> result) const override {
    result += matrix * x;
  }
  std::size_t memory() const override { return static_cast<std::size_t>(matrix.size()) * sizeof(double); }
};

/// Unsymmetric, eigenvalues about 1 within a disc of radius about `spread`.
MatrixXd random_system(Index n, double spread, unsigned seed) {
  const VectorXd entries = random_vector(n * n, seed);
  return MatrixXd::Identity(n, n) +
         spread * std::sqrt(3.0 / static_cast<double>(n)) * Eigen::Map<const MatrixXd>(entries.data(), n, n);
}

double true_residual(const MatrixXd& a, const VectorXd& x, const VectorXd& b) {
  return (b - a * x).norm() / b.norm();
}

TEST(Gmres, SolvesToItsTolerance) {
  const Dense a(random_system(200, 0.5, 1));
  const VectorXd b = random_vector(200, 2);
  for (const double tolerance : {1e-3, 1e-8, 1e-13}) {
    const GmresResult result = gmres(a, b, {.tolerance = tolerance});
    EXPECT_EQ(result.status, GmresStatus::converged);
    EXPECT_LE(true_residual(a.matrix, result.x, b), tolerance * (1.0 + 1e-3) + 1e-16);
    EXPECT_NEAR(result.residual, true_residual(a.matrix, result.x, b), 1e-15);
    ASSERT_EQ(result.history.size(), static_cast<std::size_t>(result.iterations) + 1);
    EXPECT_EQ(result.history.front(), 1.0);
    for (std::size_t k = 1; k < result.history.size(); ++k) EXPECT_LE(result.history[k], result.history[k - 1]);
    // Radius 1/2: a digit every log(10) / log(2) steps.
    EXPECT_LE(result.iterations, -1.1 * std::log2(tolerance) + 5);
  }
}

TEST(Gmres, RestartsAndStartsFromAGuess) {
  const Dense a(random_system(150, 0.6, 3));
  const VectorXd b = random_vector(150, 4);
  const GmresResult restarted = gmres(a, b, {.tolerance = 1e-10, .restart = 7});
  EXPECT_EQ(restarted.status, GmresStatus::converged);
  EXPECT_LE(true_residual(a.matrix, restarted.x, b), 1.01e-10);
  const VectorXd close = restarted.x + 1e-6 * random_vector(150, 5);
  const GmresResult warm = gmres(a, b, {.tolerance = 1e-10}, nullptr, &close);
  EXPECT_LT(warm.iterations, gmres(a, b, {.tolerance = 1e-10}).iterations - 5);
  EXPECT_LE(true_residual(a.matrix, warm.x, b), 1.01e-10);
}

TEST(Gmres, TheExactInverseNeedsOneIteration) {
  // Rows of very different size: without the preconditioner it takes as many iterations as there are unknowns.
  MatrixXd matrix = random_system(80, 0.5, 6);
  for (Index i = 0; i < 80; ++i) matrix.row(i) *= std::pow(10.0, static_cast<double>(i % 6));
  const Dense a(matrix);
  const Dense inverse(matrix.inverse());
  const VectorXd b = random_vector(80, 7);
  const GmresResult result = gmres(a, b, {.tolerance = 1e-9}, &inverse);
  EXPECT_EQ(result.status, GmresStatus::converged);
  EXPECT_LE(result.iterations, 2);
  EXPECT_GT(gmres(a, b, {.tolerance = 1e-9}).iterations, 20);
}

TEST(Gmres, EndsWithinAsManyIterationsAsUnknowns) {
  const Dense a(random_system(30, 3.0, 8));
  const VectorXd b = random_vector(30, 9);
  const GmresResult result = gmres(a, b, {.tolerance = 1e-11, .max_iterations = 60});
  EXPECT_EQ(result.status, GmresStatus::converged);
  EXPECT_LE(result.iterations, 31);
}

TEST(Gmres, ReportsThatItDoesNotConverge) {
  const Dense a(random_system(100, 0.9, 10));
  const VectorXd b = random_vector(100, 11);
  const GmresResult stopped = gmres(a, b, {.tolerance = 1e-12, .max_iterations = 9});
  EXPECT_EQ(stopped.status, GmresStatus::iteration_limit);
  EXPECT_EQ(stopped.iterations, 9);
  EXPECT_NEAR(stopped.residual, true_residual(a.matrix, stopped.x, b), 1e-14);
  EXPECT_LT(stopped.residual, 1.0);
  // Below rounding.
  const GmresResult rounding = gmres(a, b, {.tolerance = 1e-18});
  EXPECT_EQ(rounding.status, GmresStatus::stagnated);
  EXPECT_LT(rounding.residual, 1e-14);
  // A singular matrix and a right-hand side out of its range: the rest is what cannot be reached.
  MatrixXd singular = random_system(50, 0.5, 12);
  singular.row(20).setZero();
  const VectorXd ones = VectorXd::Ones(50);
  const GmresResult unreachable = gmres(Dense(singular), ones, {.tolerance = 1e-10});
  EXPECT_EQ(unreachable.status, GmresStatus::stagnated);
  EXPECT_NEAR(unreachable.residual, 1.0 / std::sqrt(50.0), 5e-3);
}

TEST(Gmres, SolvesSingularSystemsThatHaveSolutions) {
  // The constant is in the null space, as for a body without supports.
  MatrixXd matrix = random_system(60, 0.4, 13);
  matrix -= matrix.rowwise().sum() * Eigen::RowVectorXd::Constant(60, 1.0 / 60.0);
  const VectorXd b = matrix * random_vector(60, 14);
  const GmresResult result = gmres(Dense(matrix), b, {.tolerance = 1e-10});
  EXPECT_EQ(result.status, GmresStatus::converged);
  EXPECT_LE(true_residual(matrix, result.x, b), 1.01e-10);
}

TEST(Gmres, HandlesZeroSizesAndSides) {
  const Dense a(random_system(20, 0.3, 15));
  const GmresResult zero = gmres(a, VectorXd::Zero(20));
  EXPECT_EQ(zero.status, GmresStatus::converged);
  EXPECT_EQ(zero.x, VectorXd::Zero(20));
  EXPECT_EQ(zero.iterations, 0);
  const GmresResult one = gmres(Dense(MatrixXd::Constant(1, 1, 4.0)), VectorXd::Constant(1, 8.0));
  EXPECT_EQ(one.status, GmresStatus::converged);
  EXPECT_DOUBLE_EQ(one.x[0], 2.0);
}

TEST(Gmres, NamesWhereNumbersAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Dense a(random_system(20, 0.3, 16));
  VectorXd b = VectorXd::Ones(20);
  b[13] = nan;
  EXPECT_THAT([&] { gmres(a, b); }, ThrowsMessage<NumericalError>(HasSubstr("entry 13 of the right-hand side")));
  Dense bad = a;
  bad.matrix(4, 5) = nan;
  EXPECT_THAT([&] { gmres(bad, VectorXd::Ones(20)); },
              ThrowsMessage<NumericalError>(HasSubstr("not finite in iteration 1")));
  EXPECT_THAT([&] { gmres(a, VectorXd::Ones(19)); }, ThrowsMessage<InputError>(HasSubstr("20 x 20")));
  EXPECT_THAT(
      [&] { gmres(a, VectorXd::Ones(20), {}, &static_cast<const LinearOperator&>(Dense(MatrixXd::Ones(3, 3)))); },
      ThrowsMessage<InputError>(HasSubstr("preconditioner is 3 x 3")));
}

}  // namespace
}  // namespace isorim::solver
