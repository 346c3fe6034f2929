#include "solver/bem/solve.h"

#include <algorithm>
#include <utility>

#include "quadrature/target_rules.h"
#include "solver/bem/assembly.h"
#include "solver/bem/coefficients.h"
#include "solver/bem/compressed_system.h"
#include "solver/bem/dense_system.h"
#include "solver/bem/side_conditions.h"

namespace isorim::solver {

namespace {

template <int Dim>
int highest_degree(const FieldSpace<Dim>& space) {
  int highest = 1;
  for (const FieldElement<Dim>& element : space.elements) {
    for (const std::int8_t degree : element.degree) highest = std::max<int>(highest, degree);
  }
  return highest;
}

/// Blocks of vectors have ranks three times as high and half as many points.
int automatic_limit(int components) {
  return components > 1 ? 2 * SolveOptions::automatic_limit : SolveOptions::automatic_limit;
}

template <int Dim>
Eigen::VectorXd constant_at_infinity(const SideConditions<Dim>& sides, const Eigen::VectorXd& extra, int components) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(components);
  for (std::size_t k = 0; k < sides.constants.size(); ++k)
    sum += extra[static_cast<Eigen::Index>(k)] * sides.constants[k].head(components);
  return sum;
}

template <int Dim>
Eigen::VectorXd by_dense(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides, const SolveOptions& options,
                         Solution<Dim>& solution) {
  const DenseSystem system = assemble_dense(assembler, sides, options);
  DenseSolution found = solve_dense(system, options.threads);
  solution.method = "dense";
  solution.residual = found.residual;
  solution.matrix_memory = static_cast<std::size_t>(system.matrix.size()) * sizeof(double);
  return std::move(found.values);
}

template <int Dim>
Eigen::VectorXd by_compressed(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                              const SolveOptions& options, Solution<Dim>& solution) {
  CompressedSolution found = solve_compressed(assemble_compressed(assembler, sides, options), options);
  solution.method = "compressed";
  solution.iterations = found.iterations;
  solution.residual = found.residual;
  solution.matrix_memory = found.memory;
  return std::move(found.values);
}

}  // namespace

template <int Dim>
Solution<Dim> solve(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const SolveOptions& options) {
  check_problem(problem, space);
  typename quadrature::TargetRules<Dim>::Options rule_options;
  rule_options.tolerance = options.tolerance;
  rule_options.field_degree = highest_degree(space);
  const quadrature::TargetRules<Dim> rules(space.table, rule_options);
  const double flux_scale = Assembler<Dim>(problem, space, rules, {}).flux_scale();
  const SideConditions<Dim> sides = side_conditions(problem, space, rules, flux_scale, options.threads);
  const Assembler<Dim> assembler(problem, space, rules, sides.flux_modes);
  const bool is_compressed =
      options.method == SolveMethod::compressed ||
      (options.method == SolveMethod::automatic && assembler.size() > automatic_limit(assembler.components()));

  Solution<Dim> solution;
  solution.messages = sides.messages;
  solution.unknowns = static_cast<std::size_t>(assembler.size()) + sides.count();
  const Eigen::VectorXd found = is_compressed ? by_compressed(assembler, sides, options, solution)
                                              : by_dense(assembler, sides, options, solution);
  FieldCoefficients coefficients = field_coefficients(assembler, found.head(assembler.size()));
  solution.potential = std::move(coefficients.potential);
  solution.flux = std::move(coefficients.flux);
  solution.at_infinity =
      constant_at_infinity(sides, found.tail(static_cast<Eigen::Index>(sides.count())), assembler.components());
  return solution;
}

template Solution<2> solve<2>(const Problem<2>&, const FieldSpace<2>&, const SolveOptions&);
template Solution<3> solve<3>(const Problem<3>&, const FieldSpace<3>&, const SolveOptions&);

}  // namespace isorim::solver
