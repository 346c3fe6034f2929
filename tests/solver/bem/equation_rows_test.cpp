#include "solver/bem/equation_rows.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using test::ExactField;
using Kinds = std::vector<ConditionKind>;
constexpr auto value = ConditionKind::value;
constexpr auto flux = ConditionKind::flux;
constexpr auto robin = ConditionKind::robin;

template <int Dim>
ExactField<Dim> potential() {
  return {[](const geometry::Point<Dim>& x) { return Eigen::VectorXd::Constant(1, x[0] * x[1] + 0.3); },
          [](const geometry::Point<Dim>& x) {
            Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(1, Dim);
            gradient(0, 0) = x[1];
            gradient(0, 1) = x[0];
            return gradient;
          }};
}

template <int Dim>
ExactField<Dim> displacement() {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(Dim, Dim);
  matrix(1, 0) = -0.4;
  return test::linear_field<Dim>(matrix, Eigen::VectorXd::Constant(Dim, 0.1));
}

std::vector<std::int32_t> every(std::int32_t step, std::int32_t first, std::int32_t end) {
  std::vector<std::int32_t> indices;
  for (std::int32_t i = first; i < end; i += step) indices.push_back(i);
  return indices;
}

/// Divided among three lists in turn, every element belongs to several: the integrals over the parts are those of the
/// whole.
template <int Dim>
void expect_parts_to_add_up(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const std::string& what) {
  const quadrature::TargetRules<Dim> rules(space.table, {1e-8, 4});
  RigidMotion<Dim> mode;
  mode.translation = geometry::Vector<Dim>::Unit(0);
  const Assembler<Dim> assembler(problem, space, rules, {mode});
  const Eigen::Index components = assembler.components();
  const auto points = every(7, 0, space.function_count());
  RowIntegrator<Dim> integrator(assembler);
  EquationRows whole;
  integrator.set_functions(every(1, 0, space.function_count()));
  integrator.integrate(points, whole);
  ASSERT_EQ(whole.sums.cols(), components + 2);

  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(whole.sums.rows(), whole.sums.cols());
  for (const std::int32_t part : {0, 1, 2}) {
    const auto functions = every(3, part, space.function_count());
    EquationRows rows;
    integrator.set_functions(functions);
    integrator.integrate(points, rows);
    sums += rows.sums;
    for (std::size_t k = 0; k < functions.size(); ++k) {
      EXPECT_TRUE(rows.coefficients.middleCols(static_cast<Eigen::Index>(k) * components, components) ==
                  whole.coefficients.middleCols(functions[k] * components, components))
          << what << ", function " << functions[k];
    }
  }
  EXPECT_LT((sums - whole.sums).cwiseAbs().maxCoeff(), 1e-13 * whole.sums.cwiseAbs().maxCoeff()) << what;
}

TEST(EquationRows, OfPartsOfTheFunctionsAddUpToThoseOfAll) {
  const FieldSpace<3> torus = test::space_on(geometry::torus(2.0, 0.7), 3, 1);
  expect_parts_to_add_up(test::problem_from<3>(potential<3>(), test::laplace_on(torus), torus, {value}), torus,
                         "value");
  const FieldSpace<3> cube = test::space_on(geometry::cube(1.0), 2, 1);
  expect_parts_to_add_up(
      test::problem_from<3>(potential<3>(), test::laplace_on(cube), cube, {value, flux, robin}, true), cube, "mixed");
  expect_parts_to_add_up(test::problem_from<3>(displacement<3>(), test::elasticity_on(cube), cube, {robin, value}),
                         cube, "elastic");
  const FieldSpace<2> disc = test::space_on(geometry::elliptic_disc({1.3, 0.9}), 4, 2);
  expect_parts_to_add_up(test::problem_from<2>(potential<2>(), test::laplace_on(disc), disc, {robin}), disc, "plane");
}

/// Functions sum up to one, and so do the coefficients of unknown potentials to int T phi dS, whichever functions.
template <int Dim>
void expect_rows_to_sum_to_the_double_layer(const FieldSpace<Dim>& space, const std::string& what) {
  const auto problem = test::problem_from<Dim>(potential<Dim>(), test::laplace_on(space), space, {flux});
  const quadrature::TargetRules<Dim> rules(space.table, {1e-9, 3});
  const Assembler<Dim> assembler(problem, space, rules, {});
  RowIntegrator<Dim> integrator(assembler);
  const auto points = every(5, 0, space.function_count());
  for (const std::int32_t step : {1, 2}) {
    EquationRows rows;
    integrator.set_functions(every(step, 0, space.function_count()));
    integrator.integrate(points, rows);
    EXPECT_LT((rows.coefficients.rowwise().sum() - rows.sums.col(0)).cwiseAbs().maxCoeff(), 1e-12) << what;
    // In the plane the nodes crowd about the target, where d.n / r^2 is noise until it meets u(y) - u(x).
    if (step == 1 && Dim == 3) {
      EXPECT_LT((rows.sums.col(0).array() + 0.5).abs().maxCoeff(), 1e-8) << what;
    }
  }
}

TEST(EquationRows, SumUpToTheDoubleLayerOfAConstant) {
  expect_rows_to_sum_to_the_double_layer(test::space_on(geometry::sphere(1.0), 3, 1), "sphere");
  expect_rows_to_sum_to_the_double_layer(test::space_on(geometry::cube(2.0), 2, 1), "cube");
  expect_rows_to_sum_to_the_double_layer(test::space_on(geometry::elliptic_disc({1.3, 0.9}), 3, 2), "disc");
}

}  // namespace
}  // namespace isorim::solver
