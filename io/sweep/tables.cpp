#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "io/results/json_parts.h"
#include "io/results/table.h"
#include "io/sweep/csv_rows.h"
#include "io/sweep/results.h"

/// Sweeps as text: sweep.csv, the summary, and the list of cases.
namespace isorim::io {
namespace {

std::string row_text(const std::vector<std::string>& fields) {
  std::vector<std::string> quoted;
  for (const std::string& field : fields) quoted.push_back(csv_field(field));
  return fmt::format("{}\n", fmt::join(quoted, ","));
}

/// On one line.
std::string flattened(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

/// The results of a case as fields, empty where it has none.
std::vector<std::string> result_fields(const CaseRecord* record, const std::vector<std::string>& columns) {
  std::unordered_map<std::string_view, double> values;
  if (record) {
    for (const auto& [name, value] : record->results) {
      if (value) values.emplace(name, *value);
    }
  }
  std::vector<std::string> fields;
  for (const std::string& column : columns) {
    const auto found = values.find(column);
    fields.push_back(found == values.end() ? "" : exact_number(found->second));
  }
  return fields;
}

Json failures_json(const SweepResults& results) {
  Json list = Json::array();
  for (const auto& [index, record] : results.records) {
    if (record.status == "ok") continue;
    list.push_back({{"case", index + 1},
                    {"parameters", results.plan->describe(index)},
                    {"status", record.status},
                    {"exit_status", record.exit_status},
                    {"message", record.message}});
  }
  return list;
}

Json numbers_json(const std::vector<std::size_t>& indices) {
  Json list = Json::array();
  for (const std::size_t index : indices) list.push_back(index + 1);
  return list;
}

Json value_json(const Value& value) {
  if (const auto* integer = value.as<std::int64_t>()) return *integer;
  if (const auto* boolean = value.as<bool>()) return *boolean;
  if (const auto* real = value.as<double>()) return number(*real);
  return plain_text(value);
}

}  // namespace

std::string sweep_csv(const SweepResults& results) {
  const SweepPlan& plan = *results.plan;
  const std::vector<std::string> columns = result_columns(results);
  std::vector<std::string> headings{"case"};
  for (const SweepColumn& column : plan.columns) headings.push_back(column.name);
  for (const char* heading : {"status", "exit_status", "expectations_met", "expectations_missed"}) {
    headings.emplace_back(heading);
  }
  for (const std::string& column : columns) headings.push_back(column_heading(plan, column));
  headings.emplace_back("message");
  std::string text = row_text(headings);
  for (const std::size_t index : results.share()) {
    const CaseRecord* record = results.find(index);
    std::vector<std::string> fields{std::to_string(index + 1)};
    for (const Value& value : plan.cases[index].values) fields.push_back(plain_text(value));
    fields.push_back(record ? record->status : "missing");
    fields.push_back(record ? std::to_string(record->exit_status) : "");
    fields.push_back(record ? std::to_string(record->expectations_met) : "");
    fields.push_back(record ? std::to_string(record->expectations_missed) : "");
    for (std::string& field : result_fields(record, columns)) fields.push_back(std::move(field));
    fields.push_back(record ? flattened(record->message) : "");
    text += row_text(fields);
  }
  return text;
}

std::string sweep_json(const SweepResults& results, const std::filesystem::path& folder) {
  const SweepCounts counts = count(results);
  double seconds = 0.0;
  for (const auto& [index, record] : results.records) seconds += record.seconds;
  Json json;
  json["isorim"] = program_version();
  json["sweep"] = results.plan->title();
  json["status"] = counts.finished < counts.cases ? "incomplete" : exit_status(results) == 0 ? "ok" : "failed";
  json["exit_status"] = exit_status(results);
  json["shard"] = results.shard.text();
  json["folder"] = folder.string();
  json["cases"] = counts.cases;
  json["finished"] = counts.finished;
  json["failed"] = counts.failed;
  json["expectations"] = {{"met", counts.expectations_met}, {"missed", counts.expectations_missed}};
  json["seconds"] = number(seconds);
  json["missing"] = numbers_json(results.missing());
  json["not_ok"] = failures_json(results);
  return json_text(json);
}

std::string plan_text(const SweepPlan& plan, const Shard& shard) {
  std::vector<TextTable::Column> headings{{"case", Align::right}};
  for (const SweepColumn& column : plan.columns) headings.push_back({column.name, Align::right});
  TextTable table(std::move(headings));
  std::size_t count = 0;
  for (std::size_t i = 0; i < plan.cases.size(); ++i) {
    if (!shard.owns(i)) continue;
    ++count;
    std::vector<std::string> cells{std::to_string(i + 1)};
    for (const Value& value : plan.cases[i].values) cells.push_back(plain_text(value));
    table.add_row(std::move(cells));
  }
  const std::string of_all = shard.is_everything() ? "" : fmt::format(" of {}", plan.cases.size());
  return fmt::format("{}\n{}\n  {}{} cases\n", plan.title(), table.text(2), count, of_all);
}

std::string plan_json(const SweepPlan& plan, const Shard& shard) {
  Json list = Json::array();
  for (std::size_t i = 0; i < plan.cases.size(); ++i) {
    if (!shard.owns(i)) continue;
    Json values = Json::object();
    for (std::size_t c = 0; c < plan.columns.size(); ++c) {
      values[plan.columns[c].name] = value_json(plan.cases[i].values[c]);
    }
    list.push_back({{"case", i + 1}, {"values", std::move(values)}});
  }
  Json json;
  json["isorim"] = program_version();
  json["sweep"] = plan.title();
  json["shard"] = shard.text();
  json["cases"] = std::move(list);
  return json_text(json);
}

}  // namespace isorim::io
