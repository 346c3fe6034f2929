#include "solver/bem/compressed_system.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "quadrature/target_rules.h"
#include "solver/bem/assembly.h"
#include "solver/bem/dense_system.h"
#include "solver/bem/side_conditions.h"
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
ExactField<Dim> quadratic_potential() {
  return {[](const geometry::Point<Dim>& x) { return Eigen::VectorXd::Constant(1, x[0] * x[0] - x[1] * x[1] + x[0]); },
          [](const geometry::Point<Dim>& x) {
            Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(1, Dim);
            gradient(0, 0) = 2.0 * x[0] + 1.0;
            gradient(0, 1) = -2.0 * x[1];
            return gradient;
          }};
}

template <int Dim>
ExactField<Dim> shear() {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(Dim, Dim);
  matrix(0, 1) = 0.7;
  return test::linear_field<Dim>(matrix, Eigen::VectorXd::Constant(Dim, 0.2));
}

template <int Dim>
Solution<Dim> solve_by(SolveMethod method, const Problem<Dim>& problem, const FieldSpace<Dim>& space, double tolerance,
                       int threads = 0) {
  SolveOptions options;
  options.method = method;
  options.tolerance = tolerance;
  options.threads = threads;
  return solve(problem, space, options);
}

/// The compressed solution is the dense one up to the tolerance times the condition of the problem.
template <int Dim>
void expect_same(const Problem<Dim>& problem, const FieldSpace<Dim>& space, double tolerance, const std::string& what) {
  const Solution<Dim> dense = solve_by(SolveMethod::dense, problem, space, tolerance);
  const Solution<Dim> compressed = solve_by(SolveMethod::compressed, problem, space, tolerance);
  EXPECT_EQ(compressed.method, "compressed");
  EXPECT_EQ(compressed.unknowns, dense.unknowns);
  EXPECT_LT(compressed.iterations, 10) << what;
  EXPECT_LE(compressed.residual, tolerance) << what;
  EXPECT_LT((compressed.potential - dense.potential).norm(), 30.0 * tolerance * dense.potential.norm()) << what;
  EXPECT_LT((compressed.flux - dense.flux).norm(), 30.0 * tolerance * (dense.flux.norm() + dense.potential.norm()))
      << what;
  EXPECT_LT((compressed.at_infinity - dense.at_infinity).norm(), 30.0 * tolerance) << what;
}

TEST(CompressedSystem, GivesTheSolutionOfTheDenseOneInSpace) {
  const FieldSpace<3> space = test::space_on(geometry::cube(1.0), 2, 2);
  for (const Kinds& kinds : {Kinds{flux}, Kinds{robin, flux, value}}) {
    const std::string what = std::to_string(static_cast<int>(kinds[0]));
    expect_same(test::problem_from<3>(quadratic_potential<3>(), test::laplace_on(space), space, kinds), space, 1e-8,
                what);
  }
  const FieldSpace<3> ball = test::space_on(geometry::sphere(1.0), 2, 1);
  expect_same(test::problem_from<3>(shear<3>(), test::elasticity_on(ball), ball, {flux}), ball, 1e-6, "elasticity");
}

TEST(CompressedSystem, GivesTheSolutionOfTheDenseOneInThePlane) {
  const FieldSpace<2> space = test::space_on(geometry::elliptic_disc({1.3, 0.9}), 3, 4);
  for (const Kinds& kinds : {Kinds{value}, Kinds{flux}, Kinds{robin}}) {
    expect_same(test::problem_from<2>(quadratic_potential<2>(), test::laplace_on(space), space, kinds), space, 1e-8,
                "potential");
    expect_same(test::problem_from<2>(shear<2>(), test::elasticity_on(space), space, kinds), space, 1e-8, "elasticity");
  }
  // A known constant at infinity.
  const ExactField<2> constant = test::linear_field<2>(Eigen::RowVector2d::Zero(), Eigen::VectorXd::Constant(1, 2.5));
  expect_same(test::problem_from<2>(constant, test::laplace_on(space), space, {robin}, true), space, 1e-8, "exterior");
}

/// All coefficients, right sides and side columns, within the tolerance of those of the dense system in the Frobenius
/// norm.
template <int Dim>
void expect_same_equations(const Problem<Dim>& problem, const FieldSpace<Dim>& space, double tolerance,
                           const std::string& what) {
  const quadrature::TargetRules<Dim> rules(space.table, {tolerance, 3});
  const double flux_scale = Assembler<Dim>(problem, space, rules, {}).flux_scale();
  const SideConditions<Dim> sides = side_conditions(problem, space, rules, flux_scale, 0);
  const Assembler<Dim> assembler(problem, space, rules, sides.flux_modes);
  SolveOptions options;
  options.tolerance = tolerance;
  const DenseSystem dense = assemble_dense(assembler, sides, options);
  const CompressedSystem compressed = assemble_compressed(assembler, sides, options);
  EXPECT_TRUE(tolerance < 1e-4 || compressed.matrix->statistics().low_rank_blocks > 0) << what;
  const auto exact = dense.matrix.topLeftCorner(assembler.size(), assembler.size());
  EXPECT_LE((compressed.matrix->to_dense() - exact).norm(), tolerance * exact.norm()) << what;
  EXPECT_LE((compressed.right - dense.right).norm(), tolerance * dense.right.norm()) << what;
  const auto columns = dense.matrix.topRightCorner(assembler.size(), compressed.columns.cols());
  EXPECT_LE((compressed.columns - columns).norm(), tolerance * columns.norm()) << what;
}

TEST(CompressedSystem, KeepsToTheToleranceInMatrixAndRightSides) {
  const FieldSpace<3> cube = test::space_on(geometry::cube(1.0), 1, 3);
  const FieldSpace<3> torus = test::space_on(geometry::torus(2.0, 0.5), 3, 2);
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    for (const Kinds& kinds : {Kinds{value}, Kinds{flux}, Kinds{robin, flux, value}}) {
      const std::string what = std::to_string(static_cast<int>(kinds[0])) + ", " + std::to_string(tolerance);
      expect_same_equations(test::problem_from<3>(quadratic_potential<3>(), test::laplace_on(cube), cube, kinds), cube,
                            tolerance, "cube " + what);
      expect_same_equations(test::problem_from<3>(quadratic_potential<3>(), test::laplace_on(torus), torus, kinds),
                            torus, tolerance, "torus " + what);
    }
  }
  const FieldSpace<3> ball = test::space_on(geometry::sphere(1.0), 2, 3);
  expect_same_equations(test::problem_from<3>(shear<3>(), test::elasticity_on(ball), ball, {value, flux}), ball, 1e-3,
                        "elasticity");
}

TEST(CompressedSystem, IterationsDoNotGrowWithRefinementOrDegree) {
  const auto iterations = [](int degree, int refine) {
    const FieldSpace<3> space = test::space_on(geometry::sphere(1.0), degree, refine);
    const auto problem = test::problem_from<3>(quadratic_potential<3>(), test::laplace_on(space), space, {value});
    return solve_by(SolveMethod::compressed, problem, space, 1e-6).iterations;
  };
  for (int refine = 1; refine <= 4; ++refine) EXPECT_LE(iterations(1, refine), 8) << "refinement " << refine;
  for (int degree = 1; degree <= 8; ++degree) EXPECT_LE(iterations(degree, 1), 8) << "degree " << degree;
}

TEST(CompressedSystem, AnyNumberOfThreadsGivesTheSameBits) {
  const FieldSpace<3> space = test::space_on(geometry::cube(1.0), 2, 2);
  const auto problem = test::problem_from<3>(quadratic_potential<3>(), test::laplace_on(space), space, {value, flux});
  const Solution<3> one = solve_by(SolveMethod::compressed, problem, space, 1e-6, 1);
  const Solution<3> three = solve_by(SolveMethod::compressed, problem, space, 1e-6, 3);
  EXPECT_TRUE(one.potential == three.potential);
  EXPECT_TRUE(one.flux == three.flux);
}

}  // namespace
}  // namespace isorim::solver
