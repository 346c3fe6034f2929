#include "solver/bem/field_densities.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/bem/basis_moments.h"
#include "solver/linear/small_products.h"

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
void FieldDensities<Dim>::set_element(int element) {
  if (element == element_) return;
  const FieldElement<Dim>& field = space_->elements[static_cast<std::size_t>(element)];
  const Eigen::Map<const Eigen::MatrixXd> rows(space_->rows.data() + field.row, field.bernstein_count(), field.count);
  bernstein_.resize(2 * components_, field.bernstein_count());
  gather(*space_, element, solution_->potential, coefficients_);
  bernstein_.topRows(components_).noalias() = (rows * coefficients_).transpose();
  gather(*space_, element, solution_->flux, coefficients_);
  bernstein_.bottomRows(components_).noalias() = (rows * coefficients_).transpose();
  element_ = element;
}

template <int Dim>
void FieldDensities<Dim>::fill_products(int element, const quadrature::NodeView<Dim>& nodes) {
  const FieldElement<Dim>& field = space_->elements[static_cast<std::size_t>(element)];
  const auto n = static_cast<std::size_t>(padded(static_cast<int>(nodes.size())));
  const auto step = static_cast<std::ptrdiff_t>(n);
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    polynomials_[d].resize(n * static_cast<std::size_t>(field.degree[d] + 1));
    bernstein_values(field.degree[d], static_cast<int>(nodes.size()), nodes.place[d].data(), polynomials_[d].data(),
                     step);
  }
  // What stands in the padding is of no consequence.
  products_.resize(n * static_cast<std::size_t>(field.bernstein_count()));
  double* product = products_.data();
  if constexpr (Dim == 2) {
    for (int i = 0; i <= field.degree[0]; ++i, product += n)
      std::copy_n(polynomials_[0].data() + i * step, nodes.size(), product);
  } else {
    for (int j = 0; j <= field.degree[1]; ++j) {
      const double* v = polynomials_[1].data() + j * step;
      for (int i = 0; i <= field.degree[0]; ++i, product += n) {
        const double* u = polynomials_[0].data() + i * step;
        for (std::size_t q = 0; q < nodes.size(); ++q) product[q] = u[q] * v[q];
      }
    }
  }
}

template <int Dim>
void FieldDensities<Dim>::at_nodes(int element, const quadrature::NodeView<Dim>& nodes, Densities& densities) {
  set_element(element);
  fill_products(element, nodes);
  const int rows = 2 * components_;
  const int count = static_cast<int>(bernstein_.cols());
  const int n = padded(static_cast<int>(nodes.size()));
  fields_.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(n), 0.0);
  add_product(rows, n, count, {bernstein_.data(), count, 1}, products_.data(), n, fields_.data(), n);
  const auto size = static_cast<Eigen::Index>(nodes.size());
  const Eigen::Map<const Eigen::MatrixXd> fields(fields_.data(), n, rows);
  densities.potential = fields.topLeftCorner(size, components_);
  densities.flux = fields.topRightCorner(size, components_);
  const geometry::BezierElement<Dim>& bezier = space_->table.elements[static_cast<std::size_t>(element)];
  if (space_->elements[static_cast<std::size_t>(element)].rational && !bezier.polynomial) {
    fill_reciprocal_weights(space_->table, bezier, nodes, reciprocal_weight_, room_);
    const Eigen::Map<const Eigen::ArrayXd> reciprocal(reciprocal_weight_.data(), size);
    densities.potential.array().colwise() *= reciprocal;
    densities.flux.array().colwise() *= reciprocal;
  }
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
    if (kind != ConditionKind::robin && !condition.frame) {
      for (Eigen::Index q = 0; q < field.rows(); ++q) field(q, c) = value_or_zero(values_.value[component], q);
      continue;
    }
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
