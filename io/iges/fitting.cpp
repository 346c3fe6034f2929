#include "io/iges/fitting.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/iges/curves.h"

namespace isorim::io::iges {

using geometry::HomogeneousPoints;
using geometry::Interval;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;

namespace {

constexpr int curve_degree = 12;
constexpr int surface_degree = 8;

/// Interpolation on [0, 1] at the Chebyshev-Lobatto points, in the Bernstein basis.
template <int Degree>
struct Interpolation {
  Eigen::Matrix<double, Degree + 1, 1> nodes;
  /// Between the nodes, where the error is judged.
  Eigen::Matrix<double, Degree, 1> checks;
  /// Values at the nodes (columns) times this give Bézier points.
  Eigen::Matrix<double, Degree + 1, Degree + 1> to_bezier;
  /// Bézier points (columns) times this give the values at the checks.
  Eigen::Matrix<double, Degree + 1, Degree> at_checks;
};

template <int Degree>
Eigen::Matrix<double, Degree + 1, 1> bernstein(double s) {
  Eigen::Matrix<double, Degree + 1, 1> values = Eigen::Matrix<double, Degree + 1, 1>::Zero();
  values(0) = 1.0;
  for (int p = 1; p <= Degree; ++p)
    for (int i = p; i >= 0; --i) values(i) = (1.0 - s) * values(i) + (i > 0 ? s * values(i - 1) : 0.0);
  return values;
}

template <int Degree>
Interpolation<Degree> make_interpolation() {
  Interpolation<Degree> result;
  const auto node = [](double i) { return 0.5 * (1.0 - std::cos(std::numbers::pi * i / Degree)); };
  Eigen::Matrix<double, Degree + 1, Degree + 1> values;
  for (int i = 0; i <= Degree; ++i) {
    result.nodes(i) = node(i);
    values.col(i) = bernstein<Degree>(result.nodes(i));
  }
  for (int i = 0; i < Degree; ++i) {
    result.checks(i) = node(i + 0.5);
    result.at_checks.col(i) = bernstein<Degree>(result.checks(i));
  }
  result.to_bezier = values.inverse();
  return result;
}

template <int Degree>
const Interpolation<Degree>& interpolation() {
  static const Interpolation<Degree> result = make_interpolation<Degree>();
  return result;
}

double at(const Interval& range, double s) {
  return s <= 0.5 ? range.first + s * range.length() : range.last - (1.0 - s) * range.length();
}

template <class Vector>
const Vector& require_finite(const Vector& value, double t) {
  if (!value.allFinite()) throw GeometryError(fmt::format("fit: the value at parameter {} is not finite", t));
  return value;
}

void require_breakpoints(std::span<const double> breakpoints) {
  if (breakpoints.size() < 2) throw GeometryError("fit: at least 2 breakpoints are needed");
  for (std::size_t i = 1; i < breakpoints.size(); ++i)
    if (!(breakpoints[i - 1] < breakpoints[i]))
      throw GeometryError(
          fmt::format("fit: breakpoints {} and {} do not increase", breakpoints[i - 1], breakpoints[i]));
}

template <int Dim>
struct Piece {
  Interval range;
  Points<Dim> bezier;
  double deviation = 0.0;
};

template <int Dim>
Piece<Dim> fit_piece(const std::function<Point<Dim>(double)>& function, const Interval& range) {
  const Interpolation<curve_degree>& rule = interpolation<curve_degree>();
  Points<Dim> values(Dim, curve_degree + 1);
  for (int i = 0; i <= curve_degree; ++i) {
    const double t = at(range, rule.nodes(i));
    values.col(i) = require_finite(function(t), t);
  }
  // Differences to the first value: what all points share is then exact.
  const Point<Dim> origin = values.col(0);
  Piece<Dim> piece{range, (values.colwise() - origin) * rule.to_bezier, 0.0};
  piece.bezier.colwise() += origin;
  piece.bezier.col(0) = values.col(0);
  piece.bezier.col(curve_degree) = values.col(curve_degree);
  const Points<Dim> fitted = piece.bezier * rule.at_checks;
  for (int i = 0; i < curve_degree; ++i) {
    const double t = at(range, rule.checks(i));
    piece.deviation = std::max(piece.deviation, (require_finite(function(t), t) - fitted.col(i)).norm());
  }
  return piece;
}

bool can_be_halved(const Interval& range) {
  return range.first < range.middle() && range.middle() < range.last &&
         range.length() > 1e-13 * std::max(std::abs(range.first), std::abs(range.last));
}

template <int Dim>
std::vector<Piece<Dim>> fit_stretch(const std::function<Point<Dim>(double)>& function, const Interval& stretch,
                                    const FitOptions& options) {
  std::vector<Piece<Dim>> done;
  std::vector<Interval> open{stretch};
  while (!open.empty()) {
    const Interval range = open.back();
    open.pop_back();
    Piece<Dim> piece = fit_piece<Dim>(function, range);
    const bool full = static_cast<int>(done.size() + open.size()) >= options.largest_count;
    if (piece.deviation <= options.tolerance || full || !can_be_halved(range)) {
      done.push_back(std::move(piece));
      continue;
    }
    open.push_back({range.middle(), range.last});
    open.push_back({range.first, range.middle()});
  }
  return done;
}

/// Whether a row of patches meets the tolerance along each direction.
struct PatchFit {
  /// Bézier points, u fastest: 3 x (p + 1)^2.
  Points<3> bezier;
  double deviation = 0.0;
  double deviation_u = 0.0;
  double deviation_v = 0.0;
};

using SurfaceFunction = std::function<Point3(const Point2&)>;

Points<3> sample(const SurfaceFunction& function, const Interval& u, const Interval& v,
                 const Eigen::Ref<const Eigen::VectorXd>& s, const Eigen::Ref<const Eigen::VectorXd>& t) {
  Points<3> values(3, s.size() * t.size());
  for (Eigen::Index j = 0; j < t.size(); ++j)
    for (Eigen::Index i = 0; i < s.size(); ++i)
      values.col(i + j * s.size()) = require_finite(function({at(u, s(i)), at(v, t(j))}), at(u, s(i)));
  return values;
}

/// Applies `along_u` (a x b) and `along_v` (c x d) to a net of a x c points: b x d points.
Points<3> tensor(const Points<3>& net, const Eigen::Ref<const Eigen::MatrixXd>& along_u,
                 const Eigen::Ref<const Eigen::MatrixXd>& along_v) {
  Points<3> half(3, along_u.cols() * along_v.rows());
  for (Eigen::Index j = 0; j < along_v.rows(); ++j)
    half.middleCols(j * along_u.cols(), along_u.cols()) = net.middleCols(j * along_u.rows(), along_u.rows()) * along_u;
  Points<3> result = Points<3>::Zero(3, along_u.cols() * along_v.cols());
  for (Eigen::Index l = 0; l < along_v.cols(); ++l)
    for (Eigen::Index j = 0; j < along_v.rows(); ++j)
      result.middleCols(l * along_u.cols(), along_u.cols()) +=
          along_v(j, l) * half.middleCols(j * along_u.cols(), along_u.cols());
  return result;
}

double largest_distance(const Points<3>& a, const Points<3>& b) {
  return (a - b).colwise().norm().maxCoeff();
}

PatchFit fit_patch(const SurfaceFunction& function, const Interval& u, const Interval& v) {
  constexpr int n = surface_degree + 1;
  const Interpolation<surface_degree>& rule = interpolation<surface_degree>();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  Points<3> values = sample(function, u, v, rule.nodes, rule.nodes);
  const Point3 origin = values.col(0);
  PatchFit patch;
  patch.bezier = tensor(values.colwise() - origin, rule.to_bezier, rule.to_bezier);
  patch.bezier.colwise() += origin;
  for (const int i : {0, n - 1})
    for (const int j : {0, n - 1}) patch.bezier.col(i + j * n) = values.col(i + j * n);
  Eigen::MatrixXd at_nodes(n, n);
  for (int i = 0; i < n; ++i) at_nodes.col(i) = bernstein<surface_degree>(rule.nodes(i));
  const auto deviation = [&](const auto& s, const auto& t, const Eigen::MatrixXd& in_u, const Eigen::MatrixXd& in_v) {
    return largest_distance(sample(function, u, v, s, t), tensor(patch.bezier, in_u, in_v));
  };
  patch.deviation_u = deviation(rule.checks, rule.nodes, rule.at_checks, at_nodes);
  patch.deviation_v = deviation(rule.nodes, rule.checks, at_nodes, rule.at_checks);
  const double between = deviation(rule.checks, rule.checks, rule.at_checks, rule.at_checks);
  patch.deviation = std::max({patch.deviation_u, patch.deviation_v, between});
  return patch;
}

/// Halves the intervals that are marked.
std::vector<double> halve(const std::vector<double>& breakpoints, const std::vector<bool>& marked) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < breakpoints.size(); ++i) {
    result.push_back(breakpoints[i]);
    const Interval range{breakpoints[i], breakpoints[i + 1]};
    if (marked[i] && can_be_halved(range)) result.push_back(range.middle());
  }
  result.push_back(breakpoints.back());
  return result;
}

struct Grid {
  std::vector<double> u;
  std::vector<double> v;
  /// u fastest.
  std::vector<PatchFit> patches;

  std::size_t count_u() const { return u.size() - 1; }
  std::size_t count_v() const { return v.size() - 1; }
};

void fit_grid(const SurfaceFunction& function, Grid& grid) {
  grid.patches.clear();
  for (std::size_t j = 0; j < grid.count_v(); ++j)
    for (std::size_t i = 0; i < grid.count_u(); ++i)
      grid.patches.push_back(fit_patch(function, {grid.u[i], grid.u[i + 1]}, {grid.v[j], grid.v[j + 1]}));
}

/// False if nothing has to be, or can be, refined.
bool refine(Grid& grid, double tolerance) {
  std::vector<bool> rows_u(grid.count_u(), false);
  std::vector<bool> rows_v(grid.count_v(), false);
  for (std::size_t k = 0; k < grid.patches.size(); ++k) {
    const PatchFit& patch = grid.patches[k];
    if (patch.deviation <= tolerance) continue;
    const double worse = std::max(patch.deviation_u, patch.deviation_v);
    if (patch.deviation_u >= 0.1 * worse) rows_u[k % grid.count_u()] = true;
    if (patch.deviation_v >= 0.1 * worse) rows_v[k / grid.count_u()] = true;
  }
  Grid finer{halve(grid.u, rows_u), halve(grid.v, rows_v), {}};
  if (finer.u.size() == grid.u.size() && finer.v.size() == grid.v.size()) return false;
  grid = std::move(finer);
  return true;
}

FittedSurface assemble(const Grid& grid) {
  const int p = surface_degree;
  const int count_u = static_cast<int>(grid.count_u()) * p + 1;
  const int count_v = static_cast<int>(grid.count_v()) * p + 1;
  HomogeneousPoints<3> net = HomogeneousPoints<3>::Ones(4, static_cast<Eigen::Index>(count_u) * count_v);
  double deviation = 0.0;
  for (std::size_t k = 0; k < grid.patches.size(); ++k) {
    const int first_u = static_cast<int>(k % grid.count_u()) * p;
    const int first_v = static_cast<int>(k / grid.count_u()) * p;
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i)
        net.col(first_u + i + static_cast<Eigen::Index>(first_v + j) * count_u).head<3>() =
            grid.patches[k].bezier.col(i + j * (p + 1));
    deviation = std::max(deviation, grid.patches[k].deviation);
  }
  return {NurbsSurface<3>(piecewise_knots(p, grid.u), piecewise_knots(p, grid.v), std::move(net)), deviation};
}

}  // namespace

template <int Dim>
FittedCurve<Dim> fit_curve(const std::function<Point<Dim>(double)>& function, std::span<const double> breakpoints,
                           const FitOptions& options) {
  require_breakpoints(breakpoints);
  std::vector<double> ends{breakpoints.front()};
  std::vector<Piece<Dim>> pieces;
  double deviation = 0.0;
  for (std::size_t i = 0; i + 1 < breakpoints.size(); ++i)
    for (Piece<Dim>& piece : fit_stretch<Dim>(function, {breakpoints[i], breakpoints[i + 1]}, options)) {
      ends.push_back(piece.range.last);
      deviation = std::max(deviation, piece.deviation);
      pieces.push_back(std::move(piece));
    }
  Points<Dim> points(Dim, static_cast<Eigen::Index>(pieces.size()) * curve_degree + 1);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    points.middleCols(static_cast<Eigen::Index>(i) * curve_degree, curve_degree + 1) = pieces[i].bezier;
  return {NurbsCurve<Dim>::from_points(piecewise_knots(curve_degree, ends), points), deviation};
}

FittedSurface fit_surface(const SurfaceFunction& function, std::span<const double> breakpoints_u,
                          std::span<const double> breakpoints_v, const FitOptions& options) {
  require_breakpoints(breakpoints_u);
  require_breakpoints(breakpoints_v);
  Grid grid{{breakpoints_u.begin(), breakpoints_u.end()}, {breakpoints_v.begin(), breakpoints_v.end()}, {}};
  const std::size_t largest = static_cast<std::size_t>(options.largest_count) * grid.count_u() * grid.count_v();
  do {
    fit_grid(function, grid);
  } while (grid.patches.size() < largest && refine(grid, options.tolerance));
  if (grid.patches.empty()) fit_grid(function, grid);
  return assemble(grid);
}

template FittedCurve<2> fit_curve<2>(const std::function<Point<2>(double)>&, std::span<const double>,
                                     const FitOptions&);
template FittedCurve<3> fit_curve<3>(const std::function<Point<3>(double)>&, std::span<const double>,
                                     const FitOptions&);

}  // namespace isorim::io::iges
