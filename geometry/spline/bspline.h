#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/spline/knot_vector.h"

/// Algorithms on B-splines with coefficients in R^k, k arbitrary: NURBS curves use them with homogeneous points
/// (k = Dim + 1), surfaces with whole rows of their control net (k = (Dim + 1) x count of the other direction), so
/// each algorithm is written once.
namespace isorim::geometry {

/// A spline u -> sum_i N_i(u) coefficients.col(i). coefficients is k x knots.basis_count().
struct BSpline {
  KnotVector knots;
  Eigen::MatrixXd coefficients;
};

/// Values and derivatives of the p + 1 functions that live on a span: row d, column j is the d-th derivative of
/// N_{span - p + j} at u. (orders + 1) x (p + 1). Derivatives above the degree are zero. Piegl & Tiller, A2.3.
Eigen::MatrixXd basis_derivatives(const KnotVector& knots, int span, double u, int orders);

/// Column d is the d-th derivative at u, d = 0..orders; k x (orders + 1). At a breakpoint the value is the limit
/// from the right, at the domain's end from the left.
Eigen::MatrixXd evaluate_derivatives(const BSpline& spline, double u, int orders);

/// The value at u by de Boor's corner cutting: k. Equal coefficients come back bit for bit, and so does an end
/// coefficient of a clamped spline. Limits at breakpoints as above.
Eigen::VectorXd evaluate(const BSpline& spline, double u);

/// The same spline with `new_knots` (increasing or equal, inside the domain) inserted. Boehm's and the Oslo
/// algorithm in one: Piegl & Tiller, A5.4. Throws GeometryError if a multiplicity would exceed degree + 1 or a
/// knot lies outside the domain.
BSpline refine_knots(const BSpline& spline, std::span<const double> new_knots);

/// The result of a removal: the spline, how often the knot was in fact removed, and a bound on the change of the
/// curve in the norm of the coefficients (0 if nothing was removed).
struct KnotRemoval {
  BSpline spline;
  int removed = 0;
  double error_bound = 0.0;
};

/// Removes the inner knot u up to `times` times, as long as the coefficients move by at most `tolerance` (in the
/// units of the coefficients). Piegl & Tiller, A5.8. Throws GeometryError if u is no inner knot.
KnotRemoval remove_knot(const BSpline& spline, double u, int times, double tolerance);

/// The same spline with degree p + times; each breakpoint's multiplicity rises by `times`. Exact: one degree more is
/// the mean of p + 1 refinements (Prautzsch & Piper, CAGD 8, 1991). An unclamped spline comes back clamped.
BSpline elevate_degree(const BSpline& spline, int times);

/// The same spline on a clamped knot vector over the same domain.
BSpline clamp(const BSpline& spline);

/// The part of the spline over `piece` (inside the domain), clamped.
BSpline restrict_to(const BSpline& spline, Interval piece);

/// The same spline on a clamped knot vector over `domain`, which contains its own: the end pieces continue as the
/// polynomials that they are. Throws GeometryError if the domain does not contain the spline's.
BSpline extend(const BSpline& spline, Interval domain);

/// u -> spline(first + last - u).
BSpline reverse(const BSpline& spline);

/// One Bézier segment per non-empty span, in order.
struct BezierSegment {
  Interval domain;
  /// k x (p + 1).
  Eigen::MatrixXd coefficients;
};
std::vector<BezierSegment> bezier_segments(const BSpline& spline);

/// The extraction operator of each non-empty span: C, (p + 1) x (p + 1), with N_{span - p + i} = sum_j C(i, j) B_j
/// on that span, B the Bernstein polynomials of degree p. (Borden et al., IJNME 87, 2011, section 3.)
struct ExtractionOperator {
  Interval domain;
  /// Index of the first function that lives on the span.
  int first_function = 0;
  Eigen::MatrixXd matrix;
};
std::vector<ExtractionOperator> extraction_operators(const KnotVector& knots);

}  // namespace isorim::geometry
