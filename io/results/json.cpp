#include "io/results/json.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/hydrostatics/added_mass_report.h"
#include "io/hydrostatics/hydrostatics_report.h"
#include "io/results/analysis_json.h"
#include "io/results/fit_json.h"
#include "io/results/hull_report.h"
#include "io/results/json_parts.h"
#include "io/results/propeller_report.h"
#include "io/results/section_json.h"

namespace isorim::io {
namespace {

Json optional_number(const std::optional<double>& x) {
  return x ? number(*x) : Json(nullptr);
}

Json entries_json(const Entries& entries) {
  if (entries.values.empty()) return nullptr;
  if (entries.rows == 1 && entries.columns == 1) return number(entries.values.front());
  Json list = Json::array();
  for (int i = 0; i < entries.rows; ++i) {
    if (entries.columns == 1) {
      list.push_back(number(entries.values[std::size_t(i)]));
      continue;
    }
    Json row = Json::array();
    for (int j = 0; j < entries.columns; ++j) {
      row.push_back(number(entries.values[std::size_t(i * entries.columns + j)]));
    }
    list.push_back(std::move(row));
  }
  return list;
}

Json quantity_json(const Quantity& quantity) {
  Json json;
  json["value"] = entries_json(quantity.value);
  json["error"] = quantity.error.empty()       ? Json(nullptr)
                  : quantity.error.size() == 1 ? number(quantity.error.front())
                                               : list_json(quantity.error);
  if (quantity.evaluations) json["evaluations"] = *quantity.evaluations;
  if (quantity.status) json["status"] = status_name(*quantity.status);
  if (!quantity.reason.empty()) json["reason"] = quantity.reason;
  return json;
}

Json quantities_json(const std::vector<Quantity>& quantities) {
  Json json = Json::object();
  for (const Quantity& quantity : quantities) json[quantity.name] = quantity_json(quantity);
  return json;
}

Json expectation_json(const ExpectationResult& result) {
  Json json;
  json["quantity"] = result.quantity;
  json["value"] = entries_json(result.value);
  json["expected"] = entries_json(result.expected);
  json["error"] = optional_number(result.error);
  json["difference"] = optional_number(result.difference);
  json["relative_difference"] = optional_number(result.relative_difference);
  json["rtol"] = number(result.rtol);
  json["atol"] = number(result.atol);
  json["met"] = result.met;
  return json;
}

Json expectations_json(const std::vector<ExpectationResult>& results) {
  Json list = Json::array();
  for (const ExpectationResult& result : results) list.push_back(expectation_json(result));
  return list;
}

}  // namespace

std::string to_json(const Report& report) {
  Json json;
  json["isorim"] = report.version;
  json["case"] = report.title;
  json["status"] = status_name(report.status);
  json["geometry"] = geometry_json(report.geometry, report.cad);
  if (report.cad) json["cad"] = cad_json(*report.cad);
  if (report.fit) json["fit"] = fit_json(*report.fit);
  if (report.hull) json["hull"] = hull_json(*report.hull, report.hull_quantities);
  if (report.propeller) json["propeller"] = propeller_json(*report.propeller, report.propeller_quantities);
  json["properties"] = quantities_json(report.properties);
  json["integrals"] = quantities_json(report.integrals);
  if (report.analysis) json["analysis"] = analysis_json(*report.analysis);
  if (report.sections) json["sections"] = sections_json(*report.sections);
  if (report.hydrostatics) json["hydrostatics"] = hydrostatics_json(*report.hydrostatics);
  if (report.added_mass) json["added_mass"] = added_mass_json(*report.added_mass);
  json["expectations"] = expectations_json(report.expectations);
  json["timings"] = {{"read", number(report.timings.read)},
                     {"integrate", number(report.timings.integrate)},
                     {"write", number(report.timings.write)}};
  json["threads"] = report.threads;
  json["warnings"] = report.warnings;
  json["resolved_case"] = report.resolved_case;
  return json_text(json);
}

void write_json(const std::filesystem::path& path, const Report& report) {
  write_file(path, to_json(report));
}

std::string verification_json(const std::vector<VerifiedCase>& cases) {
  Json list = Json::array();
  int worst = 0;
  for (const VerifiedCase& one : cases) {
    worst = std::max(worst, one.exit_status);
    Json json;
    json["file"] = one.file;
    json["case"] = one.title;
    json["status"] = one.failure.empty() ? Json(status_name(one.status)) : Json("failed");
    json["time"] = number(one.time);
    if (!one.failure.empty()) json["failure"] = one.failure;
    json["expectations"] = expectations_json(one.expectations);
    list.push_back(std::move(json));
  }
  Json json;
  json["isorim"] = program_version();
  json["status"] = worst == 0 ? "ok" : "failed";
  json["cases"] = std::move(list);
  return json_text(json);
}

}  // namespace isorim::io
