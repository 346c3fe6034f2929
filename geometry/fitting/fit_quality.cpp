#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/curve_shape.h"
#include "geometry/fitting/foot_points.h"
#include "geometry/intersection/bernstein_polynomial.h"
#include "geometry/spline/kronrod_rule.h"

namespace isorim::geometry {

namespace {

/// Length and integral of the squared curvature over a part of a curve, and the error of the latter.
struct Bending {
  double length = 0.0;
  double squared_curvature = 0.0;
  double error = 0.0;
};

template <int Dim>
Bending bending(const SegmentedCurve<Dim>& curve, int segment, Interval part) {
  Bending sum;
  double gauss = 0.0;
  const double half = 0.5 * part.length();
  const auto add = [&](double x, const KronrodNode& rule) {
    const CurveJet<Dim> jet = curve.jet_on(segment, part.middle() + half * x);
    const double metric = jet.du.squaredNorm();
    if (!(metric > 0.0)) return;
    const double speed = std::sqrt(metric);
    const double along = jet.du.dot(jet.duu);
    const double bent = std::max(0.0, jet.duu.squaredNorm() - along * along / metric) / (metric * speed);
    sum.length += half * rule.kronrod_weight * speed;
    sum.squared_curvature += half * rule.kronrod_weight * bent;
    gauss += half * rule.gauss_weight * bent;
  };
  for (const KronrodNode& rule : kronrod_nodes) {
    add(rule.node, rule);
    if (rule.node > 0.0) add(-rule.node, rule);
  }
  sum.error = std::abs(sum.squared_curvature - gauss);
  return sum;
}

template <int Dim>
Bending adaptive_bending(const SegmentedCurve<Dim>& curve, int segment, Interval part, int depth) {
  constexpr double tolerance = 1e-6;
  const Bending whole = bending(curve, segment, part);
  if (depth == 0 || whole.error <= tolerance * whole.squared_curvature) return whole;
  const Bending left = adaptive_bending(curve, segment, {part.first, part.middle()}, depth - 1);
  const Bending right = adaptive_bending(curve, segment, {part.middle(), part.last}, depth - 1);
  return {left.length + right.length, left.squared_curvature + right.squared_curvature, left.error + right.error};
}

/// Coefficients on the stack.
using NumeratorCoefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 2 * KnotVector::max_degree, 1>;

/// C(n, k), k = 0 .. n.
std::vector<double> binomials(int n) {
  std::vector<double> row{1.0};
  for (int k = 1; k <= n; ++k) row.push_back(row.back() * (n - k + 1) / k);
  return row;
}

/// What the product of two polynomials in Bernstein form of degrees p - 1 and p - 2 needs; p >= 2.
struct ProductBinomials {
  explicit ProductBinomials(int p) : first(binomials(p - 1)), second(binomials(p - 2)), product(binomials(2 * p - 3)) {}

  std::vector<double> first;
  std::vector<double> second;
  std::vector<double> product;
};

/// C' x C'' on a segment, in Bernstein form of degree 2p - 3 and without a positive factor.
NumeratorCoefficients curvature_numerator(Eigen::Map<const Points<2>> points, const ProductBinomials& of) {
  const int p = static_cast<int>(points.cols()) - 1;
  NumeratorCoefficients numerator = NumeratorCoefficients::Zero(2 * p - 2);
  for (int i = 0; i < p; ++i) {
    const Vector2 a = of.first[static_cast<std::size_t>(i)] * (points.col(i + 1) - points.col(i));
    for (int j = 0; j + 1 < p; ++j) {
      const Vector2 b = points.col(j + 2) - 2.0 * points.col(j + 1) + points.col(j);
      numerator[i + j] += of.second[static_cast<std::size_t>(j)] * (a[0] * b[1] - a[1] * b[0]);
    }
  }
  for (int k = 0; k < numerator.size(); ++k) numerator[k] /= of.product[static_cast<std::size_t>(k)];
  return numerator;
}

/// Whether the coefficients are first above the noise on one side and then on the other: there is one root.
bool changes_once(const NumeratorCoefficients& numerator, double noise) {
  int changes = 0;
  for (Eigen::Index i = 0; i < numerator.size(); ++i) {
    if (!(std::abs(numerator[i]) > noise)) return false;
    if (i > 0 && (numerator[i] > 0.0) != (numerator[i - 1] > 0.0)) ++changes;
  }
  return changes == 1;
}

/// The root of a polynomial that changes its sign once on [0, 1]: Newton's method, bisection where it leaves the
/// bracket.
double only_root(const NumeratorCoefficients& numerator) {
  constexpr std::size_t capacity = 2 * KnotVector::max_degree;
  constexpr int most_steps = 60;
  const std::size_t n = static_cast<std::size_t>(numerator.size()) - 1;
  const double first = numerator[0];
  double low = 0.0;
  double high = 1.0;
  double t = first / (first - numerator[numerator.size() - 1]);
  for (int i = 0; i < most_steps; ++i) {
    std::array<double, capacity> net;
    std::copy_n(numerator.data(), n + 1, net.begin());
    for (std::size_t count = n; count > 1; --count)
      for (std::size_t k = 0; k < count; ++k) net[k] += t * (net[k + 1] - net[k]);
    const double value = net[0] + t * (net[1] - net[0]);
    if (value == 0.0) return t;
    ((value > 0.0) == (first > 0.0) ? low : high) = t;
    const double newton = t - value / (static_cast<double>(n) * (net[1] - net[0]));
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-15) return next;
    t = next;
  }
  return t;
}

/// Places where a function changes its sign, put together from pieces in their order.
class SignChanges {
 public:
  /// From u on the sign is this one; 0: not known.
  void append(double u, int sign) {
    if (sign == 0) return;
    if (last_ == -sign) places_.push_back(u);
    last_ = sign;
  }
  /// A polynomial over an interval, known to within `noise`. What its coefficients do not settle is halved, and left to
  /// a sign chart in the end.
  void append(const NumeratorCoefficients& numerator, Interval domain, double noise, int depth);

  const std::vector<double>& places() const { return places_; }

 private:
  std::vector<double> places_;
  int last_ = 0;
};

void SignChanges::append(const NumeratorCoefficients& numerator, Interval domain, double noise, int depth) {
  const int sign = numerator[0] > 0.0 ? 1 : -1;
  if (numerator.minCoeff() > noise || numerator.maxCoeff() < -noise) return append(domain.first, sign);
  if (changes_once(numerator, noise)) {
    append(domain.first, sign);
    return append(domain.first + only_root(numerator) * domain.length(), -sign);
  }
  if (depth > 0) {
    NumeratorCoefficients left = numerator;
    NumeratorCoefficients right = numerator;
    const Eigen::Index p = numerator.size() - 1;
    for (Eigen::Index count = p; count > 0; --count) {
      right.head(count) = 0.5 * (right.head(count) + right.segment(1, count));
      left[p - count + 1] = right[0];
    }
    if (std::abs(left[p]) > noise) {
      append(left, {domain.first, domain.middle()}, noise, depth - 1);
      return append(right, {domain.middle(), domain.last}, noise, depth - 1);
    }
  }
  const SignChart chart = sign_chart(numerator, noise);
  append(domain.first, chart.signs.front());
  for (std::size_t k = 0; k < chart.roots.size(); ++k)
    append(domain.first + chart.roots[k] * domain.length(), chart.signs[k + 1]);
}

/// Where the curvature changes its sign inside the domain.
std::vector<double> find_sign_changes(const SegmentedCurve<2>& curve) {
  constexpr double rounding = 1e-12;
  constexpr int deepest = 4;
  const int degree = static_cast<int>(curve.segment_points(0).cols()) - 1;
  if (degree < 2) return {};
  SignChanges changes;
  const ProductBinomials binomials_of_product(degree);
  for (int i = 0; i < curve.segment_count(); ++i) {
    const Eigen::Map<const Points<2>> points = curve.segment_points(i);
    const Eigen::Index p = points.cols() - 1;
    const double size = (points.rightCols(p) - points.leftCols(p)).cwiseAbs().maxCoeff();
    changes.append(curvature_numerator(points, binomials_of_product), curve.segment_domain(i), rounding * size * size,
                   deepest);
  }
  return changes.places();
}

/// The largest distance of the part [first, last] from its chord.
double lobe_height(const SegmentedCurve<2>& curve, double first, double last) {
  constexpr int samples = 16;
  const double period = curve.domain().length();
  const auto point = [&](double u) { return curve.jet(u < curve.domain().last ? u : u - period).point; };
  const Point2 start = point(first);
  const Vector2 chord = point(last) - start;
  const Vector2 normal = Vector2(-chord[1], chord[0]).normalized();
  double height = 0.0;
  for (int i = 1; i < samples; ++i)
    height = std::max(height, std::abs(normal.dot(point(first + (last - first) * i / samples) - start)));
  return height;
}

}  // namespace

template <int Dim>
double bending_energy(const SegmentedCurve<Dim>& curve) {
  constexpr int deepest = 12;
  Bending sum;
  for (int i = 0; i < curve.segment_count(); ++i) {
    const Bending part = adaptive_bending(curve, i, curve.segment_domain(i), deepest);
    sum.length += part.length;
    sum.squared_curvature += part.squared_curvature;
  }
  return sum.length * sum.squared_curvature;
}

int curvature_sign_changes(const SegmentedCurve<2>& curve, bool closed) {
  const int changes = static_cast<int>(find_sign_changes(curve).size());
  return closed ? changes + changes % 2 : changes;
}

std::vector<CurvatureLobe> curvature_lobes(const SegmentedCurve<2>& curve, bool closed) {
  std::vector<double> places = find_sign_changes(curve);
  if (closed && places.size() % 2 == 1) places.insert(places.begin(), curve.domain().first);
  if (closed && !places.empty()) places.push_back(places.front() + curve.domain().length());
  std::vector<CurvatureLobe> lobes;
  for (std::size_t i = 1; i < places.size(); ++i)
    lobes.push_back({places[i - 1], places[i], lobe_height(curve, places[i - 1], places[i])});
  return lobes;
}

template <int Dim>
FitQuality<Dim> shape_quality(const SegmentedCurve<Dim>& curve, bool closed) {
  FitQuality<Dim> quality;
  quality.bending_energy = bending_energy(curve);
  if constexpr (Dim == 2) quality.curvature_sign_changes = curvature_sign_changes(curve, closed);
  return quality;
}

template <int Dim>
void add_distances(std::span<const double> distances, FitQuality<Dim>& quality) {
  double sum = 0.0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    sum += distances[i] * distances[i];
    if (distances[i] <= quality.max_distance) continue;
    quality.max_distance = distances[i];
    quality.worst_point = static_cast<int>(i);
  }
  quality.rms_distance = distances.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(distances.size()));
}

template <int Dim>
FitQuality<Dim> fit_quality(const NurbsCurve<Dim>& curve, const Points<Dim>& points, bool closed) {
  if (!curve.is_polynomial()) throw GeometryError("fit quality: the curve is rational; expected a polynomial B-spline");
  const SegmentedCurve<Dim> segments(curve.knots(), curve.control_points(), closed);
  std::vector<double> distances(static_cast<std::size_t>(points.cols()));
  double guess = curve.domain().first;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const ClosestCurvePoint<Dim> nearest = segments.nearest(points.col(i), guess);
    distances[static_cast<std::size_t>(i)] = nearest.distance;
    guess = nearest.u;
  }
  FitQuality<Dim> quality = shape_quality(segments, closed);
  add_distances(distances, quality);
  return quality;
}

template double bending_energy(const SegmentedCurve<2>&);
template double bending_energy(const SegmentedCurve<3>&);
template FitQuality<2> shape_quality(const SegmentedCurve<2>&, bool);
template FitQuality<3> shape_quality(const SegmentedCurve<3>&, bool);
template void add_distances(std::span<const double>, FitQuality<2>&);
template void add_distances(std::span<const double>, FitQuality<3>&);
template FitQuality<2> fit_quality(const NurbsCurve<2>&, const Points<2>&, bool);
template FitQuality<3> fit_quality(const NurbsCurve<3>&, const Points<3>&, bool);

}  // namespace isorim::geometry
