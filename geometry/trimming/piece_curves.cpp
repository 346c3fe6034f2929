#include "geometry/trimming/piece_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/trimming/curve_cuts.h"

namespace isorim::geometry {
namespace {

std::string place_name(const Point3& x) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", x.x(), x.y(), x.z());
}

template <int Dim>
double extent(const NurbsCurve<Dim>& curve) {
  const Points<Dim> points = curve.control_points();
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

/// The parameters at which curves are compared: a few in every span, ends included.
std::vector<double> sample_parameters(const KnotVector& knots) {
  constexpr std::size_t most_spans = 32;
  const std::vector<double> breaks = knots.breakpoints();
  const std::size_t spans = breaks.size() - 1;
  const std::size_t stride = (spans + most_spans - 1) / most_spans;
  const int parts = spans < 4 ? 4 : 2;
  std::vector<double> parameters;
  for (std::size_t i = 0; i < spans; i += stride) {
    const double last = breaks[std::min(i + stride, spans)];
    for (int k = 0; k < parts; ++k) parameters.push_back(breaks[i] + (last - breaks[i]) * k / parts);
  }
  parameters.push_back(breaks.back());
  return parameters;
}

/// Distances of points from a curve in space.
class DistanceFrom {
 public:
  explicit DistanceFrom(const NurbsCurve<3>& curve, double sure) : curve_(curve), sure_(sure) {}

  /// By Newton's method from `u`, which moves to the foot; if that ends farther away than `sure`, also from the nearest
  /// of a few points of the curve.
  double operator()(const Point3& target, double& u) {
    const double near = descend(target, u);
    if (near <= sure_) return near;
    if (parameters_.empty()) {
      parameters_ = sample_parameters(curve_.knots());
      samples_.resize(3, static_cast<Eigen::Index>(parameters_.size()));
      for (std::size_t i = 0; i < parameters_.size(); ++i)
        samples_.col(static_cast<Eigen::Index>(i)) = evaluate(curve_, parameters_[i]);
    }
    Eigen::Index nearest = 0;
    (samples_.colwise() - target).colwise().squaredNorm().minCoeff(&nearest);
    double other = parameters_[static_cast<std::size_t>(nearest)];
    const double far = descend(target, other);
    if (far < near) u = other;
    return std::min(near, far);
  }

 private:
  double descend(const Point3& target, double& u) const {
    const Interval domain = curve_.domain();
    CurveJet<3> jet = evaluate_jet(curve_, u);
    for (int k = 0; k < 12; ++k) {
      const Vector3 offset = jet.point - target;
      if (offset.norm() <= 1e-3 * sure_) break;
      const double curvature = jet.du.squaredNorm() + std::max(0.0, offset.dot(jet.duu));
      if (!(curvature > 0.0)) break;
      const double next = std::clamp(u - offset.dot(jet.du) / curvature, domain.first, domain.last);
      if (std::abs(next - u) <= 1e-12 * domain.length()) break;
      const CurveJet<3> there = evaluate_jet(curve_, next);
      if ((there.point - target).norm() > offset.norm()) break;
      u = next;
      jet = there;
    }
    return (jet.point - target).norm();
  }

  const NurbsCurve<3>& curve_;
  double sure_;
  std::vector<double> parameters_;
  Points<3> samples_;
};

}  // namespace

double disagreement(const NurbsCurve<2>& pcurve, const NurbsCurve<3>& model_curve, const ParameterRectangle& rectangle,
                    double size) {
  const Interval own = pcurve.domain();
  const Interval theirs = model_curve.domain();
  const Point3 start = rectangle.point(start_of(pcurve));
  const Point3 end = rectangle.point(end_of(pcurve));
  const Point3 model_start = evaluate(model_curve, theirs.first);
  const Point3 model_end = evaluate(model_curve, theirs.last);
  const double same = std::max((start - model_start).norm(), (end - model_end).norm());
  const double opposite = std::max((start - model_end).norm(), (end - model_start).norm());
  const bool is_opposite = opposite < same;
  // Closed curves may start anywhere.
  const bool are_closed = (start - end).norm() <= 1e-6 * size && (model_start - model_end).norm() <= 1e-6 * size;
  double largest = are_closed ? 0.0 : std::min(same, opposite);
  DistanceFrom distance(model_curve, 1e-6 * size);
  double u = 0.0;
  bool is_first = true;
  for (const double t : sample_parameters(pcurve.knots())) {
    const double s = (t - own.first) / own.length();
    const double expected = is_opposite ? theirs.last - s * theirs.length() : theirs.first + s * theirs.length();
    // From the last foot, or from the same part of the parameter if that is nearer.
    const Point3 target = rectangle.point(evaluate(pcurve, t));
    if (is_first || (evaluate(model_curve, expected) - target).norm() < (evaluate(model_curve, u) - target).norm())
      u = expected;
    is_first = false;
    largest = std::max(largest, distance(target, u));
  }
  return largest;
}

double face_size(const LooseFace& face, const ParameterRectangle& rectangle) {
  Point3 lower = Point3::Constant(std::numeric_limits<double>::infinity());
  Point3 upper = -lower;
  const auto include = [&](const Point3& x) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  };
  for (const LooseLoop& loop : face.loops)
    for (const LoosePiece& piece : loop.pieces) {
      if (piece.model_curve) {
        const Points<3> points = piece.model_curve->control_points();
        include(points.rowwise().minCoeff());
        include(points.rowwise().maxCoeff());
      } else if (piece.pcurve) {
        for (const double t : sample_parameters(piece.pcurve->knots()))
          include(rectangle.point(rectangle.clamp_open(evaluate(*piece.pcurve, t))));
      }
    }
  const double size = (upper - lower).norm();
  return std::isfinite(size) && size > 0.0 ? size : rectangle.surface_size();
}

PieceCurves::PieceCurves(const ParameterRectangle& rectangle, const InversionOptions& options, FaceRepairs& repairs)
    : rectangle_(rectangle), options_(options), repairs_(repairs) {}

NurbsCurve<2> PieceCurves::into_domain(const NurbsCurve<2>& pcurve) const {
  // Angles that a file counts from another turn, in a direction in which the surface does not close.
  const Points<2> points = pcurve.control_points();
  Vector2 shift = Vector2::Zero();
  for (int d = 0; d < 2; ++d) {
    if (rectangle_.is_closed(d)) continue;
    const Interval domain = rectangle_.domain(d);
    const double low = points.row(d).minCoeff();
    const double high = points.row(d).maxCoeff();
    const double tolerance = rectangle_.tolerance()[d];
    if (low >= domain.first - tolerance && high <= domain.last + tolerance) continue;
    constexpr double turn = 2.0 * std::numbers::pi;
    const double by = turn * std::round((domain.middle() - 0.5 * (low + high)) / turn);
    if (low + by >= domain.first - tolerance && high + by <= domain.last + tolerance) shift[d] = by;
  }
  if (shift == Vector2::Zero()) return pcurve;
  return transform(pcurve, AffineMap<2>{Eigen::Matrix2d::Identity(), shift});
}

std::vector<NurbsCurve<2>> PieceCurves::given(const LoosePiece& piece, const std::string& name,
                                              std::string& objection) {
  const NurbsCurve<2> pcurve = into_domain(*piece.pcurve);
  const bool is_moved = pcurve.homogeneous() != piece.pcurve->homogeneous();
  ClippedCurve clipped = clip_at_open_sides(pcurve, rectangle_);
  if (clipped.is_clipped && clipped.excess > options_.largest_deviation) {
    objection = fmt::format("the parameter curve leaves the surface by {:.3g}", clipped.excess);
    return {};
  }
  if (piece.model_curve) {
    double off = 0.0;
    // A clipped curve is compared without its lines along the sides, as far as it goes.
    off = disagreement(clipped.is_clipped && clipped.parts.size() == 1 ? clipped.parts.front() : pcurve,
                       *piece.model_curve, rectangle_, options_.size);
    if (off > options_.largest_deviation) {
      objection = fmt::format("the parameter curve lies {:.3g} off the curve in space", off);
      repairs_.largest_disagreement = std::max(repairs_.largest_disagreement, off);
      return {};
    }
    repairs_.largest_disagreement = std::max(repairs_.largest_disagreement, off);
  }
  if (clipped.is_clipped || is_moved) ++repairs_.shifted_curves;
  if (clipped.is_clipped && clipped.excess > 1e-6 * options_.size)
    repairs_.notes.push_back(
        fmt::format("{}: the parameter curve left the surface by {:.3g} and was clipped", name, clipped.excess));
  return std::move(clipped.parts);
}

std::vector<NurbsCurve<2>> PieceCurves::inverted(const NurbsCurve<3>& curve, InvertedCurve& result) {
  if (!inverter_) inverter_ = std::make_unique<CurveInverter>(rectangle_, options_);
  result = inverter_->invert(curve);
  std::vector<NurbsCurve<2>> parts;
  for (const NurbsCurve<2>& whole : result.curves) {
    ClippedCurve clipped = clip_at_open_sides(whole, rectangle_);
    if (clipped.is_clipped) result.deviation = std::max(result.deviation, clipped.excess);
    parts.insert(parts.end(), clipped.parts.begin(), clipped.parts.end());
  }
  if (result.deviation > options_.largest_deviation) parts.clear();
  return parts;
}

std::vector<LoopCurve> PieceCurves::curves_of(const LoosePiece& piece, int number, const std::string& name) {
  if (!piece.pcurve && !piece.model_curve)
    throw GeometryError(fmt::format("{} has neither a parameter curve nor a curve in space", name));
  const double point = 1e-9 * options_.size;
  const bool model_is_point = piece.model_curve && extent(*piece.model_curve) <= point;
  const bool pcurve_is_point = piece.pcurve && extent(*piece.pcurve) <= 1e-12 * rectangle_.lengths().norm();
  if ((!piece.pcurve || pcurve_is_point) && (!piece.model_curve || model_is_point)) return {};

  std::vector<NurbsCurve<2>> curves;
  std::string objection;
  if (piece.pcurve && !pcurve_is_point) curves = given(piece, name, objection);
  const bool is_given = !curves.empty();
  // Clipped to a point of the surface's edge.
  if (piece.pcurve && !pcurve_is_point && !is_given && objection.empty()) return {};
  if (!is_given && piece.model_curve && !model_is_point) {
    InvertedCurve result;
    curves = inverted(*piece.model_curve, result);
    if (curves.empty() && result.deviation <= options_.largest_deviation) return {};
    if (curves.empty()) {
      if (!objection.empty()) objection = " (" + objection + ")";
      throw GeometryError(
          fmt::format("{}: the curve in space lies {:.3g} off the surface at {}; expected at most {:.3g}{}", name,
                      result.deviation, place_name(result.farthest), options_.largest_deviation, objection));
    }
    ++repairs_.inverted_pieces;
    repairs_.largest_deviation = std::max(repairs_.largest_deviation, result.deviation);
    if (!objection.empty())
      repairs_.notes.push_back(fmt::format("{}: {}; it was computed from the curve in space", name, objection));
    if (result.misfit > 0.0)
      repairs_.notes.push_back(
          fmt::format("{}: the computed parameter curve is {:.3g} off in space", name, result.misfit));
  }
  if (curves.empty())
    throw GeometryError(fmt::format("{}: {}; expected at most {:.3g}", name, objection, options_.largest_deviation));
  std::vector<LoopCurve> loop_curves;
  for (NurbsCurve<2>& curve : curves) loop_curves.push_back({std::move(curve), piece.edge, is_given, number});
  return loop_curves;
}

}  // namespace isorim::geometry
