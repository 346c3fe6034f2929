#include "geometry/trimming/domain_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/trimming/curve_cuts.h"
#include "geometry/trimming/loop_pieces.h"

namespace isorim::geometry {
namespace {

struct Box {
  Point2 lower;
  Point2 upper;
};

Box box_of(const NurbsCurve<2>& curve) {
  const Points<2> points = curve.control_points();
  return {points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
}

bool meet(const Point2& a, const Point2& b, const ParameterRectangle& rectangle) {
  return ((a - b).cwiseAbs().array() <= rectangle.tolerance().array()).all();
}

/// The pole whose side is nearest in space to a point that is known to lie at a pole.
int nearest_pole(const Point2& uv, const ParameterRectangle& rectangle) {
  const Point3 x = rectangle.point(uv);
  int nearest = -1;
  for (int side = 0; side < 4; ++side) {
    if (rectangle.side(side) != SideKind::pole) continue;
    if (nearest < 0 || (x - rectangle.pole(side)).norm() < (x - rectangle.pole(nearest)).norm()) nearest = side;
  }
  return nearest;
}

/// Lines from the end of one run to the start of the next by way of the pole between them.
void append_pole_lines(const Point2& from, const Point2& to, const ParameterRectangle& rectangle, LoopRun& curves) {
  const SideLine line = side_line(rectangle, nearest_pole(from, rectangle));
  Point2 leave = from;
  Point2 enter = to;
  leave[line.parameter] = enter[line.parameter] = line.value;
  const std::array<Point2, 4> corners{from, leave, enter, to};
  Point2 last = from;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (meet(last, corners[i], rectangle) && i != 2) continue;
    curves.push_back({straight(last, corners[i])});
    last = corners[i];
  }
}

/// Whether the curve, not only its control polygon, keeps to an interval of parameter d.
bool stays_within(const NurbsCurve<2>& curve, int d, Interval interval, double tolerance) {
  const Box box = box_of(curve);
  const bool is_sure = box.lower[d] >= interval.first - tolerance && box.upper[d] <= interval.last + tolerance;
  if (is_sure) return true;
  for (const CurvePart& part : parts_about_line(curve, d, interval.first, tolerance))
    if (part.side < 0) return false;
  for (const CurvePart& part : parts_about_line(curve, d, interval.last, tolerance))
    if (part.side > 0) return false;
  return true;
}

/// The whole periods by which a loop must be moved to lie in the rectangle, if any do it.
std::optional<Vector2> shift_into(const LoopRun& curves, const ParameterRectangle& rectangle) {
  Vector2 shift = Vector2::Zero();
  for (int d = 0; d < 2; ++d) {
    if (!rectangle.is_closed(d)) continue;
    const Interval domain = rectangle.domain(d);
    double low = start_of(curves.front().curve)[d];
    double high = low;
    for (const LoopCurve& curve : curves) {
      const Interval own = curve.curve.domain();
      for (const double t : {own.first, own.middle()}) {
        const double x = evaluate(curve.curve, t)[d];
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    const double periods = std::round((0.5 * (low + high) - domain.middle()) / domain.length());
    shift[d] = -periods * domain.length();
    const Interval moved_domain{domain.first - shift[d], domain.last - shift[d]};
    for (const LoopCurve& curve : curves)
      if (!stays_within(curve.curve, d, moved_domain, rectangle.tolerance()[d])) return std::nullopt;
  }
  return shift;
}

}  // namespace

std::vector<PlanePiece> plane_pieces(const LoopRun& curves) {
  TrimLoop loop;
  for (const LoopCurve& curve : curves) loop.curves.push_back(curve.curve);
  return loop_pieces(loop);
}

namespace {

/// The integral of B_i^n B_j^(n - 1) n over [0, 1].
double bernstein_product(int n, int i, int j) {
  double value = 0.5;
  for (int k = 1; k <= i; ++k) value *= static_cast<double>(n - i + k) / k;
  for (int k = 1; k <= j; ++k) value *= static_cast<double>(n - 1 - j + k) / k;
  for (int k = 1; k <= i + j; ++k) value *= static_cast<double>(k) / (2 * n - 1 - (i + j) + k);
  return value;
}

/// bernstein_product() of one degree: n + 1 x n.
Eigen::MatrixXd bernstein_products(int n) {
  Eigen::MatrixXd products(n + 1, n);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < n; ++j) products(i, j) = bernstein_product(n, i, j);
  return products;
}

/// Twice the area that the rays from `origin` to the points of a polynomial piece sweep over.
double swept_area(const PlanePiece& piece, const Point2& origin, const Eigen::MatrixXd& products) {
  const Eigen::Index n = piece.net.cols() - 1;
  double sum = 0.0;
  for (Eigen::Index i = 0; i <= n; ++i) {
    const Vector2 a = piece.control_point(i) - origin;
    for (Eigen::Index j = 0; j < n; ++j) {
      const Vector2 leg = piece.control_point(j + 1) - piece.control_point(j);
      sum += products(i, j) * (a.x() * leg.y() - a.y() * leg.x());
    }
  }
  return sum;
}

/// The same for a rational piece: inscribed polygons, extrapolated to infinitely many corners (Romberg).
double extrapolated_area(const PlanePiece& piece, const Point2& origin) {
  constexpr int levels = 5;
  std::array<double, levels> sums{};
  for (int level = 0; level < levels; ++level) {
    const int corners = 4 << level;
    Vector2 last = piece.start() - origin;
    double sum = 0.0;
    for (int k = 1; k <= corners; ++k) {
      const Vector2 next = evaluate(piece, static_cast<double>(k) / corners) - origin;
      sum += last.x() * next.y() - last.y() * next.x();
      last = next;
    }
    sums[static_cast<std::size_t>(level)] = sum;
  }
  double factor = 4.0;
  for (std::size_t order = 1; order < levels; ++order, factor *= 4.0)
    for (std::size_t level = levels - 1; level >= order; --level)
      sums[level] += (sums[level] - sums[level - 1]) / (factor - 1.0);
  return sums.back();
}

}  // namespace

double signed_area(const LoopRun& curves, const ParameterRectangle& rectangle) {
  const std::vector<PlanePiece> pieces = plane_pieces(curves);
  if (pieces.empty()) return 0.0;
  Point2 lower = pieces.front().lower;
  Point2 upper = pieces.front().upper;
  for (const PlanePiece& piece : pieces) {
    lower = lower.cwiseMin(piece.lower);
    upper = upper.cwiseMax(piece.upper);
  }
  const Vector2 box = upper - lower;
  const Vector2 whole = rectangle.lengths();
  const double least = 1e-9 * box.prod() + 1e-14 * (box.x() * whole.y() + box.y() * whole.x());
  const Point2 origin = pieces.front().start();
  Eigen::MatrixXd products(0, 0);
  double area = 0.0;
  for (const PlanePiece& piece : pieces) {
    const bool is_polynomial = (piece.net.row(2).array() == piece.net(2, 0)).all();
    if (is_polynomial && products.rows() != piece.net.cols())
      products = bernstein_products(static_cast<int>(piece.net.cols()) - 1);
    area += is_polynomial ? swept_area(piece, origin, products) : extrapolated_area(piece, origin);
  }
  return std::abs(area) <= least ? 0.0 : area;
}

std::optional<ClosedLoop> close_directly(const CoveringLoop& loop, const ParameterRectangle& rectangle) {
  if (loop.lacks_seam || loop.winding[0] != 0 || loop.winding[1] != 0) return std::nullopt;
  ClosedLoop closed;
  for (std::size_t i = 0; i < loop.runs.size(); ++i) {
    closed.curves.insert(closed.curves.end(), loop.runs[i].begin(), loop.runs[i].end());
    if (!loop.is_interrupted) continue;
    const LoopRun& next = loop.runs[(i + 1) % loop.runs.size()];
    append_pole_lines(end_of(loop.runs[i].back().curve), start_of(next.front().curve), rectangle, closed.curves);
  }
  const std::optional<Vector2> shift = shift_into(closed.curves, rectangle);
  if (!shift) return std::nullopt;
  for (LoopCurve& curve : closed.curves) curve = moved(std::move(curve), *shift);
  closed.area = signed_area(closed.curves, rectangle);
  if (closed.area == 0.0) return std::nullopt;
  return closed;
}

namespace {

/// A part of a curve inside the rectangle.
struct PlacedCurve {
  LoopCurve curve;
  /// The seam side that it runs along, -1 if none.
  int seam = -1;
  bool is_dropped = false;
};

class Cutter {
 public:
  explicit Cutter(const ParameterRectangle& rectangle) : rectangle_(rectangle) {}

  void cut(const LoopCurve& curve, std::vector<PlacedCurve>& placed) const {
    std::vector<NurbsCurve<2>> parts{curve.curve};
    for (int d = 0; d < 2; ++d)
      if (rectangle_.is_closed(d)) parts = cut_at_seams(parts, d);
    for (NurbsCurve<2>& part : parts) {
      LoopCurve piece = curve;
      piece.curve = std::move(part);
      if (!is_along_pole(piece.curve)) placed.push_back(place(std::move(piece)));
    }
  }

 private:
  std::vector<NurbsCurve<2>> cut_at_seams(const std::vector<NurbsCurve<2>>& curves, int d) const {
    std::vector<NurbsCurve<2>> result;
    const Interval domain = rectangle_.domain(d);
    for (const NurbsCurve<2>& curve : curves) {
      const Box box = box_of(curve);
      std::vector<NurbsCurve<2>> parts{curve};
      const double first = std::ceil((box.lower[d] - domain.first) / domain.length() - 1e-6);
      const double last = std::floor((box.upper[d] - domain.first) / domain.length() + 1e-6);
      for (double k = first; k <= last; k += 1.0) {
        const double value = k == 1.0 ? domain.last : domain.first + k * domain.length();
        std::vector<NurbsCurve<2>> finer;
        for (const NurbsCurve<2>& part : parts)
          for (const CurvePart& stretch : parts_about_line(part, d, value, rectangle_.tolerance()[d]))
            finer.push_back(part_of(part, stretch.domain));
        parts = std::move(finer);
      }
      result.insert(result.end(), parts.begin(), parts.end());
    }
    return result;
  }

  bool is_along(const Box& box, int d, double value) const {
    return std::abs(box.lower[d] - value) <= rectangle_.tolerance()[d] &&
           std::abs(box.upper[d] - value) <= rectangle_.tolerance()[d];
  }

  bool is_along_pole(const NurbsCurve<2>& curve) const {
    const Box box = box_of(curve);
    for (int side = 0; side < 4; ++side) {
      const SideLine line = side_line(rectangle_, side);
      if (rectangle_.side(side) == SideKind::pole && is_along(box, line.parameter, line.value)) return true;
    }
    return false;
  }

  PlacedCurve place(LoopCurve curve) const {
    const Box box = box_of(curve.curve);
    const Interval own = curve.curve.domain();
    const Point2 middle = evaluate(curve.curve, own.middle());
    const Vector2 advance = end_of(curve.curve) - start_of(curve.curve);
    Vector2 shift = Vector2::Zero();
    int seam = -1;
    for (int d = 0; d < 2; ++d) {
      if (!rectangle_.is_closed(d)) continue;
      const Interval domain = rectangle_.domain(d);
      const double period = domain.length();
      const double nearest = std::round((middle[d] - domain.first) / period);
      if (!is_along(box, d, domain.first + nearest * period)) {
        shift[d] = -period * std::floor((middle[d] - domain.first) / period);
        continue;
      }
      // The inside is on the left: up along u = last, down along u = first, and the other way for v.
      const bool at_last = d == 0 ? advance[1] > 0.0 : advance[0] < 0.0;
      shift[d] = (at_last ? period : 0.0) - nearest * period;
      seam = d == 0 ? (at_last ? 1 : 3) : (at_last ? 2 : 0);
    }
    return {moved(std::move(curve), shift), seam, false};
  }

  const ParameterRectangle& rectangle_;
};

/// Drops curves that run along a seam both ways.
void drop_seam_pairs(std::vector<std::vector<PlacedCurve>>& runs, const ParameterRectangle& rectangle) {
  std::vector<PlacedCurve*> waiting;
  for (std::vector<PlacedCurve>& run : runs)
    for (PlacedCurve& curve : run) {
      if (curve.seam < 0) continue;
      const int along = curve.seam % 2 == 0 ? 0 : 1;
      const double tolerance = 2.0 * rectangle.tolerance()[along];
      const Box box = box_of(curve.curve.curve);
      const auto partner = std::find_if(waiting.begin(), waiting.end(), [&](const PlacedCurve* other) {
        const Box theirs = box_of(other->curve.curve);
        return !other->is_dropped && other->seam == (curve.seam + 2) % 4 &&
               std::abs(theirs.lower[along] - box.lower[along]) <= tolerance &&
               std::abs(theirs.upper[along] - box.upper[along]) <= tolerance;
      });
      if (partner == waiting.end()) {
        waiting.push_back(&curve);
      } else {
        (*partner)->is_dropped = true;
        curve.is_dropped = true;
      }
    }
}

Point2 start_of(const LoopRun& chain) {
  return start_of(chain.front().curve);
}

Point2 end_of(const LoopRun& chain) {
  return end_of(chain.back().curve);
}

/// Chains of placed curves that are continuous in the rectangle. `is_cyclic`: the run's end continues at its start.
void append_chains(const std::vector<PlacedCurve>& run, bool is_cyclic, const ParameterRectangle& rectangle,
                   std::vector<LoopRun>& chains) {
  std::vector<LoopRun> own;
  bool is_broken = true;
  for (const PlacedCurve& placed : run) {
    if (placed.is_dropped) {
      is_broken = true;
      continue;
    }
    if (is_broken || !meet(end_of(own.back()), start_of(placed.curve.curve), rectangle)) own.emplace_back();
    own.back().push_back(placed.curve);
    is_broken = false;
  }
  if (is_cyclic && own.size() > 1 && !run.front().is_dropped && !run.back().is_dropped &&
      meet(end_of(own.back()), start_of(own.front()), rectangle)) {
    own.back().insert(own.back().end(), own.front().begin(), own.front().end());
    own.erase(own.begin());
  }
  for (LoopRun& chain : own) chains.push_back(std::move(chain));
}

/// Joins open chains along the sides of the rectangle.
class Walk {
 public:
  Walk(const ParameterRectangle& rectangle, std::vector<LoopRun> chains)
      : rectangle_(rectangle), chains_(std::move(chains)) {}

  void run(WalkedLoops& result) {
    for (const LoopRun& chain : chains_) {
      starts_.push_back(position(start_of(chain)));
      ends_.push_back(position(end_of(chain)));
    }
    std::vector<bool> is_used(chains_.size(), false);
    for (std::size_t first = 0; first < chains_.size(); ++first) {
      if (is_used[first]) continue;
      ClosedLoop loop;
      std::size_t current = first;
      while (true) {
        is_used[current] = true;
        loop.curves.insert(loop.curves.end(), chains_[current].begin(), chains_[current].end());
        const std::size_t next = following(current, first, is_used);
        connect(current, next, loop, result);
        if (next == first) break;
        current = next;
      }
      loop.area = signed_area(loop.curves, rectangle_);
      result.loops.push_back(std::move(loop));
    }
  }

  /// All ends lie on the sides.
  bool can_run() const {
    return std::all_of(chains_.begin(), chains_.end(), [&](const LoopRun& chain) {
      return distance_from_sides(start_of(chain)) <= reach && distance_from_sides(end_of(chain)) <= reach;
    });
  }

 private:
  /// Relative to the lengths of the sides; ends within it of each other count as one.
  static constexpr double reach = 4e-6;

  Point2 relative(const Point2& uv) const {
    const Point2 corner(rectangle_.domain(0).first, rectangle_.domain(1).first);
    return (uv - corner).cwiseQuotient(rectangle_.lengths());
  }

  static std::array<double, 4> side_distances(const Point2& r) {
    return {std::abs(r.y()), std::abs(1.0 - r.x()), std::abs(1.0 - r.y()), std::abs(r.x())};
  }

  double distance_from_sides(const Point2& uv) const {
    const std::array<double, 4> distances = side_distances(relative(uv));
    return *std::min_element(distances.begin(), distances.end());
  }

  /// Around the rectangle, counter-clockwise: side number plus the part of the side; 4 is 0.
  double position(const Point2& uv) const {
    const Point2 r = relative(uv);
    const std::array<double, 4> distances = side_distances(r);
    const auto side = std::min_element(distances.begin(), distances.end()) - distances.begin();
    const std::array<double, 4> along{r.x(), r.y(), 1.0 - r.x(), 1.0 - r.y()};
    return static_cast<double>(side) + std::clamp(along[static_cast<std::size_t>(side)], 0.0, 1.0);
  }

  /// From an end counter-clockwise to a start.
  double ahead(std::size_t end, std::size_t start) const {
    double distance = starts_[start] - ends_[end];
    while (distance < -reach) distance += 4.0;
    while (distance > 4.0 - reach) distance -= 4.0;
    return std::max(distance, 0.0);
  }

  std::size_t following(std::size_t current, std::size_t first, const std::vector<bool>& is_used) const {
    std::size_t best = first;
    for (std::size_t k = 0; k < chains_.size(); ++k)
      if (!is_used[k] && ahead(current, k) < ahead(current, best)) best = k;
    return best;
  }

  void connect(std::size_t from, std::size_t to, ClosedLoop& loop, WalkedLoops& result) const {
    const double distance = ahead(from, to);
    const double start = ends_[from];
    for (std::size_t k = 0; k < chains_.size(); ++k) {
      double other = ends_[k] - start;
      if (other < 0.0) other += 4.0;
      if (k != from && other > reach && other < distance - reach) result.is_consistent = false;
    }
    Point2 last = end_of(chains_[from]);
    const auto go_to = [&](const Point2& next) {
      if (meet(last, next, rectangle_)) return;
      loop.curves.push_back({straight(last, next)});
      last = next;
    };
    double done = start;
    while (done < start + distance) {
      const int side = static_cast<int>(std::floor(done + 1e-12)) % 4;
      const double stop = std::min(std::floor(done + 1e-12) + 1.0, start + distance);
      if (rectangle_.side(side) == SideKind::open) result.open_length += stop - done;
      const bool is_corner = stop == std::floor(stop) && stop < start + distance;
      if (is_corner) go_to(corner((side + 1) % 4));
      done = stop;
    }
    go_to(start_of(chains_[to]));
    if (distance > reach) ++result.bridged_ends;
  }

  Point2 corner(int index) const {
    const Interval u = rectangle_.domain(0);
    const Interval v = rectangle_.domain(1);
    return {index == 1 || index == 2 ? u.last : u.first, index >= 2 ? v.last : v.first};
  }

  const ParameterRectangle& rectangle_;
  std::vector<LoopRun> chains_;
  std::vector<double> starts_;
  std::vector<double> ends_;
};

/// Runs that are interrupted at a pole, with lines to the pole's side where they stop short of it.
std::vector<LoopRun> reaching_poles(const CoveringLoop& loop, const ParameterRectangle& rectangle) {
  if (!loop.is_interrupted || loop.lacks_seam) return loop.runs;
  std::vector<LoopRun> runs = loop.runs;
  for (LoopRun& run : runs) {
    for (const bool at_end : {false, true}) {
      const Point2 uv = at_end ? end_of(run) : start_of(run);
      const SideLine line = side_line(rectangle, nearest_pole(uv, rectangle));
      Point2 on_side = uv;
      on_side[line.parameter] = line.value;
      if (meet(uv, on_side, rectangle)) continue;
      if (at_end)
        run.push_back({straight(uv, on_side)});
      else
        run.insert(run.begin(), {straight(on_side, uv)});
    }
  }
  return runs;
}

}  // namespace

WalkedLoops walk_domain(const std::vector<CoveringLoop>& loops, const ParameterRectangle& rectangle) {
  const Cutter cutter(rectangle);
  std::vector<std::vector<PlacedCurve>> runs;
  std::vector<bool> is_cyclic;
  for (const CoveringLoop& loop : loops)
    for (const LoopRun& run : reaching_poles(loop, rectangle)) {
      runs.emplace_back();
      is_cyclic.push_back(!loop.is_interrupted);
      for (const LoopCurve& curve : run) cutter.cut(curve, runs.back());
    }
  drop_seam_pairs(runs, rectangle);
  std::vector<LoopRun> chains;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (!runs[i].empty()) append_chains(runs[i], is_cyclic[i], rectangle, chains);

  WalkedLoops result;
  std::vector<LoopRun> open;
  for (LoopRun& chain : chains) {
    if (!meet(end_of(chain), start_of(chain), rectangle)) {
      open.push_back(std::move(chain));
      continue;
    }
    const double area = signed_area(chain, rectangle);
    if (area != 0.0) result.loops.push_back({std::move(chain), area});
  }
  Walk walk(rectangle, std::move(open));
  if (!walk.can_run()) {
    result.is_consistent = false;
    return result;
  }
  walk.run(result);
  return result;
}

}  // namespace isorim::geometry
