#pragma once

#include "geometry/spline/knot_vector.h"

namespace isorim::geometry {

/// The derivatives of one order of the p + 1 functions on a span, at u in it: p + 1 values. order 0 .. p. Faster than
/// fill_basis_table() where only one order is wanted: the functions of degree p - order, then the differences of
/// control points (Piegl & Tiller, eq. 3.8) transposed.
void fill_basis_derivative(const KnotVector& knots, int span, double u, int order, double* values);

}  // namespace isorim::geometry
