#include "geometry/fitting/spline_least_squares.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "geometry/spline/bspline.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Ends;
using testing::Random;

constexpr int rhs_count = 3;

/// Rows of a least-squares problem: the parameter with its span, the weight and the right-hand sides.
struct Row {
  double u;
  double factor;
  Eigen::Vector3d rhs;
};

std::vector<Row> random_rows(Random& random, const KnotVector& knots, int count) {
  std::vector<Row> rows;
  for (int i = 0; i < count; ++i)
    rows.push_back({random.inside(knots.domain()),
                    random.real(0.1, 3.0),
                    {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}});
  // Some in every span, so that everything is determined.
  for (int span = knots.degree(); span < knots.basis_count(); ++span)
    for (int k = 0; k <= knots.degree() && knots[span] < knots[span + 1]; ++k)
      rows.push_back({knots[span] + (k + 0.5) / (knots.degree() + 1) * (knots[span + 1] - knots[span]),
                      1.0,
                      {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}});
  return rows;
}

struct DenseSolution {
  Eigen::MatrixXd coefficients;
  double condition;
};

DenseSolution dense_solution(const FitSpace& space, const std::vector<Row>& rows) {
  const int p = space.knots.degree();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), space.unknowns());
  Eigen::MatrixXd rhs(matrix.rows(), rhs_count);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    const int span = space.knots.find_span(row.u);
    const Eigen::MatrixXd values = basis_derivatives(space.knots, span, row.u, 0);
    for (int j = 0; j <= p; ++j) matrix(i, (span - p + j) % space.unknowns()) += values(0, j);
    matrix.row(i) *= row.factor;
    rhs.row(i) = row.factor * row.rhs.transpose();
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  const Eigen::MatrixXd solution = qr.solve(rhs).transpose();
  Eigen::MatrixXd all(rhs_count, space.knots.basis_count());
  for (Eigen::Index i = 0; i < all.cols(); ++i) all.col(i) = solution.col(i % space.unknowns());
  return {all, qr.maxPivot() / std::abs(qr.matrixQR()(space.unknowns() - 1, space.unknowns() - 1))};
}

Eigen::MatrixXd banded_solution(const FitSpace& space, const std::vector<Row>& rows) {
  SplineLeastSquares system(space, rhs_count);
  for (const Row& row : rows) {
    const int span = space.knots.find_span(row.u);
    const Eigen::MatrixXd values = row.factor * basis_derivatives(space.knots, span, row.u, 0);
    const Eigen::Vector3d rhs = row.factor * row.rhs;
    system.add(span - space.knots.degree(), {values.data(), static_cast<std::size_t>(values.size())},
               {rhs.data(), rhs_count});
  }
  return system.solve();
}

/// Open, periodic and clamped closed spaces; rows in order and in disorder.
TEST(SplineLeastSquares, AgreesWithADenseFactorisation) {
  Random random(11);
  for (int trial = 0; trial < 150; ++trial) {
    const int degree = random.integer(1, 7);
    const Ends ends = static_cast<Ends>(random.integer(0, 2));
    const KnotVector knots = testing::random_knots(random, degree, ends, random.integer(1, degree));
    int shared = ends == Ends::periodic ? degree : 0;
    if (ends == Ends::clamped && random.integer(0, 1) == 1) shared = 1;
    const FitSpace space{knots, shared};
    if (shared > 0 && space.unknowns() < degree + 1) continue;
    std::vector<Row> rows = random_rows(random, knots, 40);
    if (random.integer(0, 1) == 1)
      std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.u < b.u; });
    const DenseSolution expected = dense_solution(space, rows);
    const Eigen::MatrixXd found = banded_solution(space, rows);
    ASSERT_EQ(found.cols(), expected.coefficients.cols());
    const double size = 1.0 + expected.coefficients.cwiseAbs().maxCoeff();
    EXPECT_LT((found - expected.coefficients).cwiseAbs().maxCoeff(), 1e-13 * expected.condition * size) << trial;
  }
}

TEST(SplineLeastSquares, TellsWhatTheRowsDoNotDetermine) {
  const FitSpace space{KnotVector::clamped_uniform(3, 4), 0};
  std::vector<Row> rows;
  for (int i = 0; i < 20; ++i) rows.push_back({0.7 * i / 20.0, 1.0, Eigen::Vector3d::Ones()});
  EXPECT_EQ(banded_solution(space, rows).cols(), 0);
  for (int i = 0; i < 5; ++i) rows.push_back({0.8 + 0.2 * i / 5.0, 1.0, Eigen::Vector3d::Ones()});
  EXPECT_EQ(banded_solution(space, rows).cols(), space.knots.basis_count());
}

}  // namespace
}  // namespace isorim::geometry
