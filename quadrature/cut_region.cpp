#include "quadrature/cut_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/bezier/subdivision.h"
#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"

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

/// The root of a polynomial of which the ends have different signs, by bisection and the secant in turns.
double bracketed_root(std::span<const double> coefficients) {
  double low = 0.0;
  double high = 1.0;
  double at_low = coefficients.front();
  double at_high = coefficients.back();
  for (int step = 0; step < 120 && high - low > 1e-16; ++step) {
    const double middle = step % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * at_low / (at_low - at_high);
    const double value = bernstein_sum(coefficients, middle);
    if (value == 0.0 || middle <= low || middle >= high) return middle;
    if ((value < 0.0) == (at_low < 0.0)) {
      low = middle;
      at_low = value;
    } else {
      high = middle;
      at_high = value;
    }
  }
  return 0.5 * (low + high);
}

/// Appends where a polynomial in Bernstein form changes its sign, in increasing order, as parameters of `piece`: by
/// Descartes' rule, bisecting until one change of sign is left or the piece has no length.
void append_sign_changes(std::span<const double> coefficients, geometry::Interval piece, std::vector<double>& roots) {
  constexpr double shortest = 1e-13;
  int changes = 0;
  double previous = 0.0;
  for (const double c : coefficients) {
    if (c == 0.0) continue;
    if (previous != 0.0 && (c < 0.0) != (previous < 0.0)) ++changes;
    previous = c;
  }
  if (changes == 0) return;
  if (changes == 1 && coefficients.front() != 0.0 && coefficients.back() != 0.0) {
    roots.push_back(piece.first + bracketed_root(coefficients) * piece.length());
    return;
  }
  if (piece.length() < shortest) {
    roots.push_back(piece.middle());
    return;
  }
  const std::array<int, 1> degree{static_cast<int>(coefficients.size()) - 1};
  const auto [first, second] = geometry::subdivide(coefficients, 1, degree, 0);
  append_sign_changes(first, {piece.first, piece.middle()}, roots);
  if (second.front() == 0.0) roots.push_back(piece.middle());
  append_sign_changes(second, {piece.middle(), piece.last}, roots);
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
  std::vector<double> roots;
  append_sign_changes(distance, {0.0, 1.0}, roots);
  const std::array<int, 1> degree{static_cast<int>(distance.size()) - 1};
  std::vector<std::vector<double>> pieces;
  std::vector<double> rest(net.begin(), net.end());
  double start = 0.0;
  for (const double root : roots) {
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

/// A homogeneous coordinate as a polynomial in z, s = (1 + z) / 2: its Taylor coefficients at the curve's middle.
class TaylorForm {
 public:
  TaylorForm(std::span<const double> net, int degree) : degree_(degree) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<double, max_points> row;
      for (int i = 0; i <= degree; ++i) row[index(i)] = net[3 * index(i) + c];
      set(c, row);
    }
  }

  double at_middle(std::size_t coordinate) const { return coefficients_[coordinate][0]; }

  /// Coefficient k of X - centre W: the curve's position relative to its middle, times the weight function.
  double relative(std::size_t coordinate, double centre, int k) const {
    return coefficients_[coordinate][index(k)] - centre * coefficients_[weight_coordinate][index(k)];
  }
  double weight(int k) const { return coefficients_[weight_coordinate][index(k)]; }
  int degree() const { return degree_; }

 private:
  static constexpr std::size_t max_points = geometry::KnotVector::max_degree + 1;
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  /// The k-th coefficient is binomial(p, k) 2^-k times the k-th difference in the middle: p - k steps of de
  /// Casteljau's triangle there.
  void set(std::size_t coordinate, std::array<double, max_points>& row) {
    double factor = 1.0;
    for (int k = 0; k <= degree_; ++k) {
      std::array<double, max_points> average = row;
      for (int count = degree_ - k; count > 0; --count) {
        for (int i = 0; i < count; ++i) average[index(i)] = 0.5 * (average[index(i)] + average[index(i + 1)]);
      }
      coefficients_[coordinate][index(k)] = factor * average[0];
      factor *= 0.5 * (degree_ - k) / (k + 1);
      for (int i = 0; i < degree_ - k; ++i) row[index(i)] = row[index(i + 1)] - row[index(i)];
    }
  }

  int degree_;
  std::array<std::array<double, max_points>, 3> coefficients_{};
};

/// log |P_n(2 x - 1)| is below n times this wherever |x - centre| <= radius in the complex plane. P_n is at most
/// sigma^n on the ellipse with foci 0 and 1 and the sum sigma of semi-axes, and with r = 2 radius, c = 2 centre - 1 a
/// point of the disc has cosh(log sigma) <= min(1 + r, sqrt(1 + r^2 / (1 - c^2))) (the second by Cauchy and Schwarz).
double legendre_growth(double centre, double radius) {
  const double outside = std::max(0.0, std::abs(2.0 * centre - 1.0) - 1.0);
  const double r = 2.0 * radius;
  const double from_ends = std::sqrt(2.0 * (r + outside));
  const double inside = 4.0 * centre * (1.0 - centre);
  return inside > 0.0 ? std::min(from_ends, r / std::sqrt(inside)) : from_ends;
}

/// One of Bernstein's ellipses: R, log R, and the terms of the bound of a rule's error.
struct Ellipse {
  double largest;
  double log_largest;
  double log_factor;
  double log_gain;
};

/// From large to small: short curves need the large ones.
const std::array<Ellipse, 11>& ellipses() {
  static const std::array<Ellipse, 11> all = [] {
    constexpr std::array<double, 11> sums{160.0, 80.0, 40.0, 20.0, 12.0, 8.0, 5.0, 3.0, 2.0, 1.5, 1.25};
    std::array<Ellipse, 11> made{};
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double rho = sums[i];
      const double largest = 0.5 * (rho + 1.0 / rho);
      made[i] = {largest, std::log(largest), std::log(64.0 / 15.0 / (1.0 - 1.0 / (rho * rho))), 2.0 * std::log(rho)};
    }
    return made;
  }();
  return all;
}

struct CurveBound {
  /// log |P_n| < n growth along the curve, in x and in y.
  std::array<double, 2> growth;
  /// Of the weight in the middle to the least modulus.
  double weight_ratio;
};

/// Of the curve for |z| <= largest; none where its denominator may vanish.
std::optional<CurveBound> bound_curve(const TaylorForm& form, double largest) {
  const double middle_weight = form.weight(0);
  const std::array<double, 2> centre{form.at_middle(0) / middle_weight, form.at_middle(1) / middle_weight};
  std::array<double, 2> radius{};
  double weight_variation = 0.0;
  double power = 1.0;
  for (int k = 1; k <= form.degree(); ++k) {
    power *= largest;
    weight_variation += power * std::abs(form.weight(k));
    for (std::size_t c = 0; c < 2; ++c) radius[c] += power * std::abs(form.relative(c, centre[c], k));
  }
  const double least_weight = middle_weight - weight_variation;
  if (least_weight <= 0.0) return std::nullopt;
  return CurveBound{
      {legendre_growth(centre[0], radius[0] / least_weight), legendre_growth(centre[1], radius[1] / least_weight)},
      middle_weight / least_weight};
}

/// Below this an exact rule is as good as a bound.
constexpr int few_points = 6;

}  // namespace

// The n-point rule on [-1, 1] errs by at most 64 M rho^(-2 n) / (15 (1 - rho^-2)), M the largest modulus of the
// integrand on the ellipse with foci at the ends and the sum rho of its semi-axes (Trefethen 2008, theorem 4.5). There
// |z| is at most R = (rho + 1 / rho) / 2, which bounds the curve by its Taylor coefficients.
int points_along_curve(std::span<const double> net, int degree, bool polynomial, const Orders<2>& counts) {
  constexpr double log_of_accuracy = 34.54;  // 1e-15
  const int exact = polynomial ? (degree * (counts[0] + counts[1]) + 1) / 2 : max_gauss_points + 1;
  if (exact <= few_points) return exact;
  const TaylorForm form(net, degree);
  int points = exact;
  for (const Ellipse& ellipse : ellipses()) {
    const std::optional<CurveBound> bound = bound_curve(form, ellipse.largest);
    if (!bound) continue;
    // |y'| exceeds the extent in y by no more than R^(p - 1), and for rational curves what their weights add.
    double speed = (degree - 1) * ellipse.log_largest;
    if (!polynomial)
      speed += std::log(2.0 + degree * std::pow(ellipse.largest, degree - 1)) + 2.0 * std::log(bound->weight_ratio);
    const double exponent =
        log_of_accuracy + ellipse.log_factor + speed + counts[0] * bound->growth[0] + counts[1] * bound->growth[1];
    const double needed = std::ceil(exponent / ellipse.log_gain);
    if (needed > 2.0 * points) break;
    points = std::min(points, static_cast<int>(needed));
  }
  return points <= max_gauss_points ? points : 0;
}

namespace {

/// Appends the points of a curve with the weights of int f(x, y) dy, the curve bisected where it needs very many.
void append_curve(std::span<const double> net, int degree, bool polynomial, const Orders<2>& counts, LineRule& rule) {
  const geometry::Interval y = range(net, y_coordinate);
  if (y.first == y.last) return;
  const int order = points_along_curve(net, degree, polynomial, counts);
  if (order == 0) {
    const auto [first, second] = geometry::subdivide(net, 3, std::array<int, 1>{degree}, 0);
    append_curve(first, degree, polynomial, counts, rule);
    return append_curve(second, degree, polynomial, counts, rule);
  }
  const BernsteinTable& basis = bernstein_table(degree, order);
  const Rule& gauss = gauss_legendre(order);
  for (int node = 0; node < order; ++node) {
    std::array<double, 3> value{};
    std::array<double, 3> derivative{};
    for (int i = 0; i <= degree; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        value[c] += basis.values_at(node)[i] * net[3 * static_cast<std::size_t>(i) + c];
        derivative[c] += basis.derivatives_at(node)[i] * net[3 * static_cast<std::size_t>(i) + c];
      }
    }
    const double at_y = value[1] / value[2];
    const double speed = (derivative[1] - at_y * derivative[2]) / value[2];
    rule.add(value[0] / value[2], at_y, speed * gauss.weights[static_cast<std::size_t>(node)]);
  }
}

}  // namespace

CutRegion::CutRegion(const geometry::TrimmedRegion& region) {
  for (const geometry::HomogeneousPoints<2>& curve : region.curves) {
    const std::span<const double> points(curve.data(), static_cast<std::size_t>(curve.size()));
    add(points, (curve.row(2).array() == curve(2, 0)).all());
  }
  set_extent();
}

void CutRegion::add(std::span<const double> net, bool polynomial) {
  const geometry::Interval x = range(net, x_coordinate);
  const geometry::Interval y = range(net, y_coordinate);
  if (x.last <= 0.0 || y.last <= 0.0 || y.first >= 1.0) return;
  if (x.first >= 1.0) return add_strip(strip_of(net));
  curves_.push_back({nets_.size(), static_cast<int>(net.size() / 3) - 1, polynomial});
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
  rule = {};
  moments_ = {{std::max(counts[0], moments_.counts[0]), std::max(counts[1], moments_.counts[1])}, {}, 0.0};
  moments_.values.assign(static_cast<std::size_t>(moments_.counts[0] * moments_.counts[1]), 0.0);
  for (const Curve& curve : curves_) append_curve(net(curve), curve.degree, curve.polynomial, moments_.counts, rule);
  add_moments(rule, moments_);
  for (const Strip& strip : strips_) add_moments_of_strip(strip.first, strip.last, moments_);
  return moments_;
}

std::vector<CutRegion::Crossing> CutRegion::crossings(double y) const {
  std::vector<Crossing> crossings;
  for (const Curve& curve : curves_) {
    const std::vector<std::vector<double>> pieces = split_where(net(curve), y_coordinate, y);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      const bool up = middle_of(pieces[i], y_coordinate) < middle_of(pieces[i + 1], y_coordinate);
      crossings.push_back({cartesian(pieces[i + 1], 0, x_coordinate), up ? 1 : -1});
    }
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
