#include "geometry/intersection/critical_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "geometry/intersection/chebyshev_fit.h"

namespace isorim::geometry {
namespace {

/// Places in the unit square this near are the same contact.
constexpr double same_place = 1e-6;
/// Cells on curves of contact are not cut below this.
constexpr double smallest_curve_cell = 1.0 / 64.0;
/// Cells in which only nearly critical points are left are not cut below this.
constexpr double smallest_cell = 1e-7;
constexpr int most_cells = 20000;
/// Of a curve of contact, in the unit square.
constexpr double longest_step = 1.0 / 32.0;
constexpr double shortest_step = 1e-4;

struct Cell {
  Interval u;
  Interval v;
  BernsteinGrid grid;

  double size() const { return std::max(u.length(), v.length()); }
  Point2 middle() const { return {u.middle(), v.middle()}; }
};

bool has_zero(const Eigen::Ref<const Eigen::MatrixXd>& coefficients, double noise) {
  return coefficients.minCoeff() <= noise && coefficients.maxCoeff() >= -noise;
}

bool is_inside(const Point2& place) {
  return place.minCoeff() >= 0.0 && place.maxCoeff() <= 1.0;
}

/// Rounding must not put a point on a side outside.
Point2 snapped(Point2 place) {
  for (Eigen::Index i = 0; i < 2; ++i) {
    if (std::abs(place(i)) <= 1e-9) place(i) = 0.0;
    if (std::abs(place(i) - 1.0) <= 1e-9) place(i) = 1.0;
  }
  return place;
}

double distance_from(const std::vector<Point2>& polyline, const Point2& point) {
  double least = (polyline.front() - point).norm();
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    const Vector2 leg = polyline[i] - polyline[i - 1];
    const double length = leg.squaredNorm();
    const double t = length > 0.0 ? std::clamp((point - polyline[i - 1]).dot(leg) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (polyline[i - 1] + t * leg - point).norm());
  }
  return least;
}

class ContactFinder {
 public:
  explicit ContactFinder(const ElementFunction& function)
      : function_(function),
        grid_(function.grid),
        noise_(std::max(function.coincidence, 4.0 * function.noise)),
        slope_noise_(1e-14 * grid_.cwiseAbs().maxCoeff()) {}

  ElementContacts find() {
    cells_.push_back({{0.0, 1.0}, {0.0, 1.0}, grid_});
    for (int count = 0; !cells_.empty() && count < most_cells; ++count) {
      const Cell cell = std::move(cells_.back());
      cells_.pop_back();
      treat(cell);
    }
    for (const Point2& seed : seeds_) follow(seed);
    std::erase_if(contacts_.points, [&](const ElementContacts::Contact& contact) {
      return std::ranges::any_of(polylines_,
                                 [&](const auto& line) { return distance_from(line, contact.place) < 2e-3; });
    });
    find_on_sides();
    return std::move(contacts_);
  }

 private:
  // --- Points -------------------------------------------------------------------------------------------------

  void treat(const Cell& cell) {
    if (!has_zero(cell.grid, noise_)) return;
    const BernsteinGrid slope_u = derivative_u(cell.grid);
    const BernsteinGrid slope_v = derivative_v(cell.grid);
    if (!has_zero(slope_u, slope_noise_) || !has_zero(slope_v, slope_noise_)) return;
    if (has_slope_in_some_direction(slope_u, slope_v)) return;
    const std::optional<Point2> place = critical_place(cell);
    if (place && std::abs(evaluate(grid_, *place)) <= noise_) {
      const CriticalKind kind = kind_of(evaluate_jet(grid_, *place).hessian);
      if (kind == CriticalKind::degenerate) {
        if (cell.size() > smallest_curve_cell) return split(cell);
        if (is_inside(*place)) seeds_.push_back(*place);
        return;
      }
      if (is_inside(*place)) add(*place, kind);
    }
    if (has_regular_hessian(cell.grid)) return;
    if (cell.size() > (place ? smallest_cell : 1e-3)) split(cell);
  }

  /// Along the mean gradient g is monotone.
  bool has_slope_in_some_direction(const BernsteinGrid& slope_u, const BernsteinGrid& slope_v) const {
    const Vector2 mean(slope_u.mean(), slope_v.mean());
    const auto low = [](const BernsteinGrid& slope, double factor) {
      return factor > 0.0 ? factor * slope.minCoeff() : factor * slope.maxCoeff();
    };
    return low(slope_u, mean.x()) + low(slope_v, mean.y()) > slope_noise_ * mean.lpNorm<1>();
  }

  /// The determinant of the Hessian has one sign all over the cell, so at most one critical point is there.
  static bool has_regular_hessian(const BernsteinGrid& grid) {
    const BernsteinGrid uu = derivative_u(derivative_u(grid));
    const BernsteinGrid uv = derivative_u(derivative_v(grid));
    const BernsteinGrid vv = derivative_v(derivative_v(grid));
    const double a = uu.minCoeff();
    const double b = uu.maxCoeff();
    const double c = vv.minCoeff();
    const double d = vv.maxCoeff();
    const double product_low = std::min({a * c, a * d, b * c, b * d});
    const double product_high = std::max({a * c, a * d, b * c, b * d});
    const double mixed = uv.cwiseAbs().maxCoeff();
    const double mixed_low = uv.minCoeff() * uv.maxCoeff() > 0.0 ? uv.cwiseAbs().minCoeff() : 0.0;
    return product_low > mixed * mixed || product_high < mixed_low * mixed_low;
  }

  std::optional<Point2> critical_place(const Cell& cell) const {
    Point2 place = cell.middle();
    for (int iteration = 0; iteration < 30; ++iteration) {
      const Vector2 step = critical_step(evaluate_jet(grid_, place));
      place += step;
      if (!((place - cell.middle()).cwiseAbs().maxCoeff() <= 1.5 * cell.size())) return std::nullopt;
      if (step.norm() <= 1e-14) break;
    }
    place = snapped(place);
    const GridJet jet = evaluate_jet(grid_, place);
    if (jet.gradient.norm() > 1e-7 * jet.hessian.norm()) return std::nullopt;
    return place;
  }

  void split(const Cell& cell) {
    const bool across_u = cell.u.length() >= cell.v.length();
    constexpr double fraction = 0.4837;
    const Interval range = across_u ? cell.u : cell.v;
    const double cut = range.first + fraction * range.length();
    const Interval unit{0.0, 1.0};
    for (const bool first : {true, false}) {
      const Interval local = first ? Interval{0.0, fraction} : Interval{fraction, 1.0};
      const Interval part = first ? Interval{range.first, cut} : Interval{cut, range.last};
      cells_.push_back({across_u ? part : cell.u, across_u ? cell.v : part,
                        across_u ? restrict_to(cell.grid, local, unit) : restrict_to(cell.grid, unit, local)});
    }
  }

  void add(const Point2& place, CriticalKind kind) {
    for (const ElementContacts::Contact& known : contacts_.points)
      if ((known.place - place).norm() <= same_place) return;
    contacts_.points.push_back({place, kind});
  }

  void find_on_sides() {
    const BernsteinGrid& g = grid_;
    const auto add_side = [&](Side side, const BernsteinCoefficients& values, const auto& place_of) {
      if (function_.vanishes_on(side)) return;
      for (const double s : touching_places(values, noise_)) {
        const Point2 place = place_of(s);
        const bool is_known = std::ranges::any_of(polylines_, [&](const auto& line) {
          return std::min((line.front() - place).norm(), (line.back() - place).norm()) < same_place;
        });
        if (!is_known) add(place, CriticalKind::extremum);
      }
    };
    add_side(Side::bottom, g.col(0), [](double s) { return Point2(s, 0.0); });
    add_side(Side::top, g.col(g.cols() - 1), [](double s) { return Point2(s, 1.0); });
    add_side(Side::left, g.row(0).transpose(), [](double s) { return Point2(0.0, s); });
    add_side(Side::right, g.row(g.rows() - 1).transpose(), [](double s) { return Point2(1.0, s); });
  }

  // --- Curves -------------------------------------------------------------------------------------------------

  /// The critical point reached from a place by shortest steps, if zero is touched there.
  std::optional<Point2> corrected(Point2 place) const {
    Vector2 step = Vector2::Ones();
    for (int iteration = 0; iteration < 12 && step.norm() > 1e-15; ++iteration) {
      step = critical_step(evaluate_jet(grid_, place));
      place += step;
      if (!(step.norm() < longest_step)) return std::nullopt;
    }
    // Between the points found the values may exceed the tolerance a little.
    if (step.norm() > 1e-10 || std::abs(evaluate(grid_, place)) > 10.0 * noise_) return std::nullopt;
    return place;
  }

  Vector2 direction_at(const Point2& place) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(evaluate_jet(grid_, place).hessian);
    return std::abs(eigen.eigenvalues()(0)) < std::abs(eigen.eigenvalues()(1)) ? eigen.eigenvectors().col(0)
                                                                               : eigen.eigenvectors().col(1);
  }

  void follow(const Point2& seed) {
    for (const std::vector<Point2>& known : polylines_)
      if (distance_from(known, seed) < 4e-3) return;
    std::vector<Point2> line{seed};
    const Vector2 direction = direction_at(seed);
    const bool is_closed = run(line, direction);
    if (!is_closed) {
      std::ranges::reverse(line);
      run(line, -direction);
    }
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    if (length < 1e-2) {
      // Contact of higher order at a point.
      if (std::abs(evaluate(grid_, seed)) <= noise_) add(seed, CriticalKind::degenerate);
      return;
    }
    append_curves(line);
    polylines_.push_back(std::move(line));
  }

  /// Appends points until the curve leaves the square, ends or closes; true if it closes.
  bool run(std::vector<Point2>& line, Vector2 heading) const {
    const Point2 first = line.front();
    double step = longest_step;
    while (line.size() < 4000) {
      const Point2 here = line.back();
      Vector2 along = direction_at(here);
      if (along.dot(heading) < 0.0) along = -along;
      const std::optional<Point2> next = corrected(here + step * along);
      const bool is_good = next && (*next - here).norm() < 1.5 * step && (*next - here).dot(along) > 0.9 * step;
      if (!is_good) {
        step *= 0.5;
        if (step < shortest_step) return false;
        continue;
      }
      if (!is_inside(*next)) {
        if (const std::optional<Point2> exit = exit_point(here, *next)) line.push_back(*exit);
        return false;
      }
      heading = *next - here;
      line.push_back(*next);
      step = std::min(longest_step, 1.5 * step);
      if (line.size() > 4 && (first - *next).norm() < 1.2 * step && (first - *next).dot(heading) > 0.0) {
        line.push_back(first);
        return true;
      }
    }
    return false;
  }

  /// Where the curve between a point inside and one outside meets the sides.
  std::optional<Point2> exit_point(const Point2& inside, const Point2& outside) const {
    double low = 0.0;
    double high = 1.0;
    Point2 place = inside;
    for (int iteration = 0; iteration < 60; ++iteration) {
      const double middle = 0.5 * (low + high);
      const std::optional<Point2> found = corrected(inside + middle * (outside - inside));
      if (!found) return std::nullopt;
      const bool stays = found->minCoeff() >= 0.0 && found->maxCoeff() <= 1.0;
      (stays ? low : high) = middle;
      if (stays) place = *found;
    }
    place = snapped(place);
    if ((place - inside).norm() < 1e-9) return std::nullopt;
    return place;
  }

  void append_curves(const std::vector<Point2>& line) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Point2 from = line[i - 1];
      const Point2 to = line[i];
      const auto place = [&](double s) -> Point2 {
        if (s == 0.0) return from;
        if (s == 1.0) return to;
        const Point2 guess = from + s * (to - from);
        return corrected(guess).value_or(guess);
      };
      for (NurbsCurve<2>& curve : fit_curve(place, 1e-12)) contacts_.curves.push_back(std::move(curve));
    }
  }

  const ElementFunction& function_;
  const BernsteinGrid& grid_;
  double noise_;
  double slope_noise_;
  std::vector<Cell> cells_;
  std::vector<Point2> seeds_;
  std::vector<std::vector<Point2>> polylines_;
  ElementContacts contacts_;
};

}  // namespace

CriticalKind kind_of(const Eigen::Matrix2d& hessian) {
  const double determinant = hessian.determinant();
  if (std::abs(determinant) <= 1e-8 * hessian.squaredNorm()) return CriticalKind::degenerate;
  return determinant < 0.0 ? CriticalKind::saddle : CriticalKind::extremum;
}

Vector2 critical_step(const GridJet& jet) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(jet.hessian);
  const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
  Vector2 step = Vector2::Zero();
  for (int i = 0; i < 2; ++i) {
    const double value = eigen.eigenvalues()(i);
    if (std::abs(value) <= 1e-6 * largest) continue;
    const Vector2 axis = eigen.eigenvectors().col(i);
    step -= axis * (axis.dot(jet.gradient) / value);
  }
  return step;
}

ElementContacts find_contacts(const ElementFunction& function) {
  if (function.vanishes || !has_zero(function.grid, std::max(function.coincidence, 4.0 * function.noise))) return {};
  return ContactFinder(function).find();
}

std::vector<double> touching_places(const BernsteinCoefficients& polynomial, double noise) {
  if (polynomial.size() < 3 || !has_zero(polynomial, noise)) return {};
  const Eigen::Index degree = polynomial.size() - 1;
  const BernsteinCoefficients slope = static_cast<double>(degree) * (polynomial.tail(degree) - polynomial.head(degree));
  if (polynomial.cwiseAbs().maxCoeff() <= noise) return {};
  std::vector<double> places;
  for (const double root : sign_chart(slope, 1e-14 * slope.cwiseAbs().maxCoeff()).roots)
    if (std::abs(evaluate(polynomial, root)) <= noise) places.push_back(root);
  return places;
}

}  // namespace isorim::geometry
