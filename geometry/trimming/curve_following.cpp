#include "geometry/trimming/curve_following.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "geometry/bezier/subdivision.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {
namespace {

/// d(uv) / dt of the foot of the curve's point, from the curve's derivative; zero where the surface degenerates.
Vector2 slope_of(const SurfaceJet<3>& jet, const Vector3& derivative) {
  const double uu = jet.du.squaredNorm();
  const double uv = jet.du.dot(jet.dv);
  const double vv = jet.dv.squaredNorm();
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-14 * uu * vv)) return Vector2::Zero();
  const double a = jet.du.dot(derivative);
  const double b = jet.dv.dot(derivative);
  return Vector2(vv * a - uv * b, uu * b - uv * a) / determinant;
}

/// Cubic Hermite between two followed points, linear next to poles.
Point2 interpolated(const FollowedPoint& from, const FollowedPoint& to, double t) {
  const double length = to.t - from.t;
  const double s = (t - from.t) / length;
  const Vector2 chord = to.uv - from.uv;
  if (from.pole >= 0 || to.pole >= 0) return from.uv + s * chord;
  const Vector2 start = length * from.slope;
  const Vector2 end = length * to.slope;
  if (start.norm() > 4.0 * chord.norm() || end.norm() > 4.0 * chord.norm()) return from.uv + s * chord;
  const double r = 1.0 - s;
  return from.uv + s * s * (3.0 - 2.0 * s) * chord + s * r * (r * start - s * end);
}

/// The knot line of parameter d nearest to the middle of an interval and strictly inside it, at any period.
std::optional<double> knot_inside(const ParameterRectangle& rectangle, int d, double from, double to) {
  const Interval domain = rectangle.domain(d);
  const double margin = 1e-7 * domain.length();
  const double low = std::min(from, to) + margin;
  const double high = std::max(from, to) - margin;
  if (!(low < high)) return std::nullopt;
  const KnotVector& knots = d == 0 ? rectangle.surface().knots_u() : rectangle.surface().knots_v();
  const bool is_closed = rectangle.is_closed(d);
  const double first_period = is_closed ? std::floor((low - domain.first) / domain.length()) : 0.0;
  const double last_period = is_closed ? std::floor((high - domain.first) / domain.length()) : 0.0;
  std::optional<double> best;
  const double middle = 0.5 * (from + to);
  for (double period = first_period; period <= last_period; period += 1.0)
    for (const double knot : knots.breakpoints()) {
      const double value = knot + period * domain.length();
      if (value <= low || value >= high) continue;
      if (!best || std::abs(value - middle) < std::abs(*best - middle)) best = value;
    }
  return best;
}

/// Looks for a place where a curve comes within `reach` of a point, by bisecting its Bézier segments.
class PassageSearch {
 public:
  PassageSearch(Point3 point, double reach) : point_(std::move(point)), reach_(reach) {}

  std::optional<double> run(const Eigen::MatrixXd& net, Interval domain) {
    const Eigen::Matrix3Xd points = net.topRows<3>().array().rowwise() / net.row(3).array();
    const Point3 lower = points.rowwise().minCoeff();
    const Point3 upper = points.rowwise().maxCoeff();
    if ((lower - point_).cwiseMax(point_ - upper).cwiseMax(0.0).norm() > reach_) return std::nullopt;
    constexpr int most_parts = 2000;
    if ((upper - lower).norm() <= reach_ || ++parts_ > most_parts) return domain.middle();
    const int degree = static_cast<int>(net.cols()) - 1;
    const auto [left, right] =
        subdivide({net.data(), static_cast<std::size_t>(net.size())}, 4, std::span<const int>(&degree, 1), 0);
    const auto half = [&](const std::vector<double>& data) -> Eigen::MatrixXd {
      return Eigen::Map<const Eigen::MatrixXd>(data.data(), 4, net.cols());
    };
    if (const std::optional<double> t = run(half(left), {domain.first, domain.middle()})) return t;
    return run(half(right), {domain.middle(), domain.last});
  }

 private:
  Point3 point_;
  double reach_;
  int parts_ = 0;
};

}  // namespace

CurveFollower::CurveFollower(const PointInverter& points, const NurbsCurve<3>& curve, double size)
    : points_(points), curve_(curve), size_(size), pole_reach_(1e-6 * size) {}

int CurveFollower::pole_at(const Point3& target) const {
  for (int side = 0; side < 4; ++side)
    if (rectangle().side(side) == SideKind::pole && (target - rectangle().pole(side)).norm() <= pole_reach_)
      return side;
  return -1;
}

std::optional<double> CurveFollower::inner_pole() const {
  std::optional<Points<3>> controls;
  for (int side = 0; side < 4; ++side) {
    if (rectangle().side(side) != SideKind::pole) continue;
    const Point3& pole = rectangle().pole(side);
    if (!controls) controls = curve_.control_points();
    const bool is_far = ((controls->rowwise().minCoeff() - pole).array() > pole_reach_).any() ||
                        ((pole - controls->rowwise().maxCoeff()).array() > pole_reach_).any();
    if (is_far) continue;
    // What starts or ends at the pole does not run through it there.
    const Interval domain = curve_.domain();
    const double inset = 1e-3 * domain.length();
    const Interval inside{domain.first + inset, domain.last - inset};
    PassageSearch search(pole, pole_reach_);
    const NurbsCurve<3> rest = restrict_to(curve_, inside);
    for (const BezierSegment& segment : bezier_segments({rest.knots(), rest.homogeneous()}))
      if (const std::optional<double> t = search.run(segment.coefficients, segment.domain))
        return nearest(*t, pole, inside);
  }
  return std::nullopt;
}

double CurveFollower::nearest(double t, const Point3& point, Interval inside) const {
  for (int k = 0; k < 20; ++k) {
    const CurveJet<3> jet = evaluate_jet(curve_, t);
    const double speed = jet.du.squaredNorm();
    if (!(speed > 0.0)) break;
    const double step = -(jet.point - point).dot(jet.du) / speed;
    if (!inside.contains(t + step) || std::abs(step) > 1e-3 * inside.length()) break;
    t += step;
    if (std::abs(step) <= 1e-15 * inside.length()) break;
  }
  return t;
}

FollowedPoint CurveFollower::completed(double t, const Point3& target, const Vector3& derivative,
                                       const InvertedPoint& found) const {
  FollowedPoint point{t, target, found.uv, found.jet, found.distance, Vector2::Zero(), pole_at(target), false};
  if (point.pole < 0) {
    point.slope = slope_of(found.jet, derivative);
  } else {
    const SideLine line = side_line(rectangle(), point.pole);
    point.uv[line.parameter] = line.value;
  }
  return point;
}

FollowedPoint CurveFollower::refined(double t, const Point2& guess) const {
  const CurveJet<3> jet = evaluate_jet(curve_, t);
  const int pole = pole_at(jet.point);
  if (pole < 0) return completed(t, jet.point, jet.du, points_.refine(jet.point, guess));
  InvertedPoint at_pole{guess, {}, (jet.point - rectangle().pole(pole)).norm()};
  at_pole.uv[side_line(rectangle(), pole).parameter] = side_line(rectangle(), pole).value;
  at_pole.jet = rectangle().jet(at_pole.uv);
  return completed(t, jet.point, jet.du, at_pole);
}

FollowedPoint CurveFollower::first(double t) const {
  const CurveJet<3> jet = evaluate_jet(curve_, t);
  return completed(t, jet.point, jet.du, points_.locate(jet.point));
}

FollowedPoint CurveFollower::step(const FollowedPoint& from, double t, int depth) const {
  const Vector2 lengths = rectangle().lengths();
  const Vector2 most = 0.25 * lengths;
  const Vector2 change = (from.slope * (t - from.t)).cwiseMax(-most).cwiseMin(most);
  const FollowedPoint next = refined(t, from.uv + change);
  const bool is_near = next.distance <= std::max(1e-4 * size_, 4.0 * from.distance);
  bool is_short = true;
  for (int d = 0; d < 2; ++d)
    if (rectangle().is_closed(d) && from.pole < 0 && next.pole < 0)
      is_short = is_short && std::abs(next.uv[d] - from.uv[d]) <= 0.3 * lengths[d];
  if (is_near && is_short) return next;
  const int deepest = is_short ? 3 : 16;
  if (depth < deepest) {
    const double middle = 0.5 * (from.t + t);
    return step(step(from, middle, depth + 1), t, depth + 1);
  }
  if (is_near || searches_left_-- <= 0) return next;
  InvertedPoint found = points_.locate(next.target);
  if (found.distance > 0.5 * next.distance) return next;
  for (int d = 0; d < 2; ++d)
    if (rectangle().is_closed(d)) found.uv[d] += lengths[d] * std::round((from.uv[d] - found.uv[d]) / lengths[d]);
  return completed(t, next.target, evaluate_jet(curve_, t).du, found);
}

std::vector<FollowedPoint> CurveFollower::follow() const {
  const std::vector<double> breaks = curve_.knots().breakpoints();
  const int parts = std::clamp(curve_.degree() + 1, 4, 8);
  std::vector<double> ts;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    for (int k = 0; k < parts; ++k) ts.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * k / parts);
  ts.push_back(breaks.back());
  std::vector<FollowedPoint> points(ts.size());
  // From the middle, where the curve is least likely to touch a seam or a pole.
  std::size_t middle = ts.size() / 2;
  while (middle > 0 && pole_at(evaluate(curve_, ts[middle])) >= 0) --middle;
  points[middle] = first(ts[middle]);
  for (std::size_t i = middle + 1; i < ts.size(); ++i) points[i] = step(points[i - 1], ts[i], 0);
  for (std::size_t i = middle; i-- > 0;) points[i] = step(points[i + 1], ts[i], 0);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].is_break = i % static_cast<std::size_t>(parts) == 0;
  return points;
}

FollowedPoint CurveFollower::between(const FollowedPoint& from, const FollowedPoint& to, double t) const {
  return refined(t, interpolated(from, to, t));
}

FollowedPoint CurveFollower::crossing(const FollowedPoint& from, const FollowedPoint& to, int d, double value) const {
  FollowedPoint low = from;
  FollowedPoint high = to;
  FollowedPoint middle = low;
  const double near = 1e-15 * rectangle().domain(d).length();
  // Regula falsi in Illinois form: an end that stays twice counts half.
  double at_low = low.uv[d] - value;
  double at_high = high.uv[d] - value;
  int stayed = 0;
  for (int k = 0; k < 60; ++k) {
    double t = (low.t * at_high - high.t * at_low) / (at_high - at_low);
    if (!(t > low.t && t < high.t)) t = 0.5 * (low.t + high.t);
    if (!(t > low.t && t < high.t)) break;
    middle = between(low, high, t);
    const double at_middle = middle.uv[d] - value;
    if (std::abs(at_middle) <= near) break;
    if ((at_middle > 0.0) == (at_high > 0.0)) {
      high = middle;
      at_high = at_middle;
      if (stayed == 1) at_low *= 0.5;
      stayed = 1;
    } else {
      low = middle;
      at_low = at_middle;
      if (stayed == -1) at_high *= 0.5;
      stayed = -1;
    }
  }
  middle.uv[d] = value;
  middle.is_break = true;
  return middle;
}

void CurveFollower::divide(const FollowedPoint& from, const FollowedPoint& to, int depth,
                           std::vector<FollowedPoint>& points) const {
  constexpr int deepest = 12;
  const bool is_determined = from.pole < 0 && to.pole < 0;
  for (int d = 0; d < 2 && depth < deepest; ++d) {
    // Beside a pole the parameter along it has no value at the end.
    if (!is_determined) {
      const int pole = std::max(from.pole, to.pole);
      if (side_line(rectangle(), pole).parameter != d) continue;
    }
    const std::optional<double> knot = knot_inside(rectangle(), d, from.uv[d], to.uv[d]);
    if (!knot) continue;
    const FollowedPoint middle = crossing(from, to, d, *knot);
    if (!(middle.t > from.t && middle.t < to.t)) continue;
    divide(from, middle, depth + 1, points);
    divide(middle, to, depth + 1, points);
    return;
  }
  points.push_back(to);
}

std::vector<std::vector<FollowedPoint>> CurveFollower::smooth_spans(const std::vector<FollowedPoint>& points) const {
  std::vector<FollowedPoint> divided{points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) divide(points[i], points[i + 1], 0, divided);
  std::vector<std::vector<FollowedPoint>> spans(1);
  for (std::size_t i = 0; i < divided.size(); ++i) {
    spans.back().push_back(divided[i]);
    if (divided[i].is_break && i > 0 && i + 1 < divided.size()) spans.push_back({divided[i]});
  }
  return spans;
}

Point2 CurveFollower::snapped(const FollowedPoint& point, int d, double snap) const {
  Point2 uv = point.uv;
  const Interval domain = rectangle().domain(d);
  const double speed = (d == 0 ? point.jet.du : point.jet.dv).norm();
  const double periods = rectangle().is_closed(d) ? std::round((uv[d] - domain.first) / domain.length()) : 0.0;
  for (const double side : {domain.first + periods * domain.length(), domain.last})
    if (speed * std::abs(uv[d] - side) <= snap) uv[d] = side;
  return uv;
}

}  // namespace isorim::geometry
