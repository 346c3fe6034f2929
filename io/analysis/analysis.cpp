#include "io/analysis/analysis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <sys/resource.h>

#include "geometry/errors.h"
#include "io/analysis/boundary_integrals.h"
#include "io/analysis/points.h"
#include "io/analysis/solution_errors.h"
#include "io/case/analysis_checks.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/stress.h"

namespace isorim::io {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string equation_name(EquationKind equation) {
  switch (equation) {
    case EquationKind::laplace:
      return "laplace";
    case EquationKind::poisson:
      return "poisson";
    case EquationKind::elasticity:
      break;
  }
  return "elasticity";
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

/// xx, yy, zz, xy[, yz, xz]: in the plane the last two vanish.
template <int Dim>
Eigen::VectorXd stress_entries(const Eigen::Matrix3d& s) {
  if constexpr (Dim == 2) return Eigen::Vector4d(s(0, 0), s(1, 1), s(2, 2), s(0, 1));
  Eigen::VectorXd entries(6);
  entries << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
  return entries;
}

template <int Dim>
void store(const solver::PointEvaluation<Dim>& found, Eigen::Index i, FieldSamples& samples) {
  samples.location[static_cast<std::size_t>(i)] = found.location == solver::Location::inside        ? 1
                                                  : found.location == solver::Location::on_boundary ? 0
                                                                                                    : -1;
  if (found.location == solver::Location::outside) return;
  samples.value.col(i) = found.field.value;
  const Eigen::Index components = found.field.gradient.rows();
  for (Eigen::Index c = 0; c < components; ++c) {
    samples.gradient.col(i).segment(c * Dim, Dim) = found.field.gradient.row(c).transpose();
  }
  if (!samples.is_elastic()) return;
  const Eigen::Matrix3d stress = full_stress(found.field);
  samples.stress.col(i) = stress_entries<Dim>(stress);
  samples.von_mises[i] = solver::von_mises(stress);
  samples.principal.col(i) = solver::principal_stresses(stress).reverse();
}

template <int Dim>
FieldSamples sample_points(const Analysis<Dim>& analysis, std::string name, const Eigen::MatrixXd& points,
                           int threads) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Index count = points.cols();
  const int components = analysis.report.components;
  const Eigen::Index stress_rows = analysis.report.equation == "elasticity" ? (Dim == 2 ? 4 : 6) : 0;
  FieldSamples samples;
  samples.name = std::move(name);
  samples.points = points;
  samples.location.resize(static_cast<std::size_t>(count));
  samples.value = Eigen::MatrixXd::Constant(components, count, none);
  samples.gradient = Eigen::MatrixXd::Constant(Eigen::Index{components} * Dim, count, none);
  samples.stress = Eigen::MatrixXd::Constant(stress_rows, count, none);
  if (stress_rows > 0) {
    samples.von_mises = Eigen::VectorXd::Constant(count, none);
    samples.principal = Eigen::MatrixXd::Constant(3, count, none);
  }
  const geometry::Points<Dim> places = points;
  const std::vector<solver::PointEvaluation<Dim>> found = solver::evaluate_at<Dim>(
      analysis.setting.problem, analysis.setting.space, analysis.solution, places, {.threads = threads});
  for (Eigen::Index i = 0; i < count; ++i) store(found[static_cast<std::size_t>(i)], i, samples);
  return samples;
}

template <int Dim>
void evaluate_points(const CaseFile& file, const RunOptions& run, Analysis<Dim>& analysis) {
  for (const ProbeKeys& keys : file.keys.probe) {
    const Eigen::MatrixXd points = probe_points(keys, Dim, file.path.parent_path());
    analysis.report.probes.push_back(sample_points(analysis, keys.name, points, run.threads));
    FieldSamples& samples = analysis.report.probes.back();
    samples.is_line = keys.from.has_value();
    if (const std::size_t outside = samples.outside_count(); outside > 0) {
      analysis.report.messages.push_back(fmt::format("probe \"{}\": {} of {} points lie outside the domain", keys.name,
                                                     outside, samples.points.cols()));
    }
  }
  for (const GridKeys& keys : file.keys.grid) {
    const ImageShape shape = grid_shape(keys, Dim);
    analysis.report.grids.push_back(sample_points(analysis, keys.name, grid_points(shape, Dim), run.threads));
    analysis.report.grids.back().image = shape;
  }
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
  report.equation = equation_name(file.keys.analysis->equation);
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

std::size_t FieldSamples::outside_count() const {
  return static_cast<std::size_t>(std::count(location.begin(), location.end(), static_cast<signed char>(-1)));
}

template <int Dim>
Analysis<Dim> analyse(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary, const RunOptions& run) {
  Analysis<Dim> analysis;
  const Clock::time_point start = Clock::now();
  analysis.setting = boundary_value_problem(file, boundary);
  const Clock::time_point discretised = Clock::now();
  analysis.solution = solver::solve(analysis.setting.problem, analysis.setting.space, solve_options(file, run));
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
