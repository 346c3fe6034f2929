#include "geometry/intersection/chain_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/chebyshev_fit.h"

namespace isorim::geometry {
namespace {

constexpr double displacement_tolerance = 4e-15;
constexpr double shortest_piece = 1e-7;

/// The frame of a chord: s along it in [0, 1], h across it as a length.
struct Chord {
  Point2 start;
  Vector2 along;
  Vector2 normal;

  Chord(const Point2& from, const Point2& to) : start(from), along(to - from), normal(-along.y(), along.x()) {
    normal.normalize();
  }
  double position(const Point2& point) const { return (point - start).dot(along) / along.squaredNorm(); }
  double offset(const Point2& point) const { return (point - start).dot(normal); }
  Point2 at(double s, double h) const { return start + s * along + h * normal; }
};

using Polyline = std::vector<Point2>;

class Fitter {
 public:
  explicit Fitter(const ElementFunction& function)
      : function_(function), largest_noise_(2e-15 * function.magnitude.maxCoeff()) {}

  void append(const Polyline& points, std::vector<Points<2>>& curves) const {
    if (is_graph_over_chord(points)) {
      if (std::optional<Points<2>> curve = fit(points)) {
        curves.push_back(std::move(*curve));
        return;
      }
    }
    const auto [first, second] = halves(points);
    append(first, curves);
    append(second, curves);
  }

 private:
  /// No leg turns by more than 60 degrees from the chord.
  static bool is_graph_over_chord(const Polyline& points) {
    const Vector2 chord = points.back() - points.front();
    if (chord.norm() == 0.0) return false;
    const Vector2 direction = chord.normalized();
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Vector2 leg = points[i] - points[i - 1];
      if (leg.dot(direction) < 0.5 * leg.norm() - 1e-12) return false;
    }
    return true;
  }

  std::pair<Polyline, Polyline> halves(const Polyline& points) const {
    Polyline all = points;
    if (all.size() == 2) {
      const Vector2 leg = all[1] - all[0];
      if (leg.norm() < shortest_piece) {
        throw GeometryError(fmt::format(
            "the curve of intersection cannot be followed at ({:.9g}, {:.9g}) of an element", all[0].x(), all[0].y()));
      }
      const Chord chord(all[0], all[1]);
      const std::optional<double> h = offset_at(chord, 0.5, 0.0);
      all.insert(all.begin() + 1, chord.at(0.5, h.value_or(0.0)));
    }
    const auto middle = static_cast<std::ptrdiff_t>(all.size() / 2);
    return {Polyline(all.begin(), all.begin() + middle + 1), Polyline(all.begin() + middle, all.end())};
  }

  /// The offset of the zero set from the chord, from a guess; nothing if Newton's method wanders off.
  std::optional<double> offset_at(const Chord& chord, double s, double guess) const {
    const double reach = 0.25 * chord.along.norm();
    double h = guess;
    double step = 0.0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const GridSlope jet = evaluate_slope(function_.grid, chord.at(s, h));
      step = -jet.value / jet.gradient.dot(chord.normal);
      if (jet.value == 0.0) return h;
      if (!std::isfinite(step) || std::abs(h + step - guess) > reach) return std::nullopt;
      h += step;
      // Convergence is quadratic: what such a step leaves is far below rounding.
      if (std::abs(step) <= 1e-12 || (iteration > 8 && std::abs(jet.value) <= function_.noise_at(chord.at(s, h))))
        return h;
    }
    return std::abs(step) <= 1e-12 ? std::optional<double>(h) : std::nullopt;
  }

  static double interpolate(const std::vector<Point2>& skeleton, double s) {
    const auto above =
        std::find_if(skeleton.begin() + 1, skeleton.end() - 1, [s](const Point2& p) { return p.x() >= s; });
    const Point2& a = *std::prev(above);
    const Point2& b = *above;
    return b.x() > a.x() ? a.y() + (b.y() - a.y()) * (s - a.x()) / (b.x() - a.x()) : a.y();
  }

  std::optional<Points<2>> fit(const Polyline& points) const {
    const Chord chord(points.front(), points.back());
    // Columns (s, h) of the polyline.
    std::vector<Point2> skeleton;
    for (const Point2& point : points) skeleton.emplace_back(chord.position(point), chord.offset(point));
    for (const int degree : {1, 2, 4, 6, 8, 10, 12, 14, largest_fit_degree}) {
      Eigen::RowVectorXd values = Eigen::RowVectorXd::Zero(degree + 1);
      for (int k = 1; k < degree; ++k) {
        const double s = chebyshev_points(degree)[static_cast<std::size_t>(k)];
        const std::optional<double> h = offset_at(chord, s, interpolate(skeleton, s));
        if (!h) return std::nullopt;
        values(k) = *h;
      }
      const BernsteinCoefficients offsets = interpolate_bernstein(values).row(0).transpose();
      const Verdict verdict = check(chord, offsets);
      if (verdict == Verdict::met) return control_points(chord, offsets);
      if (verdict == Verdict::far && degree >= 8) return std::nullopt;
    }
    return std::nullopt;
  }

  enum class Verdict { met, near, far };

  /// The largest distance from the zero set between the interpolation points, seen across the chord.
  Verdict check(const Chord& chord, const BernsteinCoefficients& offsets) const {
    const int samples = 2 * static_cast<int>(offsets.size()) + 3;
    double worst = 0.0;
    for (int k = 1; k < samples; ++k) {
      const double s = static_cast<double>(k) / samples;
      const Point2 place = chord.at(s, evaluate(offsets, s));
      const GridSlope jet = evaluate_slope(function_.grid, place);
      const double slope = std::abs(jet.gradient.dot(chord.normal));
      if (slope > 0.0 && std::abs(jet.value) <= displacement_tolerance * slope) continue;
      // Far from zero a bound of the noise will do.
      const double noise = std::abs(jet.value) > largest_noise_ ? largest_noise_ : 2.0 * function_.noise_at(place);
      if (!(slope > 0.0)) return std::abs(jet.value) <= noise ? Verdict::met : Verdict::far;
      const double allowed = std::max(displacement_tolerance, noise / slope);
      worst = std::max(worst, std::abs(jet.value) / slope / allowed);
    }
    // Ten orders of magnitude above the tolerance the next few degrees will not help.
    return worst <= 1.0 ? Verdict::met : worst < 1e10 ? Verdict::near : Verdict::far;
  }

  static Points<2> control_points(const Chord& chord, const BernsteinCoefficients& offsets) {
    const Eigen::Index degree = offsets.size() - 1;
    Points<2> points(2, degree + 1);
    for (Eigen::Index i = 0; i <= degree; ++i)
      points.col(i) = chord.at(static_cast<double>(i) / static_cast<double>(degree), offsets(i));
    return points;
  }

  const ElementFunction& function_;
  double largest_noise_;
};

}  // namespace

std::vector<Points<2>> fit_chain(const ElementFunction& function, const ZeroChain& chain) {
  std::vector<Points<2>> curves;
  Fitter(function).append(chain.points, curves);
  return curves;
}

}  // namespace isorim::geometry
