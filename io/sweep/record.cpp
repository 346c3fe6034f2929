#include "io/sweep/record.h"

#include <algorithm>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/results/json.h"
#include "io/results/json_parts.h"

namespace isorim::io {
namespace {

using Results = std::vector<std::pair<std::string, std::optional<double>>>;

/// Whether one name is the other or stands below it.
bool is_below(std::string_view name, std::string_view above) {
  return name.starts_with(above) && (name.size() == above.size() || name[above.size()] == '.');
}

class Flattener {
 public:
  Flattener(const std::vector<std::string>& chosen, Results& results) : chosen_(chosen), results_(results) {}

  void add(const Json& json, const std::string& name) {
    if (json.is_number()) {
      results_.emplace_back(name, json.get<double>());
    } else if (json.is_boolean()) {
      results_.emplace_back(name, json.get<bool>() ? 1.0 : 0.0);
    } else if (json.is_null()) {
      results_.emplace_back(name, std::nullopt);
    } else if (json.is_object()) {
      for (const auto& [key, value] : json.items()) add(value, name.empty() ? key : fmt::format("{}.{}", name, key));
    } else if (json.is_array()) {
      add_list(json, name);
    }
  }

  /// Of a property or integral.
  void add_quantity(const Json& json, const std::string& name) {
    for (const auto& [key, value] : json.items()) add(value, key == "value" ? name : fmt::format("{}.{}", name, key));
  }

 private:
  void add_list(const Json& json, const std::string& name) {
    constexpr std::size_t most = 16;
    const bool wanted = json.size() <= most || std::ranges::any_of(chosen_, [&](const std::string& choice) {
                          return is_below(name, choice) || is_below(choice, name);
                        });
    if (!wanted) return;
    for (std::size_t i = 0; i < json.size(); ++i) add(json[i], fmt::format("{}.{}", name, i));
  }

  const std::vector<std::string>& chosen_;
  Results& results_;
};

template <class T>
T member(const Json& json, const char* name) {
  return json.at(name).get<T>();
}

}  // namespace

Results flat_results(const Report& report, const std::vector<std::string>& chosen) {
  const Json json = Json::parse(to_json(report));
  Results results;
  Flattener flattener(chosen, results);
  for (const auto& [key, value] : json.items()) {
    if (key == "properties" || key == "integrals") {
      for (const auto& [name, quantity] : value.items()) flattener.add_quantity(quantity, name);
    } else {
      flattener.add(value, key);
    }
  }
  return results;
}

std::string record_json(const CaseRecord& record) {
  Json json;
  json["case"] = record.index + 1;
  json["status"] = record.status;
  json["exit_status"] = record.exit_status;
  json["message"] = record.message;
  json["expectations"] = {{"met", record.expectations_met}, {"missed", record.expectations_missed}};
  json["seconds"] = number(record.seconds);
  json["peak_memory"] = record.peak_memory;
  json["folder"] = record.folder;
  json["files"] = record.files;
  Json& results = json["results"] = Json::object();
  for (const auto& [name, value] : record.results) results[name] = value ? number(*value) : Json(nullptr);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

CaseRecord parse_record(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    CaseRecord record;
    record.index = member<std::size_t>(json, "case") - 1;
    record.status = member<std::string>(json, "status");
    record.exit_status = member<int>(json, "exit_status");
    record.message = member<std::string>(json, "message");
    record.expectations_met = member<int>(json.at("expectations"), "met");
    record.expectations_missed = member<int>(json.at("expectations"), "missed");
    record.seconds = member<double>(json, "seconds");
    record.peak_memory = member<std::int64_t>(json, "peak_memory");
    record.folder = member<std::string>(json, "folder");
    record.files = member<std::vector<std::string>>(json, "files");
    for (const auto& [name, value] : json.at("results").items()) {
      record.results.emplace_back(name, value.is_null() ? std::nullopt : std::optional(value.get<double>()));
    }
    return record;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("found no record of a case: {}", error.what()));
  }
}

}  // namespace isorim::io
