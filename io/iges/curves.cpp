#include "io/iges/curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/iges/fitting.h"

namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::Interval;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

namespace {

/// The Bézier points of a cubic or less over [0, h], as many as the degree asks for.
Points<3> bezier_of_powers(const Eigen::Matrix<double, 3, 4>& powers, double h, int degree) {
  Points<3> points(3, degree + 1);
  points.col(0) = powers.col(0);
  for (int i = 1; i <= degree; ++i) {
    // sum_k C(i, k) / C(degree, k) a_k h^k
    Vector3 sum = Vector3::Zero();
    double factor = 1.0;
    for (int k = 1; k <= i; ++k) {
      factor *= h * (i - k + 1) / (degree - k + 1);
      sum += factor * powers.col(k);
    }
    points.col(i) = powers.col(0) + sum;
  }
  return points;
}

int degree_of(std::span<const Eigen::Matrix<double, 3, 4>> coefficients) {
  for (const int degree : {3, 2})
    for (const Eigen::Matrix<double, 3, 4>& piece : coefficients)
      if (!piece.col(degree).isZero(0.0)) return degree;
  return 1;
}

Point3 start_of(const NurbsCurve<3>& curve) {
  return evaluate(curve, curve.domain().first);
}
Point3 end_of(const NurbsCurve<3>& curve) {
  return evaluate(curve, curve.domain().last);
}

/// The pieces turned so that each starts where the one before ends.
std::vector<ParametrisedCurve> chained(std::span<const ParametrisedCurve> pieces) {
  std::vector<ParametrisedCurve> result(pieces.begin(), pieces.end());
  for (std::size_t i = 1; i < result.size(); ++i) {
    const Point3 first = start_of(result[i].curve);
    const Point3 last = end_of(result[i].curve);
    Point3 before = end_of(result[i - 1].curve);
    if (i == 1) {
      const Point3 other = start_of(result[0].curve);
      const double reach = std::min((first - other).norm(), (last - other).norm());
      if (reach < 0.5 * std::min((first - before).norm(), (last - before).norm())) {
        result[0] = reverse(result[0]);
        before = other;
      }
    }
    if ((last - before).norm() < 0.5 * (first - before).norm()) result[i] = reverse(result[i]);
  }
  return result;
}

}  // namespace

KnotVector piecewise_knots(int degree, std::span<const double> breakpoints) {
  std::vector<double> knots{breakpoints.front()};
  for (const double t : breakpoints) knots.insert(knots.end(), static_cast<std::size_t>(degree), t);
  knots.push_back(breakpoints.back());
  return {degree, std::move(knots)};
}

Interval meant_range(const Interval& meant, const Interval& domain, Remark& remark) {
  const double rounding = 1e-9 * domain.length();
  const Interval range{std::max(meant.first, domain.first), std::min(meant.last, domain.last)};
  if (!(range.length() > rounding)) {
    remark = fmt::format("the range [{}, {}] is no part of the knots' [{}, {}], which is taken", meant.first,
                         meant.last, domain.first, domain.last);
    return domain;
  }
  if (meant.first < domain.first - rounding || meant.last > domain.last + rounding)
    remark = fmt::format("the range [{}, {}] reaches beyond the knots' [{}, {}]; the common part is taken", meant.first,
                         meant.last, domain.first, domain.last);
  return range;
}

Interval parameter_range(const ParametrisedCurve& curve) {
  return curve.parameters.is_identity() ? curve.curve.domain() : curve.parameters.domain();
}

std::vector<double> parameter_breakpoints(const ParametrisedCurve& curve) {
  if (curve.parameters.is_identity()) return curve.curve.knots().breakpoints();
  const Interval range = curve.parameters.domain();
  std::vector<double> result = curve.parameters.breakpoints(range);
  // An affine piece may hold knots of its own.
  for (const ParameterMap::Piece& piece : curve.parameters.pieces())
    if (piece.half_rate == 0.0)
      for (const double u : curve.curve.knots().breakpoints())
        if (piece.to.first < u && u < piece.to.last)
          result.push_back(piece.from.first + (u - piece.to.first) / piece.to.length() * piece.from.length());
  result.push_back(range.first);
  result.push_back(range.last);
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

Point3 evaluate_at(const ParametrisedCurve& curve, double t) {
  return evaluate(curve.curve, curve.parameters(t));
}

ParametrisedCurve reverse(const ParametrisedCurve& curve) {
  ParametrisedCurve result = curve;
  result.curve = geometry::reverse(curve.curve);
  if (curve.parameters.is_identity()) return result;
  const Interval from = curve.parameters.domain();
  const Interval to = curve.parameters.image();
  std::vector<ParameterMap::Piece> pieces;
  for (const ParameterMap::Piece& piece : curve.parameters.pieces())
    pieces.push_back({.from = {from.first + (from.last - piece.from.last), from.last - (piece.from.first - from.first)},
                      .to = {to.first + (to.last - piece.to.last), to.last - (piece.to.first - to.first)},
                      .half_rate = piece.half_rate,
                      .centre = from.first + (from.last - piece.centre)});
  std::ranges::reverse(pieces);
  result.parameters = ParameterMap(std::move(pieces), curve.parameters.period().has_value());
  return result;
}

ParametrisedCurve transform(const ParametrisedCurve& curve, const AffineMap<3>& map) {
  ParametrisedCurve result = curve;
  result.curve = geometry::transform(curve.curve, map);
  return result;
}

ParametrisedCurve line(const Point3& start, const Point3& end) {
  Points<3> points(3, 2);
  points << start, end;
  return {NurbsCurve<3>::from_points(KnotVector::bezier(1), points), {}};
}

ParametrisedCurve linear_path(const Points<3>& points) {
  if (points.cols() < 2)
    throw GeometryError(fmt::format("linear path: {} point(s); at least 2 are needed", points.cols()));
  std::vector<double> breakpoints(static_cast<std::size_t>(points.cols()));
  for (std::size_t i = 0; i < breakpoints.size(); ++i) breakpoints[i] = static_cast<double>(i);
  return {NurbsCurve<3>::from_points(piecewise_knots(1, breakpoints), points), {}};
}

ParametrisedCurve parametric_spline(std::span<const double> breakpoints,
                                    std::span<const Eigen::Matrix<double, 3, 4>> coefficients) {
  if (coefficients.empty() || breakpoints.size() != coefficients.size() + 1)
    throw GeometryError(fmt::format("parametric spline: {} pieces need {} breakpoints; {} given", coefficients.size(),
                                    coefficients.size() + 1, breakpoints.size()));
  const int degree = degree_of(coefficients);
  Points<3> points(3, static_cast<Eigen::Index>(coefficients.size()) * degree + 1);
  double size = 0.0;
  for (const Eigen::Matrix<double, 3, 4>& piece : coefficients)
    size = std::max(size, piece.col(0).cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const double h = breakpoints[i + 1] - breakpoints[i];
    const Points<3> piece = bezier_of_powers(coefficients[i], h, degree);
    const Eigen::Index first = static_cast<Eigen::Index>(i) * degree;
    if (i > 0) {
      const double gap = (points.col(first) - piece.col(0)).norm();
      const double reach = (piece.rightCols(degree).colwise() - piece.col(0)).colwise().norm().maxCoeff();
      if (!(gap <= 1e-6 * (size + reach)))
        throw GeometryError(fmt::format("parametric spline: pieces {} and {} are {:.3g} apart", i, i + 1, gap));
    }
    points.middleCols(first, degree + 1) = piece;
  }
  return {NurbsCurve<3>::from_points(piecewise_knots(degree, breakpoints), points), {}};
}

ParametrisedCurve b_spline(const BSplineCurveData& data, Remark& remark) {
  const KnotVector knots(data.degree, data.knots);
  const NurbsCurve<3> whole = NurbsCurve<3>::from_points(knots, data.points, data.weights);
  const Interval domain = whole.domain();
  const Interval range = meant_range(data.range, domain, remark);
  if (range.first == domain.first && range.last == domain.last) return {whole, {}};
  return {restrict_to(whole, range), {}};
}

ParametrisedCurve composite(std::span<const ParametrisedCurve> pieces, double tolerance) {
  if (pieces.empty()) throw GeometryError("composite curve: no curves");
  const std::vector<ParametrisedCurve> chain = chained(pieces);
  std::vector<NurbsCurve<3>> curves;
  std::vector<ParameterMap::Piece> map;
  double t = 0.0;
  ParametrisedCurve result = chain.front();
  double u = chain.front().curve.domain().first;
  for (const ParametrisedCurve& piece : chain) {
    curves.push_back(piece.curve);
    const Interval own = parameter_range(piece);
    const Interval domain = piece.curve.domain();
    if (piece.parameters.is_identity()) {
      map.push_back({.from = {t, t + own.length()}, .to = {u, u + domain.length()}, .half_rate = 0.0, .centre = 0.0});
    } else {
      for (ParameterMap::Piece part : piece.parameters.pieces()) {
        part.from = {t + (part.from.first - own.first), t + (part.from.last - own.first)};
        part.to = {u + (part.to.first - domain.first), u + (part.to.last - domain.first)};
        part.centre = t + (part.centre - own.first);
        map.push_back(part);
      }
    }
    t += own.length();
    u += domain.length();
    result.deviation = std::max(result.deviation, piece.deviation);
    result.tolerance = std::max(result.tolerance, piece.tolerance);
  }
  result.curve = geometry::join<3>(curves, tolerance);
  // The sums of the lengths may miss the last knot by a rounding.
  map.back().to.last = result.curve.domain().last;
  result.parameters = ParameterMap(std::move(map));
  return result;
}

namespace {

/// Direction of the curve at parameter t; zero where it has none.
Vector3 tangent(const ParametrisedCurve& curve, double u) {
  return evaluate_jet(curve.curve, u).du.stableNormalized();
}

/// Throws unless the tangent is the same on both sides of every breakpoint strictly inside the range.
void require_smooth(const ParametrisedCurve& base, const Interval& range) {
  for (const double t : parameter_breakpoints(base)) {
    if (!(range.first < t && t < range.last)) continue;
    const double u = base.parameters(t);
    const double step = 1e-9 * base.curve.domain().length();
    const double turn = (tangent(base, u) - tangent(base, u - step)).norm();
    if (turn > 1e-5)
      throw GeometryError(
          fmt::format("offset curve: the base curve has a corner of {:.3g} rad at parameter {}", turn, t));
  }
}

}  // namespace

ParametrisedCurve offset_curve(const ParametrisedCurve& base, const OffsetCurveData& data, double tolerance) {
  const Interval own = parameter_range(base);
  const Interval range{std::max(own.first, data.range.first), std::min(own.last, data.range.last)};
  if (!(range.length() > 0.0))
    throw GeometryError(fmt::format("offset curve: the range [{}, {}] is no part of the base curve's [{}, {}]",
                                    data.range.first, data.range.last, own.first, own.last));
  const double length = data.normal.stableNorm();
  if (!(length > 0.0)) throw GeometryError("offset curve: the normal is zero");
  const Vector3 normal = data.normal / length;
  require_smooth(base, range);

  std::vector<double> breakpoints{range.first};
  for (const double t : parameter_breakpoints(base))
    if (range.first < t && t < range.last) breakpoints.push_back(t);
  breakpoints.push_back(range.last);
  const auto point = [&](double t) -> Point3 {
    const double u = base.parameters(t);
    const geometry::CurveJet<3> jet = evaluate_jet(base.curve, u);
    const double speed = jet.du.stableNorm();
    if (!(speed > 0.0)) throw GeometryError(fmt::format("offset curve: no tangent at parameter {}", t));
    return jet.point + data.distance(t) * normal.cross(jet.du / speed);
  };
  const FittedCurve<3> fitted = fit_curve<3>(point, breakpoints, {.tolerance = tolerance, .largest_count = 64});
  return {fitted.curve, {}, std::max(fitted.deviation, base.deviation), tolerance};
}

ParametrisedCurve in_own_parameter(const ParametrisedCurve& curve, Interval range, double tolerance) {
  ParametrisedCurve result = curve;
  if (curve.parameters.is_affine()) {
    result.curve = geometry::reparametrise(curve.curve, range);
    result.parameters = {};
    return result;
  }
  const ParameterMap map = curve.parameters.over(range);
  std::vector<double> breakpoints = parameter_breakpoints({curve.curve, map});
  const FittedCurve<3> fitted = fit_curve<3>([&](double t) -> Point3 { return evaluate(curve.curve, map(t)); },
                                             breakpoints, {.tolerance = tolerance, .largest_count = 64});
  return {fitted.curve, {}, std::max(fitted.deviation, curve.deviation), tolerance};
}

}  // namespace isorim::io::iges
