#include "solver/bem/error_estimate.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/knot_refinement.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Vector2;
using std::numbers::pi;

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

geometry::Points<2> columns(const std::vector<Point2>& points) {
  geometry::Points<2> all(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = points[i];
  return all;
}

/// Adaptive solution of a problem on a polygon.
struct PolygonProblem {
  geometry::Points<2> corners;
  int degree = 2;
  std::function<Condition<2>(int side)> condition;
  std::function<double(const Point2&)> exact;
  std::vector<Point2> points;

  Problem<2> on(const FieldSpace<2>& space) const {
    Problem<2> problem;
    problem.equation = test::laplace_on(space);
    for (int side = 0; side < corners.cols(); ++side) problem.conditions.push_back(condition(side));
    for (const auto& element : space.table.elements) problem.condition_of.push_back(element.patch);
    return problem;
  }

  double largest_error(const Problem<2>& problem, const FieldSpace<2>& space, const Solution<2>& solution) const {
    const auto found = evaluate_at<2>(problem, space, solution, columns(points));
    double largest = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
      largest = std::max(largest, std::abs(found[i].field.value[0] - exact(points[i])));
    return largest;
  }

  geometry::OrientedBoundary<2> boundary() const {
    return raise_degree(geometry::orient(geometry::polygon(corners)), degree);
  }

  struct Outcome {
    int functions;
    double error;
    double indicator;
  };
  Outcome uniform(int refine) const {
    DiscretisationOptions<2> options;
    options.degree = degree;
    options.refine = refine;
    const FieldSpace<2> space = field_space(boundary(), options);
    const Problem<2> problem = on(space);
    const Solution<2> solution = solve(problem, space, fine());
    return {space.function_count(), largest_error(problem, space, solution),
            total_indicator(error_indicators(problem, space, solution))};
  }

  std::vector<AdaptiveStep> steps;
  Outcome adaptive(int most_functions) {
    DiscretisationOptions<2> options;
    options.degree = degree;
    geometry::OrientedBoundary<2> refined = boundary();
    AdaptiveOptions adaptive;
    adaptive.solve = fine();
    adaptive.max_functions = most_functions;
    adaptive.max_steps = 60;
    const auto result = solve_adaptively<2>(
        field_space(refined, options), [this](const FieldSpace<2>& space) { return on(space); },
        [&](const FieldSpace<2>& space, std::span<const int> marked) {
          refined = bisect_elements(refined, space, marked);
          return field_space(refined, options);
        },
        adaptive);
    steps = result.steps;
    return {result.space.function_count(), largest_error(result.problem, result.space, result.solution),
            result.steps.back().indicator};
  }

  /// Slope of log(indicator) against log(functions) over the last steps.
  double observed_rate() const {
    std::vector<double> sizes;
    std::vector<double> values;
    for (std::size_t k = steps.size() / 2; k < steps.size(); ++k) {
      sizes.push_back(1.0 / steps[k].functions);
      values.push_back(steps[k].indicator);
    }
    return test::observed_order(sizes, values);
  }
};

/// L3: u = r^(2/3) sin(2 angle / 3) about the corner of an L, the angle from the edge along +x.
double corner_angle(const Point2& x) {
  const double angle = std::atan2(x[1], x[0]);
  return angle < -1e-12 ? angle + 2.0 * pi : std::max(angle, 0.0);
}
double corner_potential(const Point2& x) {
  return std::pow(x.norm(), 2.0 / 3.0) * std::sin(2.0 / 3.0 * corner_angle(x));
}

TEST(SolveAdaptively, RecoversTheOrderAtAReentrantCorner) {
  PolygonProblem problem;
  problem.corners = columns({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {0.0, -1.0}});
  problem.condition = [](int) {
    Condition<2> condition;
    condition.name = "exact";
    condition.components = {
        {ConditionKind::value, test::data<2>([](const Point2& x, const Vector2&) { return corner_potential(x); }), {}}};
    return condition;
  };
  problem.exact = corner_potential;
  problem.points = {{0.3, 0.4}, {-0.4, 0.1}, {-0.3, -0.5}, {-0.05, 0.05}};
  const auto uniform = problem.uniform(5);
  const auto adaptive = problem.adaptive(uniform.functions);
  RecordProperty("uniform", fmt::format("{} functions, error {:.3g}", uniform.functions, uniform.error));
  RecordProperty("adaptive", fmt::format("{} functions, error {:.3g}", adaptive.functions, adaptive.error));
  // Flux of degree 2 in H^(-1/2): order 3.5; uniform refinement has 2/3.
  EXPECT_GT(problem.observed_rate(), 3.0);
  EXPECT_LT(adaptive.error, 0.01 * uniform.error);
}

/// L4, Motz: u = sum a_i r^(i + 1/2) cos((i + 1/2) angle).
double motz(const Point2& x) {
  const double coefficients[] = {401.162454, 87.655920, 17.237915, -8.071215, 1.440273};
  const double angle = std::atan2(x[1], x[0]);
  double sum = 0.0;
  for (int i = 0; i < 5; ++i) sum += coefficients[i] * std::pow(x.norm(), i + 0.5) * std::cos((i + 0.5) * angle);
  return sum;
}

TEST(SolveAdaptively, SolvesTheMotzProblem) {
  PolygonProblem problem;
  problem.corners = columns({{-1.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {-1.0, 1.0}});
  problem.condition = [](int side) {
    Condition<2> condition;
    condition.name = "side " + std::to_string(side + 1);
    const bool is_given = side == 0 || side == 2;
    condition.components = {{is_given ? ConditionKind::value : ConditionKind::flux, {}, {}}};
    if (side == 2) condition.components[0].value = test::data<2>([](const Point2&, const Vector2&) { return 500.0; });
    return condition;
  };
  problem.exact = motz;
  // So near the singularity that five terms of the series suffice.
  problem.points = {{0.02, 0.01}, {-0.02, 0.01}, {0.0, 0.03}, {0.001, 0.001}};
  const auto uniform = problem.uniform(5);
  const auto adaptive = problem.adaptive(uniform.functions);
  RecordProperty("uniform", fmt::format("{} functions, error {:.3g}", uniform.functions, uniform.error));
  RecordProperty("adaptive", fmt::format("{} functions, error {:.3g}", adaptive.functions, adaptive.error));
  EXPECT_GT(problem.observed_rate(), 2.5);
  EXPECT_LT(adaptive.error, 1e-3 * uniform.error);
  EXPECT_LT(adaptive.error, 1e-3);
}

}  // namespace
}  // namespace isorim::solver
