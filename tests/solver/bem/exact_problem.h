#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"
#include "quadrature/rim.h"
#include "quadrature/target_rules.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/rigid_motion.h"
#include "solver/bem/solve.h"

/// Boundary-value problems made from known fields, and how far solutions lie from them.
namespace isorim::solver::test {

/// A field with its gradient: potential (1) or displacement (Dim components).
template <int Dim>
struct ExactField {
  std::function<Eigen::VectorXd(const geometry::Point<Dim>&)> value;
  /// components x Dim.
  std::function<Eigen::MatrixXd(const geometry::Point<Dim>&)> gradient;
};

/// du/dn times the conductivity, or the traction.
template <int Dim>
Eigen::VectorXd flux_of(const Equation<Dim>& equation, const Eigen::MatrixXd& gradient,
                        const geometry::Vector<Dim>& normal) {
  if (const auto* laplace = std::get_if<Laplace<Dim>>(&equation)) return laplace->conductivity * (gradient * normal);
  const auto& elastic = std::get<Elasticity<Dim>>(equation);
  const double mu = elastic.shear_modulus;
  const double lambda = 2.0 * mu * elastic.poisson / (1.0 - 2.0 * elastic.poisson);
  const Eigen::MatrixXd strain = 0.5 * (gradient + gradient.transpose());
  return 2.0 * mu * strain * normal + lambda * strain.trace() * normal;
}

/// A function of place and normal as data of a condition.
template <int Dim>
quadrature::IntegrandFactory<Dim> data(
    std::function<double(const geometry::Point<Dim>&, const geometry::Vector<Dim>&)> function) {
  return [function = std::move(function)]() -> quadrature::Integrand<Dim> {
    return [function](const Eigen::Ref<const geometry::Points<Dim>>& points,
                      const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      for (Eigen::Index q = 0; q < points.cols(); ++q)
        values[static_cast<std::size_t>(q)] = function(points.col(q), normals.col(q));
    };
  };
}

/// A condition of one kind for every component with the field's data. Robin's coefficient is 1 + |x|^2; `robin_sign`
/// is -1 in exterior problems.
template <int Dim>
Condition<Dim> condition_from(const ExactField<Dim>& field, const Equation<Dim>& equation, ConditionKind kind,
                              double robin_sign = 1.0,
                              const std::optional<Eigen::Matrix<double, Dim, Dim>>& frame = {}) {
  Condition<Dim> condition;
  condition.name = "exact";
  condition.frame = frame;
  const int components = component_count(equation);
  for (int c = 0; c < components; ++c) {
    const geometry::Vector<Dim> axis = component_axis(condition, c);
    const auto along = [axis, components](const Eigen::VectorXd& v) { return axis.head(components).dot(v); };
    const auto value = [field, along](const geometry::Point<Dim>& x, const geometry::Vector<Dim>&) {
      return along(field.value(x));
    };
    const auto flux = [field, along, equation](const geometry::Point<Dim>& x, const geometry::Vector<Dim>& n) {
      return along(flux_of(equation, field.gradient(x), n));
    };
    const auto coefficient = [](const geometry::Point<Dim>& x, const geometry::Vector<Dim>&) {
      return 1.0 + x.squaredNorm();
    };
    ComponentCondition<Dim>& component = condition.components.emplace_back();
    component.kind = kind;
    if (kind == ConditionKind::value) component.value = data<Dim>(value);
    if (kind == ConditionKind::flux) component.value = data<Dim>(flux);
    if (kind == ConditionKind::robin) {
      component.coefficient = data<Dim>(coefficient);
      component.value = data<Dim>([=](const geometry::Point<Dim>& x, const geometry::Vector<Dim>& n) {
        return value(x, n) + robin_sign * flux(x, n) / coefficient(x, n);
      });
    }
  }
  return condition;
}

template <int Dim>
FieldSpace<Dim> space_on(const geometry::Boundary<Dim>& boundary, int degree, int refine) {
  DiscretisationOptions<Dim> options;
  options.degree = degree;
  options.refine = refine;
  return field_space(geometry::orient(boundary), options);
}

/// The same conditions everywhere, or kinds[patch % kinds.size()].
template <int Dim>
Problem<Dim> problem_from(const ExactField<Dim>& field, const Equation<Dim>& equation, const FieldSpace<Dim>& space,
                          const std::vector<ConditionKind>& kinds, bool exterior = false) {
  Problem<Dim> problem;
  problem.equation = equation;
  problem.exterior = exterior;
  for (const ConditionKind kind : kinds)
    problem.conditions.push_back(condition_from(field, equation, kind, exterior ? -1.0 : 1.0));
  for (const auto& element : space.table.elements)
    problem.condition_of.push_back(element.patch % static_cast<std::int32_t>(kinds.size()));
  return problem;
}

template <int Dim>
Equation<Dim> laplace_on(const FieldSpace<Dim>& space, double conductivity = 1.0) {
  return Laplace<Dim>{conductivity, logarithm_length(space.table)};
}
template <int Dim>
Equation<Dim> elasticity_on(const FieldSpace<Dim>& space, double shear_modulus = 1.0, double poisson = 0.3) {
  return Elasticity<Dim>{shear_modulus, poisson, logarithm_length(space.table)};
}

/// Relative errors in L2 over the boundary.
struct Errors {
  double potential = 0.0;
  double flux = 0.0;
};

template <int Dim>
Errors errors_of(const Solution<Dim>& solution, const ExactField<Dim>& field, const Problem<Dim>& problem,
                 const FieldSpace<Dim>& space) {
  const quadrature::TargetRules<Dim> rules(space.table, {1e-12, 8});
  const int components = component_count(problem.equation);
  double u_error = 0.0;
  double u_norm = 0.0;
  double t_error = 0.0;
  double t_norm = 0.0;
  std::vector<double> basis;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const quadrature::NodeView<Dim> nodes = rules.far_nodes(e, 0.5 * rules.sphere(e).radius);
    const auto functions = space.functions_of(e);
    basis.resize(functions.size());
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      geometry::Point<Dim> y;
      geometry::Vector<Dim> n;
      geometry::Point<Dim - 1> place;
      for (int d = 0; d < Dim; ++d) {
        y[d] = nodes.position[static_cast<std::size_t>(d)][q];
        n[d] = nodes.normal[static_cast<std::size_t>(d)][q];
        if (d < Dim - 1) place[d] = nodes.place[static_cast<std::size_t>(d)][q];
      }
      basis_values(space, e, place, std::span<double>(basis));
      Eigen::VectorXd u = Eigen::VectorXd::Zero(components);
      Eigen::VectorXd t = u;
      for (std::size_t a = 0; a < functions.size(); ++a) {
        u += basis[a] * solution.potential.row(functions[a]).transpose();
        t += basis[a] * solution.flux.row(functions[a]).transpose();
      }
      const Eigen::VectorXd u_exact = field.value(y);
      const Eigen::VectorXd t_exact = flux_of(problem.equation, field.gradient(y), n);
      u_error += nodes.weight[q] * (u - u_exact).squaredNorm();
      u_norm += nodes.weight[q] * u_exact.squaredNorm();
      t_error += nodes.weight[q] * (t - t_exact).squaredNorm();
      t_norm += nodes.weight[q] * t_exact.squaredNorm();
    }
  }
  // Some weights on cut elements are negative, so may be a sum of rounding errors.
  return {std::sqrt(std::abs(u_error / u_norm)), std::sqrt(std::abs(t_error / t_norm))};
}

/// u = A x + b, one row of A a component.
template <int Dim>
ExactField<Dim> linear_field(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& constant) {
  return {[=](const geometry::Point<Dim>& x) -> Eigen::VectorXd { return matrix * x + constant; },
          [=](const geometry::Point<Dim>&) -> Eigen::MatrixXd { return matrix; }};
}

/// The field less its mean motions over the boundary, which pure Neumann problems set to zero.
template <int Dim>
ExactField<Dim> without_motions(const ExactField<Dim>& field, const Problem<Dim>& problem,
                                const FieldSpace<Dim>& space) {
  const std::vector<RigidMotion<Dim>> motions = free_motions(problem, space);
  const quadrature::TargetRules<Dim> rules(space.table, {1e-12, 8});
  const auto count = static_cast<Eigen::Index>(motions.size());
  const int components = component_count(problem.equation);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd work = Eigen::VectorXd::Zero(count);
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const quadrature::NodeView<Dim> nodes = rules.far_nodes(e, 0.5 * rules.sphere(e).radius);
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      geometry::Point<Dim> y;
      for (int d = 0; d < Dim; ++d) y[d] = nodes.position[static_cast<std::size_t>(d)][q];
      Eigen::MatrixXd moved(components, count);
      moved.setZero();
      for (Eigen::Index k = 0; k < count; ++k)
        if (motions[static_cast<std::size_t>(k)].moves(space.body_of(e)))
          moved.col(k) = motions[static_cast<std::size_t>(k)](y).head(components);
      gram += nodes.weight[q] * moved.transpose() * moved;
      work += nodes.weight[q] * moved.transpose() * field.value(y);
    }
  }
  const Eigen::VectorXd factors = gram.ldlt().solve(work);
  return {[=](const geometry::Point<Dim>& x) {
            Eigen::VectorXd u = field.value(x);
            for (Eigen::Index k = 0; k < count; ++k)
              u -= factors[k] * motions[static_cast<std::size_t>(k)](x).head(components);
            return u;
          },
          field.gradient};
}

/// Slope of log(error) against log(size), by least squares.
inline double observed_order(const std::vector<double>& sizes, const std::vector<double>& errors) {
  const auto n = static_cast<double>(sizes.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]);
    const double y = std::log(errors[i]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace isorim::solver::test
