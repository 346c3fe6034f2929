#include "geometry/intersection/zero_arcs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/critical_points.h"
#include "geometry/nurbs/surface.h"

namespace isorim::geometry {
namespace {

/// Cells with touching curves in them are not cut below this.
constexpr double smallest_touching_cell = 1.0 / 512.0;
constexpr double smallest_cell = 1e-12;
constexpr int most_cells = 100000;
/// Points this near to a side lie on it.
constexpr double side_tolerance = 1e-12;

struct Cell {
  Interval u;
  Interval v;
  /// The polynomial over the cell as unit square.
  BernsteinGrid grid;

  double size() const { return std::max(u.length(), v.length()); }
  Point2 middle() const { return {u.middle(), v.middle()}; }
  bool contains(const Point2& point) const { return u.contains(point.x()) && v.contains(point.y()); }
};

/// The range of Bernstein coefficients, which bounds the values.
struct Range {
  double least = 0.0;
  double most = 0.0;

  explicit Range(const BernsteinGrid& grid) : least(grid.minCoeff()), most(grid.maxCoeff()) {}
  double largest() const { return std::max(std::abs(least), std::abs(most)); }
  /// The smallest modulus; 0 if there may be a zero.
  double smallest() const { return least > 0.0 ? least : most < 0.0 ? -most : 0.0; }
  double middle() const { return 0.5 * (least + most); }
  double radius() const { return 0.5 * (most - least); }
};

/// A point where g and both derivatives vanish.
struct SingularPoint {
  Point2 place;
  Eigen::Matrix2d hessian;
  CriticalKind kind = CriticalKind::saddle;
};

double snap_to_side(double s) {
  if (std::abs(s) <= side_tolerance) return 0.0;
  if (std::abs(s - 1.0) <= side_tolerance) return 1.0;
  return s;
}

Point2 snap_to_sides(const Point2& point) {
  return {snap_to_side(point.x()), snap_to_side(point.y())};
}

/// The two directions in which a saddle's quadratic form vanishes, as columns.
Eigen::Matrix2d asymptotic_directions(const Eigen::Matrix2d& hessian) {
  const double a = hessian(0, 0);
  const double b = hessian(0, 1);
  const double c = hessian(1, 1);
  const double q = -(b + std::copysign(std::sqrt(b * b - a * c), b));
  Eigen::Matrix2d directions;
  directions << q, c, a, q;
  return directions.colwise().normalized();
}

/// The root of a polynomial that is monotone between `low` and `high`; the nearer end if it has none.
double monotone_root(const BernsteinCoefficients& polynomial, double low, double high) {
  const double at_low = evaluate(polynomial, low);
  const double at_high = evaluate(polynomial, high);
  if (at_low == 0.0 || at_high == 0.0 || (at_low > 0.0) == (at_high > 0.0))
    return std::abs(at_low) <= std::abs(at_high) ? low : high;
  const Eigen::Index degree = polynomial.size() - 1;
  const BernsteinCoefficients slope = static_cast<double>(degree) * (polynomial.tail(degree) - polynomial.head(degree));
  double t = low + (high - low) * at_low / (at_low - at_high);
  for (int iteration = 0; iteration < 80; ++iteration) {
    const double value = evaluate(polynomial, t);
    if (value == 0.0) return t;
    ((value > 0.0) == (at_low > 0.0) ? low : high) = t;
    double next = t - value / evaluate(slope, t);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-16) return next;
    t = next;
  }
  return t;
}

class Subdivision {
 public:
  Subdivision(const ElementFunction& function, SideCharts& charts) : function_(function), side_charts_(charts) {}

  std::vector<ZeroArc> arcs() {
    cells_.push_back({{0.0, 1.0}, {0.0, 1.0}, function_.grid});
    for (int count = 0; !cells_.empty(); ++count) {
      Cell cell = std::move(cells_.back());
      cells_.pop_back();
      if (count > most_cells) refuse(cell);
      treat(cell);
    }
    for (ZeroArc& arc : arcs_) finish(arc);
    // So that the neighbours find them.
    for (const Side side : {Side::bottom, Side::top, Side::left, Side::right}) chart_of_side(side);
    return std::move(arcs_);
  }

 private:
  [[noreturn]] void refuse(const Cell& cell) const {
    const Point2 place = cell.middle();
    throw GeometryError(
        fmt::format("the curve of intersection has a singular point other than an ordinary double point near "
                    "({:.9g}, {:.9g}) of an element; a shift of the cut by a small distance avoids it",
                    place.x(), place.y()));
  }

  // --- Signs along lines --------------------------------------------------------------------------------------

  const SignChart& chart_of_side(Side side) {
    std::optional<SignChart>& chart = side_charts_[static_cast<std::size_t>(side)];
    if (!chart) {
      const BernsteinGrid& grid = function_.grid;
      chart = side == Side::bottom ? sign_chart(grid.col(0), chart_noise())
              : side == Side::top  ? sign_chart(grid.col(grid.cols() - 1), chart_noise())
              : side == Side::left ? sign_chart(grid.row(0).transpose(), chart_noise())
                                   : sign_chart(grid.row(grid.rows() - 1).transpose(), chart_noise());
    }
    return *chart;
  }

  double chart_noise() const { return std::max(function_.coincidence, 4.0 * function_.noise); }

  /// Along u at the height v.
  const SignChart& horizontal_chart(double v) {
    if (v == 0.0) return chart_of_side(Side::bottom);
    if (v == 1.0) return chart_of_side(Side::top);
    const auto found = horizontal_.find(v);
    if (found != horizontal_.end()) return found->second;
    return horizontal_.emplace(v, sign_chart(along_u(function_.grid, v), chart_noise())).first->second;
  }
  const SignChart& vertical_chart(double u) {
    if (u == 0.0) return chart_of_side(Side::left);
    if (u == 1.0) return chart_of_side(Side::right);
    const auto found = vertical_.find(u);
    if (found != vertical_.end()) return found->second;
    return vertical_.emplace(u, sign_chart(along_v(function_.grid, u), chart_noise())).first->second;
  }

  /// The side's sign if the polynomial has one along all four sides of a cell.
  bool has_one_sign_around(const Cell& cell) {
    int common = 0;
    const auto agrees = [&](const SignChart& chart, Interval part) {
      std::vector<double> cuts{part.first};
      for (const double root : chart.roots)
        if (root > part.first && root < part.last) cuts.push_back(root);
      cuts.push_back(part.last);
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const int sign = chart.sign_between(cuts[i], cuts[i + 1]);
        if (sign == 0) continue;
        if (common == 0) common = sign;
        if (common != sign) return false;
      }
      return true;
    };
    return agrees(horizontal_chart(cell.v.first), cell.u) && agrees(horizontal_chart(cell.v.last), cell.u) &&
           agrees(vertical_chart(cell.u.first), cell.v) && agrees(vertical_chart(cell.u.last), cell.v);
  }

  // --- Cells --------------------------------------------------------------------------------------------------

  void treat(const Cell& cell) {
    const Range values(cell.grid);
    if (values.least >= -function_.noise || values.most <= function_.noise) return;
    const Range slope_u(derivative_u(cell.grid) / cell.u.length());
    const Range slope_v(derivative_v(cell.grid) / cell.v.length());
    constexpr double steepest = 3.0;
    if (slope_v.smallest() > 0.0 && slope_u.largest() <= steepest * slope_v.smallest())
      return append_graph(cell, slope_v.least > 0.0 ? 1 : -1, Direction::u);
    if (slope_u.smallest() > 0.0 && slope_v.largest() <= steepest * slope_u.smallest())
      return append_graph(cell, slope_u.least > 0.0 ? 1 : -1, Direction::v);
    if (!treat_singular(cell)) split(cell);
  }

  /// The parts of the graph over `along` that lie in the cell; g grows (sign = 1) or falls across.
  void append_graph(const Cell& cell, int sign, Direction along) {
    const bool over_u = along == Direction::u;
    const Interval range = over_u ? cell.u : cell.v;
    const Interval across = over_u ? cell.v : cell.u;
    const SignChart& low = over_u ? horizontal_chart(across.first) : vertical_chart(across.first);
    const SignChart& high = over_u ? horizontal_chart(across.last) : vertical_chart(across.last);
    std::vector<double> cuts{range.first, range.last};
    for (const SignChart* chart : {&low, &high})
      for (const double root : chart->roots)
        if (root > range.first && root < range.last) cuts.push_back(root);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      if (cuts[i] == cuts[i + 1] || low.sign_between(cuts[i], cuts[i + 1]) != -sign ||
          high.sign_between(cuts[i], cuts[i + 1]) != sign)
        continue;
      ZeroArc arc;
      constexpr int parts = 4;
      for (int k = 0; k <= parts; ++k) {
        const double s = k == parts ? cuts[i + 1] : cuts[i] + (cuts[i + 1] - cuts[i]) * k / parts;
        const double t =
            monotone_root(over_u ? along_v(function_.grid, s) : along_u(function_.grid, s), across.first, across.last);
        arc.points.push_back(over_u ? Point2(s, t) : Point2(t, s));
      }
      arcs_.push_back(std::move(arc));
    }
  }

  /// Bisects across the direction in which the gradient turns more, away from singular points.
  void split(const Cell& cell) {
    if (std::min(cell.u.length(), cell.v.length()) < smallest_cell) refuse(cell);
    const double bend_u = derivative_u(derivative_u(cell.grid)).cwiseAbs().maxCoeff();
    const double bend_v = derivative_v(derivative_v(cell.grid)).cwiseAbs().maxCoeff();
    const double twist = derivative_u(derivative_v(cell.grid)).cwiseAbs().maxCoeff();
    const bool across_u = bend_u > 4.0 * std::max(bend_v, twist)   ? true
                          : bend_v > 4.0 * std::max(bend_u, twist) ? false
                                                                   : cell.u.length() >= cell.v.length();
    const Interval range = across_u ? cell.u : cell.v;
    const double fraction = split_fraction(cell, across_u);
    const double cut = range.first + fraction * range.length();
    const Interval unit{0.0, 1.0};
    const Interval before{0.0, fraction};
    const Interval after{fraction, 1.0};
    if (across_u) {
      cells_.push_back({{cut, range.last}, cell.v, restrict_to(cell.grid, after, unit)});
      cells_.push_back({{range.first, cut}, cell.v, restrict_to(cell.grid, before, unit)});
    } else {
      cells_.push_back({cell.u, {cut, range.last}, restrict_to(cell.grid, unit, after)});
      cells_.push_back({cell.u, {range.first, cut}, restrict_to(cell.grid, unit, before)});
    }
  }

  /// Not a half: shapes are symmetric, and lines through their symmetric points make work.
  double split_fraction(const Cell& cell, bool across_u) const {
    constexpr std::array<double, 5> candidates{0.4837, 0.2719, 0.7291, 0.3673, 0.6173};
    const Interval range = across_u ? cell.u : cell.v;
    double best = candidates.front();
    double clearance = -1.0;
    for (const double fraction : candidates) {
      double nearest = 1.0;
      for (const SingularPoint& point : singular_) {
        if (!cell.contains(point.place)) continue;
        const double s = (across_u ? point.place.x() : point.place.y()) - range.first;
        nearest = std::min(nearest, std::abs(s / range.length() - fraction));
      }
      if (fraction == candidates.front() && nearest > 0.2) return fraction;
      if (nearest <= clearance) continue;
      best = fraction;
      clearance = nearest;
    }
    return best;
  }

  // --- Singular points ----------------------------------------------------------------------------------------

  /// True if nothing is left to do in the cell.
  bool treat_singular(const Cell& cell) {
    if (cell.size() > 0.6) return false;
    const std::optional<SingularPoint> point = singular_point_near(cell);
    if (!point) return false;
    if (point->kind == CriticalKind::saddle) return cell.contains(point->place) && append_branches(cell, *point);
    const bool is_small = point->kind == CriticalKind::extremum || cell.size() < smallest_touching_cell;
    if (!is_small) return false;
    if (has_one_sign_around(cell)) return true;
    if (point->kind == CriticalKind::degenerate && cell.size() < 1e-2 * smallest_touching_cell) refuse(cell);
    return false;
  }

  std::optional<SingularPoint> singular_point_near(const Cell& cell) {
    for (const SingularPoint& known : singular_)
      if (cell.contains(known.place)) return known;
    Point2 place = cell.middle();
    GridJet jet;
    for (int iteration = 0; iteration < 30; ++iteration) {
      jet = evaluate_jet(function_.grid, place);
      const Vector2 step = critical_step(jet);
      place += step;
      if (std::abs(place.x() - cell.u.middle()) > 1.5 * cell.size() ||
          std::abs(place.y() - cell.v.middle()) > 1.5 * cell.size())
        return std::nullopt;
      if (step.norm() <= 1e-15) break;
    }
    place = snap_to_sides(place);
    jet = evaluate_jet(function_.grid, place);
    if (std::abs(jet.value) > chart_noise()) return std::nullopt;
    if (jet.gradient.norm() > 1e-6 * jet.hessian.norm()) return std::nullopt;
    const SingularPoint point{place, jet.hessian, kind_of(jet.hessian)};
    if (point.kind == CriticalKind::saddle && place.minCoeff() >= 0.0 && place.maxCoeff() <= 1.0)
      singular_.push_back(point);
    return point;
  }

  /// In the coordinates along its two directions the Hessian is little else than its mixed derivative, all over the
  /// cell: then each branch is a graph over its direction, and no others are there.
  bool is_simple_saddle(const Cell& cell, const SingularPoint& point) const {
    const double du = cell.u.length();
    const double dv = cell.v.length();
    const Range uu(derivative_u(derivative_u(cell.grid)) / (du * du));
    const Range uv(derivative_u(derivative_v(cell.grid)) / (du * dv));
    const Range vv(derivative_v(derivative_v(cell.grid)) / (dv * dv));
    Eigen::Matrix2d middle;
    middle << uu.middle(), uv.middle(), uv.middle(), vv.middle();
    Eigen::Matrix2d radius;
    radius << uu.radius(), uv.radius(), uv.radius(), vv.radius();
    const Eigen::Matrix2d axes = asymptotic_directions(point.hessian);
    const Eigen::Matrix2d mean = axes.transpose() * middle * axes;
    const Eigen::Matrix2d spread = axes.cwiseAbs().transpose() * radius * axes.cwiseAbs();
    const double mixed = std::abs(mean(0, 1)) - spread(0, 1);
    return std::abs(mean(0, 0)) + spread(0, 0) <= 0.25 * mixed && std::abs(mean(1, 1)) + spread(1, 1) <= 0.25 * mixed;
  }

  /// Joins the singular point with the places where the zero set leaves the cell.
  bool append_branches(const Cell& cell, const SingularPoint& point) {
    if (!is_simple_saddle(cell, point)) return false;
    std::vector<Point2> ends;
    for (const double v : {cell.v.first, cell.v.last}) {
      if (v == point.place.y()) continue;
      for (const double root : horizontal_chart(v).roots)
        if (cell.u.contains(root)) ends.emplace_back(root, v);
    }
    for (const double u : {cell.u.first, cell.u.last}) {
      if (u == point.place.x()) continue;
      for (const double root : vertical_chart(u).roots)
        if (cell.v.contains(root)) ends.emplace_back(u, root);
    }
    const bool is_inside = cell.u.first < point.place.x() && point.place.x() < cell.u.last &&
                           cell.v.first < point.place.y() && point.place.y() < cell.v.last;
    if (ends.size() > 4 || (is_inside && ends.size() != 4)) return false;
    for (const Point2& end : ends) {
      ZeroArc arc;
      arc.points = {point.place, on_zero_set(0.5 * (point.place + end), end - point.place), end};
      arc.singular_start = true;
      arcs_.push_back(std::move(arc));
    }
    return true;
  }

  /// Newton across a direction.
  Point2 on_zero_set(Point2 place, const Vector2& along) const {
    const Vector2 normal = Vector2(-along.y(), along.x()).normalized();
    for (int iteration = 0; iteration < 20; ++iteration) {
      const GridJet jet = evaluate_jet(function_.grid, place);
      const double step = -jet.value / jet.gradient.dot(normal);
      if (!std::isfinite(step) || std::abs(step) > along.norm()) break;
      place += step * normal;
      if (std::abs(step) <= 1e-15) break;
    }
    return place;
  }

  /// Turns the arc so that g is negative on its left; ends near the sides are put onto them.
  void finish(ZeroArc& arc) const {
    const std::size_t middle = arc.points.size() / 2;
    const Vector2 along = arc.points[middle] - arc.points[middle - 1];
    const Vector2 gradient = evaluate_jet(function_.grid, 0.5 * (arc.points[middle] + arc.points[middle - 1])).gradient;
    if (gradient.dot(Vector2(-along.y(), along.x())) > 0.0) {
      std::reverse(arc.points.begin(), arc.points.end());
      std::swap(arc.singular_start, arc.singular_end);
    }
    arc.points.front() = snap_to_sides(arc.points.front());
    arc.points.back() = snap_to_sides(arc.points.back());
  }

  const ElementFunction& function_;
  SideCharts& side_charts_;
  std::map<double, SignChart> horizontal_;
  std::map<double, SignChart> vertical_;
  std::vector<Cell> cells_;
  std::vector<SingularPoint> singular_;
  std::vector<ZeroArc> arcs_;
};

}  // namespace

std::vector<ZeroArc> zero_arcs(const ElementFunction& function, SideCharts& charts) {
  return Subdivision(function, charts).arcs();
}

}  // namespace isorim::geometry
