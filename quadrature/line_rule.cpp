#include "quadrature/line_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/bezier/subdivision.h"
#include "geometry/spline/knot_vector.h"
#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"

namespace isorim::quadrature {

namespace {

/// One of Bernstein's ellipses with foci at -1 and 1, rho the sum of its semi-axes, on which |z| is at most
/// R = (rho + 1 / rho) / 2.
struct Ellipse {
  double largest;
  double log_largest;
  /// The logarithms of 64 / (15 (1 - rho^-2)) and of rho^2.
  double log_factor;
  double log_gain;
  /// Where growth exceeds this, a smaller ellipse needs fewer points.
  double growth_limit;
};

constexpr double log_of_accuracy = 34.54;  // 1e-15

/// From small to large: short curves need the large ones.
const std::array<Ellipse, 11>& ellipses() {
  static const std::array<Ellipse, 11> all = [] {
    constexpr std::array<double, 11> sums{1.25, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 40.0, 80.0, 160.0};
    std::array<Ellipse, 11> made{};
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double rho = sums[i];
      const double largest = 0.5 * (rho + 1.0 / rho);
      // (A + G rho / 2) / (2 log rho) is least where G rho (log rho - 1) / 2 = A.
      const double limit = rho > 3.0 ? 2.0 * log_of_accuracy / (rho * (std::log(rho) - 1.0)) : 1e300;
      made[i] = {largest, std::log(largest), std::log(64.0 / 15.0 / (1.0 - 1.0 / (rho * rho))), 2.0 * std::log(rho),
                 limit};
    }
    return made;
  }();
  return all;
}

/// A curve about its middle as polynomials in z, s = (1 + z) / 2: the absolute values of the Taylor coefficients of
/// position relative to the middle times weight, and of the weight.
class CurveVariation {
 public:
  explicit CurveVariation(const CurveNet& curve) : degree_(curve.degree), polynomial_(curve.polynomial) {
    std::array<double, max_points> weight;
    if (polynomial_) {
      std::fill_n(weight.begin(), degree_ + 1, 0.0);
      weight[0] = 1.0;
    } else {
      expand(curve.points, 2, weight);
    }
    middle_weight_ = weight[0];
    for (std::size_t c = 0; c < 2; ++c) {
      std::array<double, max_points> position;
      position[0] = 0.0;
      expand(curve.points, c, position);
      const double centre = position[0] / middle_weight_;
      for (int k = 1; k <= degree_; ++k) terms_[c][at(k)] = std::abs(position[at(k)] - centre * weight[at(k)]);
      set_growth(c, centre);
    }
    for (int k = 1; k <= degree_; ++k) terms_[2][at(k)] = std::abs(weight[at(k)]);
  }

  /// log |P_n| along a short curve is about n times this for each unit of |z|.
  double first_growth(std::size_t coordinate) const {
    double radius = 0.0;
    for (int k = 1; k <= degree_; ++k) radius += terms_[coordinate][at(k)];
    return 2.0 * radius / middle_weight_ * inside_[coordinate];
  }

  /// The number of points that the bound for this ellipse asks for; infinite where the curve may have a pole in it.
  double points(const Ellipse& ellipse, const Orders<2>& counts) const {
    double least_weight = middle_weight_;
    if (!polynomial_) least_weight -= sum(2, ellipse.largest);
    if (least_weight <= 0.0) return std::numeric_limits<double>::infinity();
    // |y'| exceeds the extent in y by no more than R^(p - 1), and for rational curves what their weights add.
    double exponent = log_of_accuracy + ellipse.log_factor + (degree_ - 1) * ellipse.log_largest;
    if (!polynomial_) {
      exponent += std::log(2.0 + degree_ * std::pow(ellipse.largest, degree_ - 1)) +
                  2.0 * std::log(middle_weight_ / least_weight);
    }
    for (std::size_t c = 0; c < 2; ++c) exponent += counts[c] * growth(c, sum(c, ellipse.largest) / least_weight);
    return std::ceil(exponent / ellipse.log_gain);
  }

 private:
  static constexpr std::size_t max_points = geometry::KnotVector::max_degree + 1;
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  /// Taylor coefficients of one homogeneous coordinate: the k-th is binomial(p, k) 2^-k times the k-th difference in
  /// the middle, which p - k steps of de Casteljau's triangle give.
  void expand(std::span<const double> net, std::size_t coordinate, std::array<double, max_points>& result) const {
    std::array<double, max_points> row;
    std::array<double, max_points> average;
    for (int i = 0; i <= degree_; ++i) row[at(i)] = net[3 * at(i) + coordinate];
    double factor = 1.0;
    for (int k = 0; k <= degree_; ++k) {
      const int count = degree_ - k;
      std::copy_n(row.begin(), count + 1, average.begin());
      for (int left = count; left > 0; --left) {
        for (int i = 0; i < left; ++i) average[at(i)] = 0.5 * (average[at(i)] + average[at(i + 1)]);
      }
      result[at(k)] = factor * average[0];
      factor *= 0.5 * count / (k + 1);
      for (int i = 0; i < count; ++i) row[at(i)] = row[at(i + 1)] - row[at(i)];
    }
  }

  double sum(std::size_t coordinate, double z) const {
    double value = 0.0;
    for (int k = degree_; k > 0; --k) value = (value + terms_[coordinate][at(k)]) * z;
    return value;
  }

  void set_growth(std::size_t coordinate, double centre) {
    const double inside = 4.0 * centre * (1.0 - centre);
    inside_[coordinate] = inside > 1e-12 ? 1.0 / std::sqrt(inside) : 1e6;
    outside_[coordinate] = std::max(0.0, std::abs(2.0 * centre - 1.0) - 1.0);
  }

  /// log |P_n(2 x - 1)| is below n times this wherever |x - centre| <= radius in the complex plane. P_n is at most
  /// sigma^n on the ellipse with foci 0 and 1 and sigma twice the sum of its semi-axes, and with r = 2 radius,
  /// c = 2 centre - 1 a point of the disc has cosh(log sigma) <= 1 + r if |c| <= 1, and <= sqrt(1 + r^2 / (1 - c^2))
  /// (by the inequality of Cauchy and Schwarz).
  double growth(std::size_t coordinate, double radius) const {
    const double r = 2.0 * radius;
    const double from_ends = std::sqrt(2.0 * (r + outside_[coordinate]));
    return outside_[coordinate] > 0.0 ? from_ends : std::min(from_ends, r * inside_[coordinate]);
  }

  int degree_;
  bool polynomial_;
  double middle_weight_;
  std::array<std::array<double, max_points>, 3> terms_;
  std::array<double, 2> inside_;
  std::array<double, 2> outside_;
};

/// Below this an exact rule is as good as a bound.
constexpr int few_points = 5;

}  // namespace

// The n-point rule errs by at most 64 M rho^(-2 n) / (15 (1 - rho^-2)), M the largest modulus of the integrand on an
// ellipse in which it is analytic (Trefethen 2008, theorem 4.5); here Taylor coefficients bound M.
int points_along_curve(const CurveNet& curve, const Orders<2>& counts) {
  const int exact = curve.polynomial ? (curve.degree * (counts[0] + counts[1]) + 1) / 2 : max_gauss_points + 1;
  if (exact <= few_points) return exact;
  const CurveVariation variation(curve);
  const double growth = counts[0] * variation.first_growth(0) + counts[1] * variation.first_growth(1);
  const auto& all = ellipses();
  std::size_t i = all.size() - 1;
  while (i > 0 && growth > all[i].growth_limit) --i;
  double points = variation.points(all[i], counts);
  for (; i > 0; --i) {
    const double smaller = variation.points(all[i - 1], counts);
    if (smaller >= points && std::isfinite(points)) break;
    points = smaller;
  }
  points = std::min(points, static_cast<double>(exact));
  return points <= max_gauss_points ? static_cast<int>(points) : 0;
}

void append_curve(const CurveNet& curve, const Orders<2>& counts, LineRule& rule) {
  const int order = points_along_curve(curve, counts);
  if (order == 0) {
    const auto [first, second] = geometry::subdivide(curve.points, 3, std::array<int, 1>{curve.degree}, 0);
    append_curve({first, curve.degree, curve.polynomial}, counts, rule);
    return append_curve({second, curve.degree, curve.polynomial}, counts, rule);
  }
  const BernsteinTable& basis = bernstein_table(curve.degree, order);
  const Rule& gauss = gauss_legendre(order);
  std::size_t target = rule.x.size();
  for (std::vector<double>* values : {&rule.x, &rule.y, &rule.dy})
    values->resize(target + static_cast<std::size_t>(order));
  for (int node = 0; node < order; ++node, ++target) {
    std::array<double, 3> value{};
    std::array<double, 3> derivative{};
    for (int i = 0; i <= curve.degree; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double point = curve.points[3 * static_cast<std::size_t>(i) + c];
        value[c] += basis.values_at(node)[i] * point;
        derivative[c] += basis.derivatives_at(node)[i] * point;
      }
    }
    const double y = value[1] / value[2];
    rule.x[target] = value[0] / value[2];
    rule.y[target] = y;
    rule.dy[target] = (derivative[1] - y * derivative[2]) / value[2] * gauss.weights[static_cast<std::size_t>(node)];
  }
}

}  // namespace isorim::quadrature
