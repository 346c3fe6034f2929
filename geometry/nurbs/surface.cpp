#include "geometry/nurbs/surface.h"

#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/validation.h"
#include "geometry/spline/local_basis.h"

namespace isorim::geometry {

template <int Dim>
NurbsSurface<Dim>::NurbsSurface(KnotVector knots_u, KnotVector knots_v, HomogeneousPoints<Dim> homogeneous)
    : knots_u_(std::move(knots_u)), knots_v_(std::move(knots_v)), homogeneous_(std::move(homogeneous)) {
  const Eigen::Index needed = static_cast<Eigen::Index>(count_u()) * count_v();
  if (homogeneous_.cols() != needed)
    throw GeometryError(fmt::format("NURBS surface: {} control points given; the knots need {} x {} = {}",
                                    homogeneous_.cols(), count_u(), count_v(), needed));
  const auto index_name = [this](Eigen::Index i) { return fmt::format("({}, {})", i % count_u(), i / count_u()); };
  require_valid_net<Dim>(homogeneous_, "NURBS surface", index_name);
}

template <int Dim>
NurbsSurface<Dim> NurbsSurface<Dim>::from_points(KnotVector knots_u, KnotVector knots_v, const Points<Dim>& points,
                                                 std::span<const double> weights) {
  return {std::move(knots_u), std::move(knots_v), homogeneous_net<Dim>(points, weights, "NURBS surface")};
}

template <int Dim>
Points<Dim> NurbsSurface<Dim>::control_points() const {
  return homogeneous_.template topRows<Dim>().array().rowwise() / homogeneous_.row(Dim).array();
}

template <int Dim>
bool NurbsSurface<Dim>::is_polynomial() const {
  return (homogeneous_.row(Dim).array() == homogeneous_(Dim, 0)).all();
}

namespace {

/// Derivatives of the homogeneous surface: entry [b].col(a) is d^(a+b) / du^a dv^b.
template <int Dim, int Orders>
using HomogeneousDerivatives = std::array<Eigen::Matrix<double, Dim + 1, Orders + 1>, Orders + 1>;

template <int Dim, int Orders>
HomogeneousDerivatives<Dim, Orders> homogeneous_derivatives(const NurbsSurface<Dim>& surface, const Point2& uv) {
  const LocalBasis<Orders> u = local_basis<Orders>(surface.knots_u(), uv[0]);
  const LocalBasis<Orders> v = local_basis<Orders>(surface.knots_v(), uv[1]);
  HomogeneousDerivatives<Dim, Orders> sums;
  for (auto& sum : sums) sum.setZero();
  for (Eigen::Index j = 0; j < v.table.rows(); ++j) {
    const Eigen::Index first = u.first + (v.first + j) * surface.count_u();
    const Eigen::Matrix<double, Dim + 1, Orders + 1> row =
        surface.homogeneous().middleCols(first, u.table.rows()).lazyProduct(u.table);
    for (std::size_t b = 0; b < sums.size(); ++b) sums[b] += v.table(j, static_cast<Eigen::Index>(b)) * row;
  }
  return sums;
}

}  // namespace

template <int Dim>
Point<Dim> evaluate(const NurbsSurface<Dim>& surface, const Point2& uv) {
  const auto value = homogeneous_derivatives<Dim, 0>(surface, uv)[0];
  return value.template head<Dim>() / value[Dim];
}

template <int Dim>
SurfaceJet<Dim> evaluate_jet(const NurbsSurface<Dim>& surface, const Point2& uv) {
  const auto derivatives = homogeneous_derivatives<Dim, 2>(surface, uv);
  const auto a = [&](std::size_t du, std::size_t dv) -> Vector<Dim> {
    return derivatives[dv].col(static_cast<Eigen::Index>(du)).template head<Dim>();
  };
  const auto w = [&](std::size_t du, std::size_t dv) { return derivatives[dv](Dim, static_cast<Eigen::Index>(du)); };
  const double weight = w(0, 0);
  SurfaceJet<Dim> jet;
  jet.point = a(0, 0) / weight;
  jet.du = (a(1, 0) - w(1, 0) * jet.point) / weight;
  jet.dv = (a(0, 1) - w(0, 1) * jet.point) / weight;
  jet.duu = (a(2, 0) - 2.0 * w(1, 0) * jet.du - w(2, 0) * jet.point) / weight;
  jet.duv = (a(1, 1) - w(1, 0) * jet.dv - w(0, 1) * jet.du - w(1, 1) * jet.point) / weight;
  jet.dvv = (a(0, 2) - 2.0 * w(0, 1) * jet.dv - w(0, 2) * jet.point) / weight;
  return jet;
}

template class NurbsSurface<2>;
template class NurbsSurface<3>;
template Point<2> evaluate(const NurbsSurface<2>&, const Point2&);
template Point<3> evaluate(const NurbsSurface<3>&, const Point2&);
template SurfaceJet<2> evaluate_jet(const NurbsSurface<2>&, const Point2&);
template SurfaceJet<3> evaluate_jet(const NurbsSurface<3>&, const Point2&);

}  // namespace isorim::geometry
