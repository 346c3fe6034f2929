#include "geometry/trimming/loop_chaining.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/trimming/curve_cuts.h"

namespace isorim::geometry {
namespace {

std::string place_name(const Point3& x) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", x.x(), x.y(), x.z());
}

LoopCurve reversed(LoopCurve curve) {
  curve.curve = reverse(curve.curve);
  return curve;
}

/// A curve with its ends in space.
struct Strand {
  LoopCurve curve;
  Point3 start;
  Point3 end;
  bool is_taken = false;
};

class LoopOrder {
 public:
  LoopOrder(std::vector<LoopCurve> curves, const ParameterRectangle& rectangle, double size) : size_(size) {
    for (LoopCurve& curve : curves) {
      const Point3 start = rectangle.point(start_of(curve.curve));
      const Point3 end = rectangle.point(end_of(curve.curve));
      strands_.push_back({std::move(curve), start, end});
    }
  }

  /// The given order wherever it holds; else the nearest end comes next.
  std::vector<LoopCurve> ordered() {
    std::vector<LoopCurve> result;
    std::size_t reversals = 0;
    take(0, false, result);
    while (first_ < strands_.size()) {
      const auto [index, is_reversed] = next();
      if (index != first_) is_reordered = true;
      reversals += is_reversed ? 1 : 0;
      take(index, is_reversed, result);
    }
    if (2 * reversals > strands_.size()) {
      // The first one ran against all the others.
      std::reverse(result.begin(), result.end());
      for (LoopCurve& curve : result) curve = reversed(std::move(curve));
      reversals = strands_.size() - reversals;
    }
    reversed_pieces = static_cast<int>(reversals);
    return result;
  }

  bool is_reordered = false;
  int reversed_pieces = 0;

 private:
  void take(std::size_t index, bool is_reversed, std::vector<LoopCurve>& result) {
    Strand& strand = strands_[index];
    strand.is_taken = true;
    while (first_ < strands_.size() && strands_[first_].is_taken) ++first_;
    end_ = is_reversed ? strand.start : strand.end;
    result.push_back(is_reversed ? reversed(std::move(strand.curve)) : std::move(strand.curve));
  }

  std::pair<std::size_t, bool> next() const {
    const double as_given = (strands_[first_].start - end_).norm();
    std::pair<std::size_t, bool> best{first_, false};
    if (as_given <= 1e-6 * size_) return best;
    // Only what is clearly nearer than the given order.
    double nearest = 0.5 * as_given;
    const auto consider = [&](std::size_t index, bool is_reversed, const Point3& point) {
      const double distance = (point - end_).norm();
      if (distance >= nearest) return;
      nearest = distance;
      best = {index, is_reversed};
    };
    for (std::size_t i = first_; i < strands_.size(); ++i) {
      if (strands_[i].is_taken) continue;
      consider(i, false, strands_[i].start);
      consider(i, true, strands_[i].end);
    }
    return best;
  }

  std::vector<Strand> strands_;
  /// The first that is not taken.
  std::size_t first_ = 0;
  Point3 end_ = Point3::Zero();
  double size_;
};

/// An order in which given parameter curves follow one another in the parameter plane as they are, no period moved: on
/// a torus all corners of the rectangle are one point in space, so there the order in space says nothing. Empty if
/// there is none.
std::vector<std::size_t> literal_order(const std::vector<LoopCurve>& curves, const ParameterRectangle& rectangle) {
  std::vector<std::size_t> order;
  for (const LoopCurve& curve : curves)
    if (!curve.is_given) return order;
  const Vector2 near = 4.0 * rectangle.tolerance();
  const auto follows = [&](std::size_t before, std::size_t after) {
    const Vector2 gap = start_of(curves[after].curve) - end_of(curves[before].curve);
    return (gap.cwiseAbs().array() <= near.array()).all();
  };
  std::vector<bool> is_taken(curves.size(), false);
  std::size_t current = 0;
  while (true) {
    is_taken[current] = true;
    order.push_back(current);
    if (order.size() == curves.size()) break;
    std::size_t next = (current + 1) % curves.size();
    for (std::size_t k = 0; k < curves.size() && (is_taken[next] || !follows(current, next)); ++k)
      next = (next + 1) % curves.size();
    if (is_taken[next] || !follows(current, next)) return {};
    current = next;
  }
  if (!follows(current, 0)) return {};
  return order;
}

enum class JoinKind { joined, bridged, pole, seam, gap };

/// How the end of one curve and the start of the next one are connected.
struct Join {
  JoinKind kind = JoinKind::gap;
  /// To be added to the next curve, whole periods.
  Vector2 shift = Vector2::Zero();
  /// The pole's side, or the first of the seam's two.
  int side = -1;
  double distance = 0.0;
};

class Chainer {
 public:
  Chainer(const ParameterRectangle& rectangle, const ChainOptions& options, FaceRepairs& repairs)
      : rectangle_(rectangle), options_(options), repairs_(repairs), reach_(1e-5 * options.size) {}

  void chain(std::vector<LoopCurve> curves, std::vector<CoveringLoop>& loops) {
    CoveringLoop loop;
    loop.runs.push_back({curves.front()});
    for (std::size_t i = 1; i < curves.size(); ++i) {
      const LoopCurve& last = loop.runs.back().back();
      const Join join = join_of(last, curves[i]);
      if (join.kind == JoinKind::gap) {
        take_apart(std::move(curves), i, loop, join, loops);
        return;
      }
      append(join, curves[i], loop);
    }
    close(std::move(curves), std::move(loop), loops);
  }

 private:
  /// A gap after the first `count` curves: perhaps they are a loop by themselves.
  void take_apart(std::vector<LoopCurve> curves, std::size_t count, const CoveringLoop& loop, const Join& gap,
                  std::vector<CoveringLoop>& loops) {
    const Join closing = join_of(loop.runs.back().back(), loop.runs.front().front());
    if (closing.kind == JoinKind::gap || closing.kind == JoinKind::seam)
      refuse(loop.runs.back().back(), curves[count], gap);
    const auto middle = curves.begin() + static_cast<std::ptrdiff_t>(count);
    std::vector<LoopCurve> rest(middle, curves.end());
    curves.erase(middle, curves.end());
    chain(std::move(curves), loops);
    chain(std::move(rest), loops);
  }

  void close(std::vector<LoopCurve> curves, CoveringLoop loop, std::vector<CoveringLoop>& loops) {
    const LoopCurve& first = loop.runs.front().front();
    const Join join = join_of(loop.runs.back().back(), first);
    if (join.kind == JoinKind::gap) refuse(loop.runs.back().back(), curves.front(), join);
    if (loop.runs.size() > 1 && (join.kind == JoinKind::joined || join.kind == JoinKind::bridged)) {
      // Start anew behind an interruption, so that no run is cut in two.
      const LoopRun& last = loop.runs.back();
      const auto pieces = std::count_if(last.begin(), last.end(), [](const LoopCurve& c) { return c.piece > 0; });
      std::rotate(curves.begin(), curves.end() - pieces, curves.end());
      chain(std::move(curves), loops);
      return;
    }
    if (join.kind == JoinKind::bridged) bridge(first, join, loop);
    repairs_.largest_bridge = std::max(repairs_.largest_bridge, join.distance);
    loop.is_interrupted = join.kind == JoinKind::pole || join.kind == JoinKind::seam;
    loop.lacks_seam = loop.lacks_seam || join.kind == JoinKind::seam;
    if (!loop.is_interrupted)
      for (int d = 0; d < 2; ++d)
        loop.winding[static_cast<std::size_t>(d)] =
            static_cast<int>(std::lround(join.shift[d] / rectangle_.lengths()[d]));
    loops.push_back(std::move(loop));
  }

  void append(const Join& join, const LoopCurve& curve, CoveringLoop& loop) {
    if (join.kind == JoinKind::bridged) bridge(curve, join, loop);
    if (join.kind == JoinKind::pole || join.kind == JoinKind::seam) {
      loop.runs.emplace_back();
      loop.lacks_seam = loop.lacks_seam || join.kind == JoinKind::seam;
    }
    repairs_.largest_bridge = std::max(repairs_.largest_bridge, join.distance);
    loop.runs.back().push_back(moved(curve, join.shift));
  }

  void bridge(const LoopCurve& next, const Join& join, CoveringLoop& loop) {
    const Point2 from = end_of(loop.runs.back().back().curve);
    const Point2 to = start_of(next.curve) + join.shift;
    loop.runs.back().push_back({straight(from, to)});
  }

  Join join_of(const LoopCurve& before, const LoopCurve& after) const {
    const Point2 end = end_of(before.curve);
    const Point2 start = start_of(after.curve);
    Join join;
    for (int d = 0; d < 2; ++d)
      if (rectangle_.is_closed(d))
        join.shift[d] = rectangle_.lengths()[d] * std::round((end[d] - start[d]) / rectangle_.lengths()[d]);
    const Vector2 gap = start + join.shift - end;
    const Point3 from = rectangle_.point(end);
    const Point3 to = rectangle_.point(start);
    join.distance = (to - from).norm();
    if ((gap.cwiseAbs().array() <= rectangle_.tolerance().array()).all()) {
      join.kind = JoinKind::joined;
      return join;
    }
    if (const int pole = common_pole(from, to); pole >= 0) {
      join.kind = JoinKind::pole;
      join.side = pole;
      join.distance = 0.0;
      if (before.is_given && after.is_given) join.shift = before.shift;
      return join;
    }
    const Point3 middle = rectangle_.point(end + 0.5 * gap);
    const bool is_straight = (middle - 0.5 * (from + to)).norm() <= 0.5 * options_.largest_gap;
    if (join.distance <= options_.largest_gap && is_straight) {
      join.kind = JoinKind::bridged;
      return join;
    }
    join.side = common_seam(end, start);
    if (join.side >= 0) {
      join.kind = JoinKind::seam;
      join.distance = 0.0;
    }
    return join;
  }

  int common_pole(const Point3& a, const Point3& b) const {
    for (int side = 0; side < 4; ++side) {
      if (rectangle_.side(side) != SideKind::pole) continue;
      const Point3& pole = rectangle_.pole(side);
      if ((a - pole).norm() <= reach_ && (b - pole).norm() <= reach_) return side;
    }
    return -1;
  }

  int common_seam(const Point2& a, const Point2& b) const {
    for (int side = 0; side < 2; ++side) {
      if (rectangle_.side(side) != SideKind::seam) continue;
      const SideLine line = side_line(rectangle_, side);
      if (is_on_seam(a, line) && is_on_seam(b, line)) return side;
    }
    return -1;
  }

  bool is_on_seam(const Point2& uv, const SideLine& line) const {
    const double period = rectangle_.lengths()[line.parameter];
    const double off = std::remainder(uv[line.parameter] - line.value, period);
    const SurfaceJet<3> jet = rectangle_.jet(uv);
    return std::abs(off) * (line.parameter == 0 ? jet.du : jet.dv).norm() <= reach_;
  }

  [[noreturn]] void refuse(const LoopCurve& before, const LoopCurve& after, const Join& gap) const {
    throw GeometryError(fmt::format(
        "{}: piece {} ends at {}, piece {} starts at {}, {:.3g} away; expected them to meet within {:.3g}, or "
        "both at a pole or on a seam of the surface",
        options_.name, before.piece, place_name(rectangle_.point(end_of(before.curve))), after.piece,
        place_name(rectangle_.point(start_of(after.curve))), gap.distance, options_.largest_gap));
  }

  const ParameterRectangle& rectangle_;
  const ChainOptions& options_;
  FaceRepairs& repairs_;
  /// How near to a pole or seam an end counts as being on it.
  double reach_;
};

}  // namespace

LoopCurve moved(LoopCurve curve, const Vector2& shift) {
  if (shift == Vector2::Zero()) return curve;
  curve.curve = transform(curve.curve, AffineMap<2>{Eigen::Matrix2d::Identity(), shift});
  curve.shift += shift;
  return curve;
}

CoveringLoop reverse(const CoveringLoop& loop) {
  CoveringLoop result = loop;
  std::reverse(result.runs.begin(), result.runs.end());
  for (LoopRun& run : result.runs) {
    std::reverse(run.begin(), run.end());
    for (LoopCurve& curve : run) curve = reversed(std::move(curve));
  }
  for (int& periods : result.winding) periods = -periods;
  return result;
}

std::vector<CoveringLoop> chain_loop(std::vector<LoopCurve> curves, const ParameterRectangle& rectangle,
                                     const ChainOptions& options, FaceRepairs& repairs) {
  std::vector<CoveringLoop> loops;
  if (curves.empty()) return loops;
  std::vector<LoopCurve> ordered;
  bool is_reordered = false;
  if (const std::vector<std::size_t> literal = literal_order(curves, rectangle); !literal.empty()) {
    for (const std::size_t index : literal) ordered.push_back(std::move(curves[index]));
    is_reordered = !std::is_sorted(literal.begin(), literal.end());
  } else {
    LoopOrder order(std::move(curves), rectangle, options.size);
    ordered = order.ordered();
    is_reordered = order.is_reordered;
    if (order.reversed_pieces > 0)
      repairs.notes.push_back(
          fmt::format("{}: {} of its pieces ran against the others", options.name, order.reversed_pieces));
  }
  if (is_reordered) repairs.notes.push_back(fmt::format("{}: its pieces were out of order", options.name));
  Chainer(rectangle, options, repairs).chain(std::move(ordered), loops);
  if (loops.size() > 1)
    repairs.notes.push_back(fmt::format("{}: it holds {} closed loops", options.name, loops.size()));
  return loops;
}

}  // namespace isorim::geometry
