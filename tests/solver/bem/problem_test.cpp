#include "solver/bem/problem.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "solver/bem/rigid_motion.h"
#include "solver/bem/solve.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
constexpr auto value = ConditionKind::value;
constexpr auto flux = ConditionKind::flux;
constexpr auto robin = ConditionKind::robin;

quadrature::IntegrandFactory<2> constant_2d(double x) {
  return test::data<2>([x](const Point2&, const Vector2&) { return x; });
}
quadrature::IntegrandFactory<3> constant_3d(double x) {
  return test::data<3>([x](const Point3&, const Vector3&) { return x; });
}

const FieldSpace<2>& square() {
  static const FieldSpace<2> space = test::space_on(geometry::rectangle({1.0, 1.0}), 2, 0);
  return space;
}

/// Zero on all sides; sound.
Problem<2> sound_problem() {
  Problem<2> problem{test::laplace_on(square()), {}, false, {}, {}, {}};
  problem.conditions.push_back({"side", {{value, {}, {}}}, {}});
  problem.condition_of.assign(square().elements.size(), 0);
  return problem;
}

void expect_refusal(const Problem<2>& problem, const std::string& fragment) {
  try {
    solve(problem, square(), {});
    ADD_FAILURE() << "accepted; expected: " << fragment;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(fragment));
  }
}

TEST(Problem, UnsoundOnesAreRefused) {
  struct Case {
    std::function<void(Problem<2>&)> spoil;
    std::string fragment;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases{
      {[](Problem<2>& p) { p.conditions.clear(); }, "no boundary conditions"},
      {[](Problem<2>& p) { p.condition_of.pop_back(); }, "for 3 elements; the boundary has 4"},
      {[](Problem<2>& p) { p.condition_of[1] = 7; }, "element 1 (patch 1) has boundary condition 7; expected 0 to 0"},
      {[](Problem<2>& p) { p.conditions[0].components.clear(); }, "'side' has 0 components; expected 1"},
      {[](Problem<2>& p) { p.conditions[0].components[0].kind = robin; }, "of kind robin and has no coefficient"},
      {[](Problem<2>& p) { p.conditions[0].components[0].coefficient = constant_2d(1.0); }, "which only robin uses"},
      {[](Problem<2>& p) { p.conditions[0].frame = Eigen::Matrix2d::Identity(); }, "a potential has no axes"},
      {[](Problem<2>& p) { std::get<Laplace<2>>(p.equation).conductivity = -1.0; }, "conductivity is -1"},
      {[](Problem<2>& p) { std::get<Laplace<2>>(p.equation).length = 0.5; }, "logarithm's length is 0.5"},
      {[nan](Problem<2>& p) { p.conditions[0].components[0].value = constant_2d(nan); },
       "'side': the value is nan at ("},
      {[](Problem<2>& p) {
         p.conditions[0].components[0] = {robin, {}, constant_2d(-2.0)};
       },
       "the coefficient is -2 at ("},
      {[](Problem<2>& p) {
         p.equation = Elasticity<2>{1.0, 0.5, 2.0};
         p.conditions[0].components.resize(2);
       },
       "Poisson's ratio is 0.5"},
      {[](Problem<2>& p) {
         p.equation = Elasticity<2>{1.0, 0.3, 2.0};
         p.conditions[0].components.resize(2);
         p.conditions[0].frame = 2.0 * Eigen::Matrix2d::Identity();
       },
       "not orthonormal"},
      {[](Problem<2>& p) {
         p.exterior = true;
         const auto& kernel = std::get<Laplace<2>>(p.equation);
         p.loads.push_back(polynomial_load(kernel, {Quadratic<2>{.constant = 1.0}}));
       },
       "an exterior problem has a source"}};
  for (const Case& unsound : cases) {
    Problem<2> problem = sound_problem();
    unsound.spoil(problem);
    expect_refusal(problem, unsound.fragment);
  }
  EXPECT_NO_THROW(solve(sound_problem(), square(), {}));
}

TEST(Problem, ConditionsMayNotMeetInsideAFunction) {
  const FieldSpace<2> space = test::space_on(geometry::disc(1.0), 2, 1);
  Problem<2> problem{test::laplace_on(space), {}, false, {}, {}, {}};
  problem.conditions = {{"left", {{value, {}, {}}}, {}}, {"right", {{flux, {}, {}}}, {}}};
  for (std::size_t e = 0; e < space.elements.size(); ++e) problem.condition_of.push_back(e % 2 == 0);
  EXPECT_THROW(solve(problem, space, {}), InputError);
}

TEST(Problem, UnbalancedFluxesAreRefusedWithTheirSum) {
  Problem<2> problem = sound_problem();
  problem.conditions[0].components[0] = {flux, constant_2d(1.0), {}};
  expect_refusal(problem, "they sum to 4 (4 in absolute value) where a solution needs 0");
  // -lap u = -4 balances.
  const auto& kernel = std::get<Laplace<2>>(problem.equation);
  problem.loads.push_back(polynomial_load(kernel, {Quadratic<2>{.constant = -4.0}}));
  const Solution<2> solution = solve(problem, square(), {});
  EXPECT_THAT(solution.messages, ElementsAre(HasSubstr("up to a constant")));
}

TEST(Problem, UnbalancedFluxesIntoAnUnboundedPlaneAreRefused) {
  Problem<2> problem = sound_problem();
  problem.exterior = true;
  problem.conditions[0].components[0] = {flux, constant_2d(1.0), {}};
  expect_refusal(problem, "they sum to 4");
}

TEST(Problem, UnbalancedForcesAreRefusedWithTheMotion) {
  Problem<2> problem = sound_problem();
  problem.equation = test::elasticity_on(square());
  problem.conditions[0].components = {{flux, {}, {}}, {flux, constant_2d(2.0), {}}};
  expect_refusal(problem, "nothing holds the body against translation along (0, 1), and the loads along it sum to 8");
}

/// Conditions of a cube by patch (x_min, x_max, y_min, y_max, z_min, z_max).
std::size_t free_count(const std::vector<Condition<3>>& conditions, const std::vector<std::int32_t>& of_patch,
                       bool exterior = false) {
  static const FieldSpace<3> space = test::space_on(geometry::cube(1.0), 2, 0);
  Problem<3> problem{test::elasticity_on(space), {}, exterior, conditions, {}, {}};
  for (const auto& element : space.table.elements)
    problem.condition_of.push_back(of_patch[static_cast<std::size_t>(element.patch)]);
  return free_motions(problem, space).size();
}

TEST(FreeMotions, AreCountedFromWhatIsHeld) {
  const Condition<3> loaded{"loaded", {{flux, {}, {}}, {flux, {}, {}}, {flux, {}, {}}}, {}};
  const Condition<3> slides_on_x{"slides", {{value, {}, {}}, {flux, {}, {}}, {flux, {}, {}}}, {}};
  const Condition<3> spring_on_y{"spring", {{flux, {}, {}}, {robin, {}, constant_3d(1.0)}, {flux, {}, {}}}, {}};
  const Condition<3> clamped{"clamped", {{value, {}, {}}, {value, {}, {}}, {value, {}, {}}}, {}};
  const std::vector<Condition<3>> conditions{loaded, slides_on_x, spring_on_y, clamped};
  EXPECT_EQ(free_count(conditions, {0, 0, 0, 0, 0, 0}), 6U);
  EXPECT_EQ(free_count(conditions, {0, 0, 0, 0, 0, 0}, true), 3U);
  EXPECT_EQ(free_count(conditions, {1, 0, 0, 0, 0, 0}), 3U);  // y, z, turning about x
  EXPECT_EQ(free_count(conditions, {1, 0, 2, 0, 0, 0}), 1U);  // z
  EXPECT_EQ(free_count(conditions, {3, 0, 0, 0, 0, 0}), 0U);
}

TEST(FreeMotions, FollowTurnedFrames) {
  const Eigen::Matrix3d frame = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  const Condition<3> loaded{"loaded", {{flux, {}, {}}, {flux, {}, {}}, {flux, {}, {}}}, {}};
  const Condition<3> guided{"guided", {{value, {}, {}}, {value, {}, {}}, {flux, {}, {}}}, frame};
  // Held on all sides but along the third axis.
  EXPECT_EQ(free_count({loaded, guided}, {1, 1, 1, 1, 1, 1}), 1U);
}

/// A cube that slides on its lower side under tension: free along x and y, and about z.
TEST(Problem, HalfHeldBodiesAreFixedAndSaySo) {
  const FieldSpace<3> space = test::space_on(geometry::cube(1.0), 2, 0);
  const double mu = 1.0, nu = 0.3, young = 2.0 * mu * (1.0 + nu), tension = 0.01;
  Problem<3> problem{test::elasticity_on(space, mu, nu), {}, false, {}, {}, {}};
  problem.conditions = {{"sides", {{flux, {}, {}}, {flux, {}, {}}, {flux, {}, {}}}, {}},
                        {"table", {{flux, {}, {}}, {flux, {}, {}}, {value, {}, {}}}, {}},
                        {"top", {{flux, {}, {}}, {flux, {}, {}}, {flux, constant_3d(tension), {}}}, {}}};
  for (const auto& element : space.table.elements) problem.condition_of.push_back(std::max(0, element.patch - 3));
  SolveOptions options;
  options.tolerance = 1e-14;
  const Solution<3> solution = solve(problem, space, options);
  ASSERT_EQ(solution.messages.size(), 1U);
  EXPECT_THAT(solution.messages[0], HasSubstr("translation along (1, 0, 0)"));
  Eigen::Matrix3d strain = Eigen::Vector3d(-nu, -nu, 1.0).asDiagonal();
  strain *= tension / young;
  const Eigen::Vector3d middle(0.5, 0.5, 0.0);
  const auto field = test::linear_field<3>(strain, -strain * middle);
  const test::Errors errors = test::errors_of(solution, field, problem, space);
  EXPECT_LT(errors.potential, 1e-11);
  EXPECT_LT(errors.flux, 1e-11);
}

}  // namespace
}  // namespace isorim::solver
