#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "geometry/vocabulary.h"

/// Splines that stand for what has no rational form, on the parameters of the thing itself.
namespace isorim::io::iges {

struct FitOptions {
  /// How far the spline may lie from the function at equal parameters, in the units of the function's values.
  double tolerance = 1e-10;
  /// Pieces per stretch between breakpoints after which a fit ends, whatever it has reached.
  int largest_count = 1024;
};

template <int Dim>
struct FittedCurve {
  geometry::NurbsCurve<Dim> curve;
  /// The largest distance found between spline and function, at points between those that were interpolated.
  double deviation = 0.0;
};

/// A polynomial spline of degree 12 with the parameters of the function: each piece interpolates at 11
/// Chebyshev-Lobatto points, and pieces are halved until they meet the tolerance. The pieces meet exactly at their
/// ends.
///
/// breakpoints: at least two, strictly increasing; the domain's ends and wherever the function is not smooth. The
/// error falls as fast as the function is smooth between them. Throws GeometryError if a value is not finite.
template <int Dim>
FittedCurve<Dim> fit_curve(const std::function<geometry::Point<Dim>(double)>& function,
                           std::span<const double> breakpoints, const FitOptions& options);

struct FittedSurface {
  geometry::NurbsSurface<3> surface;
  double deviation = 0.0;
};

/// The same for surfaces, of degree 8 in both directions: whole rows or columns of patches are halved.
FittedSurface fit_surface(const std::function<geometry::Point3(const geometry::Point2&)>& function,
                          std::span<const double> breakpoints_u, std::span<const double> breakpoints_v,
                          const FitOptions& options);

}  // namespace isorim::io::iges
