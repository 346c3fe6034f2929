#include "quadrature/cut_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/bezier/bernstein_roots.h"
#include "geometry/bezier/subdivision.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/line_rule.h"

namespace isorim::quadrature {

namespace {

/// Coordinates of a homogeneous point in a net.
enum Coordinate : std::size_t { x_coordinate = 0, y_coordinate = 1, weight_coordinate = 2 };

double cartesian(std::span<const double> net, std::size_t point, std::size_t coordinate) {
  return net[3 * point + coordinate] / net[3 * point + weight_coordinate];
}

/// The smallest interval that holds a coordinate of all control points, hence the curve.
geometry::Interval range(std::span<const double> net, std::size_t coordinate) {
  geometry::Interval range{cartesian(net, 0, coordinate), cartesian(net, 0, coordinate)};
  for (std::size_t i = 1; i < net.size() / 3; ++i) {
    range.first = std::min(range.first, cartesian(net, i, coordinate));
    range.last = std::max(range.last, cartesian(net, i, coordinate));
  }
  return range;
}

double clipped(double value) {
  return std::clamp(value, 0.0, 1.0);
}

double bernstein_sum(std::span<const double> coefficients, double s) {
  static thread_local std::vector<double> row;
  row.assign(coefficients.begin(), coefficients.end());
  for (std::size_t count = row.size() - 1; count > 0; --count) {
    for (std::size_t i = 0; i < count; ++i) row[i] += s * (row[i + 1] - row[i]);
  }
  return row.front();
}

/// The homogeneous coordinates mapped from one half of the cell to the whole of it.
std::vector<double> in_half(std::span<const double> net, std::size_t coordinate, int half) {
  std::vector<double> mapped(net.begin(), net.end());
  for (std::size_t i = 0; i < net.size() / 3; ++i) {
    double& value = mapped[3 * i + coordinate];
    value = 2.0 * value - half * mapped[3 * i + weight_coordinate];
  }
  return mapped;
}

/// The curve cut wherever a coordinate crosses a value.
std::vector<std::vector<double>> split_where(std::span<const double> net, std::size_t coordinate, double value) {
  std::vector<double> distance(net.size() / 3);
  for (std::size_t i = 0; i < distance.size(); ++i)
    distance[i] = net[3 * i + coordinate] - value * net[3 * i + weight_coordinate];
  const std::array<int, 1> degree{static_cast<int>(distance.size()) - 1};
  std::vector<std::vector<double>> pieces;
  std::vector<double> rest(net.begin(), net.end());
  double start = 0.0;
  for (const geometry::Interval& at : geometry::bernstein_roots(distance, 0.0)) {
    const double root = at.middle();
    if (root <= start || root >= 1.0) continue;
    auto [first, second] = geometry::subdivide(rest, 3, degree, 0, (root - start) / (1.0 - start));
    pieces.push_back(std::move(first));
    rest = std::move(second);
    start = root;
  }
  pieces.push_back(std::move(rest));
  return pieces;
}

/// The coordinate in the middle of the curve.
double middle_of(std::span<const double> net, std::size_t coordinate) {
  std::vector<double> values(net.size() / 3);
  std::vector<double> weights(net.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = net[3 * i + coordinate];
    weights[i] = net[3 * i + weight_coordinate];
  }
  return bernstein_sum(values, 0.5) / bernstein_sum(weights, 0.5);
}

}  // namespace

CutRegion::CutRegion(const geometry::TrimmedRegion& region) {
  for (const geometry::HomogeneousPoints<2>& curve : region.curves) {
    const bool polynomial = (curve.row(2).array() == curve(2, 0)).all();
    if (polynomial && curve(2, 0) != 1.0) {
      geometry::HomogeneousPoints<2> divided = curve / curve(2, 0);
      divided.row(2).setOnes();
      add({divided.data(), static_cast<std::size_t>(divided.size())}, true);
    } else {
      add({curve.data(), static_cast<std::size_t>(curve.size())}, polynomial);
    }
  }
  set_extent();
}

void CutRegion::add(std::span<const double> net, bool polynomial) {
  const geometry::Interval x = range(net, x_coordinate);
  const geometry::Interval y = range(net, y_coordinate);
  if (x.last <= 0.0 || y.last <= 0.0 || y.first >= 1.0) return;
  if (x.first >= 1.0) return add_strip(strip_of(net));
  // Along a line of constant y there is nothing to integrate, but the region is not whole.
  curves_.push_back({nets_.size(), static_cast<int>(net.size() / 3) - 1, polynomial, y.first == y.last});
  nets_.insert(nets_.end(), net.begin(), net.end());
}

CutRegion::Strip CutRegion::strip_of(std::span<const double> net) {
  return {cartesian(net, 0, y_coordinate), cartesian(net, net.size() / 3 - 1, y_coordinate)};
}

void CutRegion::add_strip(Strip strip) {
  strip = {clipped(strip.first), clipped(strip.last)};
  if (strip.first == strip.last) return;
  if (!strips_.empty() && strips_.back().last == strip.first) {
    strips_.back().last = strip.last;
  } else {
    strips_.push_back(strip);
  }
}

void CutRegion::set_extent() {
  constexpr double rounding = 1e-12;
  if (!curves_.empty()) return;
  double covered = 0.0;
  for (const Strip& strip : strips_) covered += strip.last - strip.first;
  if (std::abs(covered) <= rounding) extent_ = Extent::nothing;
  if (std::abs(covered - 1.0) <= rounding) extent_ = Extent::everything;
}

const RegionMoments& CutRegion::moments(const Orders<2>& counts) const {
  if (counts[0] <= moments_.counts[0] && counts[1] <= moments_.counts[1]) return moments_;
  static thread_local LineRule rule;
  for (std::vector<double>* values : {&rule.x, &rule.y, &rule.dy}) values->clear();
  moments_ = {{std::max(counts[0], moments_.counts[0]), std::max(counts[1], moments_.counts[1])}, {}, 0.0};
  moments_.values.assign(static_cast<std::size_t>(moments_.counts[0] * moments_.counts[1]), 0.0);
  for (const Curve& curve : curves_) {
    if (!curve.level) append_curve({net(curve), curve.degree, curve.polynomial}, moments_.counts, rule);
  }
  add_moments(rule, moments_);
  for (const Strip& strip : strips_) add_moments_of_strip(strip.first, strip.last, moments_);
  return moments_;
}

std::vector<CutRegion::Crossing> CutRegion::crossings(double y) const {
  std::vector<Crossing> crossings;
  for (const Curve& curve : curves_) {
    const std::vector<std::vector<double>> pieces = split_where(net(curve), y_coordinate, y);
    // What lies on the line counts as above it, ends too: then curves that meet on the line agree.
    bool below = cartesian(pieces.front(), 0, y_coordinate) < y;
    const auto visit = [&](bool next_is_below, double x) {
      if (next_is_below != below) crossings.push_back({x, below ? 1 : -1});
      below = next_is_below;
    };
    for (const std::vector<double>& piece : pieces)
      visit(middle_of(piece, y_coordinate) < y, cartesian(piece, 0, x_coordinate));
    const std::size_t last = pieces.back().size() / 3 - 1;
    visit(cartesian(pieces.back(), last, y_coordinate) < y, cartesian(pieces.back(), last, x_coordinate));
  }
  for (const Strip& strip : strips_) {
    if ((strip.first < y) != (strip.last < y)) crossings.push_back({1.0, strip.first < y ? 1 : -1});
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.x > b.x; });
  return crossings;
}

std::vector<geometry::Point2> CutRegion::inner_points(int rows) const {
  constexpr std::array<double, 3> fractions{0.02, 0.5, 0.98};
  std::vector<geometry::Point2> points;
  for (const double y : gauss_legendre(rows).nodes) {
    const std::vector<Crossing> ends = crossings(y);
    int winding = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      winding += ends[i].direction;
      const double left = i + 1 < ends.size() ? ends[i + 1].x : 0.0;
      if (winding <= 0 || left >= ends[i].x) continue;
      for (const double fraction : fractions) points.emplace_back(left + fraction * (ends[i].x - left), y);
    }
  }
  return points;
}

std::pair<CutRegion, CutRegion> CutRegion::halves(int direction) const {
  const auto coordinate = static_cast<std::size_t>(direction);
  std::pair<CutRegion, CutRegion> halves{CutRegion(), CutRegion()};
  auto& [first, second] = halves;
  for (const Curve& curve : curves_) {
    for (const std::vector<double>& piece : split_where(net(curve), coordinate, 0.5)) {
      if (middle_of(piece, coordinate) < 0.5) {
        first.add(in_half(piece, coordinate, 0), curve.polynomial);
      } else {
        second.add(in_half(piece, coordinate, 1), curve.polynomial);
        if (coordinate == x_coordinate) first.add_strip(strip_of(piece));
      }
    }
  }
  for (const Strip& strip : strips_) {
    first.add_strip(coordinate == x_coordinate ? strip : Strip{2.0 * strip.first, 2.0 * strip.last});
    second.add_strip(coordinate == x_coordinate ? strip : Strip{2.0 * strip.first - 1.0, 2.0 * strip.last - 1.0});
  }
  first.set_extent();
  second.set_extent();
  return halves;
}

}  // namespace isorim::quadrature
