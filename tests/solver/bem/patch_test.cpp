#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "solver/bem/solve.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using test::ExactField;
using Kinds = std::vector<ConditionKind>;
constexpr auto value = ConditionKind::value;
constexpr auto flux = ConditionKind::flux;
constexpr auto robin = ConditionKind::robin;

template <int Dim>
ExactField<Dim> linear_potential() {
  Eigen::MatrixXd slope(1, Dim);
  for (int d = 0; d < Dim; ++d) slope(0, d) = 1.0 - 0.7 * d;
  return test::linear_field<Dim>(slope, Eigen::VectorXd::Constant(1, 0.4));
}

template <int Dim>
ExactField<Dim> linear_displacement() {
  Eigen::MatrixXd matrix(Dim, Dim);
  Eigen::VectorXd constant(Dim);
  for (int i = 0; i < Dim; ++i) {
    constant[i] = 0.3 - 0.2 * i;
    for (int j = 0; j < Dim; ++j) matrix(i, j) = 0.5 * (i == j) + 0.3 * i - 0.4 * j + 0.1;
  }
  return test::linear_field<Dim>(matrix, constant);
}

template <int Dim>
void expect_exact(const ExactField<Dim>& field, const Equation<Dim>& equation, const FieldSpace<Dim>& space,
                  const Kinds& kinds, const std::string& what) {
  // Errors of quadrature grow by the condition of the problem, a hundred times for a ring that bends freely.
  SolveOptions options;
  options.tolerance = 1e-16;
  const Problem<Dim> problem = test::problem_from(field, equation, space, kinds);
  const Solution<Dim> solution = solve(problem, space, options);
  const bool is_neumann = kinds == Kinds{flux};
  EXPECT_EQ(solution.messages.size(), is_neumann ? 1U : 0U) << what;
  const test::Errors errors =
      test::errors_of(solution, is_neumann ? test::without_motions(field, problem, space) : field, problem, space);
  EXPECT_LT(errors.potential, 1e-12) << what;
  EXPECT_LT(errors.flux, 1e-12) << what;
  EXPECT_LT(solution.residual, 1e-14) << what;
}

/// Linear fields lie in the space, so all errors are those of quadrature and rounding.
template <int Dim>
void expect_patch_test(const std::string& name, const geometry::Boundary<Dim>& boundary,
                       const std::vector<Kinds>& all_kinds) {
  const FieldSpace<Dim> space = test::space_on(boundary, 2, 0);
  for (const Kinds& kinds : all_kinds) {
    const std::string what =
        name + ", first kind " + std::to_string(static_cast<int>(kinds[0])) + " of " + std::to_string(kinds.size());
    expect_exact(linear_potential<Dim>(), test::laplace_on(space, 1.7), space, kinds, what + ", potential");
    expect_exact(linear_displacement<Dim>(), test::elasticity_on(space, 2.5, 0.3), space, kinds,
                 what + ", displacement");
  }
}

const std::vector<Kinds>& every_kind() {
  static const std::vector<Kinds> kinds{{value}, {flux}, {robin}, {value, flux}, {robin, flux, value}};
  return kinds;
}

TEST(PatchTest, LinearFieldsAreExactInThePlane) {
  expect_patch_test<2>("disc", geometry::disc(1.0), every_kind());
  expect_patch_test<2>("rectangle", geometry::rectangle({2.0, 1.0}), every_kind());
  expect_patch_test<2>("triangle", geometry::regular_polygon(3, 1.0, {2.0, 1.0}), every_kind());
}

TEST(PatchTest, LinearFieldsAreExactOnCube) {
  expect_patch_test<3>("cube", geometry::cube(1.0), every_kind());
}

TEST(PatchTest, LinearFieldsAreExactOnSphere) {
  expect_patch_test<3>("sphere", geometry::sphere(1.0), {{value}, {flux}, {robin}});
}

TEST(PatchTest, LinearFieldsAreExactOnTorus) {
  expect_patch_test<3>("torus", geometry::torus(2.0, 0.5), {{value}, {flux}});
}

TEST(PatchTest, LinearFieldsAreExactOnCylinder) {
  expect_patch_test<3>("cylinder", geometry::cylinder(1.0, 2.0), {{value, flux}, {flux, value, robin}});
}

// Feet of the collocation points on a round wall lie on the trims of the faces that it ends in.
TEST(PatchTest, LinearFieldsAreExactOnDrilledBodies) {
  using geometry::clip;
  using geometry::CylinderTool;
  const std::vector<Kinds> kinds{{value, flux}};
  const auto outside = geometry::KeptSide::outside;
  const geometry::Boundary<3> block = geometry::box({2.0, 2.0, 1.0});
  const CylinderTool upright{{1.0, 0.9, 0.0}, {0.0, 0.0, 1.0}, 0.4, outside};
  expect_patch_test<3>("drilled block", clip(block, upright), {{value}, {value, flux}});
  expect_patch_test<3>("block drilled askew",
                       clip(block, CylinderTool{{1.0, 0.9, 0.5}, {0.3, 0.2, 1.0}, 0.35, outside}), kinds);
  expect_patch_test<3>("block drilled crosswise",
                       clip(clip(block, upright), CylinderTool{{0.0, 1.1, 0.5}, {1.0, 0.0, 0.0}, 0.25, outside}),
                       kinds);
  expect_patch_test<3>("cylinder bored crosswise",
                       clip(geometry::cylinder(1.0, 2.0), CylinderTool{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, 0.4, outside}),
                       kinds);
  expect_patch_test<3>("notched block", clip(block, geometry::SphereTool{{2.0, 2.0, 1.0}, 0.7, outside}), kinds);
  expect_patch_test<3>("dented block", clip(block, geometry::SphereTool{{1.1, 0.9, 1.1}, 0.5, outside}), kinds);
  expect_patch_test<3>("rod of a block", clip(block, CylinderTool{{1.3, 1.2, 0.0}, {0.0, 0.0, 1.0}, 0.15}), kinds);
  expect_patch_test<3>("block drilled through two faces",
                       clip(block, CylinderTool{{0.5, 0.5, 0.0}, {0.0, 0.0, 1.0}, 0.5, outside}), {{value}});
}

}  // namespace
}  // namespace isorim::solver
