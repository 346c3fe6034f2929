#include "geometry/topology/edge_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/spline/local_basis.h"

namespace isorim::geometry {
namespace {

/// A leg may turn by about 27 degrees: the sagitta of such an arc against its chord.
constexpr double flat_enough = 0.06;
/// Halvings of a first leg at most, for curves that stand still or jump.
constexpr int deepest = 10;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Knot lines of the surface that the box of the pcurve's control points spans.
int crossed_knot_lines(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve) {
  constexpr std::ptrdiff_t most = 512;
  const Points<2> points = pcurve.control_points();
  std::ptrdiff_t count = 0;
  for (const Direction direction : {Direction::u, Direction::v}) {
    const auto row = points.row(direction == Direction::u ? 0 : 1);
    const double low = row.minCoeff();
    const double high = row.maxCoeff();
    const std::vector<double> breaks = surface.knots(direction).breakpoints();
    count += std::ranges::count_if(breaks, [&](double u) { return u > low && u < high; });
  }
  return static_cast<int>(std::min(count, most));
}

/// The breakpoints with every span divided evenly, so that there are at least `legs` parts.
std::vector<double> divided(const std::vector<double>& breaks, int legs) {
  const int spans = static_cast<int>(breaks.size()) - 1;
  const int parts = std::max(1, (legs + spans - 1) / spans);
  std::vector<double> result{breaks.front()};
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    for (int k = 1; k < parts; ++k) result.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * k / parts);
    result.push_back(breaks[i + 1]);
  }
  return result;
}

/// Whether splines on these knots may turn a corner inside the domain.
bool has_kinks(const KnotVector& knots) {
  int multiplicity = 1;
  const Interval domain = knots.domain();
  for (std::size_t i = 1; i < knots.knots().size(); ++i) {
    const double knot = knots.knots()[i];
    multiplicity = knot == knots.knots()[i - 1] ? multiplicity + 1 : 1;
    if (knot > domain.first && knot < domain.last && multiplicity >= knots.degree()) return true;
  }
  return false;
}

double distance_from_chord(const Point3& point, const Point3& from, const Point3& to) {
  const Vector3 chord = to - from;
  const double along = std::clamp((point - from).dot(chord) / std::max(chord.squaredNorm(), 1e-300), 0.0, 1.0);
  return (point - from - along * chord).norm();
}

}  // namespace

EdgeCurve::EdgeCurve(const NurbsSurface<3>& surface, NurbsCurve<2> pcurve)
    : surface_(&surface),
      pcurve_(std::move(pcurve)),
      exact_(exact_lift(surface, pcurve_)),
      kinks_u_(!exact_ && has_kinks(surface.knots_u())),
      kinks_v_(!exact_ && has_kinks(surface.knots_v())) {
  sample();
  lower_ = upper_ = samples_.front().point;
  for (const Sample& sample : samples_) {
    lower_ = lower_.cwiseMin(sample.point - Vector3::Constant(sample.bulge));
    upper_ = upper_.cwiseMax(sample.point + Vector3::Constant(sample.bulge));
  }
}

Point3 EdgeCurve::at(double t) const {
  return exact_ ? evaluate(*exact_, t) : lifted_point(*surface_, pcurve_, t);
}

EdgeCurve::Tangent EdgeCurve::tangent(double t) const {
  if (!exact_) {
    const LiftedJet lifted = jet(t);
    return {lifted.point, lifted.tangent};
  }
  const LocalBasis<1> basis = local_basis<1>(exact_->knots(), t);
  const Eigen::Matrix<double, 4, 2> value =
      exact_->homogeneous().middleCols(basis.first, basis.table.rows()).lazyProduct(basis.table);
  const Point3 point = value.col(0).head<3>() / value(3, 0);
  return {point, (value.col(1).head<3>() - value(3, 1) * point) / value(3, 0)};
}

bool EdgeCurve::has_straight_legs() const {
  return exact_ && exact_->degree() == 1 && exact_->is_polynomial();
}

std::vector<double> EdgeCurve::breakpoints() const {
  if (exact_) return exact_->knots().breakpoints();
  return divided(pcurve_.knots().breakpoints(), crossed_knot_lines(*surface_, pcurve_));
}

void EdgeCurve::sample() {
  const bool straight_legs = has_straight_legs();
  const std::vector<double> parameters =
      exact_ ? divided(exact_->knots().breakpoints(), straight_legs ? 1 : 4)
             : divided(pcurve_.knots().breakpoints(), std::max(8, crossed_knot_lines(*surface_, pcurve_)));
  Point3 from = at(parameters.front());
  for (std::size_t i = 0; i + 1 < parameters.size(); ++i) {
    const Point3 to = at(parameters[i + 1]);
    if (straight_legs) {
      samples_.push_back({parameters[i], from, 0.0});
    } else {
      append_samples(parameters[i], from, parameters[i + 1], to, deepest);
    }
    from = to;
  }
  samples_.push_back({parameters.back(), from, 0.0});
}

void EdgeCurve::append_samples(double t0, const Point3& p0, double t1, const Point3& p1, int depth) {
  const double middle = 0.5 * (t0 + t1);
  const Point3 point = at(middle);
  const double first = (point - p0).norm();
  const double second = (p1 - point).norm();
  const bool even = std::min(first, second) >= 0.2 * (first + second);
  const bool stands_still = first + second <= 1e-13 * point.cwiseAbs().maxCoeff();
  const bool has_kink = may_have_kink({t0, t1});
  if (stands_still || depth == 0) {
    // The last resort: between its ends the curve may be anywhere within their distance.
    samples_.push_back({t0, p0, first});
    samples_.push_back({middle, point, second});
    return;
  }
  if (!has_kink && even && distance_from_chord(point, p0, p1) <= flat_enough * (p1 - p0).norm()) {
    const double first_sagitta = distance_from_chord(at(0.5 * (t0 + middle)), p0, point);
    const double second_sagitta = distance_from_chord(at(0.5 * (middle + t1)), point, p1);
    if (first_sagitta <= flat_enough * first && second_sagitta <= flat_enough * second) {
      // What is beyond the sagitta is for legs that wind about their chord.
      samples_.push_back({t0, p0, 1.5 * first_sagitta + 2e-3 * first});
      samples_.push_back({middle, point, 1.5 * second_sagitta + 2e-3 * second});
      return;
    }
  }
  append_samples(t0, p0, middle, point, depth - 1);
  append_samples(middle, point, t1, p1, depth - 1);
}

/// Whether a knot line at which the surface is no more than continuous is crossed on the way.
bool EdgeCurve::may_have_kink(Interval part) const {
  if (exact_) return false;
  const Point2 from = evaluate(pcurve_, part.first);
  const Point2 to = evaluate(pcurve_, part.last);
  return (kinks_u_ && surface_->knots_u().find_span(from.x()) != surface_->knots_u().find_span(to.x())) ||
         (kinks_v_ && surface_->knots_v().find_span(from.y()) != surface_->knots_v().find_span(to.y()));
}

std::size_t EdgeCurve::leg_at(double t) const {
  const auto after = std::ranges::upper_bound(samples_, t, {}, &Sample::t);
  const std::ptrdiff_t leg = after - samples_.begin() - 1;
  return static_cast<std::size_t>(std::clamp(leg, std::ptrdiff_t{0}, static_cast<std::ptrdiff_t>(samples_.size()) - 2));
}

int EdgeCurve::leg_count(Interval part) const {
  return static_cast<int>(leg_at(part.last) - leg_at(part.first)) + 1;
}

double EdgeCurve::length(Interval part) const {
  constexpr std::array<double, 4> nodes{0.069431844202973712, 0.330009478207571868, 0.669990521792428132,
                                        0.930568155797026288};
  constexpr std::array<double, 4> weights{0.173927422568726929, 0.326072577431273071, 0.326072577431273071,
                                          0.173927422568726929};
  double sum = 0.0;
  for (std::size_t leg = leg_at(part.first); leg + 1 < samples_.size() && samples_[leg].t < part.last; ++leg) {
    const double from = std::max(part.first, samples_[leg].t);
    const double to = std::min(part.last, samples_[leg + 1].t);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sum += weights[i] * (to - from) * tangent(from + nodes[i] * (to - from)).derivative.norm();
  }
  return sum;
}

EdgeCurve::LegDistance EdgeCurve::leg_distance(std::size_t leg, const Point3& target) const {
  const Sample& from = samples_[leg];
  const Sample& to = samples_[leg + 1];
  const Vector3 chord = to.point - from.point;
  const double squared = chord.squaredNorm();
  const double s = squared > 0.0 ? std::clamp((target - from.point).dot(chord) / squared, 0.0, 1.0) : 0.5;
  return {(from.point + s * chord - target).norm(), from.t + s * (to.t - from.t)};
}

/// The leg and its neighbours: a curve may come nearest a little beyond the end of the nearest leg.
Interval EdgeCurve::around(std::size_t leg, Interval within) const {
  const std::size_t first = leg == 0 ? 0 : leg - 1;
  const std::size_t last = std::min(leg + 2, samples_.size() - 1);
  return {std::max(within.first, samples_[first].t), std::min(within.last, samples_[last].t)};
}

/// Gauss and Newton's descent on the exact curve; close to the curve it converges as fast as Newton's. Where it does
/// not converge in a few steps, the target being about as far as the centre of curvature, the slope's sign decides.
EdgeCurve::Foot EdgeCurve::refine(const Point3& target, double start, Interval within) const {
  constexpr int most_steps = 10;
  double t = std::clamp(start, within.first, within.last);
  Tangent jet = tangent(t);
  double distance = (jet.point - target).norm();
  for (int i = 0; i < most_steps; ++i) {
    const double speed = jet.derivative.squaredNorm();
    if (!(speed > 0.0)) break;
    const double step = -jet.derivative.dot(jet.point - target) / speed;
    const double next = std::clamp(t + step, within.first, within.last);
    // A step along the curve changes the distance by its square over twice the distance.
    if (next == t || std::abs(next - t) * std::sqrt(speed) <= 1e-9 * distance) return {t, distance};
    const Tangent at_next = tangent(next);
    const double next_distance = (at_next.point - target).norm();
    if (!(next_distance < distance)) break;
    t = next;
    jet = at_next;
    distance = next_distance;
  }
  return bisect_slope(target, {t, distance}, jet, within);
}

EdgeCurve::Foot EdgeCurve::bisect_slope(const Point3& target, Foot start, const Tangent& jet, Interval within) const {
  const auto slope = [&](const Tangent& at) { return at.derivative.dot(at.point - target); };
  const bool ahead = slope(jet) < 0.0;
  Interval bracket = ahead ? Interval{start.t, within.last} : Interval{within.first, start.t};
  const double tiny = 1e-12 * domain().length();
  Foot best = start;
  const auto keep_nearest = [&](double t, const Tangent& at) {
    const double distance = (at.point - target).norm();
    if (distance < best.distance) best = {t, distance};
  };
  const double far_end = ahead ? within.last : within.first;
  const Tangent at_end = tangent(far_end);
  keep_nearest(far_end, at_end);
  if ((slope(at_end) < 0.0) == ahead) return best;
  while (bracket.length() > tiny) {
    const double middle = bracket.middle();
    if (middle <= bracket.first || middle >= bracket.last) break;
    const Tangent at = tangent(middle);
    keep_nearest(middle, at);
    (slope(at) < 0.0 ? bracket.first : bracket.last) = middle;
  }
  return best;
}

std::optional<EdgeCurve::Foot> EdgeCurve::nearest(const Point3& target, Interval within, double limit) const {
  const std::size_t first = leg_at(within.first);
  const std::size_t last = leg_at(within.last);
  std::size_t best_leg = first;
  LegDistance best_start{infinity, within.first};
  double lowest = infinity;
  for (std::size_t leg = first; leg <= last; ++leg) {
    const LegDistance found = leg_distance(leg, target);
    lowest = std::min(lowest, found.distance - samples_[leg].bulge);
    if (found.distance >= best_start.distance) continue;
    best_start = found;
    best_leg = leg;
  }
  if (lowest > limit) return std::nullopt;
  Foot best = refine(target, best_start.t, around(best_leg, within));
  for (std::size_t leg = first; leg <= last; ++leg) {
    if (leg + 1 >= best_leg && leg <= best_leg + 1) continue;
    const LegDistance found = leg_distance(leg, target);
    if (found.distance - samples_[leg].bulge >= best.distance) continue;
    const Foot foot = refine(target, found.t, around(leg, within));
    if (foot.distance < best.distance) best = foot;
  }
  if (best.distance > limit) return std::nullopt;
  return best;
}

std::vector<EdgeCurve::Foot> EdgeCurve::feet(const Point3& target, Interval within, double limit) const {
  std::vector<Foot> result;
  const std::size_t last = leg_at(within.last);
  LegDistance best{infinity, 0.0};
  std::size_t best_leg = 0;
  const auto close_run = [&] {
    if (best.distance == infinity) return;
    const Foot foot = refine(target, best.t, around(best_leg, within));
    const bool is_new = result.empty() || foot.t > result.back().t;
    if (foot.distance <= limit && is_new) result.push_back(foot);
    best.distance = infinity;
  };
  for (std::size_t leg = leg_at(within.first); leg <= last; ++leg) {
    const LegDistance found = leg_distance(leg, target);
    if (found.distance - samples_[leg].bulge > limit) {
      close_run();
    } else if (found.distance < best.distance) {
      best = found;
      best_leg = leg;
    }
  }
  close_run();
  return result;
}

std::vector<EdgeCurve::Box> EdgeCurve::boxes(Interval within) const {
  constexpr std::size_t most = 8;
  const std::size_t last = leg_at(within.last);
  std::vector<Box> result;
  for (std::size_t leg = leg_at(within.first); leg <= last; leg += most) {
    Box box{samples_[leg].point, samples_[leg].point};
    double bulge = 0.0;
    for (std::size_t k = leg; k <= std::min(leg + most - 1, last); ++k) {
      box.lower = box.lower.cwiseMin(samples_[k + 1].point);
      box.upper = box.upper.cwiseMax(samples_[k + 1].point);
      bulge = std::max(bulge, samples_[k].bulge);
    }
    box.lower.array() -= bulge;
    box.upper.array() += bulge;
    result.push_back(box);
  }
  return result;
}

}  // namespace isorim::geometry
