#include "geometry/trimming/curve_inversion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/LU>

#include "geometry/trimming/curve_cuts.h"
#include "geometry/trimming/curve_following.h"

namespace isorim::geometry {
namespace {

constexpr int fit_degree = 9;

/// Bernstein polynomials of fit_degree at s in [0, 1].
Eigen::Matrix<double, 1, fit_degree + 1> bernstein(double s) {
  Eigen::Matrix<double, 1, fit_degree + 1> values = Eigen::Matrix<double, 1, fit_degree + 1>::Zero();
  values[0] = 1.0;
  for (int degree = 1; degree <= fit_degree; ++degree)
    for (int i = degree; i >= 0; --i)
      values[i] = (i < degree ? (1.0 - s) * values[i] : 0.0) + (i > 0 ? s * values[i - 1] : 0.0);
  return values;
}

/// Interpolation at the Chebyshev points of one kind.
struct Interpolation {
  using Matrix = Eigen::Matrix<double, fit_degree + 1, fit_degree + 1>;
  /// In [0, 1], increasing.
  std::array<double, fit_degree + 1> nodes;
  /// From values at the nodes to Bézier coefficients.
  Matrix to_bezier;

  explicit Interpolation(bool has_ends) {
    Matrix values;
    for (int k = 0; k <= fit_degree; ++k) {
      const double angle =
          has_ends ? std::numbers::pi * k / fit_degree : std::numbers::pi * (2.0 * k + 1.0) / (2.0 * fit_degree + 2.0);
      nodes[static_cast<std::size_t>(k)] = 0.5 * (1.0 - std::cos(angle));
    }
    if (has_ends) {
      nodes.front() = 0.0;
      nodes.back() = 1.0;
    }
    for (int k = 0; k <= fit_degree; ++k) values.row(k) = bernstein(nodes[static_cast<std::size_t>(k)]);
    to_bezier = values.inverse();
  }
};

const Interpolation& interpolation(bool has_ends) {
  static const Interpolation closed(true);
  static const Interpolation open(false);
  return has_ends ? closed : open;
}

/// Fits the parameter curve piece by piece.
class Fit {
 public:
  using Coefficients = Eigen::Matrix<double, 2, fit_degree + 1>;

  /// `domain` is that of the curve in space.
  Fit(const CurveFollower& follower, Interval domain, const InversionOptions& options)
      : follower_(follower), options_(options), shortest_(1e-12 * domain.length()) {}

  /// Appends pieces from the first of the followed points to the last, over which curve and surface are smooth.
  void add(std::span<const FollowedPoint> points) {
    // Once a span was hopeless, the others are tried with less effort.
    last_allowed_ = pieces_.size() + (misfit_ > 0.0 ? 8 : 128);
    add(points, 0);
  }

  NurbsCurve<2> curve() const {
    std::vector<double> knots(fit_degree + 1, breaks_.front());
    for (std::size_t i = 1; i < breaks_.size(); ++i)
      knots.insert(knots.end(), static_cast<std::size_t>(i + 1 < breaks_.size() ? fit_degree : fit_degree + 1),
                   breaks_[i]);
    Points<2> points(2, static_cast<Eigen::Index>(pieces_.size()) * fit_degree + 1);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      points.middleCols<fit_degree + 1>(static_cast<Eigen::Index>(i) * fit_degree) = pieces_[i];
    return NurbsCurve<2>::from_points(KnotVector(fit_degree, std::move(knots)), points);
  }

  double deviation() const { return deviation_; }
  const Point3& farthest() const { return farthest_; }
  double misfit() const { return misfit_; }

 private:
  void add(std::span<const FollowedPoint> points, int depth) {
    const FollowedPoint& from = points.front();
    const FollowedPoint& to = points.back();
    if (from.pole >= 0 && to.pole >= 0) {
      add_between_poles(points, depth);
      return;
    }
    const Coefficients piece = interpolate(points);
    const double error = largest_error(piece, from, to);
    constexpr int deepest = 24;
    const double extent = (to.target - from.target).norm();
    const bool is_done = error <= options_.tolerance || depth >= deepest || pieces_.size() >= last_allowed_ ||
                         (depth > 4 && points.size() == 2 && extent < 1e-9 * options_.size);
    if (!is_done) {
      divide(points, depth);
      return;
    }
    if (error > options_.tolerance) misfit_ = std::max(misfit_, error);
    append(piece, from.t, to.t);
  }

  void append(const Coefficients& piece, double from, double to) {
    if (breaks_.empty()) breaks_.push_back(from);
    if (to - breaks_.back() < shortest_) {
      if (!pieces_.empty()) pieces_.back().col(fit_degree) = piece.col(fit_degree);
      return;
    }
    breaks_.push_back(to);
    pieces_.push_back(piece);
  }

  /// From pole to pole; a piece that stays at one is a line along its side.
  void add_between_poles(std::span<const FollowedPoint> points, int depth) {
    const bool stays = points.size() == 2 && points[0].pole == points[1].pole &&
                       follower_.between(points[0], points[1], 0.5 * (points[0].t + points[1].t)).pole >= 0;
    if (!stays) {
      divide(points, depth);
      return;
    }
    Coefficients line;
    for (int i = 0; i <= fit_degree; ++i)
      line.col(i) = points[0].uv + (points[1].uv - points[0].uv) * i / static_cast<double>(fit_degree);
    append(line, points[0].t, points[1].t);
  }

  void divide(std::span<const FollowedPoint> points, int depth) {
    if (points.size() > 2) {
      const std::size_t middle = points.size() / 2;
      add(points.first(middle + 1), depth + 1);
      add(points.subspan(middle), depth + 1);
      return;
    }
    const double t = 0.5 * (points[0].t + points[1].t);
    const std::array<FollowedPoint, 3> halves{points[0], follower_.between(points[0], points[1], t), points[1]};
    add(std::span(halves).first(2), depth + 1);
    add(std::span(halves).last(2), depth + 1);
  }

  /// At the Chebyshev points. A piece that ends at a pole is followed towards it and takes the points without ends.
  Coefficients interpolate(std::span<const FollowedPoint> points) {
    const FollowedPoint& from = points.front();
    const FollowedPoint& to = points.back();
    const bool has_ends = from.pole < 0 && to.pole < 0;
    const Interpolation& rule = interpolation(has_ends);
    Coefficients values;
    FollowedPoint last = to.pole >= 0 ? from : to;
    std::size_t next = 1;
    for (int n = 0; n <= fit_degree; ++n) {
      const int k = from.pole >= 0 ? fit_degree - n : n;
      const double t = from.t + rule.nodes[static_cast<std::size_t>(k)] * (to.t - from.t);
      if (has_ends) {
        while (next + 1 < points.size() && points[next].t < t) ++next;
        const bool is_end = k == 0 || k == fit_degree;
        last = is_end ? (k == 0 ? from : to) : follower_.between(points[next - 1], points[next], t);
      } else {
        last = follower_.onwards(last, t);
      }
      note(last);
      values.col(k) = last.uv;
    }
    Coefficients piece = values * rule.to_bezier.transpose();
    pin(from, piece.col(0));
    pin(to, piece.col(fit_degree));
    return piece;
  }

  /// Ends are exact: in both parameters, or at a pole in the one that it fixes.
  void pin(const FollowedPoint& end, Eigen::Ref<Point2> point) const {
    if (end.pole < 0) {
      point = end.uv;
      return;
    }
    const SideLine line = side_line(follower_.rectangle(), end.pole);
    point[line.parameter] = line.value;
  }

  /// In space, at places between the nodes.
  double largest_error(const Coefficients& piece, const FollowedPoint& from, const FollowedPoint& to) {
    double error = 0.0;
    for (const double s : {0.03, 0.18, 0.41, 0.66, 0.88, 0.97}) {
      const Point2 fitted = piece * bernstein(s).transpose();
      const FollowedPoint exact = follower_.refined(from.t + s * (to.t - from.t), fitted);
      note(exact);
      if (exact.pole >= 0) continue;
      const Vector2 off = fitted - exact.uv;
      error = std::max(error, (exact.jet.du * off[0] + exact.jet.dv * off[1]).norm());
      if (error > options_.tolerance) break;
    }
    return error;
  }

  void note(const FollowedPoint& point) {
    if (point.distance <= deviation_) return;
    deviation_ = point.distance;
    farthest_ = point.target;
  }

  const CurveFollower& follower_;
  const InversionOptions& options_;
  /// Pieces over less of the parameter are left out: knots must stay apart when the curve is reversed.
  double shortest_;
  std::vector<double> breaks_;
  std::vector<Coefficients> pieces_;
  /// How many pieces there may be at the end of the present span: against curves that no fit gets near.
  std::size_t last_allowed_ = 0;
  double deviation_ = 0.0;
  Point3 farthest_ = Point3::Zero();
  double misfit_ = 0.0;
};

/// The value of the constant parameter d if the points lie along such a line, to within the tolerance in space; sides
/// of the rectangle attract within `snap`.
std::optional<double> constant_parameter(const std::vector<FollowedPoint>& points, const ParameterRectangle& rectangle,
                                         int d, double tolerance, double snap) {
  double weighted = 0.0;
  double weights = 0.0;
  for (const FollowedPoint& p : points) {
    if (p.pole >= 0) continue;
    const double weight = (d == 0 ? p.jet.du : p.jet.dv).squaredNorm();
    weighted += weight * p.uv[d];
    weights += weight;
  }
  if (!(weights > 0.0)) return std::nullopt;
  const double mean = weighted / weights;
  const auto spread = [&](double value) {
    double largest = 0.0;
    for (const FollowedPoint& p : points)
      if (p.pole < 0) largest = std::max(largest, (d == 0 ? p.jet.du : p.jet.dv).norm() * std::abs(p.uv[d] - value));
    return largest;
  };
  const Interval domain = rectangle.domain(d);
  const double periods = rectangle.is_closed(d) ? std::round((mean - domain.first) / domain.length()) : 0.0;
  for (const double side : {domain.first + periods * domain.length(), domain.last})
    if (spread(side) <= snap) return side;
  if (spread(mean) <= tolerance) return mean;
  return std::nullopt;
}

bool is_monotone(const std::vector<FollowedPoint>& points, int d, double slack) {
  const bool rises = points.back().uv[d] > points.front().uv[d];
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double step = points[i + 1].uv[d] - points[i].uv[d];
    if ((rises ? step : -step) < -slack) return false;
  }
  return true;
}

/// The straight line along which the points run, if they keep to a line of constant parameter. `deviation`: of the
/// curve from the surface.
std::optional<NurbsCurve<2>> parameter_line(const CurveFollower& follower, const std::vector<FollowedPoint>& points,
                                            double deviation, const InversionOptions& options) {
  const ParameterRectangle& rectangle = follower.rectangle();
  // A curve is known no better than it keeps to the surface; sides are where files want it to be.
  const double along = std::max(4.0 * options.tolerance, deviation);
  const double snap = std::max(1e-9 * options.size, 2.0 * deviation);
  for (int d = 0; d < 2; ++d) {
    const std::optional<double> value = constant_parameter(points, rectangle, d, along, snap);
    if (!value || !is_monotone(points, 1 - d, rectangle.tolerance()[1 - d])) continue;
    Point2 from = follower.snapped(points.front(), 1 - d, snap);
    Point2 to = follower.snapped(points.back(), 1 - d, snap);
    from[d] = to[d] = *value;
    return straight(from, to);
  }
  return std::nullopt;
}

}  // namespace

CurveInverter::CurveInverter(const ParameterRectangle& rectangle, const InversionOptions& options)
    : rectangle_(rectangle), options_(options), points_(rectangle, 1e-6 * options.size) {
  const NurbsSurface<3>& surface = rectangle.surface();
  if (!surface.is_polynomial() || surface.knots_u().degree() > 3 || surface.knots_v().degree() > 3) return;
  const std::vector<double> us = surface.knots_u().greville_abscissae();
  const std::vector<double> vs = surface.knots_v().greville_abscissae();
  const Points<3> points = surface.control_points();
  Eigen::Matrix<double, 3, 2> slopes;
  slopes.col(0) = (points.col(surface.count_u() - 1) - points.col(0)) / (us.back() - us.front());
  slopes.col(1) = (points.col(points.cols() - surface.count_u()) - points.col(0)) / (vs.back() - vs.front());
  const double most =
      8.0 * std::numeric_limits<double>::epsilon() * (rectangle.surface_size() + points.colwise().norm().maxCoeff());
  for (int j = 0; j < surface.count_v(); ++j)
    for (int i = 0; i < surface.count_u(); ++i) {
      const Vector2 step(us[static_cast<std::size_t>(i)] - us.front(), vs[static_cast<std::size_t>(j)] - vs.front());
      if ((points.col(0) + slopes * step - points.col(i + j * surface.count_u())).norm() > most) return;
    }
  const Eigen::Matrix2d metric = slopes.transpose() * slopes;
  if (!(metric.determinant() > 1e-12 * metric(0, 0) * metric(1, 1))) return;
  affine_ = Affine{points.col(0), {us.front(), vs.front()}, metric.inverse() * slopes.transpose()};
}

std::optional<NurbsCurve<2>> CurveInverter::affine_image(const NurbsCurve<3>& curve) const {
  if (!affine_) return std::nullopt;
  HomogeneousPoints<2> net(3, curve.homogeneous().cols());
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const double weight = curve.homogeneous()(3, i);
    const Vector3 offset = curve.homogeneous().col(i).head<3>() / weight - affine_->origin;
    net.col(i) << weight * (affine_->parameters + affine_->inverse * offset), weight;
  }
  return NurbsCurve<2>(curve.knots(), std::move(net));
}

void CurveInverter::append(const NurbsCurve<3>& curve, int depth, InvertedCurve& result) const {
  const CurveFollower follower(points_, curve, options_.size);
  constexpr int most_splits = 4;
  const std::optional<double> through_pole = depth < most_splits ? follower.inner_pole() : std::nullopt;
  if (through_pole) {
    const auto [before, after] = split(curve, *through_pole);
    append(before, depth + 1, result);
    if (result.deviation <= options_.largest_deviation) append(after, depth + 1, result);
    return;
  }
  const std::vector<FollowedPoint> points = follower.follow();
  const bool is_at_pole = std::all_of(points.begin(), points.end(), [](const FollowedPoint& p) { return p.pole >= 0; });
  if (is_at_pole) return;
  const auto farthest =
      std::max_element(points.begin(), points.end(),
                       [](const FollowedPoint& a, const FollowedPoint& b) { return a.distance < b.distance; });
  if (farthest->distance > result.deviation) {
    result.deviation = farthest->distance;
    result.farthest = farthest->target;
  }
  if (result.deviation > options_.largest_deviation) {
    result.curves.clear();
    return;
  }
  if (std::optional<NurbsCurve<2>> line = parameter_line(follower, points, farthest->distance, options_)) {
    result.curves.push_back(std::move(*line));
    return;
  }
  Fit fit(follower, curve.domain(), options_);
  for (const std::vector<FollowedPoint>& span : follower.smooth_spans(points)) fit.add(span);
  result.curves.push_back(fit.curve());
  result.misfit = std::max(result.misfit, fit.misfit());
  if (fit.deviation() > result.deviation) {
    result.deviation = fit.deviation();
    result.farthest = fit.farthest();
  }
  if (result.deviation > options_.largest_deviation) result.curves.clear();
}

InvertedCurve CurveInverter::invert(const NurbsCurve<3>& curve) const {
  InvertedCurve result;
  if (std::optional<NurbsCurve<2>> image = affine_image(curve)) {
    const Points<3> controls = curve.control_points();
    const Points<2> parameters = image->control_points();
    for (Eigen::Index i = 0; i < controls.cols(); ++i) {
      const Point3 target = controls.col(i);
      const double distance = (evaluate(rectangle_.surface(), Point2(parameters.col(i))) - target).norm();
      if (distance <= result.deviation) continue;
      result.deviation = distance;
      result.farthest = target;
    }
    if (result.deviation <= options_.largest_deviation) result.curves.push_back(std::move(*image));
    return result;
  }
  append(curve, 0, result);
  return result;
}

}  // namespace isorim::geometry
