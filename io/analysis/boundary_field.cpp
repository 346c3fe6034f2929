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
BoundarySampler<Dim>::BoundarySampler(const solver::FieldSpace<Dim>& space, const solver::Solution<Dim>& solution,
                                      const quadrature::TargetRules<Dim>& rules)
    : space_(&space), solution_(&solution), rules_(&rules) {}

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
  return sample_;
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
