#include "io/sweep/plan.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/case_file.h"
#include "io/case/value_edit.h"
#include "io/expression.h"
#include "io/expression_names.h"
#include "io/file_bytes.h"
#include "io/sweep/axes.h"

namespace isorim::io {
namespace {

bool is_plain_name(const std::string& name) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  return !name.empty() && letter(name.front()) && std::ranges::all_of(name, [&](char c) {
    return letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
}

/// A name must be usable in expressions, and the columns must be told apart.
void check_name(const SweepColumn& column, const std::vector<SweepColumn>& before, Complaints& complaints) {
  if (!is_plain_name(column.name)) {
    complaints.add(column.where,
                   fmt::format("found the name \"{}\"; expected letters, digits and _, a letter first", column.name));
    return;
  }
  if (std::ranges::find(sweep_table_columns(), column.name) != sweep_table_columns().end()) {
    complaints.add(column.where,
                   fmt::format("the name \"{}\" is a column of every table; give another as \"name\"", column.name));
  }
  if (const std::string meaning = constant_or_function(column.name); !meaning.empty()) {
    complaints.add(column.where,
                   fmt::format("the name \"{}\" is {} of expressions; expected another", column.name, meaning));
  }
  for (const SweepColumn& other : before) {
    if (other.name == column.name) {
      complaints.add(column.where, fmt::format("the name \"{}\" is taken; give another as \"name\"", column.name));
    }
    if (!column.key.empty() && other.key == column.key) {
      complaints.add(column.where, fmt::format("the key \"{}\" is set by \"{}\" already", column.key, other.name));
    }
  }
}

/// The columns that are numbers in every case, with their numbers.
struct NumberColumns {
  std::vector<std::string> names;
  std::vector<std::size_t> columns;
};

NumberColumns number_columns(const SweepPlan& plan) {
  NumberColumns result;
  for (std::size_t c = 0; c < plan.columns.size(); ++c) {
    const auto is_number = [&](const SweepCase& one) { return as_number(one.values[c]).has_value(); };
    if (!std::ranges::all_of(plan.cases, is_number)) continue;
    result.names.push_back(plan.columns[c].name);
    result.columns.push_back(c);
  }
  return result;
}

/// Whole numbers as integers, which keys for reals take too.
Value derived_value(double number, const Place& place) {
  if (number == std::round(number) && std::abs(number) < 1e15) return {static_cast<std::int64_t>(number), place};
  return {number, place};
}

void add_derived(SweepPlan& plan, const DerivedKeys& derived, Complaints& complaints) {
  SweepColumn column{derived.name.empty() ? name_of_key(derived.key) : derived.name, derived.key, true, derived.where};
  check_name(column, plan.columns, complaints);
  const NumberColumns known = number_columns(plan);
  const KeyPlace where = derived.where.key("expression", derived.where.place);
  try {
    const NamedFunction function = compile_function(derived.expression, known.names, 0)();
    std::vector<double> numbers(known.names.size());
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        numbers[k] = *as_number(plan.cases[i].values[known.columns[k]]);
      }
      const double value = function(numbers);
      if (!std::isfinite(value)) {
        complaints.add(where, fmt::format("found {} for {}; expected a finite number", value, plan.describe(i)));
        break;
      }
      plan.cases[i].values.push_back(derived_value(value, derived.where.place));
    }
  } catch (const InputError& error) {
    complaints.add(where, error.what());
  }
  plan.columns.push_back(std::move(column));
}

/// What makes two cases the same: the values of their keys, integers and reals alike.
std::string fingerprint(const SweepPlan& plan, const SweepCase& one) {
  std::string text;
  for (std::size_t c = 0; c < plan.columns.size(); ++c) {
    if (plan.columns[c].key.empty()) continue;
    const auto* integer = one.values[c].as<std::int64_t>();
    text += (integer ? inline_toml({static_cast<double>(*integer), {}}) : inline_toml(one.values[c])) + '\n';
  }
  return text;
}

void check_duplicates(const SweepPlan& plan, Complaints& complaints) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < plan.cases.size(); ++i) {
    const auto [found, is_new] = seen.emplace(fingerprint(plan, plan.cases[i]), i);
    if (is_new) continue;
    complaints.add(plan.keys.where,
                   fmt::format("the cases {} and {} are the same: {}", found->second + 1, i + 1, plan.describe(i)));
    return;
  }
}

/// The path of a key as messages have it, lists counted from 1: "probe.0.points" is "probe[1].points".
std::string message_path(const std::string& key) {
  std::string result;
  std::size_t begin = 0;
  while (begin <= key.size()) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const std::string part = key.substr(begin, end - begin);
    std::size_t index = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    if (error == std::errc{} && stop == part.data() + part.size()) {
      result += fmt::format("[{}]", index + 1);
    } else {
      result += (result.empty() ? "" : ".") + part;
    }
    begin = end + 1;
  }
  return result;
}

/// Whether something is wrong with a key that varies, or with the sections on the way to it.
bool concern_columns(const SweepPlan& plan, const Complaints& complaints) {
  return std::ranges::any_of(plan.columns, [&](const SweepColumn& column) {
    if (column.key.empty()) return false;
    const std::string path = message_path(column.key);
    // A section that is not there at all: "geometri" for "geometri.radius".
    const bool is_made = !plan.base.find(path.substr(0, path.find_first_of(".["))) && path.find('.') != path.npos;
    return complaints.concern(path) || (is_made && complaints.concern(path.substr(0, path.find('.'))));
  });
}

/// Holds representative cases against the declarations. Only what the sweep itself varies is refused here; what else is
/// wrong with a case is that case's failure, unless all of them have it.
void check_values(const SweepPlan& plan, const std::vector<std::size_t>& representatives) {
  std::vector<std::string> lines;
  std::string first_other;
  std::size_t others = 0;
  for (const std::size_t i : representatives) {
    Complaints complaints;
    CaseKeys keys;
    const Value tree = case_tree(plan, i);
    schema<CaseKeys>().read(tree, keys, {tree.place, ""}, complaints);
    if (complaints.empty()) continue;
    try {
      complaints.throw_if_any();
    } catch (const InputError& error) {
      if (!concern_columns(plan, complaints)) {
        if (others++ == 0) first_other = error.what();
      } else if (std::ranges::find(lines, error.what()) == lines.end()) {
        lines.emplace_back(error.what());
      }
    }
    if (lines.size() == 10) break;
  }
  if (lines.empty() && others == representatives.size()) lines.push_back(first_other);
  if (!lines.empty()) throw InputError(fmt::format("{}", fmt::join(lines, "\n")));
}

/// The files that texts of a tree name, with their contents.
void find_files(const Value& value, const std::filesystem::path& folder, std::map<std::string, std::string>& contents) {
  if (const auto* text = value.as<std::string>()) {
    std::error_code error;
    if (text->empty() || text->size() > 1000 || text->find('\0') != text->npos || contents.contains(*text)) return;
    if (std::filesystem::is_regular_file(folder / *text, error)) contents[*text] = read_bytes(folder / *text);
  } else if (const auto* list = value.as<Value::Array>()) {
    for (const Value& item : *list) find_files(item, folder, contents);
  } else if (const auto* table = value.as<Value::Table>()) {
    for (const TableEntry& entry : *table) find_files(entry.value, folder, contents);
  }
}

void add_files(SweepPlan& plan) {
  std::map<std::string, std::string> contents;
  const std::filesystem::path folder = plan.base_path.parent_path();
  find_files(plan.base, folder, contents);
  for (const SweepCase& one : plan.cases) {
    for (const Value& value : one.values) find_files(value, folder, contents);
  }
  for (auto& [name, text] : contents) plan.files.emplace_back(name, std::move(text));
}

/// The sweep file without what may change while its cases are run.
std::string definition_of(Value root) {
  std::erase_if(std::get<Value::Table>(root.data), [](const TableEntry& entry) {
    return entry.key == "title" || entry.key == "output" || entry.key == "plot" || entry.key == "run";
  });
  return to_toml(root);
}

/// x, series and names of files; results are known only when cases have run.
void check_plots(const SweepPlan& plan, Complaints& complaints) {
  std::vector<std::string> names;
  for (const SweepColumn& column : plan.columns) names.push_back(column.name);
  for (const SweepPlotKeys& plot : plan.keys.plot) {
    if (plot.series.empty() || std::ranges::find(names, plot.series) != names.end()) continue;
    complaints.add(plot.where, fmt::format("found the series \"{}\"{}; expected one of {}", plot.series,
                                           did_you_mean(plot.series, names), fmt::join(names, ", ")));
  }
}

void lay_out(SweepPlan& plan) {
  Complaints complaints;
  const std::vector<SweepAxis> axes = make_axes(plan.keys, plan.path.parent_path(), complaints, plan.files);
  for (const SweepAxis& axis : axes) {
    for (const SweepColumn& column : axis.columns) {
      check_name(column, plan.columns, complaints);
      plan.columns.push_back(column);
    }
  }
  complaints.throw_if_any();
  Combinations combinations = combine(axes, plan.keys, complaints);
  complaints.throw_if_any();
  plan.cases = std::move(combinations.cases);
  for (const DerivedKeys& derived : plan.keys.derived) {
    add_derived(plan, derived, complaints);
    complaints.throw_if_any();
  }
  check_duplicates(plan, complaints);
  check_plots(plan, complaints);
  complaints.throw_if_any();
  check_values(plan, combinations.representatives);
}

}  // namespace

SweepPlan read_sweep(const std::filesystem::path& path) {
  const Value root = read_toml(path);
  SweepPlan plan;
  plan.path = path;
  Complaints complaints;
  schema<SweepKeys>().read(root, plan.keys, {root.place, ""}, complaints);
  complaints.throw_if_any();
  plan.definition = definition_of(root);
  plan.base_path = path.parent_path() / plan.keys.base;
  plan.base = read_toml(plan.base_path);
  lay_out(plan);
  add_files(plan);
  return plan;
}

Value case_tree(const SweepPlan& plan, std::size_t index) {
  Value tree = plan.base;
  for (std::size_t c = 0; c < plan.columns.size(); ++c) {
    const SweepColumn& column = plan.columns[c];
    if (column.key.empty()) continue;
    set_value(tree, column.key, plan.cases[index].values[c],
              fmt::format("{}: the key \"{}\"", column.where.place.describe(), column.key));
  }
  return tree;
}

const std::vector<std::string>& sweep_table_columns() {
  static const std::vector<std::string> names{
      "case", "status", "exit_status", "expectations_met", "expectations_missed", "message", "seconds", "peak_memory"};
  return names;
}

std::string SweepPlan::case_name(std::size_t index) const {
  return fmt::format("{:0{}}", index + 1, fmt::formatted_size("{}", cases.size()));
}

std::string SweepPlan::describe(std::size_t index) const {
  std::vector<std::string> parts;
  const std::vector<Value>& values = cases[index].values;
  for (std::size_t c = 0; c < columns.size() && c < values.size(); ++c) {
    if (!columns[c].is_derived) parts.push_back(columns[c].name + " = " + plain_text(values[c]));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string plain_text(const Value& value) {
  const auto* text = value.as<std::string>();
  if (const auto* real = value.as<double>()) return fmt::format("{}", *real);
  return text ? *text : inline_toml(value);
}

std::optional<double> as_number(const Value& value) {
  if (const auto* integer = value.as<std::int64_t>()) return static_cast<double>(*integer);
  if (const auto* real = value.as<double>()) return *real;
  if (const auto* boolean = value.as<bool>()) return *boolean ? 1.0 : 0.0;
  return std::nullopt;
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto part = std::from_chars(text.data(), end, shard.part);
  const bool has_slash = part.ec == std::errc{} && part.ptr != end && *part.ptr == '/';
  const auto count = has_slash ? std::from_chars(part.ptr + 1, end, shard.count) : part;
  if (!has_slash || count.ec != std::errc{} || count.ptr != end || shard.part < 1 || shard.part > shard.count) {
    throw InputError(fmt::format("--shard: found \"{}\"; expected K/N with 1 <= K <= N", text));
  }
  return shard;
}

}  // namespace isorim::io
