#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/rational_removal.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {

namespace {

template <int Dim>
BSpline as_spline(const NurbsCurve<Dim>& curve) {
  return {curve.knots(), curve.homogeneous()};
}

template <int Dim>
NurbsCurve<Dim> as_curve(BSpline spline) {
  return {std::move(spline.knots), std::move(spline.coefficients)};
}

}  // namespace

template <int Dim>
NurbsCurve<Dim> insert_knot(const NurbsCurve<Dim>& curve, double u, int times) {
  if (times < 0) throw GeometryError(fmt::format("knot insertion: {} times asked for", times));
  return refine_knots(curve, std::vector<double>(static_cast<std::size_t>(times), u));
}

template <int Dim>
NurbsCurve<Dim> refine_knots(const NurbsCurve<Dim>& curve, std::span<const double> new_knots) {
  return as_curve<Dim>(refine_knots(as_spline(curve), new_knots));
}

template <int Dim>
CurveKnotRemoval<Dim> remove_knot(const NurbsCurve<Dim>& curve, double u, int times, double tolerance) {
  KnotRemoval result = remove_rational_knot<Dim>(as_spline(curve), u, times, tolerance);
  return {as_curve<Dim>(std::move(result.spline)), result.removed, result.error_bound};
}

template <int Dim>
NurbsCurve<Dim> elevate_degree(const NurbsCurve<Dim>& curve, int times) {
  return as_curve<Dim>(elevate_degree(as_spline(curve), times));
}

template <int Dim>
NurbsCurve<Dim> clamp(const NurbsCurve<Dim>& curve) {
  return as_curve<Dim>(clamp(as_spline(curve)));
}

template <int Dim>
std::pair<NurbsCurve<Dim>, NurbsCurve<Dim>> split(const NurbsCurve<Dim>& curve, double u) {
  const Interval domain = curve.domain();
  if (!(domain.first < u && u < domain.last))
    throw GeometryError(fmt::format("NURBS curve: split parameter {} is not strictly inside the domain [{}, {}]", u,
                                    domain.first, domain.last));
  return {restrict_to(curve, {domain.first, u}), restrict_to(curve, {u, domain.last})};
}

template <int Dim>
NurbsCurve<Dim> restrict_to(const NurbsCurve<Dim>& curve, Interval piece) {
  return as_curve<Dim>(restrict_to(as_spline(curve), piece));
}

template <int Dim>
NurbsCurve<Dim> reverse(const NurbsCurve<Dim>& curve) {
  return as_curve<Dim>(reverse(as_spline(curve)));
}

template <int Dim>
NurbsCurve<Dim> transform(const NurbsCurve<Dim>& curve, const AffineMap<Dim>& map) {
  HomogeneousPoints<Dim> net = curve.homogeneous();
  net.template topRows<Dim>() =
      map.linear * curve.homogeneous().template topRows<Dim>() + map.translation * curve.homogeneous().row(Dim);
  return {curve.knots(), std::move(net)};
}

template <int Dim>
NurbsCurve<Dim> reparametrise(const NurbsCurve<Dim>& curve, Interval domain) {
  if (!std::isfinite(domain.first) || !std::isfinite(domain.last) || !(domain.first < domain.last))
    throw GeometryError(
        fmt::format("NURBS curve: new domain [{}, {}] is no finite interval", domain.first, domain.last));
  const Interval old = curve.domain();
  const double scale = domain.length() / old.length();
  std::vector<double> knots(curve.knots().knots().begin(), curve.knots().knots().end());
  // Measured from the nearer end, so that both ends are met exactly.
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double u = knots[i];
    knots[i] = u < old.middle() ? domain.first + scale * (u - old.first) : domain.last - scale * (old.last - u);
    if (i > 0) knots[i] = std::max(knots[i], knots[i - 1]);
  }
  return {KnotVector(curve.degree(), std::move(knots)), curve.homogeneous()};
}

namespace {

/// Appends `next` to the clamped curve `joined` of the same degree, its parameters shifted to follow on.
template <int Dim>
NurbsCurve<Dim> append(const NurbsCurve<Dim>& joined, const NurbsCurve<Dim>& next) {
  const HomogeneousPoints<Dim>& before = joined.homogeneous();
  HomogeneousPoints<Dim> after = next.homogeneous();
  // A common factor of all homogeneous coordinates leaves a curve as it is; it makes the weights meet.
  const double weight = before(Dim, before.cols() - 1);
  after *= weight / after(Dim, 0);
  if (next.is_polynomial()) after.row(Dim).setConstant(weight);

  const Eigen::Index last = before.cols() - 1;
  HomogeneousPoints<Dim> net(Dim + 1, before.cols() + after.cols() - 1);
  net.leftCols(last) = before.leftCols(last);
  net.rightCols(after.cols() - 1) = after.rightCols(after.cols() - 1);
  const Eigen::Matrix<double, Dim + 1, 1> end = before.col(last);
  net.col(last) = end + 0.5 * (after.col(0) - end);
  net(Dim, last) = weight;

  const double shift = joined.domain().last - next.domain().first;
  const int p = joined.degree();
  std::vector<double> knots(joined.knots().knots().begin(), joined.knots().knots().end() - 1);
  for (std::size_t i = static_cast<std::size_t>(p) + 1; i < next.knots().knots().size(); ++i)
    knots.push_back(next.knots().knots()[i] + shift);
  return {KnotVector(p, std::move(knots)), std::move(net)};
}

}  // namespace

template <int Dim>
NurbsCurve<Dim> join(std::span<const NurbsCurve<Dim>> curves, double tolerance) {
  if (curves.empty()) throw GeometryError("join: no curves given");
  int degree = 1;
  for (const NurbsCurve<Dim>& curve : curves) degree = std::max(degree, curve.degree());
  const auto prepared = [degree](const NurbsCurve<Dim>& curve) {
    return elevate_degree(clamp(curve), degree - curve.degree());
  };
  NurbsCurve<Dim> joined = prepared(curves[0]);
  for (std::size_t i = 1; i < curves.size(); ++i) {
    const NurbsCurve<Dim> next = prepared(curves[i]);
    const double gap = (evaluate(next, next.domain().first) - evaluate(joined, joined.domain().last)).norm();
    if (!(gap <= tolerance))
      throw GeometryError(
          fmt::format("join: the end of curve {} and the start of curve {} are {} apart; expected at most {}", i - 1, i,
                      gap, tolerance));
    joined = append(joined, next);
  }
  return joined;
}

NurbsCurve<3> embed(const NurbsCurve<2>& curve) {
  HomogeneousPoints<3> net = HomogeneousPoints<3>::Zero(4, curve.homogeneous().cols());
  net.topRows<2>() = curve.homogeneous().topRows<2>();
  net.row(3) = curve.homogeneous().row(2);
  return {curve.knots(), std::move(net)};
}

#define ISORIM_INSTANTIATE(Dim)                                                               \
  template NurbsCurve<Dim> insert_knot(const NurbsCurve<Dim>&, double, int);                  \
  template NurbsCurve<Dim> refine_knots(const NurbsCurve<Dim>&, std::span<const double>);     \
  template CurveKnotRemoval<Dim> remove_knot(const NurbsCurve<Dim>&, double, int, double);    \
  template NurbsCurve<Dim> elevate_degree(const NurbsCurve<Dim>&, int);                       \
  template NurbsCurve<Dim> clamp(const NurbsCurve<Dim>&);                                     \
  template std::pair<NurbsCurve<Dim>, NurbsCurve<Dim>> split(const NurbsCurve<Dim>&, double); \
  template NurbsCurve<Dim> restrict_to(const NurbsCurve<Dim>&, Interval);                     \
  template NurbsCurve<Dim> reverse(const NurbsCurve<Dim>&);                                   \
  template NurbsCurve<Dim> transform(const NurbsCurve<Dim>&, const AffineMap<Dim>&);          \
  template NurbsCurve<Dim> reparametrise(const NurbsCurve<Dim>&, Interval);                   \
  template NurbsCurve<Dim> join(std::span<const NurbsCurve<Dim>>, double)
ISORIM_INSTANTIATE(2);
ISORIM_INSTANTIATE(3);
#undef ISORIM_INSTANTIATE

}  // namespace isorim::geometry
