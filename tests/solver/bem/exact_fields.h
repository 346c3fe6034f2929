#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/vocabulary.h"
#include "quadrature/rim.h"
#include "solver/bem/kernels.h"

/// Solutions that are known everywhere, and what they prescribe.
namespace isorim::solver::testing {

using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector;

/// A potential or displacement with its gradient (row i that of component i) and its load b.
template <int Dim>
struct ExactField {
  std::string name;
  std::function<Eigen::VectorXd(const Point<Dim>&)> value;
  std::function<Eigen::MatrixXd(const Point<Dim>&)> gradient;
  std::function<Eigen::VectorXd(const Point<Dim>&)> load;
};

template <int Dim>
Eigen::VectorXd flux(const Laplace<Dim>& kernel, const Eigen::MatrixXd& gradient, const Vector<Dim>& normal) {
  return kernel.conductivity * gradient * normal;
}

/// Hooke's law: 2 mu e + lambda tr(e) 1.
template <int Dim>
Eigen::MatrixXd stress(const Elasticity<Dim>& kernel, const Eigen::MatrixXd& gradient) {
  const double lambda = 2.0 * kernel.shear_modulus * kernel.poisson / (1.0 - 2.0 * kernel.poisson);
  return kernel.shear_modulus * (gradient + gradient.transpose()) +
         lambda * gradient.trace() * Eigen::MatrixXd::Identity(Dim, Dim);
}
template <int Dim>
Eigen::VectorXd flux(const Elasticity<Dim>& kernel, const Eigen::MatrixXd& gradient, const Vector<Dim>& normal) {
  return stress(kernel, gradient) * normal;
}

/// A function of place (and normal) as an integrand, one point at a time.
template <int Dim>
quadrature::IntegrandFactory<Dim> integrand(std::function<double(const Point<Dim>&, const Vector<Dim>&)> f) {
  return [f = std::move(f)] {
    return [f](const Eigen::Ref<const geometry::Points<Dim>>& points,
               const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values) {
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Vector<Dim> n = normals.cols() > 0 ? Vector<Dim>(normals.col(i)) : Vector<Dim>(Vector<Dim>::Zero());
        values[static_cast<std::size_t>(i)] = f(points.col(i), n);
      }
    };
  };
}

/// The field's load, component by component.
template <int Dim>
std::vector<quadrature::IntegrandFactory<Dim>> load_density(const ExactField<Dim>& field, int components) {
  std::vector<quadrature::IntegrandFactory<Dim>> density;
  for (int c = 0; c < components; ++c)
    density.push_back(
        integrand<Dim>([load = field.load, c](const Point<Dim>& x, const Vector<Dim>&) { return load(x)[c]; }));
  return density;
}

/// exp(a . x) sin(b . x + phase): a potential with a load everywhere.
template <int Dim>
ExactField<Dim> wave_potential(const Laplace<Dim>& kernel, const Vector<Dim>& a, const Vector<Dim>& b, double phase) {
  const double k = kernel.conductivity;
  return {"wave",
          [=](const Point<Dim>& x) -> Eigen::VectorXd {
            return Eigen::VectorXd::Constant(1, std::exp(a.dot(x)) * std::sin(b.dot(x) + phase));
          },
          [=](const Point<Dim>& x) -> Eigen::MatrixXd {
            const double e = std::exp(a.dot(x));
            return (e * (std::sin(b.dot(x) + phase) * a + std::cos(b.dot(x) + phase) * b)).transpose();
          },
          [=](const Point<Dim>& x) -> Eigen::VectorXd {
            const double e = std::exp(a.dot(x));
            const double second = (a.squaredNorm() - b.squaredNorm()) * std::sin(b.dot(x) + phase) +
                                  2.0 * a.dot(b) * std::cos(b.dot(x) + phase);
            return Eigen::VectorXd::Constant(1, -k * e * second);
          }};
}

/// v sin(b . x + phase), a displacement with a load everywhere (Navier's equation).
template <int Dim>
ExactField<Dim> wave_displacement(const Elasticity<Dim>& kernel, const Vector<Dim>& v, const Vector<Dim>& b,
                                  double phase) {
  const double mu = kernel.shear_modulus;
  const double lambda = 2.0 * mu * kernel.poisson / (1.0 - 2.0 * kernel.poisson);
  return {"elastic wave", [=](const Point<Dim>& x) -> Eigen::VectorXd { return v * std::sin(b.dot(x) + phase); },
          [=](const Point<Dim>& x) -> Eigen::MatrixXd { return v * b.transpose() * std::cos(b.dot(x) + phase); },
          [=](const Point<Dim>& x) -> Eigen::VectorXd {
            return (mu * b.squaredNorm() * v + (lambda + mu) * b.dot(v) * b) * std::sin(b.dot(x) + phase);
          }};
}

}  // namespace isorim::solver::testing
