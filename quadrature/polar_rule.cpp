#include "quadrature/polar_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/bezier/subdivision.h"

namespace isorim::quadrature {

namespace {

using Complex = std::complex<double>;

/// A point of a curve and its derivatives, at a real or complex parameter.
template <class Number>
struct CurveJet {
  Eigen::Matrix<Number, 2, 1> point;
  Eigen::Matrix<Number, 2, 1> first;
  Eigen::Matrix<Number, 2, 1> second;
};

bool is_straight(const CellCurve& curve) {
  return curve.cols() == 2 && curve(2, 0) == 1.0 && curve(2, 1) == 1.0;
}

/// De Casteljau's algorithm, whose last rows hold the derivatives.
template <class Number>
CurveJet<Number> curve_jet(const CellCurve& curve, Number s) {
  using Column = Eigen::Matrix<Number, 3, 1>;
  if (is_straight(curve)) {
    const Eigen::Matrix<Number, 2, 1> side = (curve.col(1) - curve.col(0)).template head<2>().template cast<Number>();
    return {curve.col(0).template head<2>().template cast<Number>() + s * side, side,
            Eigen::Matrix<Number, 2, 1>::Zero()};
  }
  constexpr std::size_t room = 32;
  const auto degree = static_cast<std::size_t>(curve.cols() - 1);
  std::array<Column, room> row;
  for (std::size_t i = 0; i <= degree; ++i) row[i] = curve.col(static_cast<Eigen::Index>(i)).template cast<Number>();
  Column second = Column::Zero();
  Column first = Column::Zero();
  const auto p = static_cast<double>(degree);
  for (std::size_t count = degree; count > 0; --count) {
    if (count == 2) second = p * (p - 1.0) * (row[2] - 2.0 * row[1] + row[0]);
    if (count == 1) first = p * (row[1] - row[0]);
    for (std::size_t i = 0; i < count; ++i) row[i] += s * (row[i + 1] - row[i]);
  }
  const Number w = row[0][2];
  CurveJet<Number> jet;
  jet.point = row[0].template head<2>() / w;
  jet.first = (first.template head<2>() - first[2] * jet.point) / w;
  jet.second = (second.template head<2>() - 2.0 * first[2] * jet.first - second[2] * jet.point) / w;
  return jet;
}

/// Of the way to the region, where rays start about a pole that does not belong to it.
constexpr double inner_share = 0.5;

/// Where a weight function with this ratio of weights can vanish at the nearest: as that of a quadratic does (see
/// expected_orders() of element_piece.h).
Complex nearest_weight_zero(const CellCurve& curve) {
  const double ratio = curve.row(2).maxCoeff() / curve.row(2).minCoeff();
  return {0.5, ratio > 1.0 ? 0.5 * std::sqrt((ratio + 1.0) / (ratio - 1.0)) : 1e3};
}

template <class Number>
Number cross(const Eigen::Matrix<Number, 2, 1>& a, const Eigen::Matrix<Number, 2, 1>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

std::pair<CellCurve, CellCurve> bisect(const CellCurve& curve) {
  const std::array<int, 1> degree{static_cast<int>(curve.cols()) - 1};
  const auto [first, second] =
      geometry::subdivide({curve.data(), static_cast<std::size_t>(curve.size())}, 3, degree, 0);
  return {CellCurve(Eigen::Map<const CellCurve>(first.data(), 3, curve.cols())),
          CellCurve(Eigen::Map<const CellCurve>(second.data(), 3, curve.cols()))};
}

CellCurve segment(const geometry::Point2& from, const geometry::Point2& to) {
  CellCurve curve(3, 2);
  curve << from, to, 1.0, 1.0;
  return curve;
}

/// On the image of a line in the cell with the given derivatives.
Complex line_singularity(const ElementJet<3>& jet, const geometry::Vector2& first, const geometry::Vector2& second) {
  const geometry::Vector3 tangent = first[0] * jet.first[0] + first[1] * jet.first[1];
  const geometry::Vector3 turn = first[0] * first[0] * jet.second[0] + first[1] * first[1] * jet.second[1] +
                                 2.0 * first[0] * first[1] * jet.second[2] + second[0] * jet.first[0] +
                                 second[1] * jet.first[1];
  return singularity_on_line<3>(jet.offset, tangent, turn);
}

}  // namespace

std::vector<CellCurve> sides(const Cell<2>& cell) {
  const geometry::Point2 right(cell.upper[0], cell.lower[1]);
  const geometry::Point2 left(cell.lower[0], cell.upper[1]);
  return {segment(cell.lower, right), segment(right, cell.upper), segment(cell.upper, left), segment(left, cell.lower)};
}

PolarRule::PolarRule(const NearRequest<3>& request, std::span<const CellCurve> curves, const geometry::Point2& pole,
                     const ElementJet<3>& jet, bool is_own, Around around)
    : request_(request),
      pole_(pole),
      jet_(jet),
      is_own_(is_own),
      distance_(is_own ? 0.0 : jet.offset.norm()),
      metric_(metric_of(*request.shape, jet)) {
  // A pole no farther from the region than from the target is as good as one on it: what is summed in vain on rays
  // from the pole itself is then no more than the integral.
  if (around == Around::hole) {
    const double clearance = clearance_from(curves);
    if (clearance > distance_) inner_radius_ = inner_share * clearance;
  }
  for (const CellCurve& curve : curves) add_curve(curve, 0);
}

/// By bisection.
double PolarRule::clearance_from(std::span<const CellCurve> curves) const {
  constexpr double near_enough = 0.9;
  constexpr int most_bisections = 40;
  double attained = std::numeric_limits<double>::max();
  double least = attained;
  std::vector<std::pair<CellCurve, int>> left;
  for (const CellCurve& curve : curves) left.emplace_back(curve, 0);
  while (!left.empty()) {
    const auto [curve, depth] = std::move(left.back());
    left.pop_back();
    const geometry::Vector2 start = curve.col(0).head<2>() / curve(2, 0) - pole_;
    const double distance = std::sqrt(metric_.product(start, start));
    attained = std::min(attained, distance);
    const double bound = distance_bound(curve);
    if (bound >= attained) continue;
    if (bound >= near_enough * distance || depth == most_bisections) {
      least = std::min(least, bound);
      continue;
    }
    const auto halves = bisect(curve);
    left.emplace_back(halves.first, depth + 1);
    left.emplace_back(halves.second, depth + 1);
  }
  return std::min(least, attained);
}

/// A curve comes no nearer to the pole than its control points do in the direction in which they are seen.
double PolarRule::distance_bound(const CellCurve& curve) const {
  const geometry::Points<2> points = curve.topRows<2>().array().rowwise() / curve.row(2).array();
  const geometry::Points<2> rays = points.colwise() - pole_;
  geometry::Vector2 middle = geometry::Vector2::Zero();
  for (Eigen::Index i = 0; i < rays.cols(); ++i) {
    const double squared = metric_.product(rays.col(i), rays.col(i));
    if (squared > 0.0) middle += rays.col(i) / std::sqrt(squared);
  }
  const double length = std::sqrt(metric_.product(middle, middle));
  if (length == 0.0) return 0.0;
  double least = std::numeric_limits<double>::max();
  for (Eigen::Index i = 0; i < rays.cols(); ++i) least = std::min(least, metric_.product(rays.col(i), middle));
  return std::max(least / length, 0.0);
}

PolarRule::Metric PolarRule::metric_of(const ElementShape<3>& shape, const ElementJet<3>& jet) {
  constexpr double least_speed = 1e-5;
  constexpr double most_cosine = 0.999;
  Metric metric;
  metric.uu = std::max(jet.first[0].squaredNorm(), std::pow(least_speed * shape.half_length[0], 2));
  metric.vv = std::max(jet.first[1].squaredNorm(), std::pow(least_speed * shape.half_length[1], 2));
  const double most = most_cosine * std::sqrt(metric.uu * metric.vv);
  metric.uv = std::clamp(jet.first[0].dot(jet.first[1]), -most, most);
  return metric;
}

int PolarRule::points() const {
  int sum = 0;
  for (const Sector& sector : sectors_) sum += sector.along.points * sector.radial_points;
  return sum;
}

int PolarRule::most_points_on_a_line() const {
  int most = 0;
  for (const Sector& sector : sectors_) most = std::max({most, sector.along.points, sector.radial_points});
  return most;
}

void PolarRule::append(NodeBuffer<3>& nodes) const {
  reserve_more(nodes, static_cast<std::size_t>(points()));
  for (const Sector& sector : sectors_) append(sector, nodes);
}

void PolarRule::add_curve(const CellCurve& curve, int depth) {
  constexpr double nothing = 1e-15;
  constexpr int most_points = 60;
  constexpr int most_bisections = 8;
  const CurveJet<double> start = curve_jet(curve, 0.0);
  const CurveJet<double> end = curve_jet(curve, 1.0);
  const double extent = std::max((start.point - pole_).norm(), (end.point - pole_).norm());
  if (is_straight(curve) && std::abs(cross<double>(start.point - pole_, start.first)) <=
                                nothing * extent * std::max(extent, start.first.norm()))
    return;
  Complex root = nearest_on_curve(curve);
  const CurveJet<double> nearest = curve_jet(curve, std::clamp(root.real(), 0.0, 1.0));
  const double speed = std::sqrt(metric_.product(nearest.first, nearest.first));
  // Off the surface, what whole rays give is smooth on the scale of the target's distance as well.
  const double beyond = inner_radius_ > 0.0 ? 0.0 : distance_ / speed;
  root.imag(std::max(std::hypot(root.imag(), beyond), 1e-14));
  const bool is_far = root.imag() > 1.5 || root.real() < -2.0 || root.real() > 3.0;
  const SinhMap map = is_far ? SinhMap() : SinhMap(root.real(), root.imag());
  const std::vector<SidePoint> samples = side_points(curve, std::clamp(root.real(), 0.0, 1.0));
  double log_rho = std::min(map.log_ellipse_of(root), map.log_ellipse_of(nearest_weight_zero(curve)));
  for (const SidePoint& at : samples) {
    const Complex other = at.s + line_singularity(at.jet, at.first, at.second);
    if (!is_vague(other, root, at.s)) log_rho = std::min(log_rho, map.log_ellipse_of(other));
  }
  Sector sector{curve, {map, points_along(curve, map, log_rho, extent)}, 0};
  if (sector.along.points > most_points && !is_straight(curve) && depth < most_bisections) {
    const auto [first, second] = bisect(curve);
    add_curve(first, depth + 1);
    add_curve(second, depth + 1);
    return;
  }
  for (const SidePoint& at : samples) sector.radial_points = std::max(sector.radial_points, radial_points(at));
  sectors_.push_back(std::move(sector));
}

/// Few of them on a curve that is short as seen from the pole.
std::vector<PolarRule::SidePoint> PolarRule::side_points(const CellCurve& curve, double nearest) const {
  const auto at = [&](double s) {
    const CurveJet<double> jet = curve_jet(curve, s);
    const geometry::Point2 place = jet.point.cwiseMax(0.0).cwiseMin(1.0);
    return SidePoint{s, jet.point - pole_, jet.first, jet.second,
                     element_jet(request_.shape->net, place, request_.target)};
  };
  const SidePoint middle = at(0.5);
  const double length = metric_.product(middle.first, middle.first);
  if (length < 0.05 * metric_.product(middle.ray, middle.ray)) return {middle};
  std::vector<SidePoint> points{at(0.0), middle, at(1.0)};
  if (std::abs(nearest - 0.5) < 0.45) points.push_back(at(nearest));
  return points;
}

int PolarRule::points_along(const CellCurve& curve, const SinhMap& map, double log_rho, double reach) const {
  double speed = 0.0;
  for (const double s : {0.0, 0.5, 1.0}) speed = std::max(speed, curve_jet(curve, s).first.norm());
  const auto growth = [&](Complex s) {
    const CurveJet<Complex> jet = curve_jet(curve, s);
    double grown =
        request_.shape->growth[0](log_ellipse(jet.point[0])) + request_.shape->growth[1](log_ellipse(jet.point[1]));
    if (!is_straight(curve)) {
      const Eigen::Vector2cd ray = jet.point - pole_.cast<Complex>();
      grown += std::log(std::max(1.0, std::abs(cross<Complex>(ray, jet.first)) / (reach * speed)));
    }
    return grown;
  };
  return gauss_points(map, log_rho, request_.tolerance, growth);
}

/// The complex parameter at which the curve comes nearest to the pole, in the metric: its imaginary part is how near.
PolarRule::Complex PolarRule::nearest_on_curve(const CellCurve& curve) const {
  constexpr int most_steps = 6;
  double best = 0.5;
  double least = std::numeric_limits<double>::max();
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const geometry::Vector2 ray = curve_jet(curve, s).point - pole_;
    if (metric_.product(ray, ray) < least) {
      least = metric_.product(ray, ray);
      best = s;
    }
  }
  for (int step = 0; step < most_steps; ++step) {
    const CurveJet<double> jet = curve_jet(curve, best);
    const geometry::Vector2 ray = jet.point - pole_;
    const double squared = metric_.product(jet.first, jet.first);
    const double slope = metric_.product(ray, jet.first);
    const double bend = std::max(squared + metric_.product(ray, jet.second), 0.3 * squared);
    if (!(squared > 0.0)) break;
    const double next = std::clamp(best - slope / bend, 0.0, 1.0);
    if (std::abs(next - best) < 1e-12) break;
    best = next;
  }
  const CurveJet<double> jet = curve_jet(curve, best);
  const geometry::Vector2 ray = jet.point - pole_;
  const double a = std::max(metric_.product(jet.first, jet.first), std::numeric_limits<double>::min());
  const double b = metric_.product(ray, jet.first);
  const double c = metric_.product(ray, ray);
  const Complex root = best + Complex(-b, std::sqrt(std::max(a * c - b * b, 0.0))) / a;
  return is_straight(curve) ? root : complex_root(curve, root);
}

/// Newton's method for the squared distance as a function of the complex parameter; the first guess if it fails.
PolarRule::Complex PolarRule::complex_root(const CellCurve& curve, Complex guess) const {
  const auto product = [&](const Eigen::Vector2cd& p, const Eigen::Vector2cd& q) {
    return metric_.uu * p[0] * q[0] + metric_.vv * p[1] * q[1] + metric_.uv * (p[0] * q[1] + p[1] * q[0]);
  };
  Complex root = guess;
  for (int step = 0; step < 5; ++step) {
    const CurveJet<Complex> jet = curve_jet(curve, root);
    const Eigen::Vector2cd ray = jet.point - pole_.cast<Complex>();
    const Complex slope = 2.0 * product(ray, jet.first);
    if (std::abs(slope) < 1e-14 * std::abs(product(jet.first, jet.first))) break;
    const Complex change = product(ray, ray) / slope;
    root -= change;
    if (std::abs(change) < 1e-3 * std::abs(root.imag())) break;
  }
  root.imag(std::abs(root.imag()));
  const bool is_plausible = std::abs(root - guess) <= 0.7 * std::abs(guess.imag());
  return is_plausible ? root : guess;
}

geometry::Vector3 PolarRule::tangent(const geometry::Vector2& ray) const {
  return ray[0] * jet_.first[0] + ray[1] * jet_.first[1];
}

geometry::Vector3 PolarRule::curvature(const geometry::Vector2& ray) const {
  return ray[0] * ray[0] * jet_.second[0] + ray[1] * ray[1] * jet_.second[1] + 2.0 * ray[0] * ray[1] * jet_.second[2];
}

/// On a ray, along which the coordinate runs from 0 at the pole to 1.
PolarRule::Complex PolarRule::singularity(const geometry::Vector2& ray) const {
  return line_singularity(jet_, ray, geometry::Vector2::Zero());
}

/// Where the distance from the pole's point, divided by the coordinate, vanishes, by the curvature of the ray's image.
PolarRule::Complex PolarRule::distant_singularity(const geometry::Vector2& ray) const {
  const geometry::Vector3 turn = curvature(ray);
  const double bending = turn.squaredNorm();
  const double speed = tangent(ray).squaredNorm();
  if (bending < 1e-6 * speed) return {0.0, 1e3};
  const double b = 2.0 * tangent(ray).dot(turn) / bending;
  return {-b, std::sqrt(std::max(4.0 * speed / bending - b * b, 0.0))};
}

PolarRule::Ray PolarRule::radial_map(const geometry::Vector2& ray) const {
  if (is_own_) return {0.0, {}};
  const Complex root = singularity(ray);
  // No ray to the region is shorter than the nearest, but for rounding.
  const double start =
      inner_radius_ > 0.0 ? std::min(inner_radius_ / std::sqrt(metric_.product(ray, ray)), inner_share) : 0.0;
  if (start > 0.0) {
    const double scale = std::hypot(start, std::abs(root)) / (1.0 - start);
    return {start, scale < 1.5 ? SinhMap(-start / (1.0 - start), scale) : SinhMap()};
  }
  return {0.0, SinhMap::towards(root.real() <= 0.0 ? Complex(0.0, std::abs(root)) : root)};
}

/// Along the ray to a point of the boundary: the singularity at the target and what the curvatures at both ends promise
/// of others.
int PolarRule::radial_points(const SidePoint& end) const {
  const geometry::Vector2& ray = end.ray;
  const Ray radial = radial_map(ray);
  const auto log_ellipse_of = [&](Complex t) { return radial.map.log_ellipse_of(radial.inside(t)); };
  const Complex near = is_own_ ? Complex(0.0) : singularity(ray);
  double log_rho = log_ellipse_of(distant_singularity(ray));
  if (!is_own_) log_rho = std::min(log_rho, log_ellipse_of(near));
  const Complex far = 1.0 + line_singularity(end.jet, ray, geometry::Vector2::Zero());
  if (!is_vague(far, near, 1.0)) log_rho = std::min(log_rho, log_ellipse_of(far));
  const auto growth = [&](Complex x) {
    const Complex t = radial.outside(x);
    return request_.shape->growth[0](log_ellipse(pole_[0] + t * ray[0])) +
           request_.shape->growth[1](log_ellipse(pole_[1] + t * ray[1]));
  };
  return gauss_points(radial.map, log_rho, request_.tolerance, growth);
}

void PolarRule::append(const Sector& sector, NodeBuffer<3>& nodes) const {
  const MappedRule along(sector.along);
  for (std::size_t a = 0; a < static_cast<std::size_t>(sector.along.points); ++a) {
    const CurveJet<double> jet = curve_jet(sector.curve, along.places[a]);
    const geometry::Vector2 ray = jet.point - pole_;
    const Ray from_pole = radial_map(ray);
    const MappedRule radial({from_pole.map, sector.radial_points}, from_pole.start, 1.0 - from_pole.start);
    const double factor = cross<double>(ray, jet.first) * along.weights[a];
    for (std::size_t b = 0; b < static_cast<std::size_t>(sector.radial_points); ++b) {
      const double t = radial.places[b];
      const geometry::Point2 place = pole_ + t * ray;
      append_node(nodes, place.cwiseMax(0.0).cwiseMin(1.0), factor * t * radial.weights[b]);
    }
  }
}

}  // namespace isorim::quadrature
