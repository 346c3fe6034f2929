#include "io/iges/pcurves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/spline/bspline.h"
#include "io/iges/fitting.h"

namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::Interval;
using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;
using geometry::Vector2;

namespace {

Interval range_of(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  return {values.minCoeff(), values.maxCoeff()};
}

bool is_monotone(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  bool rises = true;
  bool falls = true;
  for (Eigen::Index i = 1; i < values.size(); ++i) {
    rises = rises && values(i) >= values(i - 1);
    falls = falls && values(i) <= values(i - 1);
  }
  return rises || falls;
}

/// A direction's map as far as the curve sees it.
struct Direction {
  const ParameterMap& map;
  Interval range;
  double domain_length;

  /// So little of the map is used that its curvature does not show.
  bool is_constant() const {
    const double whole = map.is_identity() ? domain_length : map.domain().length();
    return range.length() <= pcurve_tolerance * whole;
  }
  bool is_affine() const { return map.is_affine() || is_constant(); }
  /// t -> scale t + shift, where is_affine().
  double scale() const {
    if (map.is_identity()) return 1.0;
    return map.derivative(range.middle());
  }
  double apply(double t) const {
    if (map.is_affine()) return map(t);
    return map(range.middle()) + scale() * (t - range.middle());
  }
};

/// Exact: control points go where the map sends them.
NurbsCurve<2> mapped_affinely(const NurbsCurve<2>& pcurve, const Direction& u, const Direction& v) {
  const Points<2> points = pcurve.control_points();
  geometry::HomogeneousPoints<2> net = pcurve.homogeneous();
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const double weight = net(2, i);
    if (!u.map.is_identity()) net(0, i) = weight * u.apply(points(0, i));
    if (!v.map.is_identity()) net(1, i) = weight * v.apply(points(1, i));
  }
  return {pcurve.knots(), std::move(net)};
}

NurbsCurve<2> straight(const NurbsCurve<2>& pcurve, const Direction& u, const Direction& v) {
  const Interval domain = pcurve.domain();
  const Point2 first = evaluate(pcurve, domain.first);
  const Point2 last = evaluate(pcurve, domain.last);
  Points<2> points(2, 2);
  points.col(0) << u.map(first.x()), v.map(first.y());
  points.col(1) << u.map(last.x()), v.map(last.y());
  const std::array<double, 2> ends{domain.first, domain.last};
  return NurbsCurve<2>::from_points(geometry::KnotVector::clamped(1, ends), points);
}

/// Zeros of a Bernstein polynomial strictly inside (0, 1), as places to split at: close pairs may come out as one.
void find_zeros(const Eigen::VectorXd& values, Interval range, std::vector<double>& zeros) {
  if ((values.array() > 0.0).all() || (values.array() < 0.0).all()) return;
  if (range.length() < 1e-15) {
    if (zeros.empty() || range.middle() - zeros.back() > 1e-14) zeros.push_back(range.middle());
    return;
  }
  const Eigen::Index p = values.size() - 1;
  Eigen::VectorXd left(p + 1);
  Eigen::VectorXd right = values;
  for (Eigen::Index i = 0; i <= p; ++i) {
    left(i) = right(0);
    for (Eigen::Index k = 0; k + i < p; ++k) right(k) = 0.5 * (right(k) + right(k + 1));
  }
  // `right` holds the last column of the triangle: the right half, from its start on.
  find_zeros(left, {range.first, range.middle()}, zeros);
  find_zeros(right, {range.middle(), range.last}, zeros);
}

/// Where a Bézier segment crosses one of the map's breakpoints, in the curve's parameter.
void add_crossings(const geometry::BezierSegment& segment, int row, const Direction& direction,
                   std::vector<double>& result) {
  for (const double t : direction.map.breakpoints(direction.range)) {
    const Eigen::VectorXd values = segment.coefficients.row(row) - t * segment.coefficients.row(2);
    const double largest = values.cwiseAbs().maxCoeff();
    if (largest <= 1e-14 * std::max(1.0, std::abs(t))) continue;
    std::vector<double> zeros;
    find_zeros(values, {0.0, 1.0}, zeros);
    for (const double zero : zeros) result.push_back(segment.domain.first + zero * segment.domain.length());
  }
}

/// The curve's own knots and the places where the maps change along it.
std::vector<double> split_parameters(const NurbsCurve<2>& pcurve, const Direction& u, const Direction& v) {
  std::vector<double> result;
  for (const geometry::BezierSegment& segment : geometry::bezier_segments({pcurve.knots(), pcurve.homogeneous()})) {
    result.push_back(segment.domain.first);
    add_crossings(segment, 0, u, result);
    add_crossings(segment, 1, v, result);
  }
  const Interval domain = pcurve.domain();
  result.push_back(domain.last);
  std::ranges::sort(result);
  std::vector<double> apart{domain.first};
  for (const double s : result)
    if (s - apart.back() > 1e-12 * domain.length()) apart.push_back(s);
  if (apart.size() > 1) apart.pop_back();
  apart.push_back(domain.last);
  return apart;
}

MappedPcurve fitted(const NurbsCurve<2>& pcurve, const Direction& u, const Direction& v) {
  const Vector2 lengths(u.domain_length, v.domain_length);
  const Point2 origin(u.map(u.range.first), v.map(v.range.first));
  const auto scaled = [&](double s) -> Point2 {
    const Point2 t = evaluate(pcurve, s);
    return (Point2(u.map(t.x()), v.map(t.y())) - origin).cwiseQuotient(lengths);
  };
  // Far from the origin the parameters themselves have fewer digits.
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() *
                          std::max(std::abs(u.range.first) * u.scale() / u.domain_length,
                                   std::abs(v.range.first) * v.scale() / v.domain_length);
  const std::vector<double> breakpoints = split_parameters(pcurve, u, v);
  const FittedCurve<2> fit =
      fit_curve<2>(scaled, breakpoints, {.tolerance = std::max(pcurve_tolerance, rounding), .largest_count = 64});
  AffineMap<2> back;
  back.linear = lengths.asDiagonal();
  back.translation = origin;
  return {transform(fit.curve, back), fit.deviation};
}

}  // namespace

MappedPcurve map_pcurve(const NurbsCurve<2>& pcurve, const ParameterMap& map_u, const ParameterMap& map_v,
                        Interval domain_u, Interval domain_v) {
  if (map_u.is_identity() && map_v.is_identity()) return {pcurve};
  const Points<2> points = pcurve.control_points();
  const Direction u{map_u, range_of(points.row(0)), domain_u.length()};
  const Direction v{map_v, range_of(points.row(1)), domain_v.length()};
  if (u.is_affine() && v.is_affine()) return {mapped_affinely(pcurve, u, v)};
  if ((u.is_constant() && is_monotone(points.row(1))) || (v.is_constant() && is_monotone(points.row(0))))
    return {straight(pcurve, u, v)};
  return fitted(pcurve, u, v);
}

}  // namespace isorim::io::iges
