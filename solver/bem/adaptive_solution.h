#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "geometry/topology/orientation.h"
#include "solver/bem/error_estimate.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"

/// Refinement where the solution is worst, until it is good enough.
namespace isorim::solver {

struct AdaptiveOptions {
  SolveOptions solve;
  EvaluationOptions estimate;
  /// Of the relative estimate, AdaptiveStep::estimate. Below what `solve` and `estimate` aim at it cannot be reached.
  double tolerance = 1e-4;
  /// No more solutions than this, at least one.
  int max_steps = 50;
  /// No solution with more unknowns than this but for the first.
  int max_unknowns = 5000;
  /// Of Doerfler's marking, in (0, 1].
  double share = 0.5;
};

/// Why no further step was made.
enum class AdaptiveEnd {
  tolerance_reached,
  /// AdaptiveOptions::max_steps.
  steps,
  /// AdaptiveOptions::max_unknowns.
  unknowns,
  /// The elements that are marked cannot be divided any further, see refine_locally().
  levels,
};

struct AdaptiveStep {
  std::size_t elements = 0;
  int functions = 0;
  std::size_t unknowns = 0;
  /// total_indicator() / solution_size(): of the order of the relative error of the boundary data in the energy norm.
  double estimate = 0.0;
};

template <int Dim>
struct AdaptiveResult {
  /// Of the last step.
  FieldSpace<Dim> space;
  Problem<Dim> problem;
  Solution<Dim> solution;
  std::vector<double> indicators;
  std::vector<AdaptiveStep> steps;
  AdaptiveEnd end = AdaptiveEnd::tolerance_reached;
};

/// Solve, estimate (error_indicators()), mark (mark_elements()), refine (refine_locally()), beginning with the space of
/// the given discretisation. `problem_on` states the problem on a space's elements; `after_step` is called with what
/// there is after each solution (`end` means nothing then). Not to reach the tolerance is no error. Throws as
/// field_space(), solve() and `problem_on` do.
template <int Dim>
AdaptiveResult<Dim> solve_adaptively(const geometry::OrientedBoundary<Dim>& boundary,
                                     DiscretisationOptions<Dim> discretisation,
                                     const std::function<Problem<Dim>(const FieldSpace<Dim>&)>& problem_on,
                                     const AdaptiveOptions& options = {},
                                     const std::function<void(const AdaptiveResult<Dim>&)>& after_step = {});

}  // namespace isorim::solver
