#include "geometry/trimming/knot_line_cuts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/bezier/bernstein_roots.h"
#include "geometry/bezier/subdivision.h"
#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/loop_pieces.h"

namespace isorim::geometry {
namespace {

/// The part of a piece over `range`, from the piece itself: no rounding piles up.
HomogeneousPoints<2> part_of(const PlanePiece& piece, Interval range) {
  HomogeneousPoints<2> net = piece.net;
  const int degree = static_cast<int>(net.cols()) - 1;
  restrict_net({net.data(), static_cast<std::size_t>(net.size())}, 3, {&degree, 1}, 0, range);
  return net;
}

/// One point for two that differ by rounding: on a line if either of them is.
GridCoordinate merged(const GridCoordinate& a, const GridCoordinate& b) {
  return !a.is_on_line() && b.is_on_line() ? b : a;
}

class Cutter {
 public:
  explicit Cutter(const ParameterGrid& grid) : grid_(grid) {}

  void cut_loop(const TrimLoop& loop);
  std::vector<CutPiece> take() { return std::move(pieces_); }

 private:
  GridPoint joint(const PlanePiece& before, const PlanePiece& after) const;
  void cut(const PlanePiece& piece, const GridPoint& start, const GridPoint& end);
  void collect_cuts(const PlanePiece& piece, int direction);
  void place(HomogeneousPoints<2> net, const GridPoint& start, const GridPoint& end, int depth);
  void place_by_lines(const GridPoint& start, const GridPoint& end);
  std::optional<int> station_of(const HomogeneousPoints<2>& net, const GridCoordinate& start, const GridCoordinate& end,
                                int direction) const;
  int side_of_line(const HomogeneousPoints<2>& net, int station, int direction) const;
  bool is_point(const HomogeneousPoints<2>& net) const;

  /// A parameter of the piece at which it meets a line.
  struct Cut {
    double t = 0.0;
    int direction = 0;
    int line = 0;
  };

  const ParameterGrid& grid_;
  std::vector<CutPiece> pieces_;
  std::vector<Cut> cuts_;
  std::vector<double> coefficients_;
  std::vector<double> tolerances_;
};

void Cutter::cut_loop(const TrimLoop& loop) {
  const std::vector<PlanePiece> given = loop_pieces(loop);
  std::vector<GridPoint> joints;
  joints.reserve(given.size());
  for (std::size_t i = 0; i < given.size(); ++i) joints.push_back(joint(given[i], given[(i + 1) % given.size()]));
  for (std::size_t i = 0; i < given.size(); ++i)
    cut(given[i], joints[(i + given.size() - 1) % given.size()], joints[i]);
}

GridPoint Cutter::joint(const PlanePiece& before, const PlanePiece& after) const {
  const GridPoint end = grid_.locate(before.end());
  const GridPoint start = grid_.locate(after.start());
  return {merged(end.u, start.u), merged(end.v, start.v)};
}

void Cutter::cut(const PlanePiece& piece, const GridPoint& start, const GridPoint& end) {
  cuts_.clear();
  collect_cuts(piece, 0);
  collect_cuts(piece, 1);
  if (cuts_.empty()) return place(piece.net, start, end, 0);
  std::ranges::sort(cuts_, {}, &Cut::t);
  double from = 0.0;
  GridPoint first = start;
  for (std::size_t i = 0; i < cuts_.size();) {
    const double t = cuts_[i].t;
    GridPoint last = grid_.locate(evaluate(piece, t));
    for (; i < cuts_.size() && cuts_[i].t == t; ++i) {
      GridCoordinate& coordinate = cuts_[i].direction == 0 ? last.u : last.v;
      coordinate = {grid_.axis(cuts_[i].direction).line(cuts_[i].line), 2 * cuts_[i].line};
    }
    place(part_of(piece, {from, t}), first, last, 0);
    from = t;
    first = last;
  }
  place(part_of(piece, {from, 1.0}), first, end, 0);
}

/// Where the piece meets the lines of one family, its ends apart.
void Cutter::collect_cuts(const PlanePiece& piece, int direction) {
  const GridAxis& axis = grid_.axis(direction);
  const std::vector<double>& lines = axis.lines();
  const auto first = std::lower_bound(lines.begin(), lines.end(), piece.lower[direction] - axis.tolerance());
  const auto last = std::upper_bound(first, lines.end(), piece.upper[direction] + axis.tolerance());
  const auto count = static_cast<std::size_t>(piece.net.cols());
  for (auto line = first; line != last; ++line) {
    coefficients_.resize(count);
    tolerances_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double weight = piece.net(2, static_cast<Eigen::Index>(i));
      coefficients_[i] = piece.net(direction, static_cast<Eigen::Index>(i)) - weight * *line;
      tolerances_[i] = weight * axis.tolerance();
    }
    for (const Interval& root : bernstein_roots(coefficients_, tolerances_))
      if (root.first > 0.0 && root.last < 1.0)
        cuts_.push_back({root.middle(), direction, static_cast<int>(line - lines.begin())});
  }
}

bool Cutter::is_point(const HomogeneousPoints<2>& net) const {
  for (int direction = 0; direction < 2; ++direction) {
    const double first = net(direction, 0) / net(2, 0);
    for (Eigen::Index i = 1; i < net.cols(); ++i)
      if (std::abs(net(direction, i) / net(2, i) - first) > 2.0 * grid_.axis(direction).tolerance()) return false;
  }
  return true;
}

/// The station of a piece that starts and ends on the same line and does not meet it in between.
int Cutter::side_of_line(const HomogeneousPoints<2>& net, int station, int direction) const {
  const GridAxis& axis = grid_.axis(direction);
  const double line = axis.line(station / 2);
  bool along = true;
  double sum = 0.0;
  for (Eigen::Index i = 0; i < net.cols(); ++i) {
    const double distance = net(direction, i) - net(2, i) * line;
    along = along && std::abs(distance) <= 2.0 * axis.tolerance() * net(2, i);
    sum += distance;
  }
  if (along) return station;
  return std::clamp(sum > 0.0 ? station + 1 : station - 1, 0, 2 * axis.span_count());
}

/// Nothing if the ends lie in no common span.
std::optional<int> Cutter::station_of(const HomogeneousPoints<2>& net, const GridCoordinate& start,
                                      const GridCoordinate& end, int direction) const {
  const int a = start.station;
  const int b = end.station;
  if (a == b) return start.is_on_line() ? side_of_line(net, a, direction) : a;
  if (std::abs(a - b) == 1) return start.is_on_line() ? b : a;
  if (std::abs(a - b) == 2 && start.is_on_line()) return (a + b) / 2;
  return std::nullopt;
}

/// Stores a piece that meets knot lines at its ends alone. Should rounding have hidden a crossing, so that the ends fit
/// no cell, the piece is bisected until its parts do.
void Cutter::place(HomogeneousPoints<2> net, const GridPoint& start, const GridPoint& end, int depth) {
  constexpr int deepest = 60;
  if (is_point(net) || depth == deepest) return place_by_lines(start, end);
  const std::optional<int> in_u = station_of(net, start.u, end.u, 0);
  const std::optional<int> in_v = station_of(net, start.v, end.v, 1);
  if (!in_u || !in_v) {
    auto [left, right] = bisect(PlanePiece(std::move(net)));
    const GridPoint middle = grid_.locate(left.end());
    place(std::move(left.net), start, middle, depth + 1);
    place(std::move(right.net), middle, end, depth + 1);
    return;
  }
  if (*in_u % 2 == 0 && *in_v % 2 == 0) return;
  const Eigen::Index last = net.cols() - 1;
  net.col(0).head<2>() = net(2, 0) * start.uv();
  net.col(last).head<2>() = net(2, last) * end.uv();
  pieces_.push_back({std::move(net), start, end, {*in_u, *in_v}});
}

/// Straight lines, first in u, then in v, instead of a piece that is a point to within rounding.
void Cutter::place_by_lines(const GridPoint& start, const GridPoint& end) {
  GridPoint here = start;
  for (int direction = 0; direction < 2; ++direction) {
    GridCoordinate& moving = direction == 0 ? here.u : here.v;
    const GridCoordinate& resting = direction == 0 ? here.v : here.u;
    const GridCoordinate& target = direction == 0 ? end.u : end.v;
    while (moving.station != target.station || moving.value != target.value) {
      const GridPoint from = here;
      const int step = target.station >= moving.station ? 1 : -1;
      const int span = moving.is_on_line() ? moving.station + step : moving.station;
      const int line = span + step;
      moving =
          step * (target.station - line) <= 0 ? target : GridCoordinate{grid_.axis(direction).line(line / 2), line};
      std::array<int, 2> station{span, resting.station};
      if (direction == 1) std::swap(station[0], station[1]);
      pieces_.push_back({line_piece(from.uv(), here.uv()).net, from, here, station});
    }
  }
}

}  // namespace

std::vector<CutPiece> cut_at_knot_lines(std::span<const TrimLoop> loops, const ParameterGrid& grid) {
  Cutter cutter(grid);
  for (const TrimLoop& loop : loops) cutter.cut_loop(loop);
  return cutter.take();
}

}  // namespace isorim::geometry
