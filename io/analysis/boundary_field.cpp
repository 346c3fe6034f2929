#include "io/analysis/boundary_field.h"

#include <algorithm>
#include <cstddef>

namespace isorim::io {

template <int Dim>
Eigen::VectorXd field_at(const solver::FieldSpace<Dim>& space, const Eigen::MatrixXd& coefficients, int element,
                         const geometry::Point<Dim - 1>& place, std::vector<double>& basis) {
  const auto functions = space.functions_of(element);
  basis.resize(functions.size());
  solver::basis_values(space, element, place, basis);
  Eigen::VectorXd value = Eigen::VectorXd::Zero(coefficients.cols());
  for (std::size_t a = 0; a < functions.size(); ++a) value += basis[a] * coefficients.row(functions[a]).transpose();
  return value;
}

template <int Dim>
quadrature::TargetRules<Dim> sampling_rules(const solver::FieldSpace<Dim>& space) {
  typename quadrature::TargetRules<Dim>::Options options;
  options.field_degree = 1;
  for (const solver::FieldElement<Dim>& element : space.elements) {
    for (const std::int8_t degree : element.degree) options.field_degree = std::max<int>(options.field_degree, degree);
  }
  return {space.table, options};
}

template <int Dim>
BoundarySampler<Dim>::BoundarySampler(const solver::Problem<Dim>& problem, const solver::FieldSpace<Dim>& space,
                                      const solver::Solution<Dim>& solution, const quadrature::TargetRules<Dim>& rules)
    : problem_(&problem), space_(&space), solution_(&solution), rules_(&rules), data_(problem) {}

template <int Dim>
const BoundarySample<Dim>& BoundarySampler<Dim>::sample(int element) {
  sample_.nodes = rules_->far_nodes(element, rules_->sphere(element).radius);
  const Eigen::Index count = static_cast<Eigen::Index>(sample_.nodes.size());
  const Eigen::Index components = solution_->potential.cols();
  sample_.value.resize(components, count);
  sample_.flux.resize(components, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    geometry::Point<Dim - 1> place;
    for (std::size_t d = 0; d < Dim - 1; ++d) {
      place[static_cast<Eigen::Index>(d)] = sample_.nodes.place[d][static_cast<std::size_t>(i)];
    }
    sample_.value.col(i) = field_at(*space_, solution_->potential, element, place, basis_);
    sample_.flux.col(i) = field_at(*space_, solution_->flux, element, place, basis_);
  }
  sample_.true_value = sample_.value;
  sample_.true_flux = sample_.flux;
  apply_data(element);
  return sample_;
}

/// Puts the prescribed components in the place of what the coefficients say.
template <int Dim>
void BoundarySampler<Dim>::apply_data(int element) {
  const int index = problem_->condition_of[static_cast<std::size_t>(element)];
  const solver::Condition<Dim>& condition = problem_->conditions[static_cast<std::size_t>(index)];
  data_.evaluate(index, sample_.nodes, values_);
  const Eigen::Index components = sample_.value.rows();
  for (int c = 0; c < components; ++c) {
    const solver::ConditionKind kind = condition.components[static_cast<std::size_t>(c)].kind;
    const Eigen::VectorXd axis = solver::component_axis(condition, c).head(components);
    const std::vector<double>& given = values_.value[static_cast<std::size_t>(c)];
    const std::vector<double>& coefficient = values_.coefficient[static_cast<std::size_t>(c)];
    Eigen::MatrixXd& field = kind == solver::ConditionKind::value ? sample_.true_value : sample_.true_flux;
    for (Eigen::Index i = 0; i < field.cols(); ++i) {
      double target = given.empty() ? 0.0 : given[static_cast<std::size_t>(i)];
      if (kind == solver::ConditionKind::robin) {
        // The flux into the domain, while n points out of the body.
        const double sign = problem_->exterior ? -1.0 : 1.0;
        target = sign * coefficient[static_cast<std::size_t>(i)] * (target - axis.dot(sample_.value.col(i)));
      }
      const double correction = target - axis.dot(field.col(i));
      field.col(i) += correction * axis;
    }
  }
}

template class BoundarySampler<2>;
template class BoundarySampler<3>;
template quadrature::TargetRules<2> sampling_rules(const solver::FieldSpace<2>&);
template quadrature::TargetRules<3> sampling_rules(const solver::FieldSpace<3>&);
template Eigen::VectorXd field_at(const solver::FieldSpace<2>&, const Eigen::MatrixXd&, int, const geometry::Point<1>&,
                                  std::vector<double>&);
template Eigen::VectorXd field_at(const solver::FieldSpace<3>&, const Eigen::MatrixXd&, int, const geometry::Point<2>&,
                                  std::vector<double>&);

}  // namespace isorim::io
