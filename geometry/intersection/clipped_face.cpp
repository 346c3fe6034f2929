#include "geometry/intersection/clipped_face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/intersection/chebyshev_fit.h"
#include "geometry/intersection/directed_loops.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/face_locator.h"
#include "geometry/trimming/knot_line_cuts.h"
#include "geometry/trimming/parameter_grid.h"

namespace isorim::geometry {
namespace {

/// Places in the parameters this near, relative to the domain, are the same.
constexpr double vertex_tolerance = 1e-8;
/// Traced curves this near to a loop, relative to its extent, run along it.
constexpr double on_loop_tolerance = 1e-9;
/// Curves of contact this near to a place where a loop meets F = 0, relative to the domain, run through it.
constexpr double touching_tolerance = 1e-6;

/// The signs of F on a part of a loop or, if it runs along F = 0, beside it.
struct JudgedPart {
  const CuttableFace::LoopPart& part;
  SignChart chart;
  bool is_cut = false;
};

NurbsCurve<2> curve_of(const HomogeneousPoints<2>& net) {
  return {KnotVector::bezier(static_cast<int>(net.cols()) - 1), net};
}

/// Of the one or two elements whose closure holds the piece, the one on its left.
int element_on_left(const CutPiece& piece, const ParameterGrid& grid) {
  const Vector2 along = piece.end.uv() - piece.start.uv();
  const auto cell = [&](int direction, bool lower_side) {
    const int station = piece.station[static_cast<std::size_t>(direction)];
    const int last = grid.axis(direction).span_count() - 1;
    if (station % 2 != 0) return station / 2;
    return std::clamp(station / 2 - (lower_side ? 1 : 0), 0, last);
  };
  return cell(0, along.y() > 0.0) + cell(1, along.x() < 0.0) * grid.u.span_count();
}

/// The side of the element along which the piece runs.
std::optional<Side> side_of(const CutPiece& piece, int element, const ParameterGrid& grid) {
  const int i = element % grid.u.span_count();
  const int j = element / grid.u.span_count();
  if (piece.station[0] % 2 == 0) return piece.station[0] / 2 == i ? Side::left : Side::right;
  if (piece.station[1] % 2 == 0) return piece.station[1] / 2 == j ? Side::bottom : Side::top;
  return std::nullopt;
}

class FaceCutter {
 public:
  FaceCutter(const CuttableFace& face, const ImplicitSurface& implicit, const TraceOptions& options)
      : face_(face), trace_(face.surface(), face.elements(), implicit, options) {}

  int sign_everywhere() const { return trace_.sign_everywhere(); }

  int flat_elements() const {
    int count = 0;
    for (int e = 0; e < trace_.element_count(); ++e) count += trace_.function(e).vanishes ? 1 : 0;
    return count;
  }

  /// Some coefficient is not positive beyond the tolerance.
  bool may_touch() const {
    for (int e = 0; e < trace_.element_count(); ++e)
      if (trace_.function(e).whole.minCoeff() <= trace_.function(e).coincidence) return true;
    return false;
  }

  struct Kept {
    /// Those among them that lie on F = 0.
    std::vector<FaceCuts::Cut> cuts;
    /// The parts of the loops with F < 0 and the traced curves inside the face, what is kept on their left.
    std::vector<NurbsCurve<2>> curves;
    bool is_reduced = false;
  };
  Kept keep() {
    judge_loops();
    keep_loop_parts();
    keep_traced_curves();
    return std::move(kept_);
  }

  bool has_loop_on_tool() const {
    return std::ranges::any_of(parts_, [](const JudgedPart& judged) { return judged.is_cut; });
  }

  /// After keep().
  void add_contacts(FaceCuts& result) const {
    for (int e = 0; e < trace_.element_count(); ++e) {
      const ElementContacts contacts = find_contacts(trace_.function(e));
      for (const ElementContacts::Contact& contact : contacts.points) {
        const Point2 uv = trace_.from_unit_square(e, contact.place);
        if (is_in_face(uv)) result.contacts.push_back({uv, contact.kind});
      }
      for (const NurbsCurve<2>& curve : contacts.curves) add_touching(to_parameters(curve, e), result);
    }
    for (const NurbsCurve<2>& line : trace_.touching_knot_lines()) add_touching(line, result);
    for (const JudgedPart& judged : parts_) add_contacts_of(judged, result);
  }

 private:
  // --- The loops ----------------------------------------------------------------------------------------------

  void judge_loops() {
    for (const CuttableFace::LoopPart& part : face_.loop_parts()) {
      JudgedPart judged{part, chart_along(part)};
      if (judged.chart.signs.front() == 0) {
        judged.is_cut = true;
        judged.chart = chart_beside(part, part.side);
      }
      parts_.push_back(std::move(judged));
    }
  }

  /// A point of the part and its direction, in the unit square of its element.
  struct UnitPlace {
    Point2 point;
    Vector2 left;
  };
  UnitPlace unit_place(const CuttableFace::LoopPart& part, double t) const {
    const CurveJet<2> jet = evaluate_jet(curve_of(part.net), t);
    const Point2 point = trace_.to_unit_square(part.element, jet.point);
    const Vector2 along = trace_.to_unit_square(part.element, jet.point + jet.du) - point;
    return {point, Vector2(-along.y(), along.x()).normalized()};
  }

  SignChart chart_along(const CuttableFace::LoopPart& part) const {
    const ElementFunction& function = trace_.function(part.element);
    if (function.whole.minCoeff() > function.coincidence) return {{}, {1}};
    if (function.whole.maxCoeff() < -function.coincidence) return {{}, {-1}};
    const NurbsCurve<2> curve = curve_of(part.net);
    return sign_chart(
        [&](double t) { return evaluate(function.whole, trace_.to_unit_square(part.element, evaluate(curve, t))); },
        function.coincidence);
  }

  /// The signs of F just to the left of a part on which it vanishes.
  SignChart chart_beside(const CuttableFace::LoopPart& part, const std::optional<Side>& side) const {
    const ElementFunction& function = trace_.function(part.element);
    if (function.vanishes) return {{}, {0}};
    if (side && function.vanishes_on(*side)) {
      return sign_chart([&](double t) { return evaluate(function.grid, unit_place(part, t).point); },
                        function.coincidence);
    }
    const SignChart chart = sign_chart(
        [&](double t) {
          const UnitPlace place = unit_place(part, t);
          return evaluate_jet(function.whole, place.point).gradient.dot(place.left);
        },
        std::max(1e-9 * function.whole.cwiseAbs().maxCoeff(), function.coincidence));
    if (chart.signs.front() != 0) return chart;
    // The surfaces touch along the part.
    const UnitPlace middle = unit_place(part, 0.5);
    const double beside = evaluate(function.whole, middle.point + 1e-3 * middle.left);
    return {{}, {std::abs(beside) <= function.coincidence ? 0 : beside < 0.0 ? -1 : 1}};
  }

  bool is_near_tool(const CuttableFace::LoopPart& part, double t) const {
    const ElementFunction& function = trace_.function(part.element);
    const Point2 unit = trace_.to_unit_square(part.element, evaluate(curve_of(part.net), t));
    return std::abs(evaluate(function.whole, unit)) <= 1e3 * function.coincidence;
  }

  void keep_loop_parts() {
    for (const JudgedPart& judged : parts_) {
      const SignChart& chart = judged.chart;
      const CuttableFace::LoopPart& part = judged.part;
      for (const double root : chart.roots) places_.push_back(evaluate(curve_of(part.net), root));
      // Where parts join the sign may change without a root inside either.
      for (const double end : {0.0, 1.0})
        if (judged.is_cut || is_near_tool(part, end)) places_.push_back(evaluate(curve_of(part.net), end));
      for (std::size_t i = 0; i < chart.signs.size(); ++i) {
        if (chart.signs[i] >= 0) {
          kept_.is_reduced = true;
          continue;
        }
        const double from = i == 0 ? 0.0 : chart.roots[i - 1];
        const double to = i == chart.roots.size() ? 1.0 : chart.roots[i];
        if (to <= from) continue;
        NurbsCurve<2> curve = curve_of(part.net);
        if (from > 0.0 || to < 1.0) curve = reparametrise(restrict_to(curve, {from, to}), {0.0, 1.0});
        if (judged.is_cut) kept_.cuts.push_back({curve, true});
        kept_.curves.push_back(std::move(curve));
      }
    }
  }

  // --- The traced curves --------------------------------------------------------------------------------------

  void keep_traced_curves() {
    for (const TracedCurve& traced : trace_.curves()) {
      const std::vector<double> cuts = cuts_of(traced);
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        NurbsCurve<2> curve = traced.curve;
        if (cuts.size() > 2) curve = reparametrise(restrict_to(curve, {cuts[i], cuts[i + 1]}), {0.0, 1.0});
        if (!lies_inside(curve)) continue;
        kept_.is_reduced = true;
        kept_.cuts.push_back({curve, false});
        kept_.curves.push_back(std::move(curve));
      }
    }
  }

  bool lies_inside(const NurbsCurve<2>& curve) const {
    if (!face_.locator()) return true;
    for (const double t : {0.5, 0.31, 0.73})
      if (const std::optional<bool> inside = face_.locator()->contains(evaluate(curve, t), on_loop_tolerance))
        return *inside;
    return false;
  }

  /// 0, 1 and the parameters between where the loops meet the curve. A traced curve is a graph over its chord in the
  /// unit square, and its parameter the place along the chord.
  std::vector<double> cuts_of(const TracedCurve& traced) const {
    const Point2 start = trace_.to_unit_square(traced.element, evaluate(traced.curve, 0.0));
    const Vector2 chord = trace_.to_unit_square(traced.element, evaluate(traced.curve, 1.0)) - start;
    std::vector<double> cuts{0.0, 1.0};
    for (const Point2& place : places_) {
      const Point2 unit = trace_.to_unit_square(traced.element, place);
      const double t = (unit - start).dot(chord) / chord.squaredNorm();
      const double margin = vertex_tolerance / chord.norm();
      if (!(t > margin && t < 1.0 - margin)) continue;
      const Point2 on_curve = trace_.to_unit_square(traced.element, evaluate(traced.curve, t));
      if ((on_curve - unit).norm() <= vertex_tolerance) cuts.push_back(t);
    }
    std::sort(cuts.begin(), cuts.end());
    const double margin = vertex_tolerance / chord.norm();
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [&](double a, double b) { return b - a <= margin; }), cuts.end());
    cuts.back() = 1.0;
    return cuts;
  }

  // --- Contacts -----------------------------------------------------------------------------------------------

  /// On the loops it counts as inside.
  bool is_in_face(const Point2& uv) const {
    return !face_.locator() || face_.locator()->contains(uv, on_loop_tolerance).value_or(true);
  }

  NurbsCurve<2> to_parameters(const NurbsCurve<2>& unit, int element) const {
    Points<2> points = unit.control_points();
    for (Eigen::Index i = 0; i < points.cols(); ++i) points.col(i) = trace_.from_unit_square(element, points.col(i));
    return NurbsCurve<2>::from_points(unit.knots(), points);
  }

  /// The part of a touching curve inside the face: divided where the loops meet F = 0.
  void add_touching(const NurbsCurve<2>& curve, FaceCuts& result) const {
    if (!face_.locator()) {
      result.touching.push_back(curve);
      return;
    }
    const Vector2 scale = face_.extent();
    std::vector<double> cuts{0.0, 1.0};
    for (const Point2& place : places_) {
      const ClosestCurvePoint<2> near = closest_point(curve, place);
      if ((near.point - place).cwiseQuotient(scale).norm() <= touching_tolerance) cuts.push_back(near.u);
    }
    std::ranges::sort(cuts);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      if (cuts[i + 1] - cuts[i] <= touching_tolerance) continue;
      const NurbsCurve<2> part = reparametrise(restrict_to(curve, {cuts[i], cuts[i + 1]}), {0.0, 1.0});
      if (lies_inside(part)) result.touching.push_back(part);
    }
  }

  void add_contacts_of(const JudgedPart& judged, FaceCuts& result) const {
    const CuttableFace::LoopPart& part = judged.part;
    const ElementFunction& function = trace_.function(part.element);
    if (!is_near_tool_somewhere(function)) return;
    const NurbsCurve<2> curve = curve_of(part.net);
    for (const double end : {0.0, 1.0})
      if (judged.is_cut || is_near_tool(part, end))
        result.contacts.push_back({evaluate(curve, end), CriticalKind::extremum});
    if (judged.is_cut) return;
    const std::vector<double> places = touching_places(
        [&](double t) { return evaluate(function.whole, trace_.to_unit_square(part.element, evaluate(curve, t))); },
        function.coincidence);
    for (const double t : places) result.contacts.push_back({evaluate(curve, t), CriticalKind::extremum});
  }

  static bool is_near_tool_somewhere(const ElementFunction& function) {
    return function.whole.minCoeff() <= function.coincidence && function.whole.maxCoeff() >= -function.coincidence;
  }

  const CuttableFace& face_;
  ImplicitTrace trace_;
  std::vector<JudgedPart> parts_;
  /// Where the loops meet F = 0.
  std::vector<Point2> places_;
  Kept kept_;
};

}  // namespace

CuttableFace::CuttableFace(const SurfaceShape& face)
    : surface_(std::make_shared<const NurbsSurface<3>>(surface_of(face))),
      loops_(trim_loops(face)),
      elements_(bezier_elements(Boundary<3>{{Patch<3>{"surface", *surface_}}})),
      extent_(surface_->knots_u().domain().length(), surface_->knots_v().domain().length()) {
  if (std::holds_alternative<TrimmedSurface>(face)) locator_.emplace(std::get<TrimmedSurface>(face));
  const ParameterGrid grid(*surface_);
  for (CutPiece& piece : cut_at_knot_lines(loops_, grid)) {
    const int element = element_on_left(piece, grid);
    parts_.push_back({std::move(piece.net), element, side_of(piece, element, grid)});
  }
}

FaceCuts cut_face(const CuttableFace& face, const ImplicitSurface& implicit, const TraceOptions& options) {
  FaceCutter cutter(face, implicit, options);
  FaceCuts result;
  result.flat_elements = cutter.flat_elements();
  const int sign = cutter.sign_everywhere();
  if (sign < 0 || (sign > 0 && !cutter.may_touch())) return result;
  result.cuts = cutter.keep().cuts;
  cutter.add_contacts(result);
  result.has_loop_on_tool = cutter.has_loop_on_tool();
  return result;
}

KeptPart kept_part(const CuttableFace& face, const ImplicitSurface& implicit, const TraceOptions& options) {
  FaceCutter cutter(face, implicit, options);
  const int sign = cutter.sign_everywhere();
  KeptPart result;
  if (sign > 0) return result;
  result.is_whole = sign < 0;
  if (sign < 0) return result;
  FaceCutter::Kept kept = cutter.keep();
  for (FaceCuts::Cut& cut : kept.cuts) result.cuts.push_back(std::move(cut.curve));
  result.is_whole = !kept.is_reduced && cutter.flat_elements() == 0;
  if (!result.is_whole) result.curves = std::move(kept.curves);
  return result;
}

ClippedFace clip_face(const SurfaceShape& shape, const ImplicitSurface& implicit, const TraceOptions& options) {
  const CuttableFace face(shape);
  FaceCutter cutter(face, implicit, options);
  ClippedFace result;
  const int sign = cutter.sign_everywhere();
  if (sign < 0) result.shape = shape;
  result.is_reduced = sign > 0;
  result.lies_on_tool = cutter.flat_elements() > 0;
  if (sign != 0) return result;
  FaceCutter::Kept kept = cutter.keep();
  result.is_reduced = kept.is_reduced || result.lies_on_tool;
  if (!result.is_reduced) {
    result.shape = shape;
  } else if (!kept.curves.empty()) {
    std::vector<TrimLoop> loops = chain_directed_curves(kept.curves, face.extent(), vertex_tolerance, 1e-11);
    std::erase_if(loops, [&](const TrimLoop& loop) {
      return std::abs(doubled_area(loop)) <= vertex_tolerance * vertex_tolerance * face.extent().prod();
    });
    if (!loops.empty()) result.shape = TrimmedSurface(face.surface(), std::move(loops));
  }
  if (!result.shape) return result;
  for (FaceCuts::Cut& cut : kept.cuts) result.cuts.push_back(std::move(cut.curve));
  return result;
}

}  // namespace isorim::geometry
