#include "solver/properties.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/boundary_sums.h"

namespace isorim::solver {

namespace {

using quadrature::BoundarySums;
using quadrature::Status;
using quadrature::SumLayout;

template <int Dim>
using Tensor = Eigen::Matrix<double, Dim, Dim>;

/// int x x^T over the domain about the pole, from the sums; or the tensor of their errors.
template <int Dim>
Tensor<Dim> second_moments(const quadrature::ElementSums<Dim>& sums) {
  Tensor<Dim> moments;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) {
      const int index = i <= j ? SumLayout<Dim>::second_index(i, j) : SumLayout<Dim>::second_index(j, i);
      moments(i, j) = sums[index] / (Dim + 2);
    }
  }
  return moments;
}

/// tr(M) 1 - M: the inertia tensor in space, [[int y^2, -int x y], [-int x y, int x^2]] in the plane.
template <int Dim>
Tensor<Dim> inertia_from(const Tensor<Dim>& second_moments) {
  return second_moments.trace() * Tensor<Dim>::Identity() - second_moments;
}

template <int Dim>
void set_principal_axes(DomainProperties<Dim>& properties) {
  const Eigen::SelfAdjointEigenSolver<Tensor<Dim>> eigen(properties.inertia);
  properties.principal_moments = eigen.eigenvalues();
  properties.principal_axes = eigen.eigenvectors();
  if (properties.principal_axes.determinant() < 0.0) properties.principal_axes.col(Dim - 1) *= -1.0;
}

template <int Dim>
DomainProperties<Dim> domain_properties(const BoundarySums<Dim>& sums, const geometry::Point<Dim>& pole) {
  using Layout = SumLayout<Dim>;
  DomainProperties<Dim> result;
  const double measure = sums.value[Layout::content] / Dim;
  const double measure_error = sums.error[Layout::content] / Dim;
  if (!(measure > measure_error)) {
    throw GeometryError(
        fmt::format("the boundary encloses {:.6g} with an error of {:.2g}; expected a positive {}, so its normals "
                    "point inwards or it is without content",
                    measure, measure_error, Dim == 2 ? "area" : "volume"));
  }
  result.measure = {measure, measure_error};
  const geometry::Vector<Dim> offset = sums.value.template segment<Dim>(Layout::first).matrix() / ((Dim + 1) * measure);
  const geometry::Vector<Dim> first_error = sums.error.template segment<Dim>(Layout::first).matrix() / (Dim + 1);
  result.centroid = pole + offset;
  result.centroid_error = (first_error + measure_error * offset.cwiseAbs()) / measure +
                          std::numeric_limits<double>::epsilon() * result.centroid.cwiseAbs();
  const Tensor<Dim> about_pole = second_moments<Dim>(sums.value);
  result.inertia = inertia_from<Dim>(about_pole - measure * offset * offset.transpose());
  const double shift_error = offset.norm() * (2.0 * first_error.norm() + measure_error * offset.norm());
  const double cancellation = 4.0 * std::numeric_limits<double>::epsilon() * about_pole.trace();
  result.inertia_error = second_moments<Dim>(sums.error).trace() + shift_error + cancellation;
  set_principal_axes(result);
  return result;
}

/// What an estimate says about the tolerance, where nothing is known to be exact.
Status status_of(double relative_error, const quadrature::Options& options) {
  if (options.fixed_points > 0) return Status::fixed_rule;
  return relative_error <= options.tolerance ? Status::converged : Status::tolerance_not_reached;
}

template <int Dim>
Status domain_status(const BoundarySums<Dim>& sums, const DomainProperties<Dim>& domain, double size,
                     const quadrature::Options& options) {
  const double worst = std::max({domain.measure.error / domain.measure.value, domain.centroid_error.maxCoeff() / size,
                                 domain.inertia_error / domain.inertia.trace()});
  const Status status = status_of(worst, options);
  return sums.exact && status == Status::converged ? Status::exact : status;
}

}  // namespace

template <int Dim>
GeometricProperties<Dim> geometric_properties(const geometry::ElementTable<Dim>& table,
                                              const PropertyOptions<Dim>& options) {
  using Layout = SumLayout<Dim>;
  const bool with_domain = options.scope == PropertyOptions<Dim>::Scope::boundary_and_domain;
  const geometry::BoundingBox<Dim> box = geometry::bounding_box(table);
  const geometry::Point<Dim> pole = options.pole.value_or(box.middle());
  const BoundarySums<Dim> sums = quadrature::boundary_sums<Dim>(
      table, pole, with_domain ? quadrature::SumScope::all : quadrature::SumScope::measure_only, options.integration);

  GeometricProperties<Dim> result;
  result.boundary_measure = {sums.value[Layout::measure], sums.error[Layout::measure]};
  result.closure_defect =
      sums.value.template segment<Dim>(Layout::normal).matrix().norm() / result.boundary_measure.value;
  result.evaluations = sums.evaluations;
  result.boundary_status =
      status_of(result.boundary_measure.error / result.boundary_measure.value, options.integration);
  if (with_domain) {
    result.domain = domain_properties<Dim>(sums, pole);
    result.domain_status = domain_status<Dim>(sums, *result.domain, box.diagonal(), options.integration);
  }
  return result;
}

template GeometricProperties<2> geometric_properties(const geometry::ElementTable<2>&, const PropertyOptions<2>&);
template GeometricProperties<3> geometric_properties(const geometry::ElementTable<3>&, const PropertyOptions<3>&);

}  // namespace isorim::solver
