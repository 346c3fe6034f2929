#include "solver/bem/adaptive_solution.h"

#include <optional>
#include <utility>

namespace isorim::solver {

namespace {

/// Solves on the result's space and notes the step.
template <int Dim>
void add_step(const std::function<Problem<Dim>(const FieldSpace<Dim>&)>& problem_on, const AdaptiveOptions& options,
              AdaptiveResult<Dim>& result) {
  result.problem = problem_on(result.space);
  result.solution = solve<Dim>(result.problem, result.space, options.solve);
  result.indicators = error_indicators<Dim>(result.problem, result.space, result.solution, options.estimate);
  const double size = solution_size<Dim>(result.problem, result.space, result.solution, options.estimate);
  const double total = total_indicator(result.indicators);
  result.steps.push_back({result.space.elements.size(), result.space.function_count(), result.solution.unknowns,
                          size > 0.0 ? total / size : total});
}

/// The next space; nothing, with the reason, if there is none within the limits.
template <int Dim>
std::optional<FieldSpace<Dim>> next_space(const geometry::OrientedBoundary<Dim>& boundary,
                                          const AdaptiveOptions& options, AdaptiveResult<Dim>& result,
                                          DiscretisationOptions<Dim>& discretisation) {
  const std::vector<int> marked = mark_elements(result.indicators, options.share);
  discretisation = refine_locally<Dim>(boundary, discretisation, result.space, marked);
  FieldSpace<Dim> finer = field_space<Dim>(boundary, discretisation);
  if (finer.elements.size() == result.space.elements.size()) {
    result.end = AdaptiveEnd::levels;
    return std::nullopt;
  }
  if (finer.function_count() * component_count(result.problem.equation) > options.max_unknowns) {
    result.end = AdaptiveEnd::unknowns;
    return std::nullopt;
  }
  return finer;
}

}  // namespace

template <int Dim>
AdaptiveResult<Dim> solve_adaptively(const geometry::OrientedBoundary<Dim>& boundary,
                                     DiscretisationOptions<Dim> discretisation,
                                     const std::function<Problem<Dim>(const FieldSpace<Dim>&)>& problem_on,
                                     const AdaptiveOptions& options,
                                     const std::function<void(const AdaptiveResult<Dim>&)>& after_step) {
  AdaptiveResult<Dim> result;
  result.space = field_space<Dim>(boundary, discretisation);
  while (true) {
    add_step(problem_on, options, result);
    if (after_step) after_step(result);
    if (result.steps.back().estimate <= options.tolerance) return result;
    if (static_cast<int>(result.steps.size()) >= options.max_steps) {
      result.end = AdaptiveEnd::steps;
      return result;
    }
    std::optional<FieldSpace<Dim>> finer = next_space(boundary, options, result, discretisation);
    if (!finer) return result;
    result.space = std::move(*finer);
  }
}

template AdaptiveResult<2> solve_adaptively(const geometry::OrientedBoundary<2>&, DiscretisationOptions<2>,
                                            const std::function<Problem<2>(const FieldSpace<2>&)>&,
                                            const AdaptiveOptions&,
                                            const std::function<void(const AdaptiveResult<2>&)>&);
template AdaptiveResult<3> solve_adaptively(const geometry::OrientedBoundary<3>&, DiscretisationOptions<3>,
                                            const std::function<Problem<3>(const FieldSpace<3>&)>&,
                                            const AdaptiveOptions&,
                                            const std::function<void(const AdaptiveResult<3>&)>&);

}  // namespace isorim::solver
