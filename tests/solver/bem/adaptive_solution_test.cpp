#include "solver/bem/adaptive_solution.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/bezier/element_jet.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/swept_solids.h"
#include "geometry/topology/orientation.h"
#include "solver/bem/evaluation.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using std::numbers::pi;

SolveOptions fine() {
  SolveOptions options;
  options.tolerance = 1e-12;
  return options;
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

  geometry::OrientedBoundary<2> boundary() const { return geometry::orient(geometry::polygon(corners)); }

  struct Outcome {
    int functions;
    double error;
  };
  Outcome uniform(int refine) const {
    DiscretisationOptions<2> options;
    options.degree = degree;
    options.refine = refine;
    const FieldSpace<2> space = field_space(boundary(), options);
    const Problem<2> problem = on(space);
    const Solution<2> solution = solve(problem, space, fine());
    return {space.function_count(), largest_error(problem, space, solution)};
  }

  std::vector<AdaptiveStep> steps;
  Outcome adaptive(int most_functions) {
    DiscretisationOptions<2> discretisation;
    discretisation.degree = degree;
    AdaptiveOptions options;
    options.solve = fine();
    options.tolerance = 0.0;
    options.max_unknowns = most_functions;
    options.max_steps = 60;
    const auto result = solve_adaptively<2>(
        boundary(), discretisation, [this](const FieldSpace<2>& space) { return on(space); }, options);
    EXPECT_EQ(result.end, AdaptiveEnd::unknowns);
    steps = result.steps;
    return {result.space.function_count(), largest_error(result.problem, result.space, result.solution)};
  }

  /// Slope of log(estimate) against log(functions) over the last steps.
  double observed_rate() const {
    std::vector<double> sizes;
    std::vector<double> values;
    for (std::size_t k = steps.size() / 2; k < steps.size(); ++k) {
      sizes.push_back(1.0 / steps[k].functions);
      values.push_back(steps[k].estimate);
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

geometry::Points<2> l_corners() {
  return columns({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {0.0, -1.0}});
}

TEST(SolveAdaptively, RecoversTheOrderAtAReentrantCorner) {
  PolygonProblem problem;
  problem.corners = l_corners();
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

/// The corner's potential in the L with the edge along z: flux 0 on the caps, values on the sides.
Problem<3> edge_problem(const FieldSpace<3>& space) {
  const auto value = [](const Point3& x, const Vector3&) { return corner_potential(x.head<2>()); };
  Problem<3> problem;
  problem.equation = test::laplace_on(space);
  problem.conditions.push_back({"sides", {{ConditionKind::value, test::data<3>(value), {}}}, {}});
  problem.conditions.push_back({"caps", {{ConditionKind::flux, {}, {}}}, {}});
  for (const auto& element : space.table.elements) {
    const auto jet = geometry::evaluate_jet<3>(space.table, element, Point2::Constant(0.5));
    problem.condition_of.push_back(std::abs(jet.normal().z()) > 0.5 ? 1 : 0);
  }
  return problem;
}

double edge_error(const Problem<3>& problem, const FieldSpace<3>& space, const Solution<3>& solution) {
  geometry::Points<3> points(3, 3);
  points << 0.3, -0.4, -0.05, 0.4, 0.1, 0.05, 0.5, 0.2, 0.6;
  const auto found = evaluate_at<3>(problem, space, solution, points);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    largest = std::max(largest, std::abs(found[static_cast<std::size_t>(i)].field.value[0] -
                                         corner_potential(points.col(i).head<2>())));
  return largest;
}

TEST(SolveAdaptively, RefinesAlongAReentrantEdge) {
  const auto boundary = geometry::orient(geometry::extrude(geometry::polygon(l_corners()), Vector3(0.0, 0.0, 1.0)));
  DiscretisationOptions<3> discretisation;
  discretisation.degree = 2;
  AdaptiveOptions options;
  options.solve.tolerance = 1e-8;
  options.estimate.tolerance = 1e-8;
  options.tolerance = 0.0;
  options.max_unknowns = 900;
  options.share = 0.7;
  const auto adaptive = solve_adaptively<3>(boundary, discretisation, edge_problem, options);
  const double adaptive_error = edge_error(adaptive.problem, adaptive.space, adaptive.solution);
  discretisation.refine = 2;
  const FieldSpace<3> uniform = field_space(boundary, discretisation);
  const Problem<3> problem = edge_problem(uniform);
  const Solution<3> solution = solve(problem, uniform, options.solve);
  const double uniform_error = edge_error(problem, uniform, solution);
  RecordProperty("uniform", fmt::format("{} functions, error {:.3g}", uniform.function_count(), uniform_error));
  RecordProperty("adaptive",
                 fmt::format("{} functions, error {:.3g}", adaptive.space.function_count(), adaptive_error));
  EXPECT_LT(adaptive.space.function_count(), 1.25 * uniform.function_count());
  EXPECT_LT(adaptive_error, 0.1 * uniform_error);
  for (std::size_t k = 1; k < adaptive.steps.size(); ++k)
    EXPECT_LT(adaptive.steps[k].estimate, adaptive.steps[k - 1].estimate);
}

/// The smooth harmonic function exp(x) sin(y) on the disc, prescribed on one half, as flux on the other.
AdaptiveResult<2> on_disc(const AdaptiveOptions& options, int* calls = nullptr) {
  const test::ExactField<2> field{
      [](const Point2& x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, std::exp(x[0]) * std::sin(x[1])); },
      [](const Point2& x) -> Eigen::MatrixXd {
        return std::exp(x[0]) * Eigen::RowVector2d(std::sin(x[1]), std::cos(x[1]));
      }};
  DiscretisationOptions<2> discretisation;
  // The conditions change inside elements.
  discretisation.group = [](int, const Point2& x, const Vector2&) { return x.dot(Vector2(1.0, 0.3)) > 0.0 ? 1 : 0; };
  return solve_adaptively<2>(
      geometry::orient(geometry::disc(1.0)), discretisation,
      [&](const FieldSpace<2>& space) {
        const Equation<2> equation = test::laplace_on(space);
        Problem<2> problem = test::problem_from(field, equation, space, {ConditionKind::flux, ConditionKind::value});
        problem.condition_of.assign(space.groups.begin(), space.groups.end());
        return problem;
      },
      options,
      [calls](const AdaptiveResult<2>& result) {
        if (calls) ++*calls;
        EXPECT_EQ(result.steps.back().functions, result.space.function_count());
        EXPECT_EQ(result.indicators.size(), result.space.elements.size());
      });
}

TEST(SolveAdaptively, EndsWhenTheToleranceIsReached) {
  AdaptiveOptions options;
  options.solve = fine();
  options.tolerance = 1e-7;
  int calls = 0;
  const AdaptiveResult<2> result = on_disc(options, &calls);
  EXPECT_EQ(result.end, AdaptiveEnd::tolerance_reached);
  EXPECT_LE(result.steps.back().estimate, 1e-7);
  EXPECT_GT(result.steps[result.steps.size() - 2].estimate, 1e-7);
  EXPECT_EQ(calls, static_cast<int>(result.steps.size()));
}

TEST(SolveAdaptively, EndsAtItsLimits) {
  AdaptiveOptions options;
  options.tolerance = 0.0;
  options.max_steps = 3;
  const AdaptiveResult<2> few_steps = on_disc(options);
  EXPECT_EQ(few_steps.end, AdaptiveEnd::steps);
  EXPECT_EQ(few_steps.steps.size(), 3U);
  options.max_steps = 50;
  options.max_unknowns = 60;
  const AdaptiveResult<2> few_unknowns = on_disc(options);
  EXPECT_EQ(few_unknowns.end, AdaptiveEnd::unknowns);
  EXPECT_LE(few_unknowns.steps.back().unknowns, 60U);
}

TEST(SolveAdaptively, EndsWhereElementsCannotBeDivided) {
  // A singularity at the corner of a square, where all levels are used up.
  AdaptiveOptions options;
  options.tolerance = 0.0;
  options.share = 0.3;
  options.max_steps = 200;
  DiscretisationOptions<2> discretisation;
  discretisation.degree = 5;
  const auto value = [](const Point2& x, const Vector2&) {
    return std::pow(x.norm(), 0.25) * std::cos(0.25 * std::atan2(x[1], x[0]));
  };
  const auto result = solve_adaptively<2>(
      geometry::orient(geometry::rectangle(Vector2(1.0, 1.0))), discretisation,
      [&](const FieldSpace<2>& space) {
        Problem<2> problem;
        problem.equation = test::laplace_on(space);
        problem.conditions.push_back({"exact", {{ConditionKind::value, test::data<2>(value), {}}}, {}});
        problem.condition_of.assign(space.elements.size(), 0);
        return problem;
      },
      options);
  EXPECT_EQ(result.end, AdaptiveEnd::levels);
  int deepest = 0;
  for (const auto& cell : result.space.cells) deepest = std::max(deepest, cell.level);
  EXPECT_EQ(deepest + 1, DiscretisationOptions<2>::max_local_levels);
  EXPECT_LT(result.steps.back().estimate, 0.02 * result.steps.front().estimate);
}

/// Where conditions change inside elements of level 0 their parts keep the condition of the whole.
TEST(SolveAdaptively, PartsOfAnElementKeepItsGroup) {
  AdaptiveOptions options;
  options.tolerance = 1e-7;
  const FieldSpace<2> space = on_disc(options).space;
  ASSERT_EQ(space.groups.size(), space.elements.size());
  std::vector<int> of_level_0(4, -1);
  for (std::size_t e = 0; e < space.cells.size(); ++e) {
    int& group = of_level_0[static_cast<std::size_t>(space.cells[e].index[0] >> space.cells[e].level)];
    EXPECT_TRUE(group < 0 || group == space.groups[e]) << e;
    group = space.groups[e];
  }
}

}  // namespace
}  // namespace isorim::solver
