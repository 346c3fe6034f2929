#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/results/hdf5_parts.h"
#include "io/svg/markup.h"
#include "io/svg/plot.h"
#include "io/sweep/results.h"

/// Sweeps as files: sweep.h5, collections for ParaView, plots.
namespace isorim::io {

using namespace hdf5;

namespace {

// --- HDF5 -----------------------------------------------------------------------------------------------------

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A slash would make a group.
std::string dataset_name(std::string name) {
  std::ranges::replace(name, '/', ':');
  return name;
}

/// As numbers if all of its values are, else as texts.
void write_parameter(hid_t table, const SweepResults& results, const std::vector<std::size_t>& share, std::size_t c) {
  const SweepPlan& plan = *results.plan;
  std::vector<double> numbers;
  std::vector<std::string> texts;
  for (const std::size_t index : share) {
    const Value& value = plan.cases[index].values[c];
    if (const auto number = as_number(value)) numbers.push_back(*number);
    texts.push_back(plain_text(value));
  }
  const std::string& name = plan.columns[c].name;
  if (numbers.size() == texts.size()) {
    write_dataset(table, name, numbers, {numbers.size()});
  } else {
    write_texts(table, name, texts, {texts.size()});
  }
}

/// One entry a case: what `entry` says of its record, or `missing` without one.
template <class T, class Entry>
std::vector<T> entries(const SweepResults& results, const std::vector<std::size_t>& share, T missing, Entry entry) {
  std::vector<T> list;
  for (const std::size_t index : share) {
    const CaseRecord* record = results.find(index);
    list.push_back(record ? T(entry(*record)) : missing);
  }
  return list;
}

void write_columns(hid_t table, const SweepResults& results, const std::vector<std::size_t>& share) {
  const std::vector<std::string> columns = result_columns(results);
  std::map<std::string, std::size_t> place;
  for (std::size_t c = 0; c < columns.size(); ++c) place[columns[c]] = c;
  std::vector<std::vector<double>> values(columns.size(), std::vector<double>(share.size(), none));
  for (std::size_t i = 0; i < share.size(); ++i) {
    const CaseRecord* record = results.find(share[i]);
    if (!record) continue;
    for (const auto& [name, value] : record->results) {
      const auto found = place.find(name);
      if (found != place.end() && value) values[found->second][i] = *value;
    }
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    write_dataset(table, dataset_name(column_heading(*results.plan, columns[c])), values[c], {share.size()});
  }
}

void write_table(hid_t file, const SweepResults& results) {
  const Handle table = open_group(file, "table");
  const std::vector<std::size_t> share = results.share();
  const std::vector<hsize_t> shape{share.size()};
  std::vector<std::int64_t> numbers;
  for (const std::size_t index : share) numbers.push_back(static_cast<std::int64_t>(index) + 1);
  write_dataset(table, "case", numbers, shape);
  for (std::size_t c = 0; c < results.plan->columns.size(); ++c) write_parameter(table, results, share, c);
  using Record = const CaseRecord&;
  write_texts(table, "status",
              entries<std::string>(results, share, "missing", [](Record record) { return record.status; }), shape);
  write_texts(table, "message", entries<std::string>(results, share, "", [](Record record) { return record.message; }),
              shape);
  const auto write_integers = [&](const std::string& name, auto entry) {
    write_dataset(table, name, entries<std::int64_t>(results, share, -1, entry), shape);
  };
  write_integers("exit_status", [](Record record) { return record.exit_status; });
  write_integers("expectations_met", [](Record record) { return record.expectations_met; });
  write_integers("expectations_missed", [](Record record) { return record.expectations_missed; });
  write_integers("peak_memory", [](Record record) { return record.peak_memory; });
  write_dataset(table, "seconds", entries<double>(results, share, none, [](Record record) { return record.seconds; }),
                shape);
  write_columns(table, results, share);
}

/// Copies the results of a case.
void copy_case(hid_t group, const std::string& name, const std::filesystem::path& path) {
  const Handle source(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "opening " + path.string());
  check(H5Ocopy(source, "/", group, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "copying " + path.string());
}

/// Of the results of all cases, bytes.
std::uintmax_t size_of_cases(const SweepResults& results, const std::filesystem::path& folder) {
  std::uintmax_t size = 0;
  for (const auto& [index, record] : results.records) {
    std::error_code missing;
    const std::uintmax_t one = std::filesystem::file_size(folder / record.folder / "results.h5", missing);
    if (!missing) size += one;
  }
  return size;
}

std::vector<std::string> copy_cases(hid_t file, const SweepResults& results, const std::filesystem::path& folder) {
  const Handle group = open_group(file, "cases");
  std::vector<std::string> messages;
  for (const auto& [index, record] : results.records) {
    if (std::ranges::find(record.files, "results.h5") == record.files.end()) continue;
    try {
      copy_case(group, results.plan->case_name(index), folder / record.folder / "results.h5");
    } catch (const InputError& error) {
      messages.push_back(fmt::format("sweep.h5 is without the fields of case {}: {}", index + 1, error.what()));
    }
  }
  return messages;
}

// --- Collections ----------------------------------------------------------------------------------------------

/// A time a case: times have to increase.
std::vector<double> case_times(const SweepResults& results) {
  const SweepPlan& plan = *results.plan;
  std::vector<double> numbers(plan.cases.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i) + 1.0;
  const auto is_parameter = [](const SweepColumn& column) { return !column.is_derived; };
  if (std::ranges::count_if(plan.columns, is_parameter) != 1) return numbers;
  std::vector<double> values;
  for (const SweepCase& one : plan.cases) {
    const auto value = as_number(one.values.front());
    if (!value || (!values.empty() && *value <= values.back())) return numbers;
    values.push_back(*value);
  }
  return values;
}

// --- Plots ----------------------------------------------------------------------------------------------------

/// What tells the lines of a plot apart.
std::string series_label(const SweepResults& results, const SweepPlotKeys& plot, std::size_t index) {
  if (plot.series.empty()) return "";
  const SweepPlan& plan = *results.plan;
  const auto column = std::ranges::find(plan.columns, plot.series, &SweepColumn::name);
  const Value& value = plan.cases[index].values[static_cast<std::size_t>(column - plan.columns.begin())];
  return fmt::format("{} = {}", plot.series, plain_text(value));
}

std::vector<svg::Series> plot_series(const SweepResults& results, const SweepPlotKeys& plot) {
  std::vector<svg::Series> lines;
  for (const std::string& y : plot.y.items) {
    std::vector<std::string> labels;
    std::map<std::string, std::vector<std::pair<double, double>>> points;
    for (const auto& [index, record] : results.records) {
      const auto at = column_value(results, index, plot.x);
      const auto value = column_value(results, index, y);
      if (record.is_failed() || !at || !value) continue;
      const std::string label = series_label(results, plot, index);
      if (!points.contains(label)) labels.push_back(label);
      points[label].emplace_back(*at, *value);
    }
    for (const std::string& label : labels) {
      std::ranges::stable_sort(points[label], {}, [](const auto& point) { return point.first; });
      svg::Series& line = lines.emplace_back();
      const bool names_y = plot.y.items.size() > 1;
      line.name = label;
      if (names_y) line.name = label.empty() ? y : fmt::format("{}, {}", y, label);
      for (const auto& [at, value] : points[label]) {
        line.x.push_back(at);
        line.y.push_back(value);
      }
      // A sample has no neighbours that a line could join.
      if (results.plan->keys.combine == Combination::latin_hypercube) line.line = svg::Line::none;
    }
  }
  return lines;
}

}  // namespace

std::vector<std::string> write_sweep_hdf5(const std::filesystem::path& path, const SweepResults& results,
                                          const std::filesystem::path& folder) {
  std::vector<std::string> messages;
  const auto write = [&](hid_t file) {
    write_text_attribute(file, "isorim", program_version());
    write_text_attribute(file, "sweep", results.plan->title());
    write_text_attribute(file, "shard", results.shard.text());
    write_texts(file, "definition", {results.plan->definition}, {});
    write_texts(file, "base_case", {to_toml(results.plan->base)}, {});
    write_table(file, results);
    messages = copy_cases(file, results, folder);
  };
  write_new_file(path, write, size_of_cases(results, folder));
  return messages;
}

void write_collections(const std::filesystem::path& folder, const SweepResults& results) {
  std::map<std::string, std::string> entries;
  const std::vector<double> times = case_times(results);
  for (const auto& [index, record] : results.records) {
    for (const std::string& name : record.files) {
      if (!name.ends_with(".vtu")) continue;
      entries[name.substr(0, name.size() - 4)] +=
          fmt::format("    <DataSet timestep=\"{}\" part=\"0\" name=\"{}\" file=\"{}/{}\"/>\n", times[index],
                      svg::escape(results.plan->describe(index)), svg::escape(record.folder), svg::escape(name));
    }
  }
  for (const auto& [name, text] : entries) {
    write_file(folder / (name + ".pvd"),
               fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n{}"
                           "  </Collection>\n</VTKFile>\n",
                           text));
  }
}

void write_plots(const std::filesystem::path& folder, const SweepResults& results) {
  int number = 0;
  for (const SweepPlotKeys& keys : results.plan->keys.plot) {
    ++number;
    svg::Plot plot;
    plot.title = keys.title.empty() ? results.plan->title() : keys.title;
    plot.x.label = keys.x;
    plot.x.scale = keys.x_scale;
    plot.y.label = fmt::format("{}", fmt::join(keys.y.items, ", "));
    plot.y.scale = keys.y_scale;
    plot.series = plot_series(results, keys);
    if (plot.series.empty()) continue;
    const std::string name = keys.file.empty() ? fmt::format("plot_{}", number) : keys.file;
    svg::write_svg(folder / (name.ends_with(".svg") ? name : name + ".svg"), plot);
  }
}

}  // namespace isorim::io
