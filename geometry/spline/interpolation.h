#pragma once

#include <span>

#include <Eigen/Core>

#include "geometry/spline/bspline.h"

namespace isorim::geometry {

/// Clamped knots over [parameters.front(), parameters.back()] for splines that interpolate at `parameters`: inner ones
/// are means of p consecutive parameters, so that every span between them has its share and the interpolation is
/// solvable (Piegl & Tiller, eq. 9.8). Needs more than `degree` rising parameters.
KnotVector averaged_knots(int degree, std::span<const double> parameters);

/// Row k holds the values of the basis functions at parameters[k]: as many rows as parameters.
Eigen::MatrixXd collocation_matrix(const KnotVector& knots, std::span<const double> parameters);

/// The spline on `knots` with value values.col(k) at parameters[k]; values is k x knots.basis_count(), one parameter a
/// function; values at the ends of a clamped vector are met bit for bit. Throws GeometryError if the counts differ or
/// the parameters leave a function without one in its support (Schoenberg and Whitney's condition).
BSpline interpolate(const KnotVector& knots, std::span<const double> parameters,
                    const Eigen::Ref<const Eigen::MatrixXd>& values);

}  // namespace isorim::geometry
