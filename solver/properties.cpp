#include "solver/properties.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/boundary_sums.h"

namespace isorim::solver {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

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

/// Errors of measure, centroid and inertia.
template <int Dim>
struct DomainErrors {
  double measure = 0.0;
  geometry::Vector<Dim> centroid;
  double inertia = 0.0;
};

/// How errors of the sums pass on to what is made from them; `offset` is the centroid relative to the pole.
template <int Dim>
DomainErrors<Dim> propagate(const quadrature::ElementSums<Dim>& sum_errors, double measure,
                            const geometry::Vector<Dim>& offset) {
  using Layout = SumLayout<Dim>;
  DomainErrors<Dim> errors;
  errors.measure = sum_errors[Layout::content] / Dim;
  const geometry::Vector<Dim> first = sum_errors.template segment<Dim>(Layout::first).matrix() / (Dim + 1);
  errors.centroid = (first + errors.measure * offset.cwiseAbs()) / measure;
  errors.inertia =
      second_moments<Dim>(sum_errors).trace() + offset.norm() * (2.0 * first.norm() + errors.measure * offset.norm());
  return errors;
}

template <int Dim>
DomainProperties<Dim> domain_properties(const BoundarySums<Dim>& sums, const geometry::Point<Dim>& pole) {
  using Layout = SumLayout<Dim>;
  DomainProperties<Dim> result;
  const double measure = sums.value[Layout::content] / Dim;
  const geometry::Vector<Dim> offset = sums.value.template segment<Dim>(Layout::first).matrix() / ((Dim + 1) * measure);
  const DomainErrors<Dim> errors = propagate<Dim>(sums.error, measure, offset);
  if (!(measure > errors.measure)) {
    throw GeometryError(
        fmt::format("the boundary encloses {:.6g} with an error of {:.2g}; expected a positive {}, so its normals "
                    "point inwards or it is without content",
                    measure, errors.measure, Dim == 2 ? "area" : "volume"));
  }
  result.measure = {measure, errors.measure};
  result.centroid = pole + offset;
  result.centroid_error = errors.centroid + epsilon * result.centroid.cwiseAbs();
  const Tensor<Dim> about_pole = second_moments<Dim>(sums.value);
  result.inertia = inertia_from<Dim>(about_pole - measure * offset * offset.transpose());
  result.inertia_error = errors.inertia + 4.0 * epsilon * about_pole.trace();
  set_principal_axes(result);
  return result;
}

/// The worst of the statuses of measure, centroid and inertia.
template <int Dim>
Status domain_status(const BoundarySums<Dim>& sums, const DomainProperties<Dim>& domain, const DomainErrors<Dim>& noise,
                     double size, const quadrature::Options& options) {
  const double tolerance = options.tolerance;
  const Status status = std::max(
      {quadrature::judge(domain.measure.error, tolerance * domain.measure.value, noise.measure, options),
       quadrature::judge(domain.centroid_error.maxCoeff(), tolerance * size, noise.centroid.maxCoeff(), options),
       quadrature::judge(domain.inertia_error, tolerance * domain.inertia.trace(), noise.inertia, options)});
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
  const double total_normal = sums.value.template segment<Dim>(Layout::normal).matrix().norm();
  result.closure_defect = total_normal / result.boundary_measure.value;
  result.pole_shift = total_normal * box.diagonal() / Dim;
  result.evaluations = sums.evaluations;
  result.boundary_status =
      quadrature::judge(result.boundary_measure.error, options.integration.tolerance * result.boundary_measure.value,
                        sums.rounding[Layout::measure], options.integration);
  if (sums.exact_measure && result.boundary_status == Status::converged) result.boundary_status = Status::exact;
  if (with_domain) {
    result.domain = domain_properties<Dim>(sums, pole);
    const geometry::Vector<Dim> offset = result.domain->centroid - pole;
    DomainErrors<Dim> noise = propagate<Dim>(sums.rounding, result.domain->measure.value, offset);
    noise.centroid += epsilon * result.domain->centroid.cwiseAbs();
    noise.inertia += 4.0 * epsilon * second_moments<Dim>(sums.value).trace();
    result.domain_status = domain_status<Dim>(sums, *result.domain, noise, box.diagonal(), options.integration);
  }
  return result;
}

template GeometricProperties<2> geometric_properties(const geometry::ElementTable<2>&, const PropertyOptions<2>&);
template GeometricProperties<3> geometric_properties(const geometry::ElementTable<3>&, const PropertyOptions<3>&);

}  // namespace isorim::solver
