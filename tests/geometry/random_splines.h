#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/spline/bspline.h"

/// Random splines of every kind that the kernel accepts, from fixed seeds, and reference evaluations that share no
/// code with it.
namespace isorim::geometry::testing {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double real(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(engine_); }
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<unsigned long>(high - low + 1));
  }
  double inside(Interval interval) { return real(interval.first, interval.last); }

 private:
  std::mt19937_64 engine_;
};

enum class Ends { clamped, unclamped, periodic };

/// Knots of uneven spacing (ratios up to 10) and inner multiplicities up to `largest_multiplicity`.
inline KnotVector random_knots(Random& random, int degree, Ends ends, int largest_multiplicity) {
  const int spans = random.integer(1, 6);
  std::vector<double> distinct{random.real(-2.0, 1.0)};
  for (int i = 0; i < spans; ++i) distinct.push_back(distinct.back() + random.real(0.1, 1.0));
  std::vector<double> breakpoints{distinct.front()};
  for (int i = 1; i < spans; ++i)
    breakpoints.insert(breakpoints.end(), static_cast<std::size_t>(random.integer(1, largest_multiplicity)),
                       distinct[static_cast<std::size_t>(i)]);
  breakpoints.push_back(distinct.back());
  if (ends == Ends::clamped) return KnotVector::clamped(degree, breakpoints);
  if (ends == Ends::periodic) return KnotVector::periodic(degree, breakpoints);
  std::vector<double> knots = breakpoints;
  for (int i = 0; i < degree; ++i) {
    knots.insert(knots.begin(), knots.front() - random.real(0.05, 1.0));
    knots.push_back(knots.back() + random.real(0.05, 1.0));
  }
  return {degree, knots};
}

inline KnotVector random_knots(Random& random, int degree) {
  return random_knots(random, degree, static_cast<Ends>(random.integer(0, 2)), random.integer(1, degree + 1));
}

inline BSpline random_spline(Random& random, const KnotVector& knots, int rows) {
  BSpline spline{knots, Eigen::MatrixXd(rows, knots.basis_count())};
  for (double& c : spline.coefficients.reshaped()) c = random.real(-1.0, 1.0);
  return spline;
}

/// Points in [-1, 1]^Dim, weights over two decades.
template <int Dim>
HomogeneousPoints<Dim> random_net(Random& random, int count) {
  HomogeneousPoints<Dim> net(Dim + 1, count);
  for (int i = 0; i < count; ++i) {
    for (int d = 0; d < Dim; ++d) net(d, i) = random.real(-1.0, 1.0);
    net(Dim, i) = 1.0;
    net.col(i) *= std::pow(10.0, random.real(-1.0, 1.0));
  }
  return net;
}

template <int Dim>
NurbsCurve<Dim> random_curve(Random& random, const KnotVector& knots) {
  return {knots, random_net<Dim>(random, knots.basis_count())};
}

template <int Dim>
NurbsSurface<Dim> random_surface(Random& random, const KnotVector& u, const KnotVector& v) {
  return {u, v, random_net<Dim>(random, u.basis_count() * v.basis_count())};
}

/// The k-th derivative of each basis function at u by the recurrences of Cox and de Boor in their textbook form
/// (0 / 0 = 0), in long double. All basis functions.
inline std::vector<long double> reference_basis(const KnotVector& knots, double u, int derivative) {
  const int p = knots.degree();
  const int m = static_cast<int>(knots.knots().size()) - 1;
  int span = p;
  for (int i = p; i < knots.basis_count(); ++i)
    if (knots[i] < knots[i + 1] && (knots[i] <= u || i == p)) span = i;
  std::vector<long double> values(static_cast<std::size_t>(m), 0.0L);
  values[static_cast<std::size_t>(span)] = 1.0L;
  const auto quotient = [](long double a, long double b) { return b == 0.0L ? 0.0L : a / b; };
  for (int d = 1; d <= p; ++d) {
    const bool differentiate = d > p - derivative;
    for (int i = 0; i + d < m; ++i) {
      const std::size_t s = static_cast<std::size_t>(i);
      const long double left = static_cast<long double>(knots[i + d]) - knots[i];
      const long double right = static_cast<long double>(knots[i + d + 1]) - knots[i + 1];
      if (differentiate)
        values[s] = d * (quotient(values[s], left) - quotient(values[s + 1], right));
      else
        values[s] = quotient((static_cast<long double>(u) - knots[i]) * values[s], left) +
                    quotient((static_cast<long double>(knots[i + d + 1]) - u) * values[s + 1], right);
    }
  }
  values.resize(static_cast<std::size_t>(knots.basis_count()));
  if (derivative > p) std::fill(values.begin(), values.end(), 0.0L);
  return values;
}

/// The k-th derivative of the spline.
inline Eigen::VectorXd reference_value(const BSpline& spline, double u, int derivative) {
  const std::vector<long double> basis = reference_basis(spline.knots, u, derivative);
  Eigen::VectorXd value(spline.coefficients.rows());
  for (Eigen::Index row = 0; row < value.size(); ++row) {
    long double sum = 0.0L;
    for (std::size_t i = 0; i < basis.size(); ++i)
      sum += basis[i] * spline.coefficients(row, static_cast<Eigen::Index>(i));
    value[row] = static_cast<double>(sum);
  }
  return value;
}

/// Full circle of nine points (Piegl & Tiller, section 7.5), counter-clockwise from angle 0.
inline NurbsCurve<2> circle(double radius, const Point2& centre) {
  const double h = std::sqrt(0.5);
  Points<2> points(2, 9);
  points << 1, 1, 0, -1, -1, -1, 0, 1, 1,  //
      0, 1, 1, 1, 0, -1, -1, -1, 0;
  points = (radius * points).colwise() + centre;
  const std::vector<double> weights{1, h, 1, h, 1, h, 1, h, 1};
  const std::vector<double> knots{0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1};
  return NurbsCurve<2>::from_points(KnotVector(2, knots), points, weights);
}

}  // namespace isorim::geometry::testing
