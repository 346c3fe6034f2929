#include "geometry/intersection/bernstein_polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace isorim::geometry {
namespace {

/// Of C(n, k), n up to the sums of degrees that occur.
constexpr Eigen::Index largest_degree = 160;

double binomial(Eigen::Index n, Eigen::Index k) {
  static const Eigen::MatrixXd table = [] {
    Eigen::MatrixXd pascal = Eigen::MatrixXd::Zero(largest_degree + 1, largest_degree + 1);
    for (Eigen::Index i = 0; i <= largest_degree; ++i) {
      pascal(i, 0) = 1.0;
      for (Eigen::Index j = 1; j <= i; ++j) pascal(i, j) = pascal(i - 1, j - 1) + (j < i ? pascal(i - 1, j) : 0.0);
    }
    return pascal;
  }();
  return table(n, k);
}

/// Replaces each column by de Casteljau's points at t: those of the part before t (`left`) or after it.
template <bool left>
void cut_columns(Eigen::Ref<Eigen::MatrixXd> columns, double t) {
  const Eigen::Index degree = columns.rows() - 1;
  for (Eigen::Index step = 1; step <= degree; ++step) {
    if constexpr (left) {
      for (Eigen::Index i = degree; i >= step; --i)
        columns.row(i) = (1.0 - t) * columns.row(i - 1) + t * columns.row(i);
    } else {
      for (Eigen::Index i = 0; i <= degree - step; ++i)
        columns.row(i) = (1.0 - t) * columns.row(i) + t * columns.row(i + 1);
    }
  }
}

void restrict_columns(Eigen::Ref<Eigen::MatrixXd> columns, Interval part) {
  if (part.first > 0.0) cut_columns<false>(columns, part.first);
  if (part.last < 1.0) cut_columns<true>(columns, (part.last - part.first) / (1.0 - part.first));
}

/// Coefficients on the stack.
using Stacked = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, largest_degree + 1, 1>;

/// Values, first and second derivatives of the Bernstein polynomials of a degree.
struct BernsteinBasis {
  Stacked value;
  Stacked first;
  Stacked second;
};

Stacked bernstein(Eigen::Index degree, double t) {
  Stacked values = Stacked::Zero(degree + 1);
  values(0) = 1.0;
  for (Eigen::Index p = 1; p <= degree; ++p) {
    for (Eigen::Index i = p; i > 0; --i) values(i) = (1.0 - t) * values(i) + t * values(i - 1);
    values(0) *= 1.0 - t;
  }
  return values;
}

Stacked derivative_of_lower(const Stacked& lower) {
  const Eigen::Index degree = lower.size();
  Stacked values = Stacked::Zero(degree + 1);
  values.head(degree) -= static_cast<double>(degree) * lower;
  values.tail(degree) += static_cast<double>(degree) * lower;
  return values;
}

BernsteinBasis basis_with_derivatives(Eigen::Index degree, double t) {
  BernsteinBasis basis{bernstein(degree, t), Stacked::Zero(degree + 1), Stacked::Zero(degree + 1)};
  if (degree >= 1) basis.first = derivative_of_lower(bernstein(degree - 1, t));
  if (degree >= 2) basis.second = derivative_of_lower(derivative_of_lower(bernstein(degree - 2, t)));
  return basis;
}

/// The same without second derivatives and without a copy.
struct BernsteinSlopes {
  std::array<double, largest_degree + 1> value;
  std::array<double, largest_degree + 1> first;

  BernsteinSlopes(Eigen::Index degree, double t) {
    const auto n = static_cast<std::size_t>(degree);
    value[0] = 1.0;
    for (std::size_t p = 1; p <= n; ++p) {
      if (p == n) set_slopes(n);
      value[p] = t * value[p - 1];
      for (std::size_t i = p - 1; i > 0; --i) value[i] = (1.0 - t) * value[i] + t * value[i - 1];
      value[0] *= 1.0 - t;
    }
    if (n == 0) first[0] = 0.0;
  }

 private:
  /// From the values of the degree below.
  void set_slopes(std::size_t n) {
    const auto factor = static_cast<double>(n);
    first[0] = -factor * value[0];
    for (std::size_t i = 1; i < n; ++i) first[i] = factor * (value[i - 1] - value[i]);
    first[n] = factor * value[n - 1];
  }
};

// --- Roots ----------------------------------------------------------------------------------------------------

int sign_of(double x) {
  return x > 0.0 ? 1 : x < 0.0 ? -1 : 0;
}

/// The root of a polynomial that has the sign given at `low` and the other one at `high`: Newton, kept in a shrinking
/// bracket.
double bracketed_root(const BernsteinCoefficients& polynomial, double low, double high, int sign_low) {
  const Eigen::Index degree = polynomial.size() - 1;
  const BernsteinCoefficients slope = static_cast<double>(degree) * (polynomial.tail(degree) - polynomial.head(degree));
  double t = 0.5 * (low + high);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double value = evaluate(polynomial, t);
    if (value == 0.0) return t;
    (sign_of(value) == sign_low ? low : high) = t;
    double next = t - value / evaluate(slope, t);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 1e-16 || high - low <= 1e-16) return next;
    t = next;
  }
  return t;
}

/// Collects places where the sign changes, in order.
void collect_roots(const BernsteinCoefficients& whole, Interval part, const BernsteinCoefficients& local,
                   std::vector<double>& roots) {
  if ((local.array() >= 0.0).all() || (local.array() <= 0.0).all()) return;
  const Eigen::Index degree = local.size() - 1;
  const Eigen::ArrayXd steps = (local.tail(degree) - local.head(degree)).array();
  const bool is_monotone = (steps >= 0.0).all() || (steps <= 0.0).all();
  if (is_monotone || part.length() < 1e-9) {
    if (local(0) * local(degree) < 0.0)
      roots.push_back(bracketed_root(whole, part.first, part.last, sign_of(local(0))));
    return;
  }
  const double middle = part.middle();
  const BernsteinCoefficients before = restrict_to(local, {0.0, 0.5});
  BernsteinCoefficients after = restrict_to(local, {0.5, 1.0});
  // One sign in the middle for both, whatever the rounding: a root there belongs to exactly one of them.
  after(0) = before(degree);
  collect_roots(whole, {part.first, middle}, before, roots);
  if (after(0) == 0.0) roots.push_back(middle);
  collect_roots(whole, {middle, part.last}, after, roots);
}

/// The value of largest modulus among samples of a stretch.
double largest_value(const BernsteinCoefficients& polynomial, double from, double to) {
  constexpr int samples = 9;
  double largest = 0.0;
  for (int k = 0; k < samples; ++k) {
    const double value = evaluate(polynomial, from + (to - from) * (k + 0.5) / samples);
    if (std::abs(value) > std::abs(largest)) largest = value;
  }
  return largest;
}

}  // namespace

double evaluate(const BernsteinCoefficients& polynomial, double t) {
  std::array<double, largest_degree + 1> points;
  const auto count = static_cast<std::size_t>(polynomial.size());
  std::copy_n(polynomial.data(), count, points.begin());
  for (std::size_t last = count - 1; last > 0; --last)
    for (std::size_t i = 0; i < last; ++i) points[i] += t * (points[i + 1] - points[i]);
  return points[0];
}

double evaluate(const BernsteinGrid& grid, const Point2& uv) {
  const BernsteinSlopes u(grid.rows() - 1, uv.x());
  const BernsteinSlopes v(grid.cols() - 1, uv.y());
  double sum = 0.0;
  const double* coefficient = grid.data();
  for (std::size_t j = 0; j < static_cast<std::size_t>(grid.cols()); ++j) {
    double row = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(grid.rows()); ++i) row += u.value[i] * *coefficient++;
    sum += v.value[j] * row;
  }
  return sum;
}

GridSlope evaluate_slope(const BernsteinGrid& grid, const Point2& uv) {
  const BernsteinSlopes u(grid.rows() - 1, uv.x());
  const BernsteinSlopes v(grid.cols() - 1, uv.y());
  GridSlope result;
  const double* coefficient = grid.data();
  for (std::size_t j = 0; j < static_cast<std::size_t>(grid.cols()); ++j) {
    double value = 0.0;
    double along_u = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(grid.rows()); ++i, ++coefficient) {
      value += u.value[i] * *coefficient;
      along_u += u.first[i] * *coefficient;
    }
    result.value += v.value[j] * value;
    result.gradient += Vector2(v.value[j] * along_u, v.first[j] * value);
  }
  return result;
}

GridJet evaluate_jet(const BernsteinGrid& grid, const Point2& uv) {
  const BernsteinBasis u = basis_with_derivatives(grid.rows() - 1, uv.x());
  const BernsteinBasis v = basis_with_derivatives(grid.cols() - 1, uv.y());
  GridJet jet;
  double mixed = 0.0;
  for (Eigen::Index j = 0; j < grid.cols(); ++j) {
    const double value = u.value.dot(grid.col(j));
    const double first = u.first.dot(grid.col(j));
    jet.value += v.value(j) * value;
    jet.gradient += Vector2(v.value(j) * first, v.first(j) * value);
    jet.hessian(0, 0) += v.value(j) * u.second.dot(grid.col(j));
    jet.hessian(1, 1) += v.second(j) * value;
    mixed += v.first(j) * first;
  }
  jet.hessian(0, 1) = jet.hessian(1, 0) = mixed;
  return jet;
}

BernsteinGrid multiply(const BernsteinGrid& a, const BernsteinGrid& b) {
  const Eigen::Index p = a.rows() - 1;
  const Eigen::Index q = a.cols() - 1;
  const Eigen::Index r = b.rows() - 1;
  const Eigen::Index s = b.cols() - 1;
  BernsteinGrid product = BernsteinGrid::Zero(p + r + 1, q + s + 1);
  for (Eigen::Index j = 0; j <= q; ++j)
    for (Eigen::Index l = 0; l <= s; ++l) {
      const double in_v = binomial(q, j) * binomial(s, l) / binomial(q + s, j + l);
      for (Eigen::Index i = 0; i <= p; ++i)
        for (Eigen::Index k = 0; k <= r; ++k)
          product(i + k, j + l) += in_v * binomial(p, i) * binomial(r, k) / binomial(p + r, i + k) * a(i, j) * b(k, l);
    }
  return product;
}

BernsteinGrid elevate(const BernsteinGrid& grid, Eigen::Index p, Eigen::Index q) {
  return multiply(grid, BernsteinGrid::Ones(std::max<Eigen::Index>(0, p - grid.rows() + 1) + 1,
                                            std::max<Eigen::Index>(0, q - grid.cols() + 1) + 1));
}

BernsteinGrid derivative_u(const BernsteinGrid& grid) {
  const Eigen::Index p = grid.rows() - 1;
  if (p == 0) return BernsteinGrid::Zero(1, grid.cols());
  return static_cast<double>(p) * (grid.bottomRows(p) - grid.topRows(p));
}

BernsteinGrid derivative_v(const BernsteinGrid& grid) {
  const Eigen::Index q = grid.cols() - 1;
  if (q == 0) return BernsteinGrid::Zero(grid.rows(), 1);
  return static_cast<double>(q) * (grid.rightCols(q) - grid.leftCols(q));
}

BernsteinCoefficients restrict_to(const BernsteinCoefficients& polynomial, Interval part) {
  Eigen::MatrixXd column = polynomial;
  restrict_columns(column, part);
  return column.col(0);
}

BernsteinGrid restrict_to(const BernsteinGrid& grid, Interval u, Interval v) {
  Eigen::MatrixXd result = grid;
  restrict_columns(result, u);
  Eigen::MatrixXd transposed = result.transpose();
  restrict_columns(transposed, v);
  return transposed.transpose();
}

BernsteinCoefficients along_v(const BernsteinGrid& grid, double u) {
  return grid.transpose() * bernstein(grid.rows() - 1, u);
}

BernsteinCoefficients along_u(const BernsteinGrid& grid, double v) {
  return grid * bernstein(grid.cols() - 1, v);
}

int SignChart::sign_between(double from, double to) const {
  const double middle = 0.5 * (from + to);
  const auto above = std::upper_bound(roots.begin(), roots.end(), middle);
  return signs[static_cast<std::size_t>(above - roots.begin())];
}

SignChart sign_chart(const BernsteinCoefficients& polynomial, double noise) {
  std::vector<double> candidates;
  if (polynomial.size() > 1) collect_roots(polynomial, {0.0, 1.0}, polynomial, candidates);
  candidates.push_back(1.0);
  SignChart chart;
  double start = 0.0;
  for (const double end : candidates) {
    const double value = largest_value(polynomial, start, end);
    if (std::abs(value) > noise) {
      const int sign = sign_of(value);
      if (chart.signs.empty()) {
        chart.signs.push_back(sign);
      } else if (chart.signs.back() != sign) {
        chart.roots.push_back(start);
        chart.signs.push_back(sign);
      }
    }
    start = end;
  }
  if (chart.signs.empty()) chart.signs.push_back(0);
  return chart;
}

}  // namespace isorim::geometry
