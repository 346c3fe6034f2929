#include "solver/bem/simple_solution.h"

#include <variant>

namespace isorim::solver {

namespace {

template <int Dim>
double lame(const Elasticity<Dim>& kernel) {
  return 2.0 * kernel.shear_modulus * kernel.poisson / (1.0 - 2.0 * kernel.poisson);
}

/// Columns: the vectors in the tangent plane that are dual to the tangents.
template <int Dim>
Eigen::Matrix<double, Dim, Dim - 1> dual(const Eigen::Matrix<double, Dim, Dim - 1>& tangents) {
  if constexpr (Dim == 2) {
    return tangents / tangents.squaredNorm();
  } else {
    const Eigen::Matrix2d metric = tangents.transpose() * tangents;
    const double determinant = metric(0, 0) * metric(1, 1) - metric(0, 1) * metric(1, 0);
    Eigen::Matrix2d inverse;
    inverse << metric(1, 1), -metric(0, 1), -metric(1, 0), metric(0, 0);
    return tangents * inverse / determinant;
  }
}

/// The derivative w along the normal n that gives the traction t, with A the gradient in the tangent plane (A n = 0):
/// mu A^T n + lambda tr(A) n + mu w + (lambda + mu) (w . n) n = t.
template <int Dim>
geometry::Vector<Dim> normal_derivative(const Elasticity<Dim>& kernel, const Eigen::Matrix<double, Dim, Dim>& along,
                                        const geometry::Vector<Dim>& normal, const geometry::Vector<Dim>& traction) {
  const double mu = kernel.shear_modulus;
  const double lambda = lame(kernel);
  const geometry::Vector<Dim> rest = traction - mu * along.transpose() * normal - lambda * along.trace() * normal;
  const double along_normal = rest.dot(normal) / (lambda + 2.0 * mu);
  return (rest - (lambda + mu) * along_normal * normal) / mu;
}

}  // namespace

template <int Dim>
Eigen::MatrixXd stress_of(const Elasticity<Dim>& kernel, const Eigen::MatrixXd& gradient, double uniform_stress) {
  const double pressure = lame(kernel) * gradient.trace() - uniform_stress;
  return kernel.shear_modulus * (gradient + gradient.transpose()) + pressure * Eigen::MatrixXd::Identity(Dim, Dim);
}

template <int Dim>
void set_stress(const Problem<Dim>& problem, double uniform_stress, FieldValue<Dim>& field) {
  const auto* kernel = std::get_if<Elasticity<Dim>>(&problem.equation);
  if (!kernel) return;
  field.stress = stress_of(*kernel, field.gradient, uniform_stress);
  if (Dim == 2 && problem.plane_state == PlaneState::strain)
    field.stress_across = lame(*kernel) * field.gradient.trace() - uniform_stress;
}

template <int Dim>
SimpleSolution<Dim> simple_solution(const Equation<Dim>& equation, const geometry::Point<Dim>& centre,
                                    const Eigen::VectorXd& value, const Eigen::MatrixXd& gradient,
                                    double uniform_stress) {
  SimpleSolution<Dim> simple{centre, value, gradient, {}};
  if (const auto* laplace = std::get_if<Laplace<Dim>>(&equation)) simple.stress = laplace->conductivity * gradient;
  if (const auto* elastic = std::get_if<Elasticity<Dim>>(&equation))
    simple.stress = stress_of(*elastic, gradient, uniform_stress);
  return simple;
}

template <int Dim>
Eigen::MatrixXd boundary_gradient(const Equation<Dim>& equation, const Eigen::Matrix<double, Dim, Dim - 1>& tangents,
                                  const geometry::Vector<Dim>& normal, const Eigen::MatrixXd& derivatives,
                                  const Eigen::VectorXd& flux, double uniform_stress) {
  const Eigen::MatrixXd along = derivatives * dual<Dim>(tangents).transpose();
  if (const auto* laplace = std::get_if<Laplace<Dim>>(&equation))
    return along + flux / laplace->conductivity * normal.transpose();
  const auto& elastic = std::get<Elasticity<Dim>>(equation);
  const Eigen::Matrix<double, Dim, Dim> tangential = along;
  const geometry::Vector<Dim> traction = flux + uniform_stress * normal;
  return tangential + normal_derivative<Dim>(elastic, tangential, normal, traction) * normal.transpose();
}

template Eigen::MatrixXd stress_of(const Elasticity<2>&, const Eigen::MatrixXd&, double);
template Eigen::MatrixXd stress_of(const Elasticity<3>&, const Eigen::MatrixXd&, double);
template void set_stress(const Problem<2>&, double, FieldValue<2>&);
template void set_stress(const Problem<3>&, double, FieldValue<3>&);
template SimpleSolution<2> simple_solution(const Equation<2>&, const geometry::Point<2>&, const Eigen::VectorXd&,
                                           const Eigen::MatrixXd&, double);
template SimpleSolution<3> simple_solution(const Equation<3>&, const geometry::Point<3>&, const Eigen::VectorXd&,
                                           const Eigen::MatrixXd&, double);
template Eigen::MatrixXd boundary_gradient<2>(const Equation<2>&, const Eigen::Matrix<double, 2, 1>&,
                                              const geometry::Vector<2>&, const Eigen::MatrixXd&,
                                              const Eigen::VectorXd&, double);
template Eigen::MatrixXd boundary_gradient<3>(const Equation<3>&, const Eigen::Matrix<double, 3, 2>&,
                                              const geometry::Vector<3>&, const Eigen::MatrixXd&,
                                              const Eigen::VectorXd&, double);

}  // namespace isorim::solver
