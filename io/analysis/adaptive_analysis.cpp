#include "io/analysis/adaptive_analysis.h"

#include <chrono>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "io/analysis/sampling.h"
#include "io/analysis/solution_errors.h"
#include "io/case/analysis_checks.h"
#include "solver/bem/adaptive_solution.h"

namespace isorim::io {
namespace {

using Clock = std::chrono::steady_clock;

std::string end_name(solver::AdaptiveEnd end) {
  switch (end) {
    case solver::AdaptiveEnd::tolerance_reached:
      return "tolerance_reached";
    case solver::AdaptiveEnd::steps:
      return "max_steps";
    case solver::AdaptiveEnd::unknowns:
      return "max_unknowns";
    case solver::AdaptiveEnd::levels:
      break;
  }
  return "max_levels";
}

/// Why the tolerance is not reached, and what to do about it.
std::string shortfall(solver::AdaptiveEnd end, const AdaptKeys& keys, const AdaptiveHistory& history) {
  const auto text = [&](const std::string& reason) {
    return fmt::format(
        "adapt: the estimate of the relative error is {:.2g} after {} steps with {} unknowns; the "
        "tolerance {:g} is not reached: {}",
        history.steps.back().estimate, history.steps.size(), history.steps.back().unknowns, keys.tolerance, reason);
  };
  switch (end) {
    case solver::AdaptiveEnd::tolerance_reached:
      return "";
    case solver::AdaptiveEnd::steps:
      return text(fmt::format("max_steps = {}", keys.max_steps));
    case solver::AdaptiveEnd::unknowns:
      return text(fmt::format("the next step would have more than max_unknowns = {}", keys.max_unknowns));
    case solver::AdaptiveEnd::levels:
      break;
  }
  return text("the elements with the largest errors cannot be bisected any more");
}

/// Against [exact], if there is one: on the boundary and at the probes.
template <int Dim>
std::vector<std::pair<std::string, double>> step_errors(const CaseFile& file, const BoundaryValueProblem<Dim>& setting,
                                                        const solver::Solution<Dim>& solution, int threads) {
  if (!file.keys.exact) return {};
  AnalysisReport report;
  report.probes = sample_probes(file, setting, solution, threads);
  return solution_errors(file, setting, solution, report);
}

}  // namespace

template <int Dim>
void solve_with_refinement(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary, const RunOptions& run,
                           const solver::SolveOptions& solve_options, Analysis<Dim>& analysis) {
  const AdaptKeys& keys = *adapt_keys(file.keys);
  const ProblemStatement<Dim> statement(file, boundary);
  AdaptiveHistory& history = analysis.report.adaptive.emplace();
  history.tolerance = keys.tolerance;
  solver::AdaptiveOptions options;
  options.solve = solve_options;
  if (run.progress) {
    options.solve.progress = [&run, &history](double fraction) {
      run.progress(fmt::format("step {}", history.steps.size() + 1), fraction);
    };
  }
  options.estimate = {.tolerance = solve_options.tolerance, .threads = solve_options.threads};
  options.tolerance = keys.tolerance;
  options.max_unknowns = keys.max_unknowns;
  options.max_steps = keys.max_steps;
  options.share = keys.fraction;
  Clock::time_point start = Clock::now();
  std::vector<std::string> warnings;
  const auto problem_on = [&](const solver::FieldSpace<Dim>& space) {
    analysis.setting = statement.on(space);
    // Of the first step: they speak of elements as the case divides them.
    if (history.steps.empty()) {
      warnings = analysis.setting.warnings;
      check_exact(file, space);
    }
    return analysis.setting.problem;
  };
  const auto after_step = [&](const solver::AdaptiveResult<Dim>& result) {
    const solver::AdaptiveStep& step = result.steps.back();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    history.steps.push_back({step.elements, static_cast<std::size_t>(step.functions), step.unknowns, step.estimate,
                             step_errors(file, analysis.setting, result.solution, run.threads), seconds});
    start = Clock::now();
  };
  solver::AdaptiveResult<Dim> result =
      solver::solve_adaptively<Dim>(boundary, statement.discretisation(), problem_on, options, after_step);
  analysis.setting.warnings = std::move(warnings);
  analysis.solution = std::move(result.solution);
  history.end = end_name(result.end);
  history.shortfall = shortfall(result.end, keys, history);
}

template void solve_with_refinement(const CaseFile&, const geometry::OrientedBoundary<2>&, const RunOptions&,
                                    const solver::SolveOptions&, Analysis<2>&);
template void solve_with_refinement(const CaseFile&, const geometry::OrientedBoundary<3>&, const RunOptions&,
                                    const solver::SolveOptions&, Analysis<3>&);

}  // namespace isorim::io
