#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/estimate.h"
#include "quadrature/options.h"

/// The radial integration method in its scaled form: with the pole x0 and d = x - x0,
///
///   3D:  int_Omega f dV = sum_e int int [ int_0^1 f(x0 + t d) t^2 dt ] d . (S_u x S_v) du dv
///   2D:  int_Omega f dA = sum_e int     [ int_0^1 f(x0 + t d) t   dt ] d x C_u du
///
/// (Gao, Eng. Anal. Bound. Elem. 26, 2002, eqs. 12 and 24; there divided by r, which the scaling makes needless.)
namespace isorim::quadrature {

/// A function of the place and, over a boundary, of the outward unit normal, evaluated for many points at once:
/// points and normals Dim x n (normals Dim x 0 over a domain), values n. It must be free of side effects; an object
/// serves one thread.
template <int Dim>
using Integrand = std::function<void(const Eigen::Ref<const geometry::Points<Dim>>& points,
                                     const Eigen::Ref<const geometry::Points<Dim>>& normals, std::span<double> values)>;

/// Makes an Integrand; called once for each thread that takes part (expressions are not shared between threads).
template <int Dim>
using IntegrandFactory = std::function<Integrand<Dim>()>;

struct IntegralResult {
  Estimate integral;
  /// Points at which the integrand was evaluated.
  std::int64_t evaluations = 0;
  Status status = Status::converged;
};

/// The pole of a domain integral when none is asked for: a point from which the whole boundary is seen, so that every
/// ray stays in the domain; the middle of the control net's bounding box itself if it is one, and also where none is
/// found (an annulus has none). Found from tangent planes at sampled points.
template <int Dim>
geometry::Point<Dim> default_pole(const geometry::ElementTable<Dim>& table);

/// int_Omega f over the domain that the closed boundary encloses.
///
/// The tolerance is relative to the integral, or to a hundredth of the integral of |f| where cancellation makes that
/// larger. The integrand is met on the rays from the pole to the boundary; where the domain is not star-shaped about
/// the pole these leave it, so the integrand must be defined there too. Throws NumericalError, naming the point and
/// whether the boundary is star-shaped about the pole, if a value is not finite.
///
/// Cut elements: rules with points all over the element are tried first; should the integrand not be finite at some,
/// rays in the element's cell, which stay in what is kept if that is star-shaped about some point of the cell.
template <int Dim>
IntegralResult integrate_over_domain(const geometry::ElementTable<Dim>& table, const IntegrandFactory<Dim>& integrand,
                                     const std::optional<geometry::Point<Dim>>& pole, const Options& options);

/// int f dS (dS the length or area element) over the boundary. Throws NumericalError as above.
template <int Dim>
IntegralResult integrate_over_boundary(const geometry::ElementTable<Dim>& table, const IntegrandFactory<Dim>& integrand,
                                       const Options& options);

/// No outward normal looks towards the pole, so the rays from it stay in the domain. Judged at sampled points.
template <int Dim>
bool is_star_shaped_about(const geometry::ElementTable<Dim>& table, const geometry::Point<Dim>& pole);

}  // namespace isorim::quadrature
