#include "solver/bem/bodies.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "solver/bem/solve.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::Point3;
using test::ExactField;
using ::testing::HasSubstr;
constexpr auto value = ConditionKind::value;
constexpr auto flux = ConditionKind::flux;

/// All in one, their patches named apart.
Boundary<3> together(const std::vector<std::pair<std::string, Boundary<3>>>& parts) {
  Boundary<3> all;
  for (const auto& [prefix, part] : parts)
    for (geometry::Patch<3> patch : part.patches) {
      patch.name = prefix + patch.name;
      all.patches.push_back(patch);
    }
  return all;
}

Boundary<3> two_blocks() {
  return together({{"a_", geometry::cube(1.0)}, {"b_", geometry::box({1.0, 2.0, 0.5}, {1.5, 0.0, 0.0})}});
}

TEST(Bodies, AreOuterShellsWithTheVoidsInThem) {
  // A cube with a void in which another one lies, and a third beside them.
  const Boundary<3> boundary = together({{"void_", geometry::cube(3.0, {1.0, 1.0, 1.0})},
                                         {"core_", geometry::cube(1.0, {2.0, 2.0, 2.0})},
                                         {"hull_", geometry::cube(5.0)},
                                         {"other_", geometry::cube(1.0, {6.0, 0.0, 0.0})}});
  const FieldSpace<3> space = test::space_on(boundary, 1, 0);
  ASSERT_EQ(space.body_count(), 3);
  const auto body_of = [&](std::size_t patch) { return space.body_of_patch[patch]; };
  EXPECT_EQ(body_of(0), body_of(12));
  EXPECT_NE(body_of(6), body_of(12));
  EXPECT_NE(body_of(18), body_of(12));
  EXPECT_NE(body_of(18), body_of(6));
  for (std::size_t patch = 0; patch < 24; ++patch) EXPECT_EQ(body_of(patch), body_of(patch / 6 * 6));
  EXPECT_EQ(test::space_on(geometry::cube(1.0), 1, 0).body_count(), 1);
  const Boundary<3> hollow = together({{"", geometry::cube(3.0)}, {"void_", geometry::cube(1.0, {1.0, 1.0, 1.0})}});
  EXPECT_EQ(test::space_on(hollow, 1, 0).body_count(), 1);
}

/// One field on each block, the boundary mean of the free ones zero.
template <class Field>
ExactField<3> by_block(const Field& a, const Field& b) {
  return {[=](const Point3& x) { return x[0] < 1.25 ? a.value(x) : b.value(x); },
          [=](const Point3& x) { return x[0] < 1.25 ? a.gradient(x) : b.gradient(x); }};
}

ExactField<3> potential(const Eigen::RowVector3d& slope, const Point3& middle, double mean) {
  const Eigen::MatrixXd matrix = slope;
  return test::linear_field<3>(matrix, Eigen::VectorXd::Constant(1, mean - slope.dot(middle)));
}

/// The first kind on the first block, the second on the other.
Problem<3> problem_of(const ExactField<3>& field, const Equation<3>& equation, const FieldSpace<3>& space,
                      ConditionKind first, ConditionKind second) {
  Problem<3> problem = test::problem_from(field, equation, space, {first, second});
  for (std::size_t e = 0; e < problem.condition_of.size(); ++e)
    problem.condition_of[e] = space.table.elements[e].patch < 6 ? 0 : 1;
  return problem;
}

SolveOptions accurate() {
  SolveOptions options;
  options.tolerance = 1e-14;
  return options;
}

TEST(Bodies, ConstantsAreFreeBodyByBody) {
  const FieldSpace<3> space = test::space_on(two_blocks(), 2, 0);
  const ExactField<3> field =
      by_block(potential({1.0, 2.0, -1.0}, {0.5, 0.5, 0.5}, 0.0), potential({-2.0, 0.5, 1.0}, {2.0, 1.0, 0.25}, 0.0));
  const Equation<3> equation = test::laplace_on(space, 1.7);
  for (const auto& [second, count] : {std::pair{value, 1U}, std::pair{flux, 2U}}) {
    const Problem<3> problem = problem_of(field, equation, space, flux, second);
    for (const SolveMethod method : {SolveMethod::dense, SolveMethod::compressed}) {
      SolveOptions options = accurate();
      options.method = method;
      if (method == SolveMethod::compressed) options.tolerance = 1e-12;
      const Solution<3> solution = solve(problem, space, options);
      ASSERT_EQ(solution.messages.size(), count);
      EXPECT_THAT(solution.messages[0], HasSubstr("on the body of patch 'a_x_min'"));
      if (count == 2U) {
        EXPECT_THAT(solution.messages[1], HasSubstr("on the body of patch 'b_x_min'"));
      }
      const test::Errors errors = test::errors_of(solution, field, problem, space);
      EXPECT_LT(errors.potential, method == SolveMethod::dense ? 1e-12 : 1e-9);
      EXPECT_LT(errors.flux, method == SolveMethod::dense ? 1e-12 : 1e-9);
    }
  }
}

TEST(Bodies, ValuesOnOneDoNotHoldTheOther) {
  const FieldSpace<3> space = test::space_on(two_blocks(), 2, 0);
  const Equation<3> equation = test::elasticity_on(space, 2.5, 0.3);
  Eigen::Matrix3d strain;
  strain << 0.5, 0.1, -0.2, 0.1, 0.3, 0.4, -0.2, 0.4, -0.1;
  // Without rotation, and about the middle of the free one: its mean motions are zero.
  const auto stretched = [&](const Point3& middle) {
    return test::linear_field<3>(Eigen::MatrixXd(strain), Eigen::VectorXd(-strain * middle));
  };
  const ExactField<3> field = by_block(stretched({0.5, 0.5, 0.5}), stretched({0.0, 0.3, 0.0}));
  const Problem<3> problem = problem_of(field, equation, space, flux, value);
  EXPECT_EQ(free_motions(problem, space).size(), 6U);
  const Solution<3> solution = solve(problem, space, accurate());
  ASSERT_EQ(solution.messages.size(), 1U);
  const test::Errors errors = test::errors_of(solution, field, problem, space);
  EXPECT_LT(errors.potential, 1e-11);
  EXPECT_LT(errors.flux, 1e-11);
}

// What flows into one body cannot leave through the values on another.
TEST(Bodies, AnImbalanceIsReportedOfTheBodyThatHasIt) {
  const FieldSpace<3> space = test::space_on(two_blocks(), 1, 0);
  const ExactField<3> field =
      by_block(potential({1.0, 0.0, 0.0}, Point3::Zero(), 0.0), potential({1.0, 0.0, 0.0}, Point3::Zero(), 0.0));
  Problem<3> problem = problem_of(field, test::laplace_on(space), space, value, flux);
  problem.conditions[1].components[0].value = test::data<3>([](const Point3&, const auto&) { return 1.0; });
  try {
    solve(problem, space, accurate());
    FAIL() << "fluxes out of balance were accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("only fluxes are prescribed on the body of patch 'b_x_min'"));
  }
}

}  // namespace
}  // namespace isorim::solver
