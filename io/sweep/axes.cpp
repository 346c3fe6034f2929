#include "io/sweep/axes.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/value_edit.h"
#include "io/file_bytes.h"
#include "io/sweep/csv_rows.h"
#include "io/sweep/sampling.h"

namespace isorim::io {
namespace {

/// A number as a value: an integer if the range is one of integers.
Value number_value(double number, bool is_integer, const Place& place) {
  if (is_integer && number == std::round(number)) return {static_cast<std::int64_t>(number), place};
  return {number, place};
}

/// The number of values of a range with a step; the last one may miss the end by rounding.
std::optional<std::size_t> step_count(const ParameterKeys& parameter, Complaints& complaints) {
  const double steps = (parameter.to->value - parameter.from->value) / parameter.step->value;
  const double whole = std::floor(steps + 1e-9 * std::max(1.0, steps));
  if (whole + 1 > static_cast<double>(most_sweep_cases)) {
    complaints.add(parameter.where,
                   fmt::format("found a range of {:.0f} values; expected at most {}", whole + 1, most_sweep_cases));
    return std::nullopt;
  }
  return static_cast<std::size_t>(whole) + 1;
}

std::vector<std::vector<Value>> range_entries(const ParameterKeys& parameter, Complaints& complaints) {
  std::vector<std::vector<Value>> entries;
  const double from = parameter.from->value;
  const double to = parameter.to->value;
  const bool ends = parameter.from->is_integer && parameter.to->is_integer;
  if (parameter.step) {
    const std::size_t count = step_count(parameter, complaints).value_or(0);
    for (std::size_t i = 0; i < count; ++i) {
      const double fraction = static_cast<double>(i) * parameter.step->value / (to - from);
      const double value = range_value(from, to, Spacing::linear, fraction > 1.0 - 1e-9 ? 1.0 : fraction);
      entries.push_back({number_value(value, ends && parameter.step->is_integer, parameter.where.place)});
    }
    return entries;
  }
  std::vector<double> values;
  for (int i = 0; i < *parameter.count; ++i) {
    values.push_back(range_value(from, to, parameter.spacing, static_cast<double>(i) / (*parameter.count - 1)));
  }
  const bool integers = ends && std::ranges::all_of(values, [](double x) { return x == std::round(x); });
  for (const double value : values) entries.push_back({number_value(value, integers, parameter.where.place)});
  return entries;
}

SweepAxis parameter_axis(const ParameterKeys& parameter, bool is_sampled, Complaints& complaints) {
  SweepAxis axis;
  axis.where = parameter.where;
  const std::string name = parameter.name.empty() ? name_of_key(parameter.key) : parameter.name;
  axis.columns.push_back({name, parameter.key, false, parameter.where});
  if (parameter.values) {
    for (const Value& value : parameter.values->items) axis.entries.push_back({value});
  } else if (is_sampled) {
    axis.from = parameter.from->value;
    axis.to = parameter.to->value;
    axis.spacing = parameter.spacing;
  } else {
    axis.entries = range_entries(parameter, complaints);
  }
  return axis;
}

/// Where the columns of the axis stand in the file; nothing if one is missing.
std::optional<std::vector<std::size_t>> find_columns(const RowsKeys& rows, const CsvRows& table,
                                                     Complaints& complaints) {
  std::vector<std::size_t> found;
  for (const auto& [heading, key] : rows.columns.entries) {
    const auto at = std::ranges::find(table.headings, heading);
    if (at != table.headings.end()) {
      found.push_back(static_cast<std::size_t>(at - table.headings.begin()));
      continue;
    }
    complaints.add(rows.columns.where,
                   fmt::format("found no column \"{}\" in {}{}; its columns are {}", heading, *table.name,
                               did_you_mean(heading, table.headings), fmt::join(table.headings, ", ")));
  }
  if (found.size() < rows.columns.entries.size()) return std::nullopt;
  return found;
}

void append_rows(const CsvRows& table, const std::vector<std::size_t>& columns, SweepAxis& axis,
                 Complaints& complaints) {
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const Place place{table.name, table.lines[r], 1};
    std::vector<Value>& entry = axis.entries.emplace_back();
    for (const std::size_t column : columns) {
      const std::string& field = table.rows[r][column];
      if (field.empty()) {
        complaints.add({place, table.headings[column]}, "found an empty field");
      }
      entry.push_back(value_from_text(field, place));
    }
  }
}

std::optional<SweepAxis> rows_axis(const RowsKeys& rows, const std::filesystem::path& folder, Complaints& complaints,
                                   std::vector<std::pair<std::string, std::string>>& files) {
  SweepAxis axis;
  axis.where = rows.where;
  for (const auto& [heading, key] : rows.columns.entries) {
    axis.columns.push_back({heading, key, false, rows.columns.where});
  }
  try {
    std::string text = read_bytes(folder / rows.csv);
    const CsvRows table = parse_csv(text, (folder / rows.csv).string());
    files.emplace_back(rows.csv, std::move(text));
    const auto columns = find_columns(rows, table, complaints);
    if (!columns) return std::nullopt;
    append_rows(table, *columns, axis, complaints);
  } catch (const InputError& error) {
    complaints.add(error.what());
    return std::nullopt;
  }
  return axis;
}

/// The entries of all axes together, or the strata of a sample.
std::optional<std::size_t> case_count(const std::vector<SweepAxis>& axes, const SweepKeys& keys,
                                      Complaints& complaints) {
  if (keys.combine == Combination::latin_hypercube) return static_cast<std::size_t>(*keys.samples);
  if (keys.combine == Combination::grid) {
    std::size_t count = 1;
    for (const SweepAxis& axis : axes) {
      // Both factors are far below the root of the largest number.
      count *= axis.entries.size();
      if (count <= most_sweep_cases) continue;
      complaints.add(keys.where,
                     fmt::format("found more than {0} combinations; expected at most {0}", most_sweep_cases));
      return std::nullopt;
    }
    return count;
  }
  for (const SweepAxis& axis : axes) {
    if (axis.entries.size() == axes.front().entries.size()) continue;
    complaints.add(axis.where, fmt::format("found {} values of \"{}\" and {} of \"{}\"; combine = \"zip\" expects the "
                                           "same number of each",
                                           axis.entries.size(), axis.columns.front().name, axes.front().entries.size(),
                                           axes.front().columns.front().name));
    return std::nullopt;
  }
  return axes.front().entries.size();
}

void append(SweepCase& one, const std::vector<Value>& values) {
  one.values.insert(one.values.end(), values.begin(), values.end());
}

/// All combinations, the last axis fastest. Cases that differ from the first in one axis represent all.
Combinations grid(const std::vector<SweepAxis>& axes, std::size_t count) {
  Combinations result;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<std::size_t> digits(axes.size());
    std::size_t rest = i;
    for (std::size_t a = axes.size(); a-- > 0; rest /= axes[a].entries.size())
      digits[a] = rest % axes[a].entries.size();
    SweepCase& one = result.cases.emplace_back();
    for (std::size_t a = 0; a < axes.size(); ++a) append(one, axes[a].entries[digits[a]]);
    if (std::ranges::count_if(digits, [](std::size_t digit) { return digit > 0; }) <= 1) {
      result.representatives.push_back(i);
    }
  }
  return result;
}

Combinations zip(const std::vector<SweepAxis>& axes, std::size_t count) {
  Combinations result;
  for (std::size_t i = 0; i < count; ++i) {
    SweepCase& one = result.cases.emplace_back();
    for (const SweepAxis& axis : axes) append(one, axis.entries[i]);
    result.representatives.push_back(i);
  }
  return result;
}

/// A list is sampled like a range: its entries have equal shares of the strata.
Combinations sample(const std::vector<SweepAxis>& axes, std::size_t count, int seed) {
  Combinations result;
  const auto points = latin_hypercube(count, axes.size(), static_cast<std::uint64_t>(seed));
  for (std::size_t i = 0; i < count; ++i) {
    SweepCase& one = result.cases.emplace_back();
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const SweepAxis& axis = axes[a];
      const double fraction = points[a][i];
      if (axis.entries.empty()) {
        append(one, {Value{range_value(axis.from, axis.to, axis.spacing, fraction), axis.where.place}});
      } else {
        const double place = fraction * static_cast<double>(axis.entries.size());
        append(one, axis.entries[std::min(static_cast<std::size_t>(place), axis.entries.size() - 1)]);
      }
    }
    result.representatives.push_back(i);
  }
  return result;
}

}  // namespace

std::string name_of_key(const std::string& key) {
  std::string name;
  std::size_t end = key.size();
  while (true) {
    const std::size_t dot = key.rfind('.', end == 0 ? 0 : end - 1);
    const std::size_t begin = dot == std::string::npos ? 0 : dot + 1;
    const std::string part = key.substr(begin, end - begin);
    name = name.empty() ? part : fmt::format("{}_{}", part, name);
    const bool is_index =
        !part.empty() && std::ranges::all_of(part, [](char c) { return std::isdigit(static_cast<unsigned char>(c)); });
    if (!is_index || begin == 0) return name;
    end = begin - 1;
  }
}

std::vector<SweepAxis> make_axes(const SweepKeys& keys, const std::filesystem::path& folder, Complaints& complaints,
                                 std::vector<std::pair<std::string, std::string>>& files) {
  std::vector<SweepAxis> axes;
  for (const ParameterKeys& parameter : keys.parameter) {
    axes.push_back(parameter_axis(parameter, keys.combine == Combination::latin_hypercube, complaints));
  }
  for (const RowsKeys& rows : keys.rows) {
    if (auto axis = rows_axis(rows, folder, complaints, files)) axes.push_back(std::move(*axis));
  }
  return axes;
}

Combinations combine(const std::vector<SweepAxis>& axes, const SweepKeys& keys, Complaints& complaints) {
  const auto count = case_count(axes, keys, complaints);
  if (!count) return {};
  switch (keys.combine) {
    case Combination::grid:
      return grid(axes, *count);
    case Combination::zip:
      return zip(axes, *count);
    case Combination::latin_hypercube:
      break;
  }
  return sample(axes, *count, keys.seed);
}

}  // namespace isorim::io
