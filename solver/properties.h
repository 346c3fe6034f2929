#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/estimate.h"
#include "quadrature/options.h"

namespace isorim::solver {

/// What a closed boundary encloses. Lengths in the unit of the shape; density 1.
template <int Dim>
struct DomainProperties {
  /// Area (Dim = 2) or volume (Dim = 3).
  quadrature::Estimate measure;
  geometry::Point<Dim> centroid;
  geometry::Vector<Dim> centroid_error;
  /// About the centroid. Dim = 3: I = int (r.r 1 - r r^T) dV. Dim = 2: the area moments
  /// [[int y^2, -int x y], [-int x y, int x^2]].
  Eigen::Matrix<double, Dim, Dim> inertia;
  /// One estimate for every entry of the tensor.
  double inertia_error = 0.0;
  /// Eigenvalues of the inertia in increasing order, and their axes as the columns of a rotation.
  geometry::Vector<Dim> principal_moments;
  Eigen::Matrix<double, Dim, Dim> principal_axes;
};

template <int Dim>
struct GeometricProperties {
  /// Perimeter (Dim = 2) or area (Dim = 3) of the boundary.
  quadrature::Estimate boundary_measure;
  /// Absent unless asked for.
  std::optional<DomainProperties<Dim>> domain;
  /// |int n dS| / int dS: zero but for rounding on a closed boundary; what gaps cost otherwise.
  double closure_defect = 0.0;
  /// What the gaps may cost, apart from the errors of the quadrature: the change of the enclosed measure (absolute, in
  /// the unit of length to the power Dim) when the pole moves by the diagonal d of the bounding box,
  /// |int n dS| d / Dim. (Moved by a, it changes by -a . int n dS / Dim.) Zero but for rounding on a closed boundary.
  double pole_shift = 0.0;
  /// Points of the boundary at which its position and tangents were evaluated.
  std::int64_t evaluations = 0;
  quadrature::Status boundary_status = quadrature::Status::converged;
  quadrature::Status domain_status = quadrature::Status::converged;
};

template <int Dim>
struct PropertyOptions {
  quadrature::Options integration;
  /// The pole of the radial integration; the middle of the bounding box if absent. The result does not depend on it
  /// when the boundary is closed.
  std::optional<geometry::Point<Dim>> pole;
  /// false for an open boundary, which encloses nothing: only the boundary's measure is computed.
  enum class Scope { boundary_only, boundary_and_domain } scope = Scope::boundary_and_domain;
};

/// Perimeter, area, centroid and second moments (Dim = 2), or area, volume, centroid and inertia (Dim = 3) by the
/// radial integration method, all in one pass over the elements and in parallel.
///
/// A boundary with gaps is integrated like a closed one; closure_defect and pole_shift tell what that is worth.
///
/// Throws GeometryError if the enclosed measure is not positive beyond its error (a boundary turned inside out or
/// without content): callers orient first, see geometry/topology/orientation.h.
template <int Dim>
GeometricProperties<Dim> geometric_properties(const geometry::ElementTable<Dim>& table,
                                              const PropertyOptions<Dim>& options = {});

}  // namespace isorim::solver
