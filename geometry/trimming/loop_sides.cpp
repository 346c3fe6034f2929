#include "geometry/trimming/loop_sides.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/curve_cuts.h"
#include "geometry/trimming/trimmed_surface.h"

namespace isorim::geometry {
namespace {

ClosedLoop rectangle_loop(const ParameterRectangle& rectangle) {
  ClosedLoop loop;
  for (NurbsCurve<2>& side : domain_loop(rectangle.surface()).curves) loop.curves.push_back({std::move(side)});
  loop.area = 2.0 * rectangle.lengths().prod();
  return loop;
}

void reverse_in_place(ClosedLoop& loop) {
  std::reverse(loop.curves.begin(), loop.curves.end());
  for (LoopCurve& curve : loop.curves) curve.curve = reverse(curve.curve);
  loop.area = -loop.area;
}

/// The box of a loop's control points.
struct LoopBox {
  Point2 lower;
  Point2 upper;

  explicit LoopBox(const std::vector<PlanePiece>& pieces) : lower(pieces[0].lower), upper(pieces[0].upper) {
    for (const PlanePiece& piece : pieces) {
      lower = lower.cwiseMin(piece.lower);
      upper = upper.cwiseMax(piece.upper);
    }
  }

  bool contains(const Point2& point) const {
    return (point.array() >= lower.array()).all() && (point.array() <= upper.array()).all();
  }
};

/// How many of the other loops each one lies in.
std::vector<int> nesting_depths(const std::vector<ClosedLoop>& loops, const ParameterRectangle& rectangle) {
  std::vector<std::vector<PlanePiece>> pieces;
  std::vector<LoopBox> boxes;
  for (const ClosedLoop& loop : loops) {
    pieces.push_back(plane_pieces(loop.curves));
    boxes.emplace_back(pieces.back());
  }
  const double resolution = 1e-9 * rectangle.lengths().minCoeff();
  std::vector<int> depths(loops.size(), 0);
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t other = 0; other < loops.size(); ++other) {
      // A loop that lies in another is the smaller one; it may touch it, so that not every point tells.
      if (other == i || std::abs(loops[i].area) > std::abs(loops[other].area)) continue;
      for (const PlanePiece& piece : pieces[i]) {
        const Point2 point = evaluate(piece, 0.5);
        if (!boxes[other].contains(point)) break;
        const std::optional<int> turns = winding_number(pieces[other], point, resolution);
        if (!turns) continue;
        if (*turns != 0) ++depths[i];
        break;
      }
    }
  return depths;
}

/// The loops close as they are: turns them as nesting wants it.
class Nesting {
 public:
  Nesting(std::vector<ClosedLoop> loops, const LooseFace& face, const ParameterRectangle& rectangle)
      : loops_(std::move(loops)), face_(face), rectangle_(rectangle), depths_(nesting_depths(loops_, rectangle)) {}

  std::vector<ClosedLoop> oriented(FaceRepairs& repairs) {
    const bool is_trusted = face_.sides == LoopSides::left;
    bool has_outer = !face_.natural_outer_boundary;
    // On a sphere or a torus the rest of the surface may be meant.
    if (has_outer && is_trusted && rectangle_.has_no_open_side() && !matches(1) && matches(-1)) has_outer = false;
    int reversed = 0;
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      if ((loops_[i].area > 0.0) == (wanted(i, has_outer ? 1 : -1) > 0)) continue;
      reverse_in_place(loops_[i]);
      ++reversed;
    }
    repairs.reversed_loops += reversed;
    if (is_trusted && reversed > 0)
      repairs.notes.push_back(fmt::format("{} of {} loops ran the wrong way round", reversed, loops_.size()));
    if (has_outer) return std::move(loops_);
    std::vector<ClosedLoop> all{rectangle_loop(rectangle_)};
    all.insert(all.end(), loops_.begin(), loops_.end());
    return all;
  }

 private:
  /// The sign of a loop's area if the outermost ones have `outermost`.
  int wanted(std::size_t i, int outermost) const { return depths_[i] % 2 == 0 ? outermost : -outermost; }

  bool matches(int outermost) const {
    for (std::size_t i = 0; i < loops_.size(); ++i)
      if ((loops_[i].area > 0.0) != (wanted(i, outermost) > 0)) return false;
    return true;
  }

  std::vector<ClosedLoop> loops_;
  const LooseFace& face_;
  const ParameterRectangle& rectangle_;
  std::vector<int> depths_;
};

/// Which loops are turned round.
using Turns = std::vector<bool>;

bool winds(const CoveringLoop& loop) {
  return loop.winding[0] != 0 || loop.winding[1] != 0;
}

/// Doubled area of a loop that does not wind, at whatever period.
double plane_area(const CoveringLoop& loop, const ParameterRectangle& rectangle) {
  LoopRun curves;
  for (const LoopRun& run : loop.runs) curves.insert(curves.end(), run.begin(), run.end());
  return signed_area(curves, rectangle);
}

/// Of loops that wind around, the order in which they lie across.
std::vector<std::size_t> across(const std::vector<CoveringLoop>& loops, const ParameterRectangle& rectangle) {
  std::vector<std::size_t> order;
  std::vector<double> heights(loops.size(), 0.0);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!winds(loops[i])) continue;
    order.push_back(i);
    const int d = loops[i].winding[0] != 0 ? 1 : 0;
    Point2 sum = Point2::Zero();
    for (const LoopCurve& curve : loops[i].runs.front())
      sum += rectangle.wrap(evaluate(curve.curve, curve.curve.domain().middle()));
    heights[i] = sum[d] / static_cast<double>(loops[i].runs.front().size());
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return heights[a] < heights[b]; });
  return order;
}

/// +1: the inside of the winding loop is at larger values of the parameter across.
int sign_of(const CoveringLoop& loop) {
  return loop.winding[0] != 0 ? (loop.winding[0] > 0 ? 1 : -1) : (loop.winding[1] > 0 ? -1 : 1);
}

/// The orientations to try, the likeliest first.
std::vector<Turns> candidates(const std::vector<CoveringLoop>& loops, const LooseFace& face,
                              const ParameterRectangle& rectangle) {
  const Turns as_given(loops.size(), false);
  const Turns all(loops.size(), true);
  if (face.sides == LoopSides::left) return {as_given, all};
  const std::vector<std::size_t> winding = across(loops, rectangle);
  // The outer loop, if none winds around, is the first or the largest one.
  std::size_t outer = loops.size();
  std::vector<double> areas(loops.size(), 0.0);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (winds(loops[i])) continue;
    areas[i] = plane_area(loops[i], rectangle);
    if (!winding.empty() || face.natural_outer_boundary) continue;
    if (outer == loops.size() || (face.sides == LoopSides::nested && std::abs(areas[i]) > std::abs(areas[outer])))
      outer = i;
  }
  Turns plain = as_given;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (areas[i] != 0.0) plain[i] = (areas[i] > 0.0) != (i == outer);
  if (winding.empty()) return {plain, all, as_given};
  std::vector<Turns> result;
  int agreements = 0;
  for (const int lowest : {1, -1}) {
    Turns turns = plain;
    for (std::size_t k = 0; k < winding.size(); ++k) {
      const bool is_turned = sign_of(loops[winding[k]]) != (k % 2 == 0 ? lowest : -lowest);
      turns[winding[k]] = is_turned;
      if (lowest == 1 && !is_turned) ++agreements;
    }
    result.push_back(std::move(turns));
  }
  if (2 * agreements < static_cast<int>(winding.size())) std::swap(result[0], result[1]);
  return result;
}

struct Attempt {
  WalkedLoops walked;
  int turned = 0;
  bool is_valid = false;
  /// Of the surface's open sides, without a curve of the face.
  double uncovered = 0.0;
};

Attempt attempt(const std::vector<CoveringLoop>& loops, const Turns& turns, const LooseFace& face,
                const ParameterRectangle& rectangle) {
  Attempt result;
  std::vector<CoveringLoop> oriented;
  for (std::size_t i = 0; i < loops.size(); ++i) oriented.push_back(turns[i] ? reverse(loops[i]) : loops[i]);
  result.turned = static_cast<int>(std::count(turns.begin(), turns.end(), true));
  result.walked = walk_domain(oriented, rectangle);
  result.uncovered = face.natural_outer_boundary ? 0.0 : result.walked.open_length;
  const auto area = [&] {
    return std::accumulate(result.walked.loops.begin(), result.walked.loops.end(), 0.0,
                           [](double sum, const ClosedLoop& loop) { return sum + loop.area; });
  };
  const bool may_add_rectangle = face.natural_outer_boundary || rectangle.has_no_open_side();
  if (result.walked.bridged_ends == 0 && area() <= 0.0 && may_add_rectangle)
    result.walked.loops.insert(result.walked.loops.begin(), rectangle_loop(rectangle));
  result.is_valid = result.walked.is_consistent && area() > 0.0;
  return result;
}

std::vector<ClosedLoop> walked(const std::vector<CoveringLoop>& loops, const LooseFace& face,
                               const ParameterRectangle& rectangle, FaceRepairs& repairs) {
  std::optional<Attempt> best;
  for (const Turns& turns : candidates(loops, face, rectangle)) {
    Attempt next = attempt(loops, turns, face, rectangle);
    if (next.is_valid && (!best || next.uncovered < best->uncovered - 1e-3)) best = std::move(next);
  }
  if (!best)
    throw GeometryError(fmt::format(
        "the {} loops bound no part of the surface, in whichever direction they are run through", loops.size()));
  repairs.reversed_loops += best->turned;
  repairs.bridged_ends += best->walked.bridged_ends;
  if (best->uncovered > 1e-3)
    repairs.notes.push_back("the loops do not bound a part by themselves: the edge of the surface was added to them");
  return std::move(best->walked.loops);
}

}  // namespace

std::vector<ClosedLoop> closed_loops(const std::vector<CoveringLoop>& loops, const LooseFace& face,
                                     const ParameterRectangle& rectangle, FaceRepairs& repairs) {
  if (loops.empty()) {
    if (rectangle.has_no_open_side() || face.natural_outer_boundary) return {rectangle_loop(rectangle)};
    throw GeometryError("the loops bound nothing: all of them are points");
  }
  std::vector<ClosedLoop> closed;
  int bridged = 0;
  for (const CoveringLoop& loop : loops) {
    std::optional<ClosedLoop> direct = close_directly(loop, rectangle);
    // The line along a pole may go round either side of it: only the inside tells.
    const bool is_doubtful = loop.is_interrupted && face.sides == LoopSides::left && direct && direct->area < 0.0;
    if (!direct || is_doubtful) return walked(loops, face, rectangle, repairs);
    if (loop.is_interrupted) bridged += static_cast<int>(loop.runs.size());
    closed.push_back(std::move(*direct));
  }
  repairs.bridged_ends += bridged;
  return Nesting(std::move(closed), face, rectangle).oriented(repairs);
}

}  // namespace isorim::geometry
