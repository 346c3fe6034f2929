#include "io/sweep/results.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/case/complaints.h"

namespace isorim::io {
namespace {

bool is_below(std::string_view name, std::string_view above) {
  return name.starts_with(above) && (name.size() == above.size() || name[above.size()] == '.');
}

/// Whether one of the parts of a dotted name is this.
bool has_part(std::string_view name, std::string_view part) {
  for (std::size_t at = name.find(part); at != std::string_view::npos; at = name.find(part, at + 1)) {
    const bool begins = at == 0 || name[at - 1] == '.';
    const bool ends = at + part.size() == name.size() || name[at + part.size()] == '.';
    if (begins && ends) return true;
  }
  return false;
}

/// What a table shows without being asked: nothing that differs from run to run, so that it is the same each time.
bool is_usual(const std::string& name) {
  if (is_below(name, "analysis")) return is_below(name, "analysis.unknowns") || is_below(name, "analysis.errors");
  for (const char* part : {"error", "evaluations", "seconds", "times", "timings", "sections"}) {
    if (has_part(name, part)) return false;
  }
  for (const char* section : {"geometry", "cad", "expectations", "threads"}) {
    if (is_below(name, section)) return false;
  }
  return true;
}

/// Every name that a record has, in the order in which they appear.
std::vector<std::string> recorded_names(const SweepResults& results) {
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const auto& [index, record] : results.records) {
    for (const auto& [name, value] : record.results) {
      if (known.insert(name).second) names.push_back(name);
    }
  }
  return names;
}

/// A name chooses itself and what stands below it, but not the error estimate of a quantity.
bool is_chosen(const std::string& name, const std::string& choice) {
  if (!is_below(name, choice)) return false;
  const std::string_view rest = std::string_view(name).substr(choice.size());
  return !is_below(rest, ".error") && !is_below(rest, ".evaluations");
}

std::vector<std::string> column_names(const SweepPlan& plan) {
  std::vector<std::string> names;
  for (const SweepColumn& column : plan.columns) names.push_back(column.name);
  return names;
}

void complain_unknown(const std::string& name, const KeyPlace& where, const std::vector<std::string>& known,
                      std::vector<std::string>& messages) {
  messages.push_back(
      fmt::format("{}: no case has the result \"{}\"{}", where.place.describe(), name, did_you_mean(name, known)));
}

}  // namespace

std::vector<std::size_t> SweepResults::share() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < plan->cases.size(); ++i) {
    if (shard.owns(i)) indices.push_back(i);
  }
  return indices;
}

std::vector<std::size_t> SweepResults::missing() const {
  std::vector<std::size_t> indices = share();
  std::erase_if(indices, [&](std::size_t index) { return find(index) != nullptr; });
  return indices;
}

const CaseRecord* SweepResults::find(std::size_t index) const {
  const auto found = records.find(index);
  return found == records.end() ? nullptr : &found->second;
}

SweepCounts count(const SweepResults& results) {
  SweepCounts counts;
  for (const std::size_t index : results.share()) {
    ++counts.cases;
    const CaseRecord* record = results.find(index);
    if (!record) continue;
    ++counts.finished;
    counts.failed += record->is_failed() ? 1 : 0;
    counts.expectations_met += record->expectations_met;
    counts.expectations_missed += record->expectations_missed;
  }
  return counts;
}

int exit_status(const SweepResults& results) {
  for (const int status : {2, 3, 1}) {
    const auto has_it = [&](const auto& entry) { return entry.second.exit_status == status; };
    if (std::ranges::any_of(results.records, has_it)) return status;
  }
  return 0;
}

std::vector<std::string> result_columns(const SweepResults& results) {
  const std::vector<std::string> names = recorded_names(results);
  const std::vector<std::string>& choices = results.plan->keys.output.results;
  std::vector<std::string> columns;
  if (choices.empty()) {
    std::ranges::copy_if(names, std::back_inserter(columns), is_usual);
    return columns;
  }
  for (const std::string& choice : choices) {
    for (const std::string& name : names) {
      if (is_chosen(name, choice) && std::ranges::find(columns, name) == columns.end()) columns.push_back(name);
    }
  }
  return columns;
}

std::string column_heading(const SweepPlan& plan, const std::string& result) {
  const bool taken = std::ranges::find(plan.columns, result, &SweepColumn::name) != plan.columns.end() ||
                     std::ranges::find(sweep_table_columns(), result) != sweep_table_columns().end();
  return taken ? "results." + result : result;
}

std::optional<double> column_value(const SweepResults& results, std::size_t index, const std::string& column) {
  const SweepPlan& plan = *results.plan;
  for (std::size_t c = 0; c < plan.columns.size(); ++c) {
    if (plan.columns[c].name == column) return as_number(plan.cases[index].values[c]);
  }
  const CaseRecord* record = results.find(index);
  if (!record) return std::nullopt;
  const std::string name = column.starts_with("results.") ? column.substr(8) : column;
  const auto found = std::ranges::find(record->results, name, [](const auto& result) { return result.first; });
  return found == record->results.end() ? std::nullopt : found->second;
}

std::vector<std::string> unknown_results(const SweepResults& results) {
  const std::vector<std::string> names = recorded_names(results);
  if (names.empty()) return {};
  std::vector<std::string> messages;
  const SweepKeys& keys = results.plan->keys;
  for (const std::string& choice : keys.output.results) {
    const bool found = std::ranges::any_of(names, [&](const std::string& name) { return is_chosen(name, choice); });
    if (!found) complain_unknown(choice, keys.output.where, names, messages);
  }
  std::vector<std::string> known = column_names(*results.plan);
  for (const std::string& name : names) known.push_back(column_heading(*results.plan, name));
  for (const SweepPlotKeys& plot : keys.plot) {
    std::vector<std::string> wanted = plot.y.items;
    wanted.push_back(plot.x);
    for (const std::string& name : wanted) {
      if (std::ranges::find(known, name) == known.end()) complain_unknown(name, plot.where, known, messages);
    }
  }
  return messages;
}

std::vector<std::string> write_sweep_files(const std::filesystem::path& folder, const SweepResults& results) {
  write_file(folder / "sweep.csv", sweep_csv(results));
  std::vector<std::string> messages = write_sweep_hdf5(folder / "sweep.h5", results, folder);
  write_collections(folder, results);
  write_plots(folder, results);
  for (std::string& message : unknown_results(results)) messages.push_back(std::move(message));
  write_file(folder / "sweep.json", sweep_json(results, folder));
  return messages;
}

}  // namespace isorim::io
