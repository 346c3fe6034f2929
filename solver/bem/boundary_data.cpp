#include "solver/bem/boundary_data.h"

#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::solver {

namespace {

template <int Dim>
std::string place_of(const Eigen::Ref<const geometry::Points<Dim>>& points, Eigen::Index column) {
  if constexpr (Dim == 2)
    return fmt::format("({:.6g}, {:.6g})", points(0, column), points(1, column));
  else
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", points(0, column), points(1, column), points(2, column));
}

std::string_view kind_name(ConditionKind kind) {
  switch (kind) {
    case ConditionKind::value:
      return "value";
    case ConditionKind::flux:
      return "flux";
    case ConditionKind::robin:
      return "reference";
  }
  return "value";
}

template <int Dim>
void evaluate_finite(const quadrature::Integrand<Dim>& integrand, const std::string& name, std::string_view what,
                     const Eigen::Ref<const geometry::Points<Dim>>& points,
                     const Eigen::Ref<const geometry::Points<Dim>>& normals, std::vector<double>& values) {
  values.resize(static_cast<std::size_t>(points.cols()));
  integrand(points, normals, values);
  for (std::size_t q = 0; q < values.size(); ++q) {
    if (!std::isfinite(values[q])) {
      throw InputError(fmt::format("boundary condition '{}': the {} is {} at {}; expected a finite number", name, what,
                                   values[q], place_of<Dim>(points, static_cast<Eigen::Index>(q))));
    }
  }
}

}  // namespace

template <int Dim>
BoundaryData<Dim>::BoundaryData(const Problem<Dim>& problem) : problem_(&problem) {
  for (const Condition<Dim>& condition : problem.conditions) {
    std::vector<Component>& made = components_.emplace_back();
    for (const ComponentCondition<Dim>& component : condition.components) {
      made.push_back(
          {component.value ? component.value() : nullptr, component.coefficient ? component.coefficient() : nullptr});
    }
  }
}

template <int Dim>
void BoundaryData<Dim>::evaluate(int condition, const Eigen::Ref<const geometry::Points<Dim>>& points,
                                 const Eigen::Ref<const geometry::Points<Dim>>& normals, ConditionValues<Dim>& result) {
  const auto index = static_cast<std::size_t>(condition);
  const Condition<Dim>& given = problem_->conditions[index];
  for (std::size_t c = 0; c < given.components.size(); ++c) {
    const Component& component = components_[index][c];
    const ConditionKind kind = given.components[c].kind;
    result.value[c].clear();
    result.coefficient[c].clear();
    if (component.value)
      evaluate_finite<Dim>(component.value, given.name, kind_name(kind), points, normals, result.value[c]);
    if (kind != ConditionKind::robin) continue;
    evaluate_finite<Dim>(component.coefficient, given.name, "coefficient", points, normals, result.coefficient[c]);
    for (std::size_t q = 0; q < result.coefficient[c].size(); ++q) {
      if (result.coefficient[c][q] <= 0.0) {
        throw InputError(fmt::format("boundary condition '{}': the coefficient is {} at {}; expected a positive number",
                                     given.name, result.coefficient[c][q],
                                     place_of<Dim>(points, static_cast<Eigen::Index>(q))));
      }
    }
  }
}

template <int Dim>
void BoundaryData<Dim>::evaluate(int condition, const quadrature::NodeView<Dim>& nodes, ConditionValues<Dim>& result) {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  points_.resize(Dim, count);
  normals_.resize(Dim, count);
  for (std::size_t d = 0; d < Dim; ++d) {
    for (Eigen::Index q = 0; q < count; ++q) {
      points_(static_cast<Eigen::Index>(d), q) = nodes.position[d][static_cast<std::size_t>(q)];
      normals_(static_cast<Eigen::Index>(d), q) = nodes.normal[d][static_cast<std::size_t>(q)];
    }
  }
  evaluate(condition, points_, normals_, result);
}

template class BoundaryData<2>;
template class BoundaryData<3>;

}  // namespace isorim::solver
