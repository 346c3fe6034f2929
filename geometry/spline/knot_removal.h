#pragma once

#include "geometry/spline/bspline.h"

namespace isorim::geometry {

/// A spline without one occurrence of a knot, and how far its coefficients would move if that were put back.
struct SingleRemoval {
  BSpline spline;
  /// The largest norm of a coefficient's change, each column taken as a stack of vectors of `block` rows. It bounds
  /// the change of the spline (the basis functions are positive and sum to 1).
  double largest_move = 0.0;
};

/// Solves the insertion equations from both ends towards the middle; the middle one is left over and gives the
/// change (Piegl & Tiller, section 5.4). u is an inner knot.
SingleRemoval remove_knot_once(const BSpline& spline, double u, Eigen::Index block);

/// Throws GeometryError unless u is a knot strictly inside the domain.
void require_inner_knot(const KnotVector& knots, double u);

}  // namespace isorim::geometry
