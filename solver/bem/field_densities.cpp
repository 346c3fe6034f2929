#include "solver/bem/field_densities.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace isorim::solver {

namespace {

/// The coefficients of an element's functions: functions x components.
template <int Dim>
void gather(const FieldSpace<Dim>& space, int element, const Eigen::MatrixXd& all, Eigen::MatrixXd& own) {
  const std::span<const std::int32_t> functions = space.functions_of(element);
  own.resize(static_cast<Eigen::Index>(functions.size()), all.cols());
  for (std::size_t a = 0; a < functions.size(); ++a) own.row(static_cast<Eigen::Index>(a)) = all.row(functions[a]);
}

double value_or_zero(const std::vector<double>& values, Eigen::Index node) {
  return values.empty() ? 0.0 : values[static_cast<std::size_t>(node)];
}

}  // namespace

template <int Dim>
FieldDensities<Dim>::FieldDensities(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const Solution<Dim>& solution)
    : problem_(&problem),
      space_(&space),
      solution_(&solution),
      components_(static_cast<int>(solution.potential.cols())),
      data_(problem) {}

template <int Dim>
void FieldDensities<Dim>::at_nodes(int element, const quadrature::NodeView<Dim>& nodes, Densities& densities) {
  const int count = space_->elements[static_cast<std::size_t>(element)].count;
  basis_.resize(count, static_cast<Eigen::Index>(nodes.size()));
  geometry::Point<Dim - 1> place;
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    for (std::size_t d = 0; d < Dim - 1; ++d) place[static_cast<Eigen::Index>(d)] = nodes.place[d][q];
    const auto column = static_cast<Eigen::Index>(q);
    basis_values(*space_, element, place, {basis_.col(column).data(), static_cast<std::size_t>(count)});
  }
  interpolate(element, densities);
  data_.evaluate(problem_->condition_of[static_cast<std::size_t>(element)], nodes, values_);
  prescribe(element, densities);
}

template <int Dim>
void FieldDensities<Dim>::at_place(int element, const geometry::Point<Dim - 1>& place,
                                   const geometry::Point<Dim>& position, const geometry::Vector<Dim>& normal,
                                   Densities& densities) {
  const int count = space_->elements[static_cast<std::size_t>(element)].count;
  basis_.resize(count, 1);
  basis_values(*space_, element, place, {basis_.data(), static_cast<std::size_t>(count)});
  interpolate(element, densities);
  const geometry::Points<Dim> points = position;
  const geometry::Points<Dim> normals = normal;
  data_.evaluate(problem_->condition_of[static_cast<std::size_t>(element)], points, normals, values_);
  prescribe(element, densities);
}

template <int Dim>
Eigen::MatrixXd FieldDensities<Dim>::potential_derivatives(int element, const geometry::Point<Dim - 1>& place) {
  gather(*space_, element, solution_->potential, coefficients_);
  const Eigen::Matrix<double, Eigen::Dynamic, Dim> jets = basis_jets(*space_, element, place);
  return coefficients_.transpose() * jets.template rightCols<Dim - 1>();
}

template <int Dim>
void FieldDensities<Dim>::interpolate(int element, Densities& densities) {
  gather(*space_, element, solution_->potential, coefficients_);
  densities.potential.noalias() = basis_.transpose() * coefficients_;
  gather(*space_, element, solution_->flux, coefficients_);
  densities.flux.noalias() = basis_.transpose() * coefficients_;
}

template <int Dim>
void FieldDensities<Dim>::prescribe(int element, Densities& densities) const {
  const auto number = static_cast<std::size_t>(problem_->condition_of[static_cast<std::size_t>(element)]);
  const Condition<Dim>& condition = problem_->conditions[number];
  for (int c = 0; c < components_; ++c) {
    const auto component = static_cast<std::size_t>(c);
    const ConditionKind kind = condition.components[component].kind;
    const Eigen::VectorXd axis = component_axis(condition, c).head(components_);
    Eigen::MatrixXd& field = kind == ConditionKind::value ? densities.potential : densities.flux;
    for (Eigen::Index q = 0; q < field.rows(); ++q) {
      double wanted = value_or_zero(values_.value[component], q);
      if (kind == ConditionKind::robin) {
        const double difference = wanted - densities.potential.row(q).dot(axis);
        wanted = (problem_->exterior ? -1.0 : 1.0) * value_or_zero(values_.coefficient[component], q) * difference;
      }
      field.row(q) += (wanted - field.row(q).dot(axis)) * axis.transpose();
    }
  }
}

template class FieldDensities<2>;
template class FieldDensities<3>;

}  // namespace isorim::solver
