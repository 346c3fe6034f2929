#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/rational_removal.h"
#include "geometry/nurbs/surface.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {

namespace {

Direction other(Direction direction) {
  return direction == Direction::u ? Direction::v : Direction::u;
}

/// A net of rows x columns homogeneous points, rows fastest, with the columns fastest.
template <int Dim>
HomogeneousPoints<Dim> transposed_net(const HomogeneousPoints<Dim>& net, int rows, int columns) {
  HomogeneousPoints<Dim> result(Dim + 1, net.cols());
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) result.col(j + i * columns) = net.col(i + j * rows);
  return result;
}

/// The surface as a spline in one direction whose coefficients are the rows of the net across it.
template <int Dim>
BSpline as_spline(const NurbsSurface<Dim>& surface, Direction direction) {
  const int nu = surface.count_u();
  const int nv = surface.count_v();
  if (direction == Direction::v)
    return {surface.knots_v(), surface.homogeneous().reshaped((Dim + 1) * static_cast<Eigen::Index>(nu), nv)};
  return {surface.knots_u(),
          transposed_net<Dim>(surface.homogeneous(), nu, nv).reshaped((Dim + 1) * static_cast<Eigen::Index>(nv), nu)};
}

/// Undoes as_spline(); `across` are the knots of the other direction.
template <int Dim>
NurbsSurface<Dim> as_surface(BSpline spline, Direction direction, const KnotVector& across) {
  HomogeneousPoints<Dim> net = spline.coefficients.reshaped(Dim + 1, spline.coefficients.size() / (Dim + 1));
  if (direction == Direction::v) return {across, std::move(spline.knots), std::move(net)};
  const int count = spline.knots.basis_count();
  return {std::move(spline.knots), across, transposed_net<Dim>(net, across.basis_count(), count)};
}

}  // namespace

template <int Dim>
NurbsSurface<Dim> insert_knot(const NurbsSurface<Dim>& surface, Direction direction, double u, int times) {
  if (times < 0) throw GeometryError(fmt::format("knot insertion: {} times asked for", times));
  return refine_knots(surface, direction, std::vector<double>(static_cast<std::size_t>(times), u));
}

template <int Dim>
NurbsSurface<Dim> refine_knots(const NurbsSurface<Dim>& surface, Direction direction,
                               std::span<const double> new_knots) {
  return as_surface<Dim>(refine_knots(as_spline(surface, direction), new_knots), direction,
                         surface.knots(other(direction)));
}

template <int Dim>
SurfaceKnotRemoval<Dim> remove_knot(const NurbsSurface<Dim>& surface, Direction direction, double u, int times,
                                    double tolerance) {
  KnotRemoval result = remove_rational_knot<Dim>(as_spline(surface, direction), u, times, tolerance);
  return {as_surface<Dim>(std::move(result.spline), direction, surface.knots(other(direction))), result.removed,
          result.error_bound};
}

template <int Dim>
NurbsSurface<Dim> elevate_degree(const NurbsSurface<Dim>& surface, Direction direction, int times) {
  return as_surface<Dim>(elevate_degree(as_spline(surface, direction), times), direction,
                         surface.knots(other(direction)));
}

template <int Dim>
NurbsSurface<Dim> clamp(const NurbsSurface<Dim>& surface) {
  return restrict_to(surface, surface.knots_u().domain(), surface.knots_v().domain());
}

template <int Dim>
std::pair<NurbsSurface<Dim>, NurbsSurface<Dim>> split(const NurbsSurface<Dim>& surface, Direction direction, double u) {
  const BSpline spline = as_spline(surface, direction);
  const KnotVector& across = surface.knots(other(direction));
  const Interval domain = spline.knots.domain();
  if (!(domain.first < u && u < domain.last))
    throw GeometryError(fmt::format("NURBS surface: split parameter {} is not strictly inside the domain [{}, {}]", u,
                                    domain.first, domain.last));
  return {as_surface<Dim>(restrict_to(spline, {domain.first, u}), direction, across),
          as_surface<Dim>(restrict_to(spline, {u, domain.last}), direction, across)};
}

template <int Dim>
NurbsSurface<Dim> restrict_to(const NurbsSurface<Dim>& surface, Interval u, Interval v) {
  const NurbsSurface<Dim> strip =
      as_surface<Dim>(restrict_to(as_spline(surface, Direction::v), v), Direction::v, surface.knots_u());
  return as_surface<Dim>(restrict_to(as_spline(strip, Direction::u), u), Direction::u, strip.knots_v());
}

template <int Dim>
NurbsSurface<Dim> extend(const NurbsSurface<Dim>& surface, Direction direction, Interval domain) {
  return as_surface<Dim>(extend(as_spline(surface, direction), domain), direction, surface.knots(other(direction)));
}

template <int Dim>
NurbsSurface<Dim> reverse(const NurbsSurface<Dim>& surface, Direction direction) {
  return as_surface<Dim>(reverse(as_spline(surface, direction)), direction, surface.knots(other(direction)));
}

template <int Dim>
NurbsSurface<Dim> swap_directions(const NurbsSurface<Dim>& surface) {
  return {surface.knots_v(), surface.knots_u(),
          transposed_net<Dim>(surface.homogeneous(), surface.count_u(), surface.count_v())};
}

template <int Dim>
NurbsSurface<Dim> transform(const NurbsSurface<Dim>& surface, const AffineMap<Dim>& map) {
  HomogeneousPoints<Dim> net = surface.homogeneous();
  net.template topRows<Dim>() =
      map.linear * surface.homogeneous().template topRows<Dim>() + map.translation * surface.homogeneous().row(Dim);
  return {surface.knots_u(), surface.knots_v(), std::move(net)};
}

template <int Dim>
NurbsCurve<Dim> isoparametric_curve(const NurbsSurface<Dim>& surface, Direction direction, double value) {
  const Eigen::VectorXd row = evaluate(as_spline(surface, other(direction)), value);
  return {surface.knots(direction), row.reshaped(Dim + 1, row.size() / (Dim + 1))};
}

template <int Dim>
std::array<NurbsCurve<Dim>, 4> boundary_curves(const NurbsSurface<Dim>& surface) {
  const Interval u = surface.knots_u().domain();
  const Interval v = surface.knots_v().domain();
  return {isoparametric_curve(surface, Direction::u, v.first), isoparametric_curve(surface, Direction::v, u.last),
          isoparametric_curve(surface, Direction::u, v.last), isoparametric_curve(surface, Direction::v, u.first)};
}

#define ISORIM_INSTANTIATE(Dim)                                                                                \
  template NurbsSurface<Dim> insert_knot(const NurbsSurface<Dim>&, Direction, double, int);                    \
  template NurbsSurface<Dim> refine_knots(const NurbsSurface<Dim>&, Direction, std::span<const double>);       \
  template SurfaceKnotRemoval<Dim> remove_knot(const NurbsSurface<Dim>&, Direction, double, int, double);      \
  template NurbsSurface<Dim> elevate_degree(const NurbsSurface<Dim>&, Direction, int);                         \
  template NurbsSurface<Dim> clamp(const NurbsSurface<Dim>&);                                                  \
  template std::pair<NurbsSurface<Dim>, NurbsSurface<Dim>> split(const NurbsSurface<Dim>&, Direction, double); \
  template NurbsSurface<Dim> restrict_to(const NurbsSurface<Dim>&, Interval, Interval);                        \
  template NurbsSurface<Dim> extend(const NurbsSurface<Dim>&, Direction, Interval);                            \
  template NurbsSurface<Dim> reverse(const NurbsSurface<Dim>&, Direction);                                     \
  template NurbsSurface<Dim> swap_directions(const NurbsSurface<Dim>&);                                        \
  template NurbsSurface<Dim> transform(const NurbsSurface<Dim>&, const AffineMap<Dim>&);                       \
  template NurbsCurve<Dim> isoparametric_curve(const NurbsSurface<Dim>&, Direction, double);                   \
  template std::array<NurbsCurve<Dim>, 4> boundary_curves(const NurbsSurface<Dim>&)
ISORIM_INSTANTIATE(2);
ISORIM_INSTANTIATE(3);
#undef ISORIM_INSTANTIATE

}  // namespace isorim::geometry
