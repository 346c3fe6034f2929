#include "geometry/nurbs/rational_removal.h"

#include <algorithm>
#include <utility>

#include "geometry/spline/knot_removal.h"

namespace isorim::geometry {

namespace {

/// The coefficients as (Dim + 1) x count homogeneous points.
template <int Dim>
Eigen::Map<const HomogeneousPoints<Dim>> points_of(const BSpline& spline) {
  return {spline.coefficients.data(), Dim + 1, spline.coefficients.size() / (Dim + 1)};
}

/// How far a point moves at most in space when the homogeneous points move by 1.
template <int Dim>
double amplification(const Eigen::Map<const HomogeneousPoints<Dim>>& before,
                     const Eigen::Map<const HomogeneousPoints<Dim>>& after) {
  const double smallest_weight = std::min(before.row(Dim).minCoeff(), after.row(Dim).minCoeff());
  if ((before.row(Dim).array() == before(Dim, 0)).all()) return 1.0 / smallest_weight;
  const double reach = (before.template topRows<Dim>().colwise().norm().array() / before.row(Dim).array()).maxCoeff();
  return (1.0 + reach) / smallest_weight;
}

}  // namespace

template <int Dim>
KnotRemoval remove_rational_knot(BSpline spline, double u, int times, double tolerance) {
  require_inner_knot(spline.knots, u);
  KnotRemoval result{std::move(spline), 0, 0.0};
  while (result.removed < times && result.spline.knots.multiplicity(u) > 0) {
    SingleRemoval candidate = remove_knot_once(result.spline, u, Dim + 1);
    const auto after = points_of<Dim>(candidate.spline);
    if (!(after.row(Dim).minCoeff() > 0.0)) break;
    const double bound =
        result.error_bound + amplification<Dim>(points_of<Dim>(result.spline), after) * candidate.largest_move;
    if (!(bound <= tolerance)) break;
    result = {std::move(candidate.spline), result.removed + 1, bound};
  }
  return result;
}

template KnotRemoval remove_rational_knot<2>(BSpline, double, int, double);
template KnotRemoval remove_rational_knot<3>(BSpline, double, int, double);

}  // namespace isorim::geometry
