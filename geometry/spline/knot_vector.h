#pragma once

#include <span>
#include <vector>

#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// A knot vector together with the degree p of the splines on it; valid from construction on.
///
/// With m + 1 knots it carries n = m - p basis functions. It need not be clamped: the spline is defined on
/// [knots[p], knots[n]] (Piegl & Tiller, The NURBS Book, 2nd ed., chapter 2 and section 12.2).
class KnotVector {
 public:
  /// Throws GeometryError if: degree < 1 or > max_degree; fewer than 2 (degree + 1) knots; a knot is not finite or
  /// smaller than its predecessor; the domain is empty; a multiplicity exceeds degree + 1. The message gives the
  /// index and the values. (Multiplicity degree + 1 inside is legal: the spline may be discontinuous there.)
  KnotVector(int degree, std::vector<double> knots);

  /// 0 (p + 1 times), 1/spans, ..., 1 (p + 1 times).
  static KnotVector clamped_uniform(int degree, int spans);
  /// p + 1 zeros and p + 1 ones: one Bézier segment.
  static KnotVector bezier(int degree) { return clamped_uniform(degree, 1); }
  /// Clamped at both ends, with the breakpoints given in increasing order, inner ones with the multiplicity given
  /// by repetition.
  static KnotVector clamped(int degree, std::span<const double> breakpoints);
  /// The knots of a periodic spline of degree p: `breakpoints` (increasing, inner ones possibly repeated, first
  /// and last delimiting the period) continued by p knots on each side with the period. It carries
  /// breakpoints.size() - 1 + p functions, the last p of which repeat the first p control points.
  static KnotVector periodic(int degree, std::span<const double> breakpoints);

  static constexpr int max_degree = 30;

  int degree() const { return degree_; }
  std::span<const double> knots() const { return knots_; }
  double operator[](int i) const { return knots_[static_cast<std::size_t>(i)]; }
  /// Number n of basis functions.
  int basis_count() const { return static_cast<int>(knots_.size()) - degree_ - 1; }
  Interval domain() const {
    return {knots_[static_cast<std::size_t>(degree_)], knots_[static_cast<std::size_t>(basis_count())]};
  }
  /// Multiplicity degree + 1 at both ends of the domain and nothing outside it.
  bool is_clamped() const;
  /// The distinct knots inside the domain, ends included: the ends of the Bézier elements.
  std::vector<double> breakpoints() const;
  /// How often u occurs among the knots (compared exactly).
  int multiplicity(double u) const;
  /// The index i with knots[i] <= u < knots[i + 1], a non-empty span in the domain; the last one at the domain's
  /// end. Outside the domain the nearest such span (the polynomial there is continued).
  int find_span(double u) const;
  /// The Greville abscissa of each basis function: the mean of its p inner knots.
  std::vector<double> greville_abscissae() const;

  friend bool operator==(const KnotVector&, const KnotVector&) = default;

 private:
  int degree_;
  std::vector<double> knots_;
};

}  // namespace isorim::geometry
