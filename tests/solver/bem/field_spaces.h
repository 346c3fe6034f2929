#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "geometry/bezier/element_jet.h"
#include "solver/bem/field_space.h"

namespace isorim::solver::testing {

template <int Dim>
std::vector<double> values_at(const FieldSpace<Dim>& space, int element, const geometry::Point<Dim - 1>& place) {
  std::vector<double> values(static_cast<std::size_t>(space.elements[static_cast<std::size_t>(element)].count));
  basis_values<Dim>(space, element, place, values);
  return values;
}

/// Row i: the functions at point i.
template <int Dim>
Eigen::MatrixXd collocation_matrix(const FieldSpace<Dim>& space) {
  const int n = space.function_count();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    const CollocationPoint<Dim>& point = space.points[static_cast<std::size_t>(i)];
    const std::vector<double> values = values_at<Dim>(space, point.element, point.place);
    for (std::size_t k = 0; k < values.size(); ++k) matrix(i, space.functions_of(point.element)[k]) = values[k];
  }
  return matrix;
}

/// |A| |A^-1| in the maximum norm.
inline double condition(const Eigen::MatrixXd& matrix) {
  const Eigen::MatrixXd inverse = matrix.partialPivLu().inverse();
  return matrix.cwiseAbs().rowwise().sum().maxCoeff() * inverse.cwiseAbs().rowwise().sum().maxCoeff();
}

/// Coefficients of the function of the space that takes f's values at the points; f of position and normal.
template <int Dim, class Function>
Eigen::VectorXd interpolate(const FieldSpace<Dim>& space, const Function& f) {
  Eigen::VectorXd values(space.function_count());
  for (int i = 0; i < space.function_count(); ++i) {
    const CollocationPoint<Dim>& point = space.points[static_cast<std::size_t>(i)];
    values(i) = f(point.position, point.normal);
  }
  return collocation_matrix(space).partialPivLu().solve(values);
}

template <int Dim>
double value(const FieldSpace<Dim>& space, const Eigen::VectorXd& coefficients, int element,
             const geometry::Point<Dim - 1>& place) {
  const std::vector<double> values = values_at<Dim>(space, element, place);
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) sum += values[k] * coefficients(space.functions_of(element)[k]);
  return sum;
}

/// The largest difference between f and the function over all elements, at random places and at the corners, poles
/// (where there is no normal) left out.
template <int Dim, class Function>
double largest_error(const FieldSpace<Dim>& space, const Eigen::VectorXd& coefficients, const Function& f) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double error = 0.0;
  for (std::size_t e = 0; e < space.elements.size(); ++e)
    for (int k = 0; k < 10; ++k) {
      geometry::Point<Dim - 1> place;
      for (int d = 0; d + 1 < Dim; ++d) place(d) = k < 4 ? (k >> d) & 1 : uniform(generator);
      const auto jet = geometry::evaluate_jet<Dim>(space.table, space.table.elements[e], place);
      if (jet.area_vector.norm() == 0.0) continue;
      const double difference =
          value<Dim>(space, coefficients, static_cast<int>(e), place) - f(jet.position, jet.normal());
      error = std::max(error, std::abs(difference));
    }
  return error;
}

/// How well the space takes up f: interpolated at the collocation points.
template <int Dim, class Function>
double interpolation_error(const FieldSpace<Dim>& space, const Function& f) {
  return largest_error<Dim>(space, interpolate<Dim>(space, f), f);
}

}  // namespace isorim::solver::testing
