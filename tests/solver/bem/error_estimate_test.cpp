#include "solver/bem/error_estimate.h"

#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using geometry::Point2;

TEST(MarkElements, SmallestSetWithTheShare) {
  const std::vector<double> indicators{1.0, 3.0, 0.0, 2.0};
  EXPECT_NEAR(total_indicator(indicators), std::sqrt(14.0), 1e-15);
  EXPECT_EQ(mark_elements(indicators, 0.6), (std::vector<int>{1}));
  EXPECT_EQ(mark_elements(indicators, 0.7), (std::vector<int>{1, 3}));
  EXPECT_EQ(mark_elements(indicators, 1.0), (std::vector<int>{0, 1, 3}));
}

TEST(MarkElements, EqualIndicatorsAreMarkedTogether) {
  const std::vector<double> indicators{1.0, 2.0, 1.0, 2.0 * (1.0 - 1e-9), 1.0};
  EXPECT_EQ(mark_elements(indicators, 0.3), (std::vector<int>{1, 3}));
}

SolveOptions fine() {
  SolveOptions options;
  options.tolerance = 1e-12;
  return options;
}

TEST(ErrorIndicators, VanishForSolutionsInTheSpace) {
  const FieldSpace<3> space = test::space_on<3>(geometry::sphere(1.0), 2, 0);
  const Equation<3> equation = test::laplace_on(space);
  Eigen::MatrixXd slope(1, 3);
  slope << 1.0, -2.0, 0.5;
  const auto field = test::linear_field<3>(slope, Eigen::VectorXd::Constant(1, 0.3));
  const auto problem = test::problem_from(field, equation, space, {ConditionKind::robin});
  const auto solution = solve(problem, space, fine());
  EXPECT_LT(total_indicator(error_indicators(problem, space, solution)), 1e-10);
}

/// The indicator falls with refinement as the error does.
TEST(ErrorIndicators, FallAsTheErrorDoes) {
  const test::ExactField<2> field{
      [](const Point2& x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, std::exp(x[0]) * std::sin(x[1])); },
      [](const Point2& x) -> Eigen::MatrixXd {
        return std::exp(x[0]) * Eigen::RowVector2d(std::sin(x[1]), std::cos(x[1]));
      }};
  std::vector<double> ratios;
  for (const int refine : {2, 3, 4}) {
    const FieldSpace<2> space = test::space_on<2>(geometry::disc(1.0), 3, refine);
    const auto problem = test::problem_from(field, test::laplace_on(space), space, {ConditionKind::value});
    const auto solution = solve(problem, space, fine());
    // Of the flux in L2, brought to the norm of H^(-1/2) by h^(1/2).
    const double error = test::errors_of(solution, field, problem, space).flux * std::pow(0.5, 0.5 * refine);
    ratios.push_back(total_indicator(error_indicators(problem, space, solution)) / error);
  }
  for (const double ratio : ratios) {
    EXPECT_GT(ratio, 0.5 * ratios.front());
    EXPECT_LT(ratio, 2.0 * ratios.front());
  }
}

/// u = 1 + 2 x on the unit sphere: int u^2 dS = 4 pi (1 + 4 / 3), int |2 k n_x| dS = 4 pi k, L^2 = 12.
TEST(SolutionSize, OfALinearPotential) {
  const FieldSpace<3> space = test::space_on<3>(geometry::sphere(1.0), 2, 1);
  Equation<3> equation = test::laplace_on(space);
  std::get<Laplace<3>>(equation).conductivity = 5.0;
  const auto field = test::linear_field<3>(Eigen::RowVector3d(2.0, 0.0, 0.0), Eigen::VectorXd::Ones(1));
  const auto problem = test::problem_from(field, equation, space, {ConditionKind::value});
  const double size = solution_size(problem, space, solve(problem, space, fine()));
  const double length = std::sqrt(12.0);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(size, std::sqrt(4.0 * pi * (1.0 + 4.0 / 3.0) / length + 16.0 * pi * pi / length), 1e-6);
}

}  // namespace
}  // namespace isorim::solver
