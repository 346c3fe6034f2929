#pragma once

#include <vector>

#include "geometry/intersection/bernstein_polynomial.h"
#include "geometry/intersection/element_zero_set.h"
#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// Where a polynomial on a Bézier element touches zero: its value and both derivatives vanish.
namespace isorim::geometry {

enum class CriticalKind {
  /// Two branches of the zero set cross.
  saddle,
  /// The zero set is this point alone.
  extremum,
  /// The Hessian is singular, as on a curve along which zero is touched.
  degenerate,
};

/// By the sign of the Hessian's determinant, degenerate below 1e-8 of the square of its norm.
CriticalKind kind_of(const Eigen::Matrix2d& hessian);

/// Newton's step to a zero of the gradient; along a curve of critical points the shortest.
Vector2 critical_step(const GridJet& jet);

/// What touches zero without crossing it, or crosses itself there.
struct ElementContacts {
  struct Contact {
    /// In the unit square.
    Point2 place;
    CriticalKind kind = CriticalKind::extremum;
  };
  /// Each once; those on curves of contact are not among them.
  std::vector<Contact> points;
  /// Curves along which zero is touched, each in one direction: polynomial Bézier curves over [0, 1] in the unit
  /// square, critical points to 1e-12 of the square. They end on its sides or where they started.
  std::vector<NurbsCurve<2>> curves;
};

/// The contacts of f with zero, sides that are divided out left aside: critical points with |g| up to the larger of
/// `coincidence` and rounding, found by subdivision (cells whose Bernstein coefficients show that g or a derivative has
/// no zero are left out) and Newton's method; on the square's sides also the points where g along the side touches
/// zero. Curves of contact are followed from the points found on them. Contacts nearer to each other than about 1e-3 of
/// the square may be taken for one.
ElementContacts find_contacts(const ElementFunction& function);

/// Where a polynomial on [0, 1] touches zero: extrema of modulus at most `noise`, inside (0, 1).
std::vector<double> touching_places(const BernsteinCoefficients& polynomial, double noise);

}  // namespace isorim::geometry
