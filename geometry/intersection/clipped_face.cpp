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

/// A part of a loop in one element, with the signs of F on it or, if it runs along F = 0, beside it.
struct LoopPart {
  HomogeneousPoints<2> net;
  int element = 0;
  SignChart chart;
  bool is_cut = false;
};

NurbsCurve<2> curve_of(const HomogeneousPoints<2>& net) {
  return {KnotVector::bezier(static_cast<int>(net.cols()) - 1), net};
}

class FaceClipper {
 public:
  FaceClipper(const SurfaceShape& face, const ImplicitSurface& implicit, const TraceOptions& options)
      : face_(face),
        surface_(surface_of(face)),
        loops_(trim_loops(face)),
        trace_(surface_, implicit, options),
        extent_(surface_.knots_u().domain().length(), surface_.knots_v().domain().length()) {}

  ClippedFace clip() {
    ClippedFace result;
    const int sign = trace_.sign_everywhere();
    if (sign < 0) result.shape = face_;
    result.is_reduced = sign > 0;
    result.lies_on_tool = lies_on_tool();
    if (sign != 0) return result;
    divide_loops();
    keep_loop_parts(result);
    keep_traced_curves(result);
    result.is_reduced = is_reduced_ || result.lies_on_tool;
    if (!is_reduced_ && !result.lies_on_tool) {
      result.shape = face_;
    } else if (!kept_.empty()) {
      std::vector<TrimLoop> loops = chain_directed_curves(kept_, extent_, vertex_tolerance, 1e-11);
      std::erase_if(loops, [&](const TrimLoop& loop) {
        return std::abs(doubled_area(loop)) <= vertex_tolerance * vertex_tolerance * extent_.prod();
      });
      if (!loops.empty()) result.shape = TrimmedSurface(surface_, std::move(loops));
    }
    if (!result.shape) result.cuts.clear();
    return result;
  }

 private:
  bool lies_on_tool() const {
    const int count = static_cast<int>((trace_.breakpoints_u().size() - 1) * (trace_.breakpoints_v().size() - 1));
    for (int e = 0; e < count; ++e)
      if (trace_.function(e).vanishes) return true;
    return false;
  }

  // --- The loops ----------------------------------------------------------------------------------------------

  void divide_loops() {
    const ParameterGrid grid(surface_);
    for (CutPiece& piece : cut_at_knot_lines(loops_, grid)) {
      LoopPart part;
      part.element = element_on_left(piece, grid);
      const std::optional<Side> side = side_of(piece, part.element, grid);
      part.net = std::move(piece.net);
      part.chart = chart_along(part);
      if (part.chart.signs.front() == 0) {
        part.is_cut = true;
        part.chart = chart_beside(part, side);
      }
      parts_.push_back(std::move(part));
    }
  }

  /// Of the one or two elements whose closure holds the piece, the one on its left.
  static int element_on_left(const CutPiece& piece, const ParameterGrid& grid) {
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
  static std::optional<Side> side_of(const CutPiece& piece, int element, const ParameterGrid& grid) {
    const int i = element % grid.u.span_count();
    const int j = element / grid.u.span_count();
    if (piece.station[0] % 2 == 0) return piece.station[0] / 2 == i ? Side::left : Side::right;
    if (piece.station[1] % 2 == 0) return piece.station[1] / 2 == j ? Side::bottom : Side::top;
    return std::nullopt;
  }

  /// A point of the part and its direction, in the unit square of its element.
  struct UnitPlace {
    Point2 point;
    Vector2 left;
  };
  UnitPlace unit_place(const LoopPart& part, double t) const {
    const CurveJet<2> jet = evaluate_jet(curve_of(part.net), t);
    const Point2 point = trace_.to_unit_square(part.element, jet.point);
    const Vector2 along = trace_.to_unit_square(part.element, jet.point + jet.du) - point;
    return {point, Vector2(-along.y(), along.x()).normalized()};
  }

  SignChart chart_along(const LoopPart& part) const {
    const ElementFunction& function = trace_.function(part.element);
    const NurbsCurve<2> curve = curve_of(part.net);
    return sign_chart(
        [&](double t) { return evaluate(function.whole, trace_.to_unit_square(part.element, evaluate(curve, t))); },
        function.coincidence);
  }

  /// The signs of F just to the left of a part on which it vanishes.
  SignChart chart_beside(const LoopPart& part, const std::optional<Side>& side) const {
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

  bool is_near_tool(const LoopPart& part, double t) const {
    const ElementFunction& function = trace_.function(part.element);
    const Point2 unit = trace_.to_unit_square(part.element, evaluate(curve_of(part.net), t));
    return std::abs(evaluate(function.whole, unit)) <= 1e3 * function.coincidence;
  }

  void keep_loop_parts(ClippedFace& result) {
    for (const LoopPart& part : parts_) {
      const SignChart& chart = part.chart;
      for (const double root : chart.roots) places_.push_back(evaluate(curve_of(part.net), root));
      // Where parts join the sign may change without a root inside either.
      for (const double end : {0.0, 1.0})
        if (part.is_cut || is_near_tool(part, end)) places_.push_back(evaluate(curve_of(part.net), end));
      for (std::size_t i = 0; i < chart.signs.size(); ++i) {
        if (chart.signs[i] >= 0) {
          is_reduced_ = true;
          continue;
        }
        const double from = i == 0 ? 0.0 : chart.roots[i - 1];
        const double to = i == chart.roots.size() ? 1.0 : chart.roots[i];
        if (to <= from) continue;
        NurbsCurve<2> curve = curve_of(part.net);
        if (from > 0.0 || to < 1.0) curve = reparametrise(restrict_to(curve, {from, to}), {0.0, 1.0});
        if (part.is_cut) result.cuts.push_back(curve);
        kept_.push_back(std::move(curve));
      }
    }
  }

  // --- The traced curves --------------------------------------------------------------------------------------

  void keep_traced_curves(ClippedFace& result) {
    if (trace_.curves().empty()) return;
    std::optional<FaceLocator> locator;
    if (std::holds_alternative<TrimmedSurface>(face_)) locator.emplace(std::get<TrimmedSurface>(face_));
    for (const TracedCurve& traced : trace_.curves()) {
      std::vector<double> cuts = cuts_of(traced);
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        NurbsCurve<2> curve = traced.curve;
        if (cuts.size() > 2) curve = reparametrise(restrict_to(curve, {cuts[i], cuts[i + 1]}), {0.0, 1.0});
        if (locator && !lies_inside(*locator, curve)) continue;
        is_reduced_ = true;
        result.cuts.push_back(curve);
        kept_.push_back(std::move(curve));
      }
    }
  }

  static bool lies_inside(const FaceLocator& locator, const NurbsCurve<2>& curve) {
    for (const double t : {0.5, 0.31, 0.73})
      if (const std::optional<bool> inside = locator.contains(evaluate(curve, t), on_loop_tolerance)) return *inside;
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

  const SurfaceShape& face_;
  const NurbsSurface<3>& surface_;
  std::vector<TrimLoop> loops_;
  ImplicitTrace trace_;
  Vector2 extent_;
  std::vector<LoopPart> parts_;
  /// Where the loops meet F = 0.
  std::vector<Point2> places_;
  std::vector<NurbsCurve<2>> kept_;
  /// Something is cut off.
  bool is_reduced_ = false;
};

}  // namespace

ClippedFace clip_face(const SurfaceShape& face, const ImplicitSurface& implicit, const TraceOptions& options) {
  return FaceClipper(face, implicit, options).clip();
}

}  // namespace isorim::geometry
