#pragma once

#include <cstddef>
#include <functional>

#include <Eigen/Core>
#include <Eigen/LU>

#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"
#include "tests/solver/bem/exact_fields.h"

/// Problems with known solutions, and these as functions of a space without a solve.
namespace isorim::solver::testing {

/// The coefficients whose function takes these values (function_count x components) at the collocation points.
template <int Dim>
Eigen::MatrixXd interpolate(const FieldSpace<Dim>& space, const Eigen::MatrixXd& values) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(space.function_count(), space.function_count());
  for (int i = 0; i < space.function_count(); ++i) {
    const CollocationPoint<Dim>& point = space.points[static_cast<std::size_t>(i)];
    const auto functions = space.functions_of(point.element);
    std::vector<double> basis(functions.size());
    basis_values(space, point.element, point.place, std::span<double>(basis));
    for (std::size_t a = 0; a < functions.size(); ++a) matrix(i, functions[a]) = basis[a];
  }
  return matrix.partialPivLu().solve(values);
}

/// Which kind of condition a component has on an element.
using KindOf = std::function<ConditionKind(int element, int component)>;

/// The problem that an exact field solves, with data from functions: one condition for every set of kinds.
template <class Kernel>
Problem<Kernel::dimension> exact_problem(const Kernel& kernel, const FieldSpace<Kernel::dimension>& space,
                                         const ExactField<Kernel::dimension>& field, const KindOf& kind_of,
                                         bool exterior = false) {
  constexpr int dimension = Kernel::dimension;
  Problem<dimension> problem;
  problem.equation = kernel;
  problem.exterior = exterior;
  std::vector<std::vector<ConditionKind>> known;
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    std::vector<ConditionKind> kinds;
    for (int c = 0; c < Kernel::components; ++c) kinds.push_back(kind_of(static_cast<int>(e), c));
    std::size_t number = 0;
    while (number < known.size() && known[number] != kinds) ++number;
    if (number == known.size()) {
      known.push_back(kinds);
      Condition<dimension> condition;
      condition.name = "condition " + std::to_string(number);
      for (int c = 0; c < Kernel::components; ++c) {
        ComponentCondition<dimension> component;
        component.kind = kinds[static_cast<std::size_t>(c)];
        component.value = integrand<dimension>([=](const Point<dimension>& x, const Vector<dimension>& n) {
          if (component.kind == ConditionKind::value) return field.value(x)[c];
          const double given = flux(kernel, field.gradient(x), n)[c];
          // Robin with the coefficient 2: t = 2 (reference - u), in exterior problems its opposite.
          return component.kind == ConditionKind::flux ? given : (exterior ? -0.5 : 0.5) * given + field.value(x)[c];
        });
        if (component.kind == ConditionKind::robin)
          component.coefficient =
              integrand<dimension>([](const Point<dimension>&, const Vector<dimension>&) { return 2.0; });
        condition.components.push_back(component);
      }
      problem.conditions.push_back(condition);
    }
    problem.condition_of.push_back(static_cast<std::int32_t>(number));
  }
  return problem;
}

/// The field's interpolant in the space.
template <class Kernel>
Solution<Kernel::dimension> exact_solution(const Kernel& kernel, const FieldSpace<Kernel::dimension>& space,
                                           const ExactField<Kernel::dimension>& field) {
  Eigen::MatrixXd value(space.function_count(), Kernel::components);
  Eigen::MatrixXd traction(space.function_count(), Kernel::components);
  for (int i = 0; i < space.function_count(); ++i) {
    const auto& point = space.points[static_cast<std::size_t>(i)];
    value.row(i) = field.value(point.position).transpose();
    traction.row(i) = flux(kernel, field.gradient(point.position), point.normal).transpose();
  }
  Solution<Kernel::dimension> solution;
  solution.potential = interpolate(space, value);
  solution.flux = interpolate(space, traction);
  solution.at_infinity = Eigen::VectorXd::Zero(Kernel::components);
  return solution;
}

/// x . Q x with Q symmetric and without trace: harmonic.
template <int Dim>
ExactField<Dim> harmonic_quadratic(const Laplace<Dim>&, const Eigen::Matrix<double, Dim, Dim>& q) {
  return {"harmonic quadratic",
          [=](const Point<Dim>& x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, x.dot((q * x).eval())); },
          [=](const Point<Dim>& x) -> Eigen::MatrixXd { return 2.0 * (q * x).transpose(); },
          [](const Point<Dim>&) -> Eigen::VectorXd { return Eigen::VectorXd::Zero(1); }};
}

/// The gradient of a harmonic polynomial x y (in space + c y z): a displacement without force, without divergence.
template <int Dim>
ExactField<Dim> harmonic_displacement(const Elasticity<Dim>&) {
  const auto value = [](const Point<Dim>& x) -> Eigen::VectorXd {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(Dim);
    u[0] = x[0] * x[0] - x[1] * x[1];
    u[1] = -2.0 * x[0] * x[1];
    if constexpr (Dim == 3) u[2] = 0.3;
    return u;
  };
  const auto gradient = [](const Point<Dim>& x) -> Eigen::MatrixXd {
    Eigen::MatrixXd g = Eigen::MatrixXd::Zero(Dim, Dim);
    g(0, 0) = 2.0 * x[0];
    g(0, 1) = -2.0 * x[1];
    g(1, 0) = -2.0 * x[1];
    g(1, 1) = -2.0 * x[0];
    return g;
  };
  return {"harmonic displacement", value, gradient,
          [](const Point<Dim>&) -> Eigen::VectorXd { return Eigen::VectorXd::Zero(Dim); }};
}

}  // namespace isorim::solver::testing
