#include "io/analysis/analysis.h"

#include <chrono>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "geometry/errors.h"
#include "io/analysis/adaptive_analysis.h"
#include "io/analysis/boundary_integrals.h"
#include "io/analysis/points.h"
#include "io/analysis/sampling.h"
#include "io/analysis/solution_errors.h"
#include "io/case/analysis_checks.h"

namespace isorim::io {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

solver::SolveOptions solve_options(const CaseFile& file, const RunOptions& run) {
  solver::SolveOptions options;
  options.threads = run.threads;
  if (run.progress) options.progress = [report = run.progress](double fraction) { report("solve", fraction); };
  if (!file.keys.solve) return options;
  const SolveKeys& keys = *file.keys.solve;
  switch (keys.method) {
    case SolveMethodKind::automatic:
      options.method = solver::SolveMethod::automatic;
      break;
    case SolveMethodKind::dense:
      options.method = solver::SolveMethod::dense;
      break;
    case SolveMethodKind::compressed:
      options.method = solver::SolveMethod::compressed;
      break;
  }
  options.tolerance = keys.tolerance;
  options.max_iterations = keys.max_iterations;
  return options;
}

template <int Dim>
void evaluate_points(const CaseFile& file, const RunOptions& run, Analysis<Dim>& analysis) {
  AnalysisReport& report = analysis.report;
  report.probes = sample_probes(file, analysis.setting, analysis.solution, run.threads);
  report.grids = sample_grids(file, analysis.setting, analysis.solution, run.threads);
  for (const FieldSamples& samples : report.probes) {
    const std::size_t outside = samples.outside_count();
    if (outside == 0) continue;
    report.messages.push_back(fmt::format("probe \"{}\": {} of {} points lie outside the domain", samples.name, outside,
                                          samples.points.cols()));
  }
  for (const FieldSamples& samples : report.grids) {
    if (samples.outside_count() == samples.location.size())
      report.messages.push_back(fmt::format("grid \"{}\": all of its points lie outside the domain", samples.name));
  }
}

/// A dense matrix that the machine cannot hold is better refused than begun.
template <int Dim>
void check_memory(const CaseFile& file, const BoundaryValueProblem<Dim>& setting) {
  if (!file.keys.solve || file.keys.solve->method != SolveMethodKind::dense) return;
  const double unknowns = static_cast<double>(setting.space.function_count()) * component_count(file.keys, Dim);
  const double needed = 8.0 * unknowns * unknowns;
  const double present = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (needed < present) return;
  constexpr double gigabyte = 1024.0 * 1024.0 * 1024.0;
  throw InputError(fmt::format(
      "{}: {}: a dense matrix of {:g} unknowns takes {:.1f} GB; the machine has {:.1f} GB; expected method = "
      "\"compressed\" or fewer unknowns",
      file.keys.solve->where.place.describe(), file.keys.solve->where.path, unknowns, needed / gigabyte,
      present / gigabyte));
}

/// Bytes.
std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

template <int Dim>
void describe_solution(const CaseFile& file, Analysis<Dim>& analysis) {
  AnalysisReport& report = analysis.report;
  const solver::Solution<Dim>& solution = analysis.solution;
  report.equation = name_of(file.keys.analysis->equation, equation_names);
  report.exterior = file.keys.analysis->exterior;
  report.components = component_count(file.keys, Dim);
  report.elements = analysis.setting.space.table.elements.size();
  report.functions = static_cast<std::size_t>(analysis.setting.space.function_count());
  report.unknowns = solution.unknowns;
  report.method = solution.method;
  report.iterations = solution.iterations;
  report.residual = solution.residual;
  report.matrix_memory = solution.matrix_memory;
  report.at_infinity = solution.at_infinity;
  report.messages = analysis.setting.warnings;
  report.messages.insert(report.messages.end(), solution.messages.begin(), solution.messages.end());
}

/// A table of points and numbers, points in rows.
Quantity point_quantity(std::string name, const Eigen::MatrixXd& columns) {
  Entries entries{{}, static_cast<int>(columns.cols()), static_cast<int>(columns.rows())};
  entries.values.assign(columns.data(), columns.data() + columns.size());
  if (entries.rows == 1) std::swap(entries.rows, entries.columns);
  return {std::move(name), std::move(entries), {}, {}, {}, ""};
}

}  // namespace

template <int Dim>
Analysis<Dim> analyse(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary, const RunOptions& run) {
  Analysis<Dim> analysis;
  const Clock::time_point start = Clock::now();
  // What a file of points lacks should not be found out after the solution.
  for (const ProbeKeys& keys : file.keys.probe) probe_points(keys, Dim, file.path.parent_path());
  Clock::time_point discretised = start;
  if (adapt_keys(file.keys)) {
    solve_with_refinement(file, boundary, run, solve_options(file, run), analysis);
  } else {
    const ProblemStatement<Dim> statement(file, boundary);
    analysis.setting = statement.on(solver::field_space(boundary, statement.discretisation()));
    check_exact(file, analysis.setting.space);
    check_memory(file, analysis.setting);
    discretised = Clock::now();
    analysis.solution = solver::solve(analysis.setting.problem, analysis.setting.space, solve_options(file, run));
  }
  const Clock::time_point solved = Clock::now();
  describe_solution(file, analysis);
  evaluate_points(file, run, analysis);
  add_boundary_integrals(file, run, analysis);
  analysis.report.errors = solution_errors(file, analysis.setting, analysis.solution, analysis.report);
  analysis.report.discretise_time = std::chrono::duration<double>(discretised - start).count();
  analysis.report.solve_time = std::chrono::duration<double>(solved - discretised).count();
  analysis.report.evaluate_time = seconds_since(solved);
  analysis.report.peak_memory = peak_memory();
  return analysis;
}

std::vector<Quantity> expected_quantities(const AnalysisReport& report) {
  std::vector<Quantity> list;
  const auto add = [&](const std::string& name, double value) {
    list.push_back({name, single(value), {}, {}, {}, ""});
  };
  add("unknowns", static_cast<double>(report.unknowns));
  add("iterations", report.iterations);
  add("residual", report.residual);
  add("matrix_memory", static_cast<double>(report.matrix_memory));
  if (report.balance) add("balance", *report.balance);
  if (report.adaptive) {
    add("steps", static_cast<double>(report.adaptive->steps.size()));
    add("estimate", report.adaptive->steps.back().estimate);
  }
  for (const auto& [name, value] : report.errors) add(name, value);
  for (const FieldSamples& probe : report.probes) {
    list.push_back(point_quantity(probe.name + ".value", probe.value));
    list.push_back(point_quantity(probe.name + ".gradient", probe.gradient));
    if (!probe.is_elastic()) continue;
    list.push_back(point_quantity(probe.name + ".stress", probe.stress));
    list.push_back(point_quantity(probe.name + ".von_mises", probe.von_mises.transpose()));
    list.push_back(point_quantity(probe.name + ".principal", probe.principal));
  }
  for (const ConditionResult& condition : report.conditions) {
    const bool elastic = condition.moment.size() > 0;
    list.push_back(point_quantity(condition.name + (elastic ? ".force" : ".flux"), condition.flux));
    if (elastic) list.push_back(point_quantity(condition.name + ".moment", condition.moment));
  }
  return list;
}

template Analysis<2> analyse(const CaseFile&, const geometry::OrientedBoundary<2>&, const RunOptions&);
template Analysis<3> analyse(const CaseFile&, const geometry::OrientedBoundary<3>&, const RunOptions&);

}  // namespace isorim::io
