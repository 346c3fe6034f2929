#include "solver/bem/solve.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "geometry/errors.h"
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
bool same_equation(const Equation<Dim>& a, const Equation<Dim>& b) {
  if (a.index() != b.index()) return false;
  if (const auto* laplace = std::get_if<Laplace<Dim>>(&a)) {
    const auto& other = std::get<Laplace<Dim>>(b);
    return laplace->conductivity == other.conductivity && laplace->length == other.length;
  }
  const auto& elastic = std::get<Elasticity<Dim>>(a);
  const auto& other = std::get<Elasticity<Dim>>(b);
  return elastic.shear_modulus == other.shear_modulus && elastic.poisson == other.poisson &&
         elastic.length == other.length;
}

/// How the first problem and another one differ in more than what is given; empty if they do not.
template <int Dim>
std::string difference(const Problem<Dim>& first, const Problem<Dim>& other) {
  if (!same_equation(first.equation, other.equation) || first.exterior != other.exterior ||
      first.plane_state != other.plane_state)
    return "another equation, material or domain";
  if (first.condition_of != other.condition_of || first.conditions.size() != other.conditions.size())
    return "its conditions elsewhere";
  for (std::size_t k = 0; k < first.conditions.size(); ++k) {
    const Condition<Dim>& a = first.conditions[k];
    const Condition<Dim>& b = other.conditions[k];
    const auto same_kind = [](const auto& x, const auto& y) { return x.kind == y.kind; };
    if (!std::ranges::equal(a.components, b.components, same_kind) || a.frame != b.frame)
      return fmt::format("another kind or frame of the condition \"{}\"", b.name);
  }
  return "";
}

/// What all problems have in common, with the right sides of each.
template <int Dim>
SideConditions<Dim> sides_of(std::span<const Problem<Dim>> problems, const FieldSpace<Dim>& space,
                             const quadrature::TargetRules<Dim>& rules, int threads) {
  const double flux_scale = Assembler<Dim>(problems, space, rules, {}).flux_scale();
  SideConditions<Dim> sides = side_conditions(problems.front(), space, rules, flux_scale, threads);
  sides.right.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(problems.size()));
  for (std::size_t k = 1; k < problems.size(); ++k)
    sides.right.col(static_cast<Eigen::Index>(k)) =
        side_conditions(problems[k], space, rules, flux_scale, threads).right.col(0);
  return sides;
}

template <int Dim>
Eigen::MatrixXd by_dense(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides, const SolveOptions& options,
                         std::vector<Solution<Dim>>& solutions) {
  const DenseSystem system = assemble_dense(assembler, sides, options);
  DenseSolution found = solve_dense(system, options.threads);
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    solutions[k].method = "dense";
    solutions[k].residual = found.residual[static_cast<Eigen::Index>(k)];
    solutions[k].matrix_memory = static_cast<std::size_t>(system.matrix.size()) * sizeof(double);
  }
  return std::move(found.values);
}

template <int Dim>
Eigen::MatrixXd by_compressed(const Assembler<Dim>& assembler, const SideConditions<Dim>& sides,
                              const SolveOptions& options, std::vector<Solution<Dim>>& solutions) {
  CompressedSolution found = solve_compressed(assemble_compressed(assembler, sides, options), options);
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    solutions[k].method = "compressed";
    solutions[k].iterations = found.iterations[static_cast<Eigen::Index>(k)];
    solutions[k].residual = found.residual[static_cast<Eigen::Index>(k)];
    solutions[k].matrix_memory = found.memory;
  }
  return std::move(found.values);
}

}  // namespace

template <int Dim>
std::vector<Solution<Dim>> solve_all(std::span<const Problem<Dim>> problems, const FieldSpace<Dim>& space,
                                     const SolveOptions& options) {
  if (problems.empty()) return {};
  for (std::size_t k = 0; k < problems.size(); ++k) {
    check_problem(problems[k], space);
    const std::string found = difference(problems.front(), problems[k]);
    if (!found.empty())
      throw InputError(fmt::format("problem {} has {}; expected problems that differ in given values alone", k, found));
  }
  typename quadrature::TargetRules<Dim>::Options rule_options;
  rule_options.tolerance = options.tolerance;
  rule_options.field_degree = highest_degree(space);
  const quadrature::TargetRules<Dim> rules(space.table, rule_options);
  const SideConditions<Dim> sides = sides_of(problems, space, rules, options.threads);
  const Assembler<Dim> assembler(problems, space, rules, sides.flux_modes);
  const bool is_compressed =
      options.method == SolveMethod::compressed ||
      (options.method == SolveMethod::automatic && assembler.size() > automatic_limit(assembler.components()));

  std::vector<Solution<Dim>> solutions(problems.size());
  const Eigen::MatrixXd found = is_compressed ? by_compressed(assembler, sides, options, solutions)
                                              : by_dense(assembler, sides, options, solutions);
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    const auto values = found.col(static_cast<Eigen::Index>(k));
    FieldCoefficients coefficients = field_coefficients(assembler, values.head(assembler.size()), static_cast<int>(k));
    Solution<Dim>& solution = solutions[k];
    solution.messages = sides.messages;
    solution.unknowns = static_cast<std::size_t>(assembler.size()) + sides.count();
    solution.potential = std::move(coefficients.potential);
    solution.flux = std::move(coefficients.flux);
    solution.at_infinity =
        constant_at_infinity(sides, values.tail(static_cast<Eigen::Index>(sides.count())), assembler.components());
  }
  return solutions;
}

template <int Dim>
Solution<Dim> solve(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const SolveOptions& options) {
  return std::move(solve_all(std::span(&problem, 1), space, options).front());
}

template Solution<2> solve<2>(const Problem<2>&, const FieldSpace<2>&, const SolveOptions&);
template Solution<3> solve<3>(const Problem<3>&, const FieldSpace<3>&, const SolveOptions&);
template std::vector<Solution<2>> solve_all<2>(std::span<const Problem<2>>, const FieldSpace<2>&, const SolveOptions&);
template std::vector<Solution<3>> solve_all<3>(std::span<const Problem<3>>, const FieldSpace<3>&, const SolveOptions&);

}  // namespace isorim::solver
