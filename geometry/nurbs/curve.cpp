#include "geometry/nurbs/curve.h"

#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/validation.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {

template <int Dim>
NurbsCurve<Dim>::NurbsCurve(KnotVector knots, HomogeneousPoints<Dim> homogeneous)
    : knots_(std::move(knots)), homogeneous_(std::move(homogeneous)) {
  if (homogeneous_.cols() != knots_.basis_count())
    throw GeometryError(fmt::format("NURBS curve: {} control points given; {} knots of degree {} need {}",
                                    homogeneous_.cols(), knots_.knots().size(), knots_.degree(), knots_.basis_count()));
  require_valid_net<Dim>(homogeneous_, "NURBS curve", [](Eigen::Index i) { return fmt::format("{}", i); });
}

template <int Dim>
NurbsCurve<Dim> NurbsCurve<Dim>::from_points(KnotVector knots, const Points<Dim>& points,
                                             std::span<const double> weights) {
  return {std::move(knots), homogeneous_net<Dim>(points, weights, "NURBS curve")};
}

template <int Dim>
Points<Dim> NurbsCurve<Dim>::control_points() const {
  return homogeneous_.template topRows<Dim>().array().rowwise() / homogeneous_.row(Dim).array();
}

template <int Dim>
bool NurbsCurve<Dim>::is_polynomial() const {
  return (homogeneous_.row(Dim).array() == homogeneous_(Dim, 0)).all();
}

template <int Dim>
Point<Dim> evaluate(const NurbsCurve<Dim>& curve, double u) {
  const LocalBasis<0> basis = local_basis<0>(curve.knots(), u);
  const Eigen::Matrix<double, Dim + 1, 1> value =
      curve.homogeneous().middleCols(basis.first, basis.table.rows()).lazyProduct(basis.table);
  return value.template head<Dim>() / value[Dim];
}

template <int Dim>
CurveJet<Dim> evaluate_jet(const NurbsCurve<Dim>& curve, double u) {
  const LocalBasis<2> basis = local_basis<2>(curve.knots(), u);
  const Eigen::Matrix<double, Dim + 1, 3> value =
      curve.homogeneous().middleCols(basis.first, basis.table.rows()).lazyProduct(basis.table);
  const auto coordinates = value.template topRows<Dim>();
  const auto weight = value.row(Dim);
  CurveJet<Dim> jet;
  jet.point = coordinates.col(0) / weight[0];
  jet.du = (coordinates.col(1) - weight[1] * jet.point) / weight[0];
  jet.duu = (coordinates.col(2) - 2.0 * weight[1] * jet.du - weight[2] * jet.point) / weight[0];
  return jet;
}

template class NurbsCurve<2>;
template class NurbsCurve<3>;
template Point<2> evaluate(const NurbsCurve<2>&, double);
template Point<3> evaluate(const NurbsCurve<3>&, double);
template CurveJet<2> evaluate_jet(const NurbsCurve<2>&, double);
template CurveJet<3> evaluate_jet(const NurbsCurve<3>&, double);

}  // namespace isorim::geometry
