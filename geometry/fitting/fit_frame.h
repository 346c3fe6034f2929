#pragma once

#include <vector>

#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/fit_data.h"
#include "geometry/fitting/fit_problem.h"
#include "geometry/fitting/foot_points.h"

namespace isorim::geometry {

/// A curve in the making.
template <int Dim>
struct FitState {
  /// From 0 to 1, corners repeated p times.
  std::vector<double> breakpoints;
  std::vector<double> parameters;
  /// All control points, shared ones repeated.
  Points<Dim> control;
  /// Weighted mean of the squared distances to the points C(parameter).
  double mean_squared = 0.0;
  /// Of the points C(parameter), not weighted.
  double max_distance = 0.0;
  int iterations = 0;
  /// Of method free.
  Fairness fairness{};
};

/// What stays the same while a curve is fitted: points, degree, corners and what the ends must meet.
template <int Dim>
class FitFrame {
 public:
  /// Throws GeometryError if the options contradict each other.
  FitFrame(const Points<Dim>& points, const CurveFitOptions<Dim>& options);

  /// The same with every stride-th point, corners and ends among them.
  FitFrame thinned(int stride) const;
  /// The same with other weights of the prepared points: positive, of mean 1.
  FitFrame reweighted(const std::vector<double>& weights) const;

  const PreparedPoints<Dim>& prepared() const { return prepared_; }
  const CurveFitOptions<Dim>& options() const { return options_; }
  int point_count() const { return static_cast<int>(prepared_.data.size()); }
  int degree() const { return options_.degree; }
  /// Closed without corners: a periodic knot vector.
  bool is_periodic() const { return options_.closed && prepared_.corners.empty(); }
  /// The smallest and the largest number of distinct control points that make sense.
  int fewest_control_points() const;
  int most_control_points() const;
  /// Throws GeometryError, with the limits, for another number.
  void require_count(int control_points) const;

  /// Distinct control points on these breakpoints, and the other way round the number of free knots between the ends
  /// and corners.
  int control_points(const std::vector<double>& breakpoints) const;
  int free_knots(int control_points) const;

  /// Whether knots are looked for, not given by the options or by a rule.
  bool moves_knots() const { return options_.knots == FitKnots::automatic; }
  /// Whether a knot inside the domain may be moved: no corner.
  bool is_free_knot(double u) const;
  /// Breakpoints by a rule other than automatic, and the parameters that go with them: those of the prepared points,
  /// moved by one constant if the rule puts the first breakpoint elsewhere. Throws GeometryError for given ones that do
  /// not run from 0 to 1 or do not have the corners among them.
  FitState<Dim> start(FitKnots rule, int control_points) const;
  /// The same with the rule of the options, and the control points. Automatic rules go from the best to the safest.
  /// Throws GeometryError if the data do not determine the control points.
  FitState<Dim> first_fit(int control_points, const Fairness& fairness) const;
  FitSpace space(const std::vector<double>& breakpoints) const;
  /// What corners and ends demand.
  FitConstraints<Dim> constraints(const KnotVector& knots) const;
  /// A parameter that has left [0, 1] (by less than 1): round the closed curve, or back to the end of an open one.
  double into_domain(double u) const;

  /// Solves for the control points; false if the data do not determine them (the state is then left as it was).
  bool solve(FitState<Dim>& state, const Fairness& fairness) const;
  SegmentedCurve<Dim> curve(const FitState<Dim>& state) const;
  /// Measures the distances at the parameters.
  void measure(FitState<Dim>& state) const;
  /// Moves every parameter towards the nearest point of the curve, and measures the distances there.
  void correct_parameters(FitState<Dim>& state, int steps) const;

 private:
  std::vector<double> corner_parameters() const;
  FitState<Dim> start_on_given_knots() const;

  CurveFitOptions<Dim> options_;
  PreparedPoints<Dim> prepared_;
};

}  // namespace isorim::geometry
