#pragma once

#include <span>
#include <vector>

#include "geometry/spline/bspline.h"
#include "geometry/spline/knot_vector.h"
#include "geometry/vocabulary.h"

/// Splines in one parameter with points to collocate at: what the spaces on curves and surfaces are made of.
namespace isorim::solver {

/// Where a function is collocated: in the unit cell of an element.
struct LinePoint {
  int element = 0;
  double place = 0.0;
};

/// The B-splines of a clamped knot vector, their Bézier elements and one collocation point for each.
struct LineSpace {
  geometry::KnotVector knots;
  /// The last function is the continuation of the first across the seam: both count as one, number 0. Continuous there.
  bool periodic = false;
  /// One for each element, in order.
  std::vector<geometry::ExtractionOperator> elements;
  /// One for each function.
  std::vector<LinePoint> points;
  /// For each function the number of the piece (stretch between jumps) that it lives on, from 0.
  std::vector<int> piece;

  int function_count() const { return knots.basis_count() - (periodic ? 1 : 0); }
  /// The function that B-spline i belongs to.
  int number(int i) const { return i == function_count() ? 0 : i; }
};

/// knots: clamped. Inner knots of multiplicity p + 1 are places where functions may jump.
LineSpace line_space(geometry::KnotVector knots, bool periodic);

/// One point for each B-spline of a clamped knot vector without inner jumps, strictly inside the domain, increasing:
/// the n zeros of the spline of one degree more (same multiplicities) that is orthogonal to all n B-splines. On one
/// element these are the Gauss-Legendre points; among many equal elements they tend to the Greville abscissae within a
/// few elements from the ends. No end correction is needed at any degree, and interpolation there is about as well
/// conditioned as the B-splines are.
std::vector<double> gauss_points(const geometry::KnotVector& knots);

/// Points that lie on a breakpoint, or nearer to it than this share of the element, are moved this far into the
/// element: integrals over the neighbour are nearly singular otherwise.
inline constexpr double edge_clearance = 0.1;

}  // namespace isorim::solver
