#include <cstdint>

#include <fmt/format.h>

#include "io/case/reference.h"
#include "io/sweep/sweep_keys.h"

namespace isorim::io {

namespace {

constexpr auto required = Presence::required;

void check_range(const ParameterKeys& parameter, const KeyPlace& where, Complaints& complaints) {
  const auto complain = [&](const std::string& message) { complaints.add(where, message); };
  const double from = parameter.from->value;
  const double to = parameter.to->value;
  if (from == to) return complain(fmt::format("found from = to = {}; expected a range, or \"values\"", from));
  if (parameter.spacing == Spacing::logarithmic) {
    if (from <= 0 || to <= 0) {
      complain(fmt::format("found the logarithmic range from {} to {}; expected both above 0", from, to));
    }
    if (parameter.step) complain("found \"step\" in a logarithmic range; expected \"count\"");
  }
  if (parameter.step && parameter.count) complain("found both \"step\" and \"count\"; expected one of them");
  if (parameter.step && !((to - from) / parameter.step->value > 0)) {
    complain(fmt::format("found step = {}, which does not lead from {} to {}", parameter.step->value, from, to));
  }
}

/// Either a list or a range.
void check_parameter(const ParameterKeys& parameter, const KeyPlace& where, Complaints& complaints) {
  if (parameter.key.empty()) complaints.add(where.key("key", where.place), "found an empty path");
  const bool has_range = parameter.from || parameter.to || parameter.count || parameter.step;
  if (parameter.values && has_range) {
    complaints.add(where, "found both \"values\" and a range (from, to, count, step); expected one of them");
  } else if (!parameter.values && !(parameter.from && parameter.to)) {
    complaints.add(where, "found no values; expected \"values\" or a range with \"from\" and \"to\"");
  } else if (parameter.values) {
    if (parameter.spacing == Spacing::logarithmic) complaints.add(where, "a list of values has no spacing");
  } else {
    check_range(parameter, where, complaints);
  }
}

void check_sweep(const SweepKeys& sweep, const KeyPlace& where, Complaints& complaints) {
  if (sweep.parameter.empty() && sweep.rows.empty()) {
    complaints.add(where, "found nothing that varies; expected [[parameter]] or [[rows]]");
  }
  const bool samples = sweep.combine == Combination::latin_hypercube;
  if (samples && !sweep.samples) {
    complaints.add(where, "the key \"samples\" is missing, which combine = \"latin_hypercube\" needs");
  }
  if (!samples && sweep.samples) {
    complaints.add(where, "found \"samples\", which only combine = \"latin_hypercube\" has");
  }
  for (const ParameterKeys& parameter : sweep.parameter) {
    if (!parameter.from || !parameter.to) continue;
    const bool is_divided = parameter.count || parameter.step;
    if (!samples && !is_divided) {
      complaints.add(parameter.where, "the key \"count\" or \"step\" is missing");
    } else if (samples && is_divided) {
      complaints.add(parameter.where,
                     "found \"count\" or \"step\" in a range that is sampled; expected \"from\" and \"to\" alone");
    }
  }
}

}  // namespace

bool KeyType<ValueList>::read(const Value& v, ValueList& t, const Range&, const KeyPlace& w, Complaints& c) {
  t.where = w;
  const auto* list = v.as<Value::Array>();
  if (!list || list->empty()) {
    complain_type(c, w, v, "a list of at least one value");
    return false;
  }
  t.items = *list;
  return true;
}

bool KeyType<RangeNumber>::read(const Value& v, RangeNumber& t, const Range& r, const KeyPlace& w, Complaints& c) {
  t.is_integer = v.as<std::int64_t>() != nullptr;
  return read_real(v, t.value, r, w, c);
}

bool KeyType<ColumnKeys>::read(const Value& v, ColumnKeys& t, const Range&, const KeyPlace& w, Complaints& c) {
  t.where = w;
  const auto* table = v.as<Value::Table>();
  if (!table || table->empty()) {
    complain_type(c, w, v, "a table: heading = \"key of the case\"");
    return false;
  }
  bool good = true;
  for (const TableEntry& entry : *table) {
    t.entries.emplace_back(entry.key, "");
    good &= read_text(entry.value, t.entries.back().second, w.key(entry.key, entry.value.place), c);
  }
  return good;
}

template <>
const Schema<ParameterKeys>& schema<ParameterKeys>() {
  static const auto declared =
      Schema<ParameterKeys>("parameter", "[[parameter]]: a key of the case that varies. Either a list or a range.")
          .key("key", &ParameterKeys::key,
               {.text = "Path of the key in the case, as --set takes it: \"geometry.radius\", \"probe.0.points\".",
                .presence = required})
          .key("name", &ParameterKeys::name,
               {.text = "Its name in tables, plots and expressions; the last part of the key if absent."})
          .key("values", &ParameterKeys::values, {.text = "List: anything that the key may take."})
          .key("from", &ParameterKeys::from, {.text = "Range: first value."})
          .key("to", &ParameterKeys::to, {.text = "Range: last value."})
          .key("count", &ParameterKeys::count,
               {.text = "Range: number of values, ends included.", .range = Range::between(2, 1000000)})
          .key("step", &ParameterKeys::step, {.text = "Range: distance of values, instead of count."})
          .choice("spacing", &ParameterKeys::spacing,
                  {{"linear", Spacing::linear}, {"logarithmic", Spacing::logarithmic}},
                  {.text = "Range: equal differences or equal ratios. Values are rounded to 12 significant digits."})
          .check(check_parameter);
  return declared;
}

template <>
const Schema<RowsKeys>& schema<RowsKeys>() {
  static const auto declared =
      Schema<RowsKeys>("rows", "[[rows]]: keys that vary together, row by row of a CSV file with a line of headings.")
          .key("csv", &RowsKeys::csv,
               {.text = "The file, from the folder of the sweep file; fields separated by commas, semicolons or tabs.",
                .presence = required})
          .key(
              "columns", &RowsKeys::columns,
              {.text = "The columns that are used: heading = \"key of the case\". The heading is the parameter's name; "
                       "an empty key makes it a name for expressions and plots alone.",
               .presence = required});
  return declared;
}

template <>
const Schema<DerivedKeys>& schema<DerivedKeys>() {
  static const auto declared =
      Schema<DerivedKeys>("derived", "[[derived]]: a value computed from the parameters of each case.")
          .key("name", &DerivedKeys::name,
               {.text = "Its name in tables, plots and later expressions; the last part of the key if absent."})
          .key("key", &DerivedKeys::key, {.text = "Path of the key that it sets; none if absent."})
          .key("expression", &DerivedKeys::expression,
               {.text = "In the names of the parameters that are numbers and of values derived before.",
                .presence = required})
          .check([](const DerivedKeys& derived, const KeyPlace& where, Complaints& complaints) {
            if (derived.name.empty() && derived.key.empty()) {
              complaints.add(where, "found neither \"name\" nor \"key\"; expected at least one of them");
            }
          });
  return declared;
}

template <>
const Schema<SweepOutputKeys>& schema<SweepOutputKeys>() {
  static const auto declared =
      Schema<SweepOutputKeys>("output", "[output]: what is written of the cases.")
          .key("results", &SweepOutputKeys::results,
               {.text =
                    "Columns of the table: quantities (\"volume\", \"centroid\", the name of an integral), or paths "
                    "in results.json (\"analysis.errors.boundary_l2\", \"timings.integrate\"). If absent: properties, "
                    "integrals, errors of analyses and the like."})
          .key("case_files", &SweepOutputKeys::case_files,
               {.text = "Writes the files of each case as `isorim run` does, by the case's own [output], to cases/N/; "
                        "the fields of sweep.h5 and the collections for ParaView need them."});
  return declared;
}

template <>
const Schema<SweepPlotKeys>& schema<SweepPlotKeys>() {
  const std::vector<std::pair<std::string, svg::Scale>> scales{{"linear", svg::Scale::linear},
                                                               {"logarithmic", svg::Scale::logarithmic}};
  static const auto declared =
      Schema<SweepPlotKeys>("plot", "[[plot]]: a picture of results against a parameter.")
          .key("x", &SweepPlotKeys::x, {.text = "A parameter, derived value or result.", .presence = required})
          .key("y", &SweepPlotKeys::y, {.text = "Derived values or results.", .presence = required})
          .key("series", &SweepPlotKeys::series,
               {.text = "A parameter or derived value: a line for each of its values."})
          .key("file", &SweepPlotKeys::file, {.text = "Name of the picture; plot_1.svg, ... if absent."})
          .key("title", &SweepPlotKeys::title, {.text = "Title of the picture; that of the sweep if absent."})
          .choice("x_scale", &SweepPlotKeys::x_scale, scales, {.text = "Scale of the x axis."})
          .choice("y_scale", &SweepPlotKeys::y_scale, scales, {.text = "Scale of the y axis."})
          .check([](const SweepPlotKeys& plot, const KeyPlace& where, Complaints& complaints) {
            if (plot.y.items.empty()) complaints.add(where.key("y", where.place), "found an empty list");
            if (plot.file.find('/') != std::string::npos) {
              complaints.add(where.key("file", where.place),
                             fmt::format("found \"{}\"; expected a name without folders", plot.file));
            }
          });
  return declared;
}

template <>
const Schema<SweepRunKeys>& schema<SweepRunKeys>() {
  static const auto declared =
      Schema<SweepRunKeys>("run", "[run]: how the cases are run.")
          .key("stop_on_failure", &SweepRunKeys::stop_on_failure,
               {.text = "Begins no further case after one has failed."})
          .key("timeout", &SweepRunKeys::timeout,
               {.text = "A case that takes longer is ended and counts as failed.",
                .unit = "seconds",
                .range = Range::above(0)})
          .key("memory", &SweepRunKeys::memory,
               {.text = "A case that asks for more fails.", .unit = "MB", .range = Range::at_least(50)});
  return declared;
}

template <>
const Schema<SweepKeys>& schema<SweepKeys>() {
  static const auto declared =
      Schema<SweepKeys>("sweep", "A sweep file: the keys and sections at its top.")
          .key("title", &SweepKeys::title, {.text = "What the sweep is; the file's name if absent."})
          .key("base", &SweepKeys::base,
               {.text = "The case file whose keys vary, from the folder of the sweep file.", .presence = required})
          .choice("combine", &SweepKeys::combine,
                  {{"grid", Combination::grid},
                   {"zip", Combination::zip},
                   {"latin_hypercube", Combination::latin_hypercube}},
                  {.text = "How the parameters make cases: all combinations, the last parameter fastest; the first "
                           "values of all, the second ones, and so on; or a Latin hypercube sample."})
          .key("samples", &SweepKeys::samples,
               {.text = "Number of cases of a Latin hypercube sample: each range is divided into as many strata, one "
                        "value drawn from each.",
                .range = Range::between(1, 1000000)})
          .key("seed", &SweepKeys::seed,
               {.text = "Of the sample; the same seed gives the same sample on every machine.",
                .range = Range::at_least(0)})
          .key("parameter", &SweepKeys::parameter, {.text = "What varies: [[parameter]], any number."})
          .key("rows", &SweepKeys::rows, {.text = "What varies together, from CSV files: [[rows]], any number."})
          .key("derived", &SweepKeys::derived, {.text = "What follows from the parameters: [[derived]], any number."})
          .key("output", &SweepKeys::output, {.text = "What is written."})
          .key("plot", &SweepKeys::plot, {.text = "Pictures: [[plot]], any number."})
          .key("run", &SweepKeys::run, {.text = "How the cases are run."})
          .check(check_sweep);
  return declared;
}

std::vector<const Description*> sweep_tables() {
  return described_tables(schema<SweepKeys>().description());
}

std::string sweep_reference() {
  return reference_text(schema<SweepKeys>().description());
}

std::string sweep_reference_markdown() {
  return "# Sweep files\n\nA sweep file is TOML. Unknown keys are errors.\n" +
         reference_markdown(schema<SweepKeys>().description());
}

}  // namespace isorim::io
