#include "solver/bem/problem.h"

#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::solver {

namespace {

void require_positive(std::string_view name, double value) {
  if (!(std::isfinite(value) && value > 0.0))
    throw InputError(fmt::format("{} is {}; expected a positive number", name, value));
}

template <int Dim>
void check_material(const Laplace<Dim>& equation) {
  require_positive("the conductivity", equation.conductivity);
}

template <int Dim>
void check_material(const Elasticity<Dim>& equation) {
  require_positive("the shear modulus", equation.shear_modulus);
  if (!(equation.poisson > -1.0 && equation.poisson < 0.5))
    throw InputError(fmt::format("Poisson's ratio is {}; expected a number in (-1, 0.5)", equation.poisson));
}

template <int Dim>
void check_length(const Equation<Dim>& equation, const geometry::ElementTable<Dim>& table) {
  if constexpr (Dim == 2) {
    const double length = std::visit([](const auto& kernel) { return kernel.length; }, equation);
    const double least = 0.5 * geometry::bounding_box(table).diagonal();
    if (!(std::isfinite(length) && length >= least)) {
      throw InputError(fmt::format(
          "the logarithm's length is {}; expected at least {}, half the diagonal of the boundary's bounding "
          "box (logarithm_length() gives a good one)",
          length, least));
    }
  }
}

template <int Dim>
void check_component(const Condition<Dim>& condition, std::size_t index) {
  const ComponentCondition<Dim>& component = condition.components[index];
  const bool is_robin = component.kind == ConditionKind::robin;
  if (is_robin && !component.coefficient) {
    throw InputError(fmt::format("boundary condition '{}': component {} is of kind robin and has no coefficient",
                                 condition.name, index + 1));
  }
  if (!is_robin && component.coefficient) {
    throw InputError(fmt::format("boundary condition '{}': component {} has a coefficient, which only robin uses",
                                 condition.name, index + 1));
  }
}

template <int Dim>
void check_condition(const Condition<Dim>& condition, int components) {
  if (static_cast<int>(condition.components.size()) != components) {
    throw InputError(fmt::format("boundary condition '{}' has {} components; expected {}", condition.name,
                                 condition.components.size(), components));
  }
  for (std::size_t c = 0; c < condition.components.size(); ++c) check_component(condition, c);
  if (!condition.frame) return;
  if (components == 1)
    throw InputError(fmt::format("boundary condition '{}' has a frame, but a potential has no axes", condition.name));
  const Eigen::Matrix<double, Dim, Dim> product = *condition.frame * condition.frame->transpose();
  const double defect = (product - Eigen::Matrix<double, Dim, Dim>::Identity()).cwiseAbs().maxCoeff();
  if (!(defect <= 1e-12)) {
    throw InputError(fmt::format("boundary condition '{}': the axes of its frame are not orthonormal (defect {:.3g})",
                                 condition.name, defect));
  }
}

template <int Dim>
void check_assignment(const Problem<Dim>& problem, const FieldSpace<Dim>& space) {
  const std::size_t elements = space.table.elements.size();
  if (problem.conditions.empty()) throw InputError("no boundary conditions are given: nothing determines a solution");
  if (problem.condition_of.size() != elements) {
    throw InputError(fmt::format("boundary conditions are given for {} elements; the boundary has {}",
                                 problem.condition_of.size(), elements));
  }
  for (std::size_t e = 0; e < elements; ++e) {
    const std::int32_t condition = problem.condition_of[e];
    if (condition >= 0 && static_cast<std::size_t>(condition) < problem.conditions.size()) continue;
    throw InputError(fmt::format("element {} (patch {}) has boundary condition {}; expected 0 to {}", e,
                                 space.table.elements[e].patch, condition, problem.conditions.size() - 1));
  }
}

/// Functions end where conditions change, so each has one kind of unknown.
template <int Dim>
void check_functions(const Problem<Dim>& problem, const FieldSpace<Dim>& space) {
  std::vector<std::int32_t> condition_of_function(static_cast<std::size_t>(space.function_count()), -1);
  for (std::size_t e = 0; e < space.table.elements.size(); ++e) {
    const std::int32_t condition = problem.condition_of[e];
    for (const std::int32_t function : space.functions_of(static_cast<int>(e))) {
      std::int32_t& known = condition_of_function[static_cast<std::size_t>(function)];
      if (known < 0) known = condition;
      if (known == condition) continue;
      throw InputError(
          fmt::format("patch {}: the conditions '{}' and '{}' meet inside the support of a function; the "
                      "space has to be built with functions that end where conditions change",
                      space.table.elements[e].patch, problem.conditions[static_cast<std::size_t>(known)].name,
                      problem.conditions[static_cast<std::size_t>(condition)].name));
    }
  }
}

}  // namespace

template <int Dim>
int component_count(const Equation<Dim>& equation) {
  return std::visit([](const auto& kernel) { return std::decay_t<decltype(kernel)>::components; }, equation);
}

template <int Dim>
double logarithm_length(const geometry::ElementTable<Dim>& table) {
  return geometry::bounding_box(table).diagonal();
}

template <int Dim>
void check_problem(const Problem<Dim>& problem, const FieldSpace<Dim>& space) {
  std::visit([](const auto& kernel) { check_material(kernel); }, problem.equation);
  check_length(problem.equation, space.table);
  check_assignment(problem, space);
  const int components = component_count(problem.equation);
  for (const Condition<Dim>& condition : problem.conditions) check_condition(condition, components);
  check_functions(problem, space);
  if (problem.exterior && !problem.loads.empty()) {
    throw InputError(
        "an exterior problem has a source or body force; its integral over the unbounded domain cannot be "
        "brought to the boundary");
  }
}

template int component_count<2>(const Equation<2>&);
template int component_count<3>(const Equation<3>&);
template double logarithm_length<2>(const geometry::ElementTable<2>&);
template double logarithm_length<3>(const geometry::ElementTable<3>&);
template void check_problem<2>(const Problem<2>&, const FieldSpace<2>&);
template void check_problem<3>(const Problem<3>&, const FieldSpace<3>&);

}  // namespace isorim::solver
