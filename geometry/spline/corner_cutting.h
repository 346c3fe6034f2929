#pragma once

#include <Eigen/Core>

#include "geometry/spline/bspline.h"

/// De Boor's corner cutting on the p + 1 coefficients of one span [knots[span], knots[span + 1]], the one step from
/// which evaluation, clamping, splitting and Bézier extraction are made. Every step is a convex combination for u in
/// the span, and equal coefficients stay equal bit for bit.
namespace isorim::geometry {

/// Column `target` becomes the point at u on the line through column x (at left) and column y (at right).
void blend_columns(Eigen::Ref<Eigen::MatrixXd> columns, Eigen::Index target, Eigen::Index x, Eigen::Index y, double u,
                   double left, double right);

/// Replaces the coefficients of the span by those over the knots u (p + 1 times), knots[span + 1], ...: the blossoms
/// f(u, .., u, knots[span + 1], .., knots[span + i]). local is k x (p + 1).
void cut_from_left(const KnotVector& knots, int span, double u, Eigen::Ref<Eigen::MatrixXd> local);

/// Replaces the coefficients of the span by those over the knots ..., knots[span], u (p + 1 times).
void cut_from_right(const KnotVector& knots, int span, double u, Eigen::Ref<Eigen::MatrixXd> local);

/// Replaces the coefficients of the span by its Bézier coefficients.
void cut_to_bezier(const KnotVector& knots, int span, Eigen::Ref<Eigen::MatrixXd> local);

/// Throws GeometryError unless the spline has one coefficient for each basis function.
void require_consistent(const BSpline& spline);

/// The non-empty spans inside the domain, in order.
std::vector<int> nonempty_spans(const KnotVector& knots);

}  // namespace isorim::geometry
