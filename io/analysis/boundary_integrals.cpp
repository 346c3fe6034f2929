#include "io/analysis/boundary_integrals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/analysis/boundary_field.h"
#include "io/case/analysis_checks.h"

namespace isorim::io {
namespace {

std::string kind_name(BoundaryKind kind) {
  switch (kind) {
    case BoundaryKind::value:
      return "value";
    case BoundaryKind::flux:
      return "flux";
    case BoundaryKind::robin:
      return "robin";
    case BoundaryKind::displacement:
      return "displacement";
    case BoundaryKind::traction:
      return "traction";
    case BoundaryKind::foundation:
      return "foundation";
    case BoundaryKind::symmetry:
      break;
  }
  return "symmetry";
}

template <int Dim>
geometry::Point<Dim> position_of(const quadrature::NodeView<Dim>& nodes, std::size_t i) {
  geometry::Point<Dim> position;
  for (int d = 0; d < Dim; ++d) position[d] = nodes.position[std::size_t(d)][i];
  return position;
}

Eigen::VectorXd moment_of(const geometry::Point2& x, const Eigen::VectorXd& t) {
  return Eigen::VectorXd::Constant(1, x.x() * t[1] - x.y() * t[0]);
}
Eigen::VectorXd moment_of(const geometry::Point3& x, const Eigen::VectorXd& t) {
  return x.cross(Eigen::Vector3d(t));
}

template <int Dim>
std::vector<ConditionResult> empty_results(const CaseFile& file, int components) {
  std::vector<ConditionResult> results;
  const bool elastic = file.keys.analysis->equation == EquationKind::elasticity;
  for (std::size_t i = 0; i < file.keys.boundary_condition.size(); ++i) {
    ConditionResult result;
    result.name = condition_name(file.keys, i);
    result.kind = kind_name(file.keys.boundary_condition[i].kind);
    result.flux = Eigen::VectorXd::Zero(components);
    result.moment = Eigen::VectorXd::Zero(elastic ? (Dim == 2 ? 1 : 3) : 0);
    results.push_back(std::move(result));
  }
  return results;
}

/// Integrals of the case that name the solution.
template <int Dim>
class ResultIntegrals {
 public:
  explicit ResultIntegrals(const CaseFile& file) : path_(file.path.string()) {
    for (const IntegralKeys& keys : file.keys.integral) {
      if (!is_result_integral(file, keys, Dim)) continue;
      keys_.push_back(&keys);
      functions_.push_back(
          compile_function(keys.integrand, result_names(file.keys.analysis->equation, Dim), Dim, file.definitions)());
      sums_.push_back(0.0);
    }
  }

  void add(const BoundarySample<Dim>& sample) {
    if (functions_.empty()) return;
    const Eigen::Index components = sample.value.rows();
    std::vector<double> variables(static_cast<std::size_t>(2 * Dim + 2 * components));
    for (std::size_t i = 0; i < sample.nodes.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      for (std::size_t d = 0; d < Dim; ++d) {
        variables[d] = sample.nodes.position[d][i];
        variables[Dim + d] = sample.nodes.normal[d][i];
      }
      for (Eigen::Index c = 0; c < components; ++c) {
        variables[static_cast<std::size_t>(2 * Dim + c)] = sample.true_value(c, column);
        variables[static_cast<std::size_t>(2 * Dim + components + c)] = sample.true_flux(c, column);
      }
      for (std::size_t k = 0; k < functions_.size(); ++k) {
        const double value = functions_[k](variables);
        if (!std::isfinite(value)) refuse(k, position_of(sample.nodes, i), value);
        sums_[k] += sample.nodes.weight[i] * value;
      }
    }
  }

  std::vector<Quantity> quantities() const {
    std::vector<Quantity> list;
    for (std::size_t k = 0; k < keys_.size(); ++k) list.push_back({keys_[k]->name, single(sums_[k]), {}, {}, {}, ""});
    return list;
  }

 private:
  [[noreturn]] void refuse(std::size_t k, const geometry::Point<Dim>& place, double value) const {
    throw NumericalError(fmt::format("{}: the integral \"{}\" of {} is {} at ({}); expected a finite number",
                                     keys_[k]->where.place.describe(), keys_[k]->name, keys_[k]->integrand, value,
                                     fmt::join(place.begin(), place.end(), ", ")));
  }

  std::string path_;
  std::vector<const IntegralKeys*> keys_;
  std::vector<NamedFunction> functions_;
  std::vector<double> sums_;
};

}  // namespace

template <int Dim>
void add_boundary_integrals(const CaseFile& file, const RunOptions& run, Analysis<Dim>& analysis) {
  const BoundaryValueProblem<Dim>& setting = analysis.setting;
  AnalysisReport& report = analysis.report;
  const quadrature::TargetRules<Dim> rules = sampling_rules(setting.space);
  BoundarySampler<Dim> sampler(setting.problem, setting.space, analysis.solution, rules);
  ResultIntegrals<Dim> integrals(file);
  report.conditions = empty_results<Dim>(file, report.components);
  double magnitude = 0.0;
  Eigen::VectorXd total = Eigen::VectorXd::Zero(report.components);
  for (std::size_t e = 0; e < setting.space.table.elements.size(); ++e) {
    const BoundarySample<Dim>& sample = sampler.sample(static_cast<int>(e));
    const auto condition = static_cast<std::size_t>(setting.problem.condition_of[e]);
    ConditionResult& result = report.conditions[static_cast<std::size_t>(setting.case_condition[condition])];
    ++result.elements;
    for (std::size_t i = 0; i < sample.nodes.size(); ++i) {
      const Eigen::VectorXd flux = sample.true_flux.col(static_cast<Eigen::Index>(i));
      const double weight = sample.nodes.weight[i];
      result.measure += weight;
      result.flux += weight * flux;
      if (result.moment.size() > 0) result.moment += weight * moment_of(position_of(sample.nodes, i), flux);
      magnitude += weight * flux.norm();
    }
    integrals.add(sample);
  }
  analysis.integrals = integrals.quantities();
  for (const ConditionResult& result : report.conditions) total += result.flux;
  report.load = Eigen::VectorXd::Zero(report.components);
  if (!setting.problem.loads.empty()) {
    report.load = solver::load_resultant(setting.problem.loads, setting.space.table,
                                         geometry::Point<Dim>::Zero().eval(), 1e-12, run.threads)
                      .force;
  }
  const double rest = (total + report.load).norm();
  if (!report.exterior) report.balance = magnitude > 0.0 ? rest / magnitude : rest;
}

template void add_boundary_integrals(const CaseFile&, const RunOptions&, Analysis<2>&);
template void add_boundary_integrals(const CaseFile&, const RunOptions&, Analysis<3>&);

}  // namespace isorim::io
