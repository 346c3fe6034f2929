#include "geometry/tspline/local_bspline.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "geometry/spline/knot_vector.h"

namespace isorim::geometry {
namespace {

/// Values of the functions of one degree that live on a piece, by their first knot.
using Column = std::array<double, static_cast<std::size_t>(KnotVector::max_degree) + 2>;

int degree_of(std::span<const double> knots) {
  return static_cast<int>(knots.size()) - 2;
}

double knot(std::span<const double> knots, int i) {
  return knots[static_cast<std::size_t>(i)];
}

/// From the functions of degree r - 1 on the piece to those of degree r. rise(a, b) weighs the function on knots a to
/// b, fall(a, b) the next one. Only functions that live on the piece are touched, so no b - a is zero.
template <class Rise, class Fall>
void raise_degree(std::span<const double> knots, int piece, int r, Column& values, Rise&& rise, Fall&& fall) {
  const int last = std::min(piece, degree_of(knots) - r);
  for (int i = std::max(0, piece - r); i <= last; ++i) {
    double sum = 0.0;
    if (i > piece - r) sum += rise(knot(knots, i), knot(knots, i + r)) * values[static_cast<std::size_t>(i)];
    if (i < piece) sum += fall(knot(knots, i + 1), knot(knots, i + r + 1)) * values[static_cast<std::size_t>(i) + 1];
    values[static_cast<std::size_t>(i)] = sum;
  }
}

void raise_at(std::span<const double> knots, int piece, int r, double u, Column& values) {
  raise_degree(
      knots, piece, r, values, [u](double a, double b) { return (u - a) / (b - a); },
      [u](double a, double b) { return (b - u) / (b - a); });
}

}  // namespace

int piece_at(std::span<const double> knots, double u, Limit limit) {
  const auto above = limit == Limit::from_right ? std::upper_bound(knots.begin(), knots.end(), u)
                                                : std::lower_bound(knots.begin(), knots.end(), u);
  if (above == knots.begin() || above == knots.end()) return -1;
  return static_cast<int>(above - knots.begin()) - 1;
}

double blossom(std::span<const double> knots, int piece, std::span<const double> arguments) {
  Column values{};
  values[static_cast<std::size_t>(piece)] = 1.0;
  for (int r = 1; r <= degree_of(knots); ++r)
    raise_at(knots, piece, r, arguments[static_cast<std::size_t>(r) - 1], values);
  return values[0];
}

double piece_derivative(std::span<const double> knots, int piece, double u, int order) {
  const int p = degree_of(knots);
  if (order > p) return 0.0;
  Column values{};
  values[static_cast<std::size_t>(piece)] = 1.0;
  for (int r = 1; r <= p - order; ++r) raise_at(knots, piece, r, u, values);
  for (int r = p - order + 1; r <= p; ++r)
    raise_degree(
        knots, piece, r, values, [r](double a, double b) { return r / (b - a); },
        [r](double a, double b) { return -r / (b - a); });
  return values[0];
}

void bernstein_coefficients(std::span<const double> knots, Interval range, std::span<double> coefficients) {
  const int piece = piece_at(knots, range.first, Limit::from_right);
  if (piece < 0) {
    std::fill(coefficients.begin(), coefficients.end(), 0.0);
    return;
  }
  std::array<double, static_cast<std::size_t>(KnotVector::max_degree)> arguments{};
  const std::span<double> used = std::span(arguments).first(knots.size() - 2);
  std::fill(used.begin(), used.end(), range.first);
  for (std::size_t j = 0;; ++j) {
    coefficients[j] = blossom(knots, piece, used);
    if (j == used.size()) return;
    used[used.size() - 1 - j] = range.last;
  }
}

}  // namespace isorim::geometry
