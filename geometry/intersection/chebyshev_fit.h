#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "geometry/intersection/bernstein_polynomial.h"
#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"

/// Polynomials in Bernstein form through values at Chebyshev points: smooth functions are met to rounding by moderate
/// degrees (Trefethen, Approximation Theory and Approximation Practice, 2013, chapters 3 and 8).
namespace isorim::geometry {

/// The highest degree that is used; smooth functions that need more are cut in two.
inline constexpr int largest_fit_degree = 16;

/// (1 - cos(k pi / n)) / 2, k = 0..n: increasing, 0 and 1 among them.
const std::vector<double>& chebyshev_points(int n);

/// The Bernstein coefficients of degree n through the values at chebyshev_points(n): `values` has n + 1 columns, one
/// row a component. End values come back bit for bit.
Eigen::MatrixXd interpolate_bernstein(const Eigen::Ref<const Eigen::MatrixXd>& values);

/// Polynomial Bézier curves over [0, 1], one after the other, that meet a smooth curve to within `tolerance`; the curve
/// is given on [0, 1]. Inner ends are points of the curve. Throws GeometryError, with the place, if parts a thousandth
/// long still miss it.
std::vector<NurbsCurve<2>> fit_curve(const std::function<Point2(double)>& curve, double tolerance);

/// The sign chart, on [0, 1], of a function that is analytic there: by polynomials on parts small enough that they
/// meet it to within `noise`.
SignChart sign_chart(const std::function<double(double)>& function, double noise);

/// Where a function that is analytic on [0, 1] touches zero: extrema of modulus at most `noise`, inside (0, 1).
std::vector<double> touching_places(const std::function<double(double)>& function, double noise);

}  // namespace isorim::geometry
