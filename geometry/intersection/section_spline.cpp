#include "geometry/intersection/section_spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/smooth_run.h"
#include "geometry/spline/bspline.h"

namespace isorim::geometry {
namespace {

constexpr int degree = 5;
/// Curvatures that differ by less, relative to their size and to that of the curve, are the same.
constexpr double curvature_tolerance = 1e-5;
/// Segments are not made shorter than this part of their run.
constexpr double shortest_segment = 1e-7;

double cross(const Vector2& a, const Vector2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A smooth curve by its arc length, from a table of lengths: Gauss-Legendre rules of 8 points on eighths of each
/// Bézier segment.
class PlanePath {
 public:
  explicit PlanePath(const NurbsCurve<2>& curve) : curve_(&curve) {
    constexpr int parts = 8;
    const std::vector<double> breaks = curve.knots().breakpoints();
    add_node(breaks.front(), 0.0);
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
      for (int k = 1; k <= parts; ++k) {
        const double next = k == parts ? breaks[i + 1] : breaks[i] + (breaks[i + 1] - breaks[i]) * k / parts;
        add_node(next, lengths_.back() + length_between(nodes_.back(), next));
      }
  }

  double length() const { return lengths_.back(); }

  ArcJet at(double s) const {
    // Newton's method from the inverse that the table's values and speeds interpolate; the step squares the error.
    constexpr double last_step = 1e-9;
    constexpr int most_steps = 12;
    const auto above = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, s);
    const auto i = static_cast<std::size_t>(above - lengths_.begin()) - 1;
    double t = guess(i, s);
    for (int iteration = 0; iteration < most_steps; ++iteration) {
      const double speed = evaluate_jet(*curve_, t).du.norm();
      const double step = (s - lengths_[i] - length_between(nodes_[i], t)) / speed;
      if (!std::isfinite(step)) break;
      t = std::clamp(t + step, nodes_[i], nodes_[i + 1]);
      if (std::abs(step) * speed <= last_step * length()) break;
    }
    const CurveJet<2> jet = evaluate_jet(*curve_, t);
    const double speed = jet.du.norm();
    ArcJet result{jet.point, Vector2::Zero(), Vector2::Zero()};
    if (!(speed > 0.0)) return result;
    result.tangent = jet.du / speed;
    result.bend = cross(jet.du, jet.duu) / (speed * speed * speed) * Vector2(-result.tangent.y(), result.tangent.x());
    return result;
  }

 private:
  double length_between(double from, double to) const {
    static constexpr std::array<double, 4> nodes{0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                                                 0.96028985649753623168};
    static constexpr std::array<double, 4> weights{0.36268378337836198297, 0.31370664587788728734,
                                                   0.22238103445337447054, 0.10122853629037625915};
    const double middle = 0.5 * (from + to);
    const double half = 0.5 * (to - from);
    double sum = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      for (const double side : {-1.0, 1.0})
        sum += weights[k] * evaluate_jet(*curve_, middle + side * half * nodes[k]).du.norm();
    return half * sum;
  }

  void add_node(double t, double length) {
    nodes_.push_back(t);
    lengths_.push_back(length);
    speeds_.push_back(evaluate_jet(*curve_, t).du.norm());
  }

  /// The parameter at the length s by cubic Hermite interpolation of the inverse; where the speed vanishes, linear.
  double guess(std::size_t i, double s) const {
    const double span = lengths_[i + 1] - lengths_[i];
    const double width = nodes_[i + 1] - nodes_[i];
    if (!(span > 0.0)) return nodes_[i];
    const double x = (s - lengths_[i]) / span;
    if (!(speeds_[i] * width > 0.3 * span && speeds_[i + 1] * width > 0.3 * span)) return nodes_[i] + x * width;
    const double first = span / speeds_[i];
    const double last = span / speeds_[i + 1];
    const double bend = first + last - 2.0 * width;
    const double t = nodes_[i] + x * (first + x * (3.0 * width - 2.0 * first - last + x * bend));
    return std::clamp(t, nodes_[i], nodes_[i + 1]);
  }

  const NurbsCurve<2>* curve_;
  std::vector<double> nodes_;
  /// At the nodes.
  std::vector<double> lengths_;
  std::vector<double> speeds_;
};

enum class Joint { smooth, bend, corner };

/// What happens between the end of one path and the start of the next.
Joint joint_between(const ArcJet& end, const ArcJet& start, double length, double corner_angle) {
  const double angle = std::atan2(std::abs(cross(end.tangent, start.tangent)), end.tangent.dot(start.tangent));
  if (!(angle <= corner_angle)) return Joint::corner;
  const double jump = (end.bend - start.bend).norm();
  const double allowed = curvature_tolerance * (end.bend.norm() + start.bend.norm() + 1.0 / length);
  return jump <= allowed ? Joint::smooth : Joint::bend;
}

/// The Bézier points of the quintic over an arc of length h with the two ends' data.
Points<2> hermite(const ArcJet& from, const ArcJet& to, double h) {
  Points<2> points(2, degree + 1);
  points.col(0) = from.point;
  points.col(1) = from.point + h / 5.0 * from.tangent;
  points.col(2) = from.point + 2.0 * h / 5.0 * from.tangent + h * h / 20.0 * from.bend;
  points.col(5) = to.point;
  points.col(4) = to.point - h / 5.0 * to.tangent;
  points.col(3) = to.point - 2.0 * h / 5.0 * to.tangent + h * h / 20.0 * to.bend;
  return points;
}

Point2 de_casteljau(Points<2> points, double t) {
  for (Eigen::Index last = points.cols() - 1; last > 0; --last)
    for (Eigen::Index i = 0; i < last; ++i) points.col(i) += t * (points.col(i + 1) - points.col(i));
  return points.col(0);
}

class SectionFitter {
 public:
  SectionFitter(const SectionCurve& section, const SectionSplineOptions& options)
      : section_(section), options_(options) {
    if (!(options.tolerance > 0.0))
      throw GeometryError(
          fmt::format("fitting a section: the tolerance is {}; it must be positive", options.tolerance));
    // What bridges a gap has no direction of its own.
    for (const NurbsCurve<2>& curve : section.plane_curves.curves) {
      PlanePath path(curve);
      if (path.length() > std::max(2.0 * section.largest_gap, 1e-14)) paths_.push_back(std::move(path));
    }
    if (paths_.empty())
      for (const NurbsCurve<2>& curve : section.plane_curves.curves)
        if (PlanePath path(curve); path.length() > 0.0) paths_.push_back(std::move(path));
    if (paths_.empty()) throw GeometryError("fitting a section: the curve is a point");
    for (const PlanePath& path : paths_) length_ += path.length();
  }

  SectionSpline fit() {
    find_joints();
    rotate_to_corner();
    double start = 0.0;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      if (i == 0 || joints_[i] != Joint::smooth) runs_.push_back({start, start, i, i});
      start += paths_[i].length();
      runs_.back().last = start;
      runs_.back().end = i + 1;
    }
    for (Run& run : runs_) fit(run);
    return spline();
  }

 private:
  /// Consecutive paths without a jump of tangent or curvature between them.
  struct Run {
    double first;
    double last;
    std::size_t begin;
    std::size_t end;
    /// Of the knots between its segments.
    int multiplicity = hermite_multiplicity;
  };

  /// joints_[i] is before path i; that before the first one is a corner if the curve is open.
  void find_joints() {
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      const PlanePath& before = paths_[(i + paths_.size() - 1) % paths_.size()];
      joints_.push_back(i == 0 && !section_.is_closed ? Joint::corner
                                                      : joint_between(before.at(before.length()), paths_[i].at(0.0),
                                                                      length_, options_.corner_angle));
    }
  }

  void rotate_to_corner() {
    auto first = std::ranges::find(joints_, Joint::corner);
    if (first == joints_.end()) first = std::ranges::find(joints_, Joint::bend);
    if (first == joints_.end()) return;
    const auto shift = first - joints_.begin();
    std::rotate(joints_.begin(), first, joints_.end());
    std::rotate(paths_.begin(), paths_.begin() + shift, paths_.end());
  }

  /// At a joint inside the run the limits agree but for gaps: their mean.
  ArcJet at(const Run& run, double s) const {
    double start = run.first;
    std::size_t i = run.begin;
    while (i + 1 < run.end && s > start + paths_[i].length()) start += paths_[i++].length();
    const double local = std::clamp(s - start, 0.0, paths_[i].length());
    ArcJet jet = paths_[i].at(local);
    const bool has_next = i + 1 < run.end || s == run.last;
    if (local == paths_[i].length() && has_next) return mean_with_next(jet, i);
    if (s == run.first) return mean_with_previous(jet, i);
    return jet;
  }

  ArcJet mean_with_next(const ArcJet& jet, std::size_t i) const {
    const std::size_t next = (i + 1) % paths_.size();
    if (next == 0 && !section_.is_closed) return jet;
    return mean(jet, paths_[next].at(0.0), joints_[next]);
  }
  ArcJet mean_with_previous(const ArcJet& jet, std::size_t i) const {
    if (i == 0 && !section_.is_closed) return jet;
    const PlanePath& previous = paths_[(i + paths_.size() - 1) % paths_.size()];
    return mean(jet, previous.at(previous.length()), joints_[i]);
  }

  static ArcJet mean(const ArcJet& own, const ArcJet& other, Joint joint) {
    ArcJet result = own;
    result.point = 0.5 * (own.point + other.point);
    if (joint == Joint::corner) return result;
    result.tangent = (own.tangent + other.tangent).normalized();
    if (joint == Joint::smooth) result.bend = 0.5 * (own.bend + other.bend);
    return result;
  }

  /// Appends the segments of a run: C4, or Hermite's if those are not more.
  void fit(Run& run) {
    RunSamples samples;
    samples.start = at(run, run.first);
    samples.end = at(run, run.last);
    samples.is_periodic = is_periodic() && runs_.size() == 1 && joints_.front() == Joint::smooth;
    const double error_before = error_;
    const std::size_t count_before = segments_.size();
    append(run, {run.first, run.last}, samples.start, samples.end, samples);
    if (!tolerance_met_ || section_.largest_gap > 0.5 * options_.tolerance) return;
    const std::optional<RunSpline> smooth =
        smooth_run_spline(samples, 0.8 * options_.tolerance, [&](double s) { return at(run, s).point; });
    if (!smooth) return;
    run.multiplicity = 1;
    error_ = std::max(error_before, smooth->error);
    segments_.resize(count_before);
    segments_.insert(segments_.end(), smooth->segments.begin(), smooth->segments.end());
  }

  void append(const Run& run, Interval s, const ArcJet& from, const ArcJet& to, RunSamples& samples) {
    const Points<2> points = hermite(from, to, s.length());
    const ArcJet middle = at(run, s.middle());
    double error = (de_casteljau(points, 0.5) - middle.point).norm();
    // At a gap the curve jumps; the spline passes through the middle.
    const double allowed = std::max(0.5 * options_.tolerance, 0.75 * section_.largest_gap);
    constexpr std::array<double, 4> checks{0.15, 0.3, 0.7, 0.85};
    std::array<Point2, 4> places;
    for (const std::size_t k : {1U, 2U, 0U, 3U}) {
      if (!(error <= allowed)) break;
      places[k] = at(run, s.first + checks[k] * s.length()).point;
      error = std::max(error, (de_casteljau(points, checks[k]) - places[k]).norm());
    }
    const bool is_shortest = s.length() < shortest_segment * (run.last - run.first);
    if (error <= allowed || is_shortest) {
      error_ = std::max(error_, error);
      tolerance_met_ = tolerance_met_ && error <= allowed;
      segments_.push_back({s, points});
      samples.spans.push_back({s, error});
      samples.samples.push_back({s.first, from.point});
      for (std::size_t k = 0; k < checks.size(); ++k) {
        samples.samples.push_back({s.first + checks[k] * s.length(), places[k]});
        if (k == 1) samples.samples.push_back({s.middle(), middle.point});
      }
      return;
    }
    append(run, {s.first, s.middle()}, from, middle, samples);
    append(run, {s.middle(), s.last}, middle, to, samples);
  }

  // --- The B-spline -------------------------------------------------------------------------------------------

  /// C2.
  static constexpr int hermite_multiplicity = 3;

  static int multiplicity(Joint joint, const Run& run) {
    return joint == Joint::corner ? 5 : joint == Joint::bend ? 4 : run.multiplicity;
  }

  /// Of the knot at the start of a segment.
  int multiplicity_at(double s) const {
    const auto after = std::ranges::upper_bound(runs_, s, {}, &Run::first);
    const Run& run = *std::prev(after);
    return run.first == s ? multiplicity(joints_[run.begin], run) : run.multiplicity;
  }

  SectionSpline spline() const {
    SectionSpline result{spline_curve(), is_periodic(), {}, length_, error_, tolerance_met_};
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (joints_[runs_[i].begin] == Joint::corner && (section_.is_closed || i > 0))
        result.corners.push_back(runs_[i].first);
    return result;
  }

  bool is_periodic() const { return section_.is_closed && joints_.front() != Joint::corner; }

  NurbsCurve<2> spline_curve() const {
    std::vector<double> breaks{0.0};
    for (std::size_t i = 1; i < segments_.size(); ++i)
      breaks.insert(breaks.end(), static_cast<std::size_t>(multiplicity_at(segments_[i].s.first)),
                    segments_[i].s.first);
    const double end = segments_.back().s.last;
    const bool closes = is_periodic();
    breaks.insert(breaks.end(), static_cast<std::size_t>(closes ? multiplicity(joints_.front(), runs_.front()) : 1),
                  end);
    const KnotVector knots = closes ? KnotVector::periodic(degree, breaks) : KnotVector::clamped(degree, breaks);
    Points<2> points(2, knots.basis_count());
    for (Eigen::Index i = 0; i < points.cols(); ++i) points.col(i) = control_point(knots, static_cast<int>(i));
    if (closes)
      for (Eigen::Index k = 0; k < degree; ++k) points.col(points.cols() - degree + k) = points.col(k);
    if (section_.is_closed && !closes) points.col(points.cols() - 1) = points.col(0);
    return NurbsCurve<2>::from_points(knots, points);
  }

  /// The blossom of a segment that the function lives on, the longest between its inner knots, at these knots.
  Point2 control_point(const KnotVector& knots, int index) const {
    const double period = segments_.back().s.last;
    std::array<double, degree> arguments;
    for (int k = 0; k < degree; ++k) arguments[static_cast<std::size_t>(k)] = knots[index + 1 + k];
    const ArcSegment* best = nullptr;
    double shift = 0.0;
    const std::vector<double> shifts =
        is_periodic() ? std::vector<double>{0.0, -period, period} : std::vector<double>{0.0};
    for (const double by : shifts)
      for (const ArcSegment& segment : segments_) {
        const double first = segment.s.first + by;
        const double last = segment.s.last + by;
        const bool is_between = first >= arguments.front() && last <= arguments.back();
        const bool touches =
            arguments.front() == arguments.back() && (first == arguments.front() || last == arguments.front());
        if (!is_between && !touches) continue;
        if (best && segment.s.length() <= best->s.length()) continue;
        best = &segment;
        shift = by;
      }
    Points<2> points = best->points;
    for (Eigen::Index level = 0; level < degree; ++level) {
      const double t = (arguments[static_cast<std::size_t>(level)] - shift - best->s.first) / best->s.length();
      for (Eigen::Index i = 0; i + level < degree; ++i)
        points.col(i) = (1.0 - t) * points.col(i) + t * points.col(i + 1);
    }
    return points.col(0);
  }

  const SectionCurve& section_;
  SectionSplineOptions options_;
  std::vector<PlanePath> paths_;
  std::vector<Joint> joints_;
  std::vector<Run> runs_;
  std::vector<ArcSegment> segments_;
  double length_ = 0.0;
  double error_ = 0.0;
  bool tolerance_met_ = true;
};

/// Appends samples after `from`, up to and with `to`.
void append_samples(const SectionPiece& piece, const PlaneFrame& frame, Interval part, double sag, int depth,
                    std::vector<SectionSample>& samples) {
  const Point3 from = evaluate_jet(piece, part.first).place.point;
  const SectionPointJet to = evaluate_jet(piece, part.last);
  const Vector3 chord = to.place.point - from;
  double height = 0.0;
  for (const double t : {0.3, 0.5, 0.7}) {
    const Vector3 offset = evaluate_jet(piece, part.first + t * part.length()).place.point - from;
    const double along =
        chord.squaredNorm() > 0.0 ? std::clamp(offset.dot(chord) / chord.squaredNorm(), 0.0, 1.0) : 0.0;
    height = std::max(height, (offset - along * chord).norm());
  }
  if (height > 0.8 * sag && depth < 24) {
    append_samples(piece, frame, {part.first, part.middle()}, sag, depth + 1, samples);
    append_samples(piece, frame, {part.middle(), part.last}, sag, depth + 1, samples);
    return;
  }
  samples.push_back({to.place, frame.to_plane(to.place.point), to.derivative.stableNormalized()});
}

}  // namespace

SectionSpline fit_section(const SectionCurve& curve, const SectionSplineOptions& options) {
  return SectionFitter(curve, options).fit();
}

NurbsCurve<3> to_space(const NurbsCurve<2>& curve, const PlaneFrame& frame) {
  const HomogeneousPoints<2>& flat = curve.homogeneous();
  HomogeneousPoints<3> net(4, flat.cols());
  for (Eigen::Index i = 0; i < flat.cols(); ++i)
    net.col(i) << flat(2, i) * frame.origin + flat(0, i) * frame.axis_x + flat(1, i) * frame.axis_y, flat(2, i);
  return {curve.knots(), net};
}

std::vector<SectionSample> sample_section(const SectionCurve& curve, const PlaneFrame& frame, double sag) {
  if (!(sag > 0.0)) throw GeometryError(fmt::format("sampling a section: the sag is {}; it must be positive", sag));
  std::vector<SectionSample> samples;
  for (const SectionPiece& piece : curve.pieces) {
    const SectionPointJet start = evaluate_jet(piece, 0.0);
    const Point2 plane = frame.to_plane(start.place.point);
    const bool is_new = samples.empty() || (samples.back().place.point - start.place.point).norm() > 0.1 * sag;
    if (is_new) samples.push_back({start.place, plane, start.derivative.stableNormalized()});
    append_samples(piece, frame, {0.0, 1.0}, sag, 0, samples);
  }
  if (curve.is_closed && !samples.empty() &&
      (samples.back().place.point - samples.front().place.point).norm() > 0.1 * sag)
    samples.push_back(samples.front());
  return samples;
}

}  // namespace isorim::geometry
