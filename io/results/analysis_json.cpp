#include "io/results/analysis_json.h"

#include <cstddef>

namespace isorim::io {
namespace {

Json vector_json(const Eigen::VectorXd& values) {
  Json list = Json::array();
  for (const double x : values) list.push_back(number(x));
  return list;
}

/// One entry a column: a number if there is one row, else a list.
Json columns_json(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() == 1) return vector_json(matrix.row(0).transpose());
  Json list = Json::array();
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) list.push_back(vector_json(matrix.col(i)));
  return list;
}

/// One entry a point: the gradient of a potential as a list, that of a displacement as rows.
Json gradients_json(const FieldSamples& samples) {
  const Eigen::Index dim = samples.points.rows();
  const Eigen::Index components = samples.value.rows();
  if (components == 1) return columns_json(samples.gradient);
  Json list = Json::array();
  for (Eigen::Index i = 0; i < samples.gradient.cols(); ++i) {
    Json rows = Json::array();
    for (Eigen::Index c = 0; c < components; ++c) {
      rows.push_back(vector_json(samples.gradient.col(i).segment(c * dim, dim)));
    }
    list.push_back(std::move(rows));
  }
  return list;
}

Json probe_json(const FieldSamples& samples) {
  Json json;
  json["points"] = columns_json(samples.points);
  Json& locations = json["location"] = Json::array();
  for (const signed char location : samples.location) {
    locations.push_back(location > 0 ? "inside" : location == 0 ? "boundary" : "outside");
  }
  json["value"] = columns_json(samples.value);
  json["gradient"] = gradients_json(samples);
  if (!samples.is_elastic()) return json;
  json["stress_components"] =
      samples.stress.rows() == 4 ? Json{"xx", "yy", "zz", "xy"} : Json{"xx", "yy", "zz", "xy", "yz", "xz"};
  json["stress"] = columns_json(samples.stress);
  json["von_mises"] = vector_json(samples.von_mises);
  json["principal"] = columns_json(samples.principal);
  return json;
}

/// The values of a grid are in its own file.
Json grid_json(const FieldSamples& samples) {
  Json json;
  json["file"] = grid_file_name(samples);
  json["counts"] = samples.image->counts;
  json["outside"] = samples.outside_count();
  return json;
}

Json condition_json(const ConditionResult& result) {
  Json json;
  const bool elastic = result.moment.size() > 0;
  json["kind"] = result.kind;
  json["elements"] = result.elements;
  json["measure"] = number(result.measure);
  if (elastic) {
    json["force"] = vector_json(result.flux);
    json["moment"] = vector_json(result.moment);
  } else {
    json["flux"] = number(result.flux[0]);
  }
  return json;
}

Json errors_json(const std::vector<std::pair<std::string, double>>& errors) {
  Json json = Json::object();
  for (const auto& [name, value] : errors) json[name] = number(value);
  return json;
}

Json adaptive_json(const AdaptiveHistory& history) {
  Json json;
  json["tolerance"] = number(history.tolerance);
  json["reached"] = history.is_reached();
  json["end"] = history.end;
  Json& steps = json["steps"] = Json::array();
  for (const AdaptiveStepResult& step : history.steps) {
    steps.push_back({{"elements", step.elements},
                     {"functions", step.functions},
                     {"unknowns", step.unknowns},
                     {"estimate", number(step.estimate)},
                     {"errors", errors_json(step.errors)},
                     {"seconds", number(step.seconds)}});
  }
  return json;
}

}  // namespace

Json analysis_json(const AnalysisReport& report) {
  Json json;
  json["equation"] = report.equation;
  json["exterior"] = report.exterior;
  json["elements"] = report.elements;
  json["functions"] = report.functions;
  json["unknowns"] = report.unknowns;
  json["method"] = report.method;
  json["iterations"] = report.iterations;
  json["residual"] = number(report.residual);
  json["matrix_memory"] = report.matrix_memory;
  json["peak_memory"] = report.peak_memory;
  if (report.adaptive) json["adaptive"] = adaptive_json(*report.adaptive);
  json["errors"] = errors_json(report.errors);
  Json& conditions = json["boundary_conditions"] = Json::object();
  for (const ConditionResult& result : report.conditions) conditions[result.name] = condition_json(result);
  json["load"] = report.components == 1 && report.load.size() == 1 ? number(report.load[0]) : vector_json(report.load);
  json["balance"] = report.balance ? number(*report.balance) : Json(nullptr);
  if (report.at_infinity.size() > 0 && report.exterior) json["at_infinity"] = vector_json(report.at_infinity);
  Json& probes = json["probes"] = Json::object();
  for (const FieldSamples& samples : report.probes) probes[samples.name] = probe_json(samples);
  Json& grids = json["grids"] = Json::object();
  for (const FieldSamples& samples : report.grids) grids[samples.name] = grid_json(samples);
  json["messages"] = report.messages;
  json["times"] = {{"discretise", number(report.discretise_time)},
                   {"solve", number(report.solve_time)},
                   {"evaluate", number(report.evaluate_time)}};
  return json;
}

}  // namespace isorim::io
