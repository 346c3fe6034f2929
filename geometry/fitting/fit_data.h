#pragma once

#include <vector>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/fit_problem.h"

namespace isorim::geometry {

/// What is fitted: the given points without repetitions, turned so that a closed curve with corners starts in one, with
/// weights and first parameters; and how they belong to the given ones.
template <int Dim>
struct PreparedPoints {
  FitData<Dim> data;
  std::vector<double> parameters;
  /// For each given point the index of its prepared one.
  std::vector<int> index;
  /// Prepared points that are corners, increasing. On a closed curve the first of them is 0.
  std::vector<int> corners;
  bool closed = true;
  /// Of the data's polygon, closing chord included.
  double length = 0.0;
};

/// Checks points and options together and prepares the points; throws GeometryError as fit_points() says.
template <int Dim>
PreparedPoints<Dim> prepare_points(const Points<Dim>& points, const CurveFitOptions<Dim>& options);

}  // namespace isorim::geometry
