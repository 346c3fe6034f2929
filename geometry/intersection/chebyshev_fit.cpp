#include "geometry/intersection/chebyshev_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/critical_points.h"

namespace isorim::geometry {
namespace {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

std::vector<double> make_points(int n) {
  std::vector<double> points;
  for (int k = 0; k <= n; ++k) {
    const double half = 0.5 * std::numbers::pi * k / n;
    points.push_back(std::sin(half) * std::sin(half));
  }
  points.back() = 1.0;
  return points;
}

/// Values of the Bernstein polynomials at the points, inverted in extended precision: the condition number of degree 16
/// is about 1e5.
LongMatrix make_interpolation(int n) {
  LongMatrix values(n + 1, n + 1);
  const std::vector<double>& points = chebyshev_points(n);
  for (int k = 0; k <= n; ++k) {
    const long double t = points[static_cast<std::size_t>(k)];
    for (int i = 0; i <= n; ++i) values(i, k) = i == 0 ? 1.0L : 0.0L;
    for (int p = 1; p <= n; ++p) {
      for (int i = p; i > 0; --i) values(i, k) = (1.0L - t) * values(i, k) + t * values(i - 1, k);
      values(0, k) *= 1.0L - t;
    }
  }
  return values.inverse();
}

const LongMatrix& interpolation(int n) {
  static const std::vector<LongMatrix> matrices = [] {
    std::vector<LongMatrix> made(1);
    for (int degree = 1; degree <= largest_fit_degree; ++degree) made.push_back(make_interpolation(degree));
    return made;
  }();
  return matrices[static_cast<std::size_t>(n)];
}

struct Stretch {
  Interval part;
  BernsteinCoefficients polynomial;
};

BernsteinCoefficients fit(const std::function<double(double)>& function, Interval part, int degree) {
  Eigen::MatrixXd values(1, degree + 1);
  for (int k = 0; k <= degree; ++k)
    values(0, k) = function(part.first + part.length() * chebyshev_points(degree)[static_cast<std::size_t>(k)]);
  return interpolate_bernstein(values).row(0).transpose();
}

/// Between the points of the interpolation, where it errs most.
double largest_error(const std::function<double(double)>& function, const Stretch& stretch) {
  constexpr int samples = 24;
  double error = 0.0;
  for (int k = 0; k < samples; ++k) {
    const double t = std::pow(std::sin(0.5 * std::numbers::pi * (k + 0.5) / samples), 2);
    const double value = function(stretch.part.first + stretch.part.length() * t);
    error = std::max(error, std::abs(value - evaluate(stretch.polynomial, t)));
  }
  return error;
}

void append_stretches(const std::function<double(double)>& function, Interval part, double noise,
                      std::vector<Stretch>& stretches) {
  for (const int degree : {4, 8, largest_fit_degree}) {
    Stretch stretch{part, fit(function, part, degree)};
    if (largest_error(function, stretch) > noise && (degree < largest_fit_degree || part.length() > 1e-3)) continue;
    stretches.push_back(std::move(stretch));
    return;
  }
  append_stretches(function, {part.first, part.middle()}, noise, stretches);
  append_stretches(function, {part.middle(), part.last}, noise, stretches);
}

/// Whether the polynomial is nowhere farther than the tolerance, between the interpolation points.
bool meets(const std::function<Point2(double)>& curve, Interval part, const Points<2>& points, double tolerance) {
  const int samples = 2 * static_cast<int>(points.cols()) + 1;
  for (int k = 0; k < samples; ++k) {
    const double t = (k + 0.5) / samples;
    const Point2 fitted(evaluate(BernsteinCoefficients(points.row(0).transpose()), t),
                        evaluate(BernsteinCoefficients(points.row(1).transpose()), t));
    if (!((fitted - curve(part.first + part.length() * t)).norm() <= tolerance)) return false;
  }
  return true;
}

void append_fits(const std::function<Point2(double)>& curve, Interval part, double tolerance,
                 std::vector<NurbsCurve<2>>& pieces) {
  for (const int degree : {1, 2, 3, 4, 6, 8, 10, 12, 14, largest_fit_degree}) {
    Points<2> values(2, degree + 1);
    for (int k = 0; k <= degree; ++k)
      values.col(k) = curve(part.first + part.length() * chebyshev_points(degree)[static_cast<std::size_t>(k)]);
    const Points<2> points = interpolate_bernstein(values);
    if (!meets(curve, part, points, tolerance)) continue;
    pieces.push_back(NurbsCurve<2>::from_points(KnotVector::bezier(degree), points));
    return;
  }
  if (part.length() < 1e-3) {
    const Point2 place = curve(part.middle());
    throw GeometryError(fmt::format("a curve at ({:.9g}, {:.9g}) is not smooth enough to be met to {:.3g}", place.x(),
                                    place.y(), tolerance));
  }
  append_fits(curve, {part.first, part.middle()}, tolerance, pieces);
  append_fits(curve, {part.middle(), part.last}, tolerance, pieces);
}

}  // namespace

std::vector<NurbsCurve<2>> fit_curve(const std::function<Point2(double)>& curve, double tolerance) {
  std::vector<NurbsCurve<2>> pieces;
  append_fits(curve, {0.0, 1.0}, tolerance, pieces);
  return pieces;
}

const std::vector<double>& chebyshev_points(int n) {
  static const std::vector<std::vector<double>> points = [] {
    std::vector<std::vector<double>> made(1);
    for (int degree = 1; degree <= largest_fit_degree; ++degree) made.push_back(make_points(degree));
    return made;
  }();
  return points[static_cast<std::size_t>(n)];
}

Eigen::MatrixXd interpolate_bernstein(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  const int n = static_cast<int>(values.cols()) - 1;
  Eigen::MatrixXd coefficients = (values.cast<long double>() * interpolation(n)).cast<double>();
  coefficients.col(0) = values.col(0);
  coefficients.col(n) = values.col(n);
  return coefficients;
}

std::vector<double> touching_places(const std::function<double(double)>& function, double noise) {
  std::vector<Stretch> stretches;
  append_stretches(function, {0.0, 1.0}, noise, stretches);
  std::vector<double> places;
  for (const Stretch& stretch : stretches) {
    for (const double s : touching_places(stretch.polynomial, 2.0 * noise))
      places.push_back(stretch.part.first + s * stretch.part.length());
    // The ends of stretches are no ends of the function: an extremum there would be missed.
    const double end = stretch.part.last;
    if (end < 1.0 && std::abs(function(end)) <= noise) places.push_back(end);
  }
  return places;
}

SignChart sign_chart(const std::function<double(double)>& function, double noise) {
  std::vector<Stretch> stretches;
  append_stretches(function, {0.0, 1.0}, noise, stretches);
  SignChart whole;
  for (const Stretch& stretch : stretches) {
    const SignChart chart = sign_chart(stretch.polynomial, 2.0 * noise);
    if (chart.signs.front() == 0) continue;
    for (std::size_t i = 0; i < chart.signs.size(); ++i) {
      if (!whole.signs.empty() && whole.signs.back() == chart.signs[i]) continue;
      if (!whole.signs.empty()) {
        const double local = i == 0 ? 0.0 : chart.roots[i - 1];
        whole.roots.push_back(stretch.part.first + stretch.part.length() * local);
      }
      whole.signs.push_back(chart.signs[i]);
    }
  }
  if (whole.signs.empty()) whole.signs.push_back(0);
  return whole;
}

}  // namespace isorim::geometry
