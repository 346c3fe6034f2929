#pragma once

#include <span>
#include <vector>

#include "geometry/fitting/spline_least_squares.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// The points to be fitted, with positive weights, of mean 1 unless their scale matters; one each.
template <int Dim>
struct FitData {
  Points<Dim> points;
  std::vector<double> weights;

  std::size_t size() const { return weights.size(); }
};

/// A term mu times the integral of |C^(derivative)|^2 over the domain; none for derivatives above the degree.
struct Fairness {
  double mu = 0.0;
  int derivative = 2;
  /// Factors on mu, one for each interval between successive breakpoints; empty: all 1.
  std::vector<double> factors{};
};

/// Conditions that a fit meets exactly.
template <int Dim>
struct FitConstraints {
  /// Control point `function` lies here.
  struct FixedPoint {
    int function = 0;
    Point<Dim> point;
  };
  std::vector<FixedPoint> fixed;
  /// C'' = 0 at the end of a clamped knot vector of degree 2 or more. The end control point must be fixed.
  bool natural_start = false;
  bool natural_end = false;
};

/// The control points (all of them, shared ones repeated) that minimise the mean weighted squared distance of the
/// points C(parameter) from the data, plus the fairness term; one parameter a point. Empty if the data do not
/// determine them.
template <int Dim>
Points<Dim> solve_fit(const FitSpace& space, const FitData<Dim>& data, std::span<const double> parameters,
                      const Fairness& fairness, const FitConstraints<Dim>& constraints);

}  // namespace isorim::geometry
