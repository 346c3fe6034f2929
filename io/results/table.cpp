#include "io/results/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "io/analysis/analysis.h"
#include "io/hydrostatics/added_mass_report.h"
#include "io/hydrostatics/hydrostatics_report.h"
#include "io/results/fit_text.h"
#include "io/results/hull_report.h"
#include "io/results/plane_sections.h"
#include "io/results/propeller_report.h"

namespace isorim::io {
namespace {

/// Characters, not bytes, of UTF-8 text.
std::size_t display_width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, Align align) {
  const std::string blanks(width - std::min(width, display_width(text)), ' ');
  return align == Align::left ? text + blanks : blanks + text;
}

std::string small_number(double x) {
  return std::isfinite(x) ? fmt::format("{:.1e}", x) : fmt::format("{}", x);
}

std::string optional_small_number(const std::optional<double>& x) {
  return x ? small_number(*x) : "-";
}

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// "centroid x", "inertia xy", "principal_moments 1".
std::string entry_name(const Quantity& quantity, int row, int column) {
  constexpr std::array<char, 3> axes{'x', 'y', 'z'};
  if (quantity.value.values.size() == 1) return quantity.name;
  if (quantity.name == "principal_moments") return fmt::format("{} {}", quantity.name, row + 1);
  if (quantity.name == "principal_axes")
    return fmt::format("{} {}{}", quantity.name, axes[std::size_t(row)], column + 1);
  const bool by_number = quantity.is_sequence || quantity.value.rows > 3 || quantity.value.columns > 3;
  if (quantity.value.columns == 1) {
    return by_number ? fmt::format("{} {}", quantity.name, row + 1)
                     : fmt::format("{} {}", quantity.name, axes[std::size_t(row)]);
  }
  if (by_number) return fmt::format("{} {},{}", quantity.name, row + 1, column + 1);
  return fmt::format("{} {}{}", quantity.name, axes[std::size_t(row)], axes[std::size_t(column)]);
}

std::string entry_error(const Quantity& quantity, std::size_t index) {
  if (quantity.error.empty()) return "-";
  return small_number(quantity.error.size() == 1 ? quantity.error.front() : quantity.error[index]);
}

const ExpectationResult* expectation_of(const Report& report, const std::string& name) {
  const auto found = std::find_if(report.expectations.begin(), report.expectations.end(),
                                  [&](const ExpectationResult& result) { return result.quantity == name; });
  return found == report.expectations.end() ? nullptr : &*found;
}

void add_quantity(TextTable& table, const Report& report, const Quantity& quantity) {
  const ExpectationResult* expectation = expectation_of(report, quantity.name);
  if (quantity.value.values.empty()) {
    table.add_row({quantity.name, "refused", "", "", "", expectation ? "MISSED" : ""});
    return;
  }
  const Entries& value = quantity.value;
  const bool symmetric = quantity.name == "inertia";
  for (int i = 0; i < value.rows; ++i) {
    for (int j = symmetric ? i : 0; j < value.columns; ++j) {
      const std::size_t index = std::size_t(i * value.columns + j);
      std::vector<std::string> row{entry_name(quantity, i, j), exact_number(value.values[index]),
                                   entry_error(quantity, index)};
      if (expectation) {
        const double expected = expectation->expected.values[index];
        row.insert(row.end(), {exact_number(expected), small_number(std::abs(value.values[index] - expected)),
                               expectation->met ? "met" : "MISSED"});
      }
      table.add_row(row);
    }
  }
}

std::string compact(const Entries& entries) {
  if (entries.values.empty()) return "refused";
  if (entries.values.size() == 1) return fmt::format("{:.14g}", entries.values.front());
  std::vector<std::string> texts;
  for (const double x : entries.values) texts.push_back(fmt::format("{:.4g}", x));
  if (texts.size() > 3) return fmt::format("[{}, {}, .. {}]", texts[0], texts[1], texts.back());
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string status_line(const Report& report) {
  const auto missed = std::count_if(report.expectations.begin(), report.expectations.end(),
                                    [](const ExpectationResult& result) { return !result.met; });
  std::string line = fmt::format("status: {}", status_name(report.status));
  if (!report.expectations.empty()) {
    line += fmt::format(
        ", {} of {} met",
        counted(static_cast<std::int64_t>(report.expectations.size()) - missed, "expectation", "expectations"),
        report.expectations.size());
  }
  return line;
}

std::string megabytes(std::size_t bytes) {
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1048576.0);
}

/// "elasticity, 640 unknowns on 96 elements, dense, residual 1.2e-15, matrix 3.1 MB; solved in 0.4 s".
std::string analysis_line(const Report& report) {
  if (!report.analysis) return "";
  const AnalysisReport& analysis = *report.analysis;
  const std::string iterations =
      analysis.iterations > 0 ? fmt::format(" in {}", counted(analysis.iterations, "iteration", "iterations")) : "";
  return fmt::format("  {}{}, {} unknowns on {} elements, {}{}, residual {}, matrix {}; solved in {:.2f} s\n",
                     analysis.exterior ? "exterior " : "", analysis.equation, analysis.unknowns, analysis.elements,
                     analysis.method, iterations, small_number(analysis.residual), megabytes(analysis.matrix_memory),
                     analysis.solve_time);
}

/// The steps of adaptive refinement with the errors that are known.
std::string history_text(const Report& report) {
  if (!report.analysis || !report.analysis->adaptive) return "";
  const AdaptiveHistory& history = *report.analysis->adaptive;
  std::vector<TextTable::Column> columns{
      {"step", Align::right}, {"elements", Align::right}, {"unknowns", Align::right}, {"estimate", Align::right}};
  for (const auto& [name, value] : history.steps.front().errors) columns.push_back({name, Align::right});
  TextTable table(columns);
  for (std::size_t i = 0; i < history.steps.size(); ++i) {
    const AdaptiveStepResult& step = history.steps[i];
    std::vector<std::string> row{fmt::format("{}", i + 1), fmt::format("{}", step.elements),
                                 fmt::format("{}", step.unknowns), small_number(step.estimate)};
    for (const auto& [name, value] : step.errors) row.push_back(small_number(value));
    table.add_row(std::move(row));
  }
  return fmt::format("  adaptive refinement, tolerance {:g} {}\n\n{}", history.tolerance,
                     history.is_reached() ? "reached" : "NOT REACHED", table.text(2));
}

/// What of an analysis is worth a line: errors, fluxes and forces, and whatever is expected.
bool is_shown(const Report& report, const Quantity& quantity) {
  const auto has_name = [&](const auto& error) { return error.first == quantity.name; };
  if (expectation_of(report, quantity.name) || std::ranges::any_of(report.analysis->errors, has_name)) return true;
  return quantity.name.ends_with(".flux") || quantity.name.ends_with(".force") || quantity.name == "balance";
}

/// Of a CAD file: its unit, and what tells how closed it is.
std::string cad_line(const Report& report) {
  if (!report.cad) return "";
  const GeometrySummary& geometry = report.geometry;
  const std::string& unit = report.cad->unit;
  if (unit.empty())
    return fmt::format("  {}; largest gap {}, gaps may cost {} of {}\n", report.cad->format,
                       small_number(geometry.largest_gap), small_number(geometry.pole_shift),
                       geometry.dimension == 2 ? "area" : "volume");
  return fmt::format("  {}; unit {}, largest gap {} {}, gaps may cost {} {}^{} of {}\n", report.cad->format, unit,
                     small_number(geometry.largest_gap), unit, small_number(geometry.pole_shift), unit,
                     geometry.dimension, geometry.dimension == 2 ? "area" : "volume");
}

}  // namespace

TextTable::TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

void TextTable::add_row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  rows_.push_back(std::move(cells));
}

std::string TextTable::text(int indent) const {
  std::vector<std::string> headings;
  for (const Column& column : columns_) headings.push_back(column.heading);
  std::vector<std::size_t> widths(columns_.size(), 0);
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], display_width(row[i]));
  };
  widen(headings);
  std::for_each(rows_.begin(), rows_.end(), widen);
  std::string result;
  const auto write = [&](const std::vector<std::string>& row) {
    std::string line(static_cast<std::size_t>(indent), ' ');
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += (i > 0 ? "  " : "") + padded(row[i], widths[i], columns_[i].align);
    }
    result += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  };
  write(headings);
  std::for_each(rows_.begin(), rows_.end(), write);
  return result;
}

std::string exact_number(double x) {
  return fmt::format("{}", x);
}

std::string geometry_line(const GeometrySummary& geometry) {
  const std::string trimmed = geometry.trimmed_faces > 0 ? fmt::format(" ({} trimmed)", geometry.trimmed_faces) : "";
  const std::string t_splines =
      geometry.t_splines > 0 ? " (" + counted(geometry.t_splines, "T-spline", "T-splines") + ")" : "";
  std::string line =
      fmt::format("{}D, {}{}{}, {}, {}", geometry.dimension, counted(geometry.patches, "patch", "patches"), trimmed,
                  t_splines, counted(geometry.elements, "element", "elements"), geometry.closed ? "closed" : "OPEN");
  if (geometry.voids > 0) {
    line += ", " + (geometry.dimension == 2 ? counted(geometry.voids, "hole", "holes")
                                            : counted(geometry.voids, "void", "voids"));
  }
  return line;
}

std::string results_text(const Report& report) {
  TextTable table({{"quantity"},
                   {"value", Align::right},
                   {"error est.", Align::right},
                   {"expected", Align::right},
                   {"difference", Align::right},
                   {""}});
  for (const std::vector<Quantity>* list : {&report.fit_quantities, &report.hull_quantities, &report.properties,
                                            &report.propeller_quantities, &report.integrals}) {
    for (const Quantity& quantity : *list) {
      if (quantity.name != "principal_axes") add_quantity(table, report, quantity);
    }
  }
  if (report.analysis) {
    for (const Quantity& quantity : expected_quantities(*report.analysis)) {
      if (is_shown(report, quantity)) add_quantity(table, report, quantity);
    }
  }
  if (report.sections) {
    for (const Quantity& quantity : section_quantities(*report.sections)) {
      if (expectation_of(report, quantity.name)) add_quantity(table, report, quantity);
    }
  }
  if (report.hydrostatics) {
    for (const Quantity& quantity : expected_quantities(*report.hydrostatics)) {
      if (expectation_of(report, quantity.name)) add_quantity(table, report, quantity);
    }
  }
  if (report.added_mass) {
    for (const Quantity& quantity : expected_quantities(*report.added_mass)) {
      if (expectation_of(report, quantity.name)) add_quantity(table, report, quantity);
    }
  }
  add_quantity(table, report, {"closure_defect", single(report.geometry.closure_defect), {}, {}, {}, ""});
  return fmt::format("{}\n  {}\n{}{}{}{}{}{}\n{}\n{}{}{}  {}\n", report.title, geometry_line(report.geometry),
                     cad_line(report), report.fit ? fit_text(*report.fit) : "",
                     report.hull ? hull_text(*report.hull) : "",
                     report.propeller ? propeller_text(*report.propeller) : "", analysis_line(report),
                     history_text(report), table.text(2), report.sections ? sections_text(*report.sections) : "",
                     report.hydrostatics ? hydrostatics_text(*report.hydrostatics) : "",
                     report.added_mass ? added_mass_text(*report.added_mass) : "", status_line(report));
}

std::string verification_text(const std::vector<VerifiedCase>& cases) {
  TextTable table({{"case"},
                   {"quantity"},
                   {"value", Align::right},
                   {"expected", Align::right},
                   {"rel. error", Align::right},
                   {"our estimate", Align::right},
                   {"time [s]", Align::right},
                   {""}});
  std::size_t met = 0;
  std::size_t count = 0;
  std::size_t failed = 0;
  for (const VerifiedCase& one : cases) {
    std::string file = one.file;
    std::string time = fmt::format("{:.3f}", one.time);
    if (!one.failure.empty()) {
      ++failed;
      table.add_row({file, "-", "-", "-", "-", "-", time, "FAILED"});
    }
    for (const ExpectationResult& result : one.expectations) {
      ++count;
      met += result.met;
      const std::string mark =
          result.met ? (one.status == RunStatus::tolerance_not_reached ? "TOLERANCE" : "met") : "MISSED";
      // Where zero is expected the difference stands alone.
      const std::optional<double> difference =
          result.relative_difference ? result.relative_difference : result.difference;
      table.add_row({file, result.quantity, compact(result.value), compact(result.expected),
                     optional_small_number(difference), optional_small_number(result.error), time, mark});
      file.clear();
      time.clear();
    }
  }
  return fmt::format(
      "{}\n{} of {} expectations met in {} cases{}\n", table.text(), met, count, cases.size() - failed,
      failed > 0 ? fmt::format("; {} could not run", counted(static_cast<std::int64_t>(failed), "case", "cases")) : "");
}

}  // namespace isorim::io
