#pragma once

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/problem.h"

namespace isorim::solver {

/// Stress of a displacement's gradient, for what a uniform temperature adds see LoadIntegrand::uniform_stress().
template <int Dim>
Eigen::MatrixXd stress_of(const Elasticity<Dim>& kernel, const Eigen::MatrixXd& gradient, double uniform_stress);

/// Sets stress and stress_across from the gradient; nothing for potentials.
template <int Dim>
void set_stress(const Problem<Dim>& problem, double uniform_stress, FieldValue<Dim>& field);

/// A linear field, and the matrix that makes its flux of a normal: flux = stress n.
template <int Dim>
struct SimpleSolution {
  geometry::Point<Dim> centre = geometry::Point<Dim>::Zero();
  Eigen::VectorXd value;
  /// components x Dim.
  Eigen::MatrixXd gradient;
  Eigen::MatrixXd stress;

  /// Constant and without flux.
  bool is_uniform() const { return gradient.isZero(0.0) && stress.isZero(0.0); }
  Eigen::VectorXd at(const geometry::Point<Dim>& y) const { return value + gradient * (y - centre); }
};

/// The one with that value and gradient at the centre, under a uniform temperature.
template <int Dim>
SimpleSolution<Dim> simple_solution(const Equation<Dim>& equation, const geometry::Point<Dim>& centre,
                                    const Eigen::VectorXd& value, const Eigen::MatrixXd& gradient,
                                    double uniform_stress);

/// The gradient (components x Dim) at a point of the boundary with that flux or traction and those derivatives of the
/// value along tangents (components x (Dim - 1), tangents Dim x (Dim - 1)).
template <int Dim>
Eigen::MatrixXd boundary_gradient(const Equation<Dim>& equation, const Eigen::Matrix<double, Dim, Dim - 1>& tangents,
                                  const geometry::Vector<Dim>& normal, const Eigen::MatrixXd& derivatives,
                                  const Eigen::VectorXd& flux, double uniform_stress);

}  // namespace isorim::solver
