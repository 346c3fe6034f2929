#include "geometry/propeller/blade_foot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/chebyshev_fit.h"
#include "geometry/propeller/bracketed_root.h"

namespace isorim::geometry {
namespace {

constexpr int samples = 128;
/// To which pieces are fitted, relative to the parameters' range: 5 units of rounding of a blade that is ten times as
/// long as the hub is thick.
constexpr double fit_accuracy = 2e-14;
/// Pieces shorter than this, of the face's u, are rounding.
constexpr double shortest_piece = 1e-11;

double part(Interval range, int i, int count) {
  return std::lerp(range.first, range.last, static_cast<double>(i) / count);
}

bool changes_sign(double a, double b) {
  return (a < 0.0) != (b < 0.0);
}

/// Where sign * f is least, by golden section.
template <class Function>
double turning_place(const Function& f, double sign, Interval bracket) {
  constexpr double golden = 0.3819660112501051;
  for (int turn = 0; turn < 60; ++turn) {
    const double left = bracket.first + golden * bracket.length();
    const double right = bracket.last - golden * bracket.length();
    const bool is_left = sign * f(left) < sign * f(right);
    (is_left ? bracket.last : bracket.first) = is_left ? right : left;
  }
  return bracket.middle();
}

/// Appends the roots of f given its values at rising places; also pairs of them between places, where f turns round
/// near zero.
template <class Function>
void append_roots(const Function& f, const std::vector<double>& places, const std::vector<double>& values,
                  std::vector<double>& roots) {
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    if (changes_sign(values[k], values[k + 1])) {
      roots.push_back(bracketed_root(f, {places[k], places[k + 1]}));
      continue;
    }
    if (k == 0 || changes_sign(values[k - 1], values[k])) continue;
    if (std::abs(values[k]) > std::abs(values[k - 1]) || std::abs(values[k]) > std::abs(values[k + 1])) continue;
    const double turning = turning_place(f, values[k] < 0.0 ? -1.0 : 1.0, {places[k - 1], places[k + 1]});
    if (!changes_sign(f(turning), values[k])) continue;
    roots.push_back(bracketed_root(f, {places[k - 1], turning}));
    roots.push_back(bracketed_root(f, {turning, places[k + 1]}));
  }
}

}  // namespace

BladeFoot::BladeFoot(const NurbsSurface<3>& face, const Generatrix& hub)
    : face_(face), hub_(hub), v_(face.knots_v().domain()), extent_{} {
  const Interval u = face.knots_u().domain();
  std::vector<double> x;
  for (int i = 0; i <= samples; ++i) {
    const double place = part(u, i, samples);
    check_outward(place);
    x.push_back(point_at(place).x());
  }
  const auto turning = [&](auto sampled, double sign) {
    const auto i = static_cast<int>(sampled - x.begin());
    const Interval bracket{part(u, std::max(0, i - 1), samples), part(u, std::min(samples, i + 1), samples)};
    return point_at(turning_place([&](double at) { return point_at(at).x(); }, sign, bracket)).x();
  };
  extent_.first = turning(std::ranges::min_element(x), 1.0);
  extent_.last = turning(std::ranges::max_element(x), -1.0);
}

void BladeFoot::check_outward(double u) const {
  if (height(u, v_.first) > 0.0 || height(u, v_.last) <= 0.0)
    throw GeometryError(fmt::format("propeller: the blade does not stand on the hub at u = {:.6g}", u));
  const double foot = v_at(u);
  for (int j = 1; j <= samples; ++j) {
    const double v = part({foot, v_.last}, j, samples);
    if (height(u, v) > 0.0) continue;
    const Point3 at = evaluate(face_, Point2(u, v));
    throw GeometryError(
        fmt::format("propeller: the blade meets the hub in more than its foot, at ({:.6g}, {:.6g}, {:.6g})", at.x(),
                    at.y(), at.z()));
  }
}

double BladeFoot::height(double u, double v) const {
  const Point3 point = evaluate(face_, Point2(u, v));
  return std::hypot(point.y(), point.z()) - hub_.radius(point.x());
}

double BladeFoot::v_at(double u) const {
  return bracketed_root([&](double v) { return height(u, v); }, v_);
}

void BladeFoot::append_cuts(Interval span, std::vector<double>& found) const {
  constexpr int steps = 32;
  std::vector<double> places;
  std::vector<double> foot;
  std::vector<double> x;
  for (int i = 0; i <= steps; ++i) {
    places.push_back(part(span, i, steps));
    foot.push_back(v_at(places.back()));
    x.push_back(evaluate(face_, Point2(places.back(), foot.back())).x());
  }
  const auto append = [&](const std::vector<double>& values, double level, const auto& f) {
    std::vector<double> beyond = values;
    for (double& value : beyond) value -= level;
    append_roots([&](double u) { return f(u) - level; }, places, beyond, found);
  };
  const std::vector<double> rows = face_.knots_v().breakpoints();
  for (std::size_t j = 1; j + 1 < rows.size(); ++j) append(foot, rows[j], [&](double u) { return v_at(u); });
  for (std::size_t j = 1; j < hub_.pieces().size(); ++j)
    append(x, hub_.pieces()[j].x.first, [&](double u) { return point_at(u).x(); });
}

std::vector<double> BladeFoot::cuts() const {
  const std::vector<double> spans = face_.knots_u().breakpoints();
  std::vector<double> found = spans;
  for (std::size_t i = 0; i + 1 < spans.size(); ++i) append_cuts({spans[i], spans[i + 1]}, found);
  std::ranges::sort(found);
  std::vector<double> result{found.front()};
  for (const double u : found)
    if (u - result.back() > shortest_piece) result.push_back(u);
  result.back() = found.back();
  return result;
}

std::vector<BladeFoot::Piece> BladeFoot::pieces() const {
  const Interval hub = hub_.extent();
  if (!(hub.first < extent_.first && extent_.last < hub.last))
    throw GeometryError(fmt::format(
        "propeller hub: its profile runs along the shaft from X = {:.6g} to {:.6g}; the blades on it need {:.6g} to "
        "{:.6g}",
        hub.first, hub.last, extent_.first, extent_.last));
  const std::vector<double> ends = cuts();
  std::vector<Piece> result;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const int hub_piece = hub_.piece_at(point_at(0.5 * (ends[i] + ends[i + 1])).x());
    const auto line = [&](double s) {
      const double u = std::lerp(ends[i], ends[i + 1], s);
      return Point2(u, v_at(u));
    };
    for (NurbsCurve<2>& curve : fit_curve(line, fit_accuracy)) result.push_back({std::move(curve), hub_piece});
  }
  return result;
}

}  // namespace isorim::geometry
