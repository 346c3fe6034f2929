#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/spline/knot_vector.h"

namespace isorim::geometry {

/// Consecutive data of one value between which the spline is to stay at it: from parameters[first] to parameters[last].
struct ConstantRun {
  int first = 0;
  int last = 0;
};

/// The splines on one clamped knot vector that meet their data exactly: those with the least integral of their squared
/// third derivative (second or first where there are but three or two data), which reproduces polynomials of degree 2.
/// With one function for every condition that is interpolation.
///
/// Exact to rounding in the data and bit for bit at both ends and along runs, where the coefficients of all functions
/// that live there are the value itself. Dense; O(n^3) once for n functions.
class SmoothestSpline {
 public:
  struct Conditions {
    /// Rising; the first and last are the ends of the knots' domain.
    std::vector<double> parameters;
    /// Disjoint, in order. The values of a run have to be the same.
    std::vector<ConstantRun> runs = {};
    /// The first derivative vanishes at the first parameter.
    bool is_level_at_start = false;
    /// Functions whose coefficients are to be 0, neither the first nor the last one.
    std::vector<int> zeros = {};
  };

  /// Throws GeometryError if the counts contradict each other or the knots leave too few functions to meet the
  /// conditions.
  SmoothestSpline(const KnotVector& knots, Conditions conditions);

  /// The coefficients: `values` is k x parameters.size(), the result k x knots.basis_count().
  Eigen::MatrixXd coefficients(const Eigen::Ref<const Eigen::MatrixXd>& values) const;

 private:
  Conditions conditions_;
  /// Of each function, the datum whose value its coefficient is, or one of the two below.
  std::vector<int> fixed_by_;
  static constexpr int not_fixed = -1;
  static constexpr int zero = -2;
  std::vector<int> free_;
  /// Data that the free functions have to meet.
  std::vector<int> met_;
  /// (met data, and the level start) x functions.
  Eigen::MatrixXd conditions_matrix_;
  /// free coefficients = from_conditions_ * right-hand side + from_fixed_ * fixed coefficients (all functions').
  Eigen::MatrixXd from_conditions_;
  Eigen::MatrixXd from_fixed_;
};

/// Clamped knots with a breakpoint at each parameter and in the middle between neighbours: twice as many functions as
/// data, so that runs and level ends leave enough of them to meet the rest smoothly.
KnotVector doubled_knots(int degree, std::span<const double> parameters);

}  // namespace isorim::geometry
