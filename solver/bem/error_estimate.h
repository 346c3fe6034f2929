#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "solver/bem/evaluation.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"

/// How wrong a solution is, element by element, and refinement where it is worst.
namespace isorim::solver {

/// An indicator for every element: with r the residual of the integral equation (kernels.h), which collocation makes
/// zero at the collocation points alone,
///
///   eta_e^2 = (1 / h_e) int_e |r|^2 dS,
///
/// h_e the element's size. The residual of the exact flux or traction vanishes; r maps from its errors in H^(-1/2) to
/// H^(1/2) (from those of the potential in H^(1/2) to the same), and the weighted norm is that of H^(1/2) for functions
/// that oscillate on the scale of the elements (C. Carstensen & E. P. Stephan, Math. Comp. 64 (1995) 483-500, with
/// h |r'|^2 in place of |r|^2 / h). In units of the potential times length^((Dim - 2) / 2), so indicators of one
/// solution compare with one another. Sampled at Gauss points, one or two more in each direction than collocation has.
template <int Dim>
std::vector<double> error_indicators(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                     const Solution<Dim>& solution, const EvaluationOptions& options = {});

/// The root of the sum of the squares.
double total_indicator(std::span<const double> indicators);

/// The smallest set of elements whose squares sum up to at least `share` (0 to 1) of all, largest first (W. Doerfler,
/// SIAM J. Numer. Anal. 33 (1996) 1106-1124). Elements whose indicators are equal to a relative 1e-6 of the last one
/// are taken along, so that symmetric problems stay symmetric.
std::vector<int> mark_elements(std::span<const double> indicators, double share);

struct AdaptiveOptions {
  SolveOptions solve;
  EvaluationOptions estimate;
  /// Of Doerfler's marking.
  double share = 0.5;
  /// Solves at most so many times.
  int max_steps = 20;
  /// Refines no more when the space has so many functions.
  int max_functions = 5000;
  /// Stops when the total indicator, relative to that of the first step, is no larger; 0: never.
  double reduction = 0.0;
};

struct AdaptiveStep {
  int functions = 0;
  double indicator = 0.0;
};

template <int Dim>
struct AdaptiveResult {
  /// Of the last step.
  FieldSpace<Dim> space;
  Problem<Dim> problem;
  Solution<Dim> solution;
  std::vector<double> indicators;
  std::vector<AdaptiveStep> steps;
};

/// Solve, estimate, mark, refine. `problem_on` states the problem on a space's elements; `refine` gives the space in
/// which the elements of the last one that are marked are divided.
template <int Dim>
AdaptiveResult<Dim> solve_adaptively(
    FieldSpace<Dim> space, const std::function<Problem<Dim>(const FieldSpace<Dim>&)>& problem_on,
    const std::function<FieldSpace<Dim>(const FieldSpace<Dim>&, std::span<const int>)>& refine,
    const AdaptiveOptions& options = {});

}  // namespace isorim::solver
