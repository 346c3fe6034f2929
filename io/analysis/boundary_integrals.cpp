#include "io/analysis/boundary_integrals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/analysis_checks.h"
#include "solver/bem/boundary_integrals.h"

namespace isorim::io {
namespace {

/// An integral of the case that names the solution.
template <int Dim>
class ResultFunction {
 public:
  ResultFunction(const CaseFile& file, const IntegralKeys& keys)
      : keys_(&keys),
        function_(compile_function(keys.integrand, result_names(file.keys.analysis->equation, Dim), Dim,
                                   file.definitions)()) {}

  void operator()(const quadrature::NodeView<Dim>& nodes, const solver::Densities& fields, std::span<double> values) {
    const Eigen::Index components = fields.potential.cols();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      variables_.clear();
      for (std::size_t d = 0; d < Dim; ++d) variables_.push_back(nodes.position[d][i]);
      for (std::size_t d = 0; d < Dim; ++d) variables_.push_back(nodes.normal[d][i]);
      for (Eigen::Index c = 0; c < components; ++c) variables_.push_back(fields.potential(row, c));
      for (Eigen::Index c = 0; c < components; ++c) variables_.push_back(fields.flux(row, c));
      values[i] = function_(variables_);
      if (!std::isfinite(values[i])) refuse(values[i]);
    }
  }

 private:
  [[noreturn]] void refuse(double value) const {
    throw NumericalError(fmt::format("{}: the integral \"{}\" of {} is {} at ({}); expected a finite number",
                                     keys_->where.place.describe(), keys_->name, keys_->integrand, value,
                                     fmt::join(variables_.begin(), variables_.begin() + Dim, ", ")));
  }

  const IntegralKeys* keys_;
  NamedFunction function_;
  std::vector<double> variables_;
};

template <int Dim>
void add_integrals(const CaseFile& file, const solver::EvaluationOptions& options, Analysis<Dim>& analysis) {
  const BoundaryValueProblem<Dim>& setting = analysis.setting;
  for (const IntegralKeys& keys : file.keys.integral) {
    if (!is_result_integral(file, keys, Dim)) continue;
    const double value = solver::integrate_fields<Dim>(
        setting.problem, setting.space, analysis.solution,
        [&]() -> solver::FieldFunction<Dim> { return ResultFunction<Dim>(file, keys); }, options);
    analysis.integrals.push_back({keys.name, single(value), {}, {}, {}, ""});
  }
}

/// Those of the solver's conditions together that one of the case's made.
template <int Dim>
std::vector<ConditionResult> condition_results(const CaseFile& file, const BoundaryValueProblem<Dim>& setting,
                                               const solver::ResultIntegrals<Dim>& integrals) {
  std::vector<ConditionResult> results;
  for (std::size_t i = 0; i < file.keys.boundary_condition.size(); ++i) {
    ConditionResult& result = results.emplace_back();
    result.name = condition_name(file.keys, i);
    result.kind = name_of(file.keys.boundary_condition[i].kind, boundary_kind_names);
    result.flux = Eigen::VectorXd::Zero(integrals.total.flux.size());
    result.moment = Eigen::VectorXd::Zero(integrals.total.moment.size());
  }
  for (std::size_t k = 0; k < setting.case_condition.size(); ++k) {
    ConditionResult& result = results[static_cast<std::size_t>(setting.case_condition[k])];
    result.elements += static_cast<int>(std::ranges::count(setting.problem.condition_of, static_cast<std::int32_t>(k)));
    result.measure += integrals.conditions[k].measure;
    result.flux += integrals.conditions[k].flux;
    result.moment += integrals.conditions[k].moment;
  }
  return results;
}

}  // namespace

template <int Dim>
void add_boundary_integrals(const CaseFile& file, const RunOptions& run, Analysis<Dim>& analysis) {
  const BoundaryValueProblem<Dim>& setting = analysis.setting;
  AnalysisReport& report = analysis.report;
  const solver::EvaluationOptions options{.threads = run.threads};
  const solver::ResultIntegrals<Dim> integrals = solver::result_integrals<Dim>(
      setting.problem, setting.space, analysis.solution, geometry::Point<Dim>::Zero(), options);
  report.conditions = condition_results(file, setting, integrals);
  report.load = integrals.load.force;
  if (!report.exterior) {
    const double magnitude = integrals.total.flux_magnitude;
    report.balance = integrals.force_imbalance.norm() / (magnitude > 0.0 ? magnitude : 1.0);
  }
  add_integrals(file, options, analysis);
}

template void add_boundary_integrals(const CaseFile&, const RunOptions&, Analysis<2>&);
template void add_boundary_integrals(const CaseFile&, const RunOptions&, Analysis<3>&);

}  // namespace isorim::io
