#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/hydrostatics/hydrostatics_report.h"
#include "io/results/table.h"
#include "io/svg/plot.h"

/// The forms in which hydrostatics are told: JSON, text, CSV, SVG.
namespace isorim::io {
namespace {

std::string with_unit(const std::string& what, const std::string& unit) {
  return unit.empty() ? what : fmt::format("{} [{}]", what, unit);
}

svg::Series line(std::string name, std::vector<double> x, std::vector<double> y) {
  return {std::move(name), std::move(x), std::move(y), svg::Line::solid, svg::Marker::none};
}

std::string csv_of(const NumberTable& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (std::size_t i = 0; i < table.rows(); ++i) {
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const double x = table.values[k][i];
      text += (k > 0 ? "," : "") + (std::isfinite(x) ? exact_number(x) : std::string());
    }
    text += '\n';
  }
  return text;
}

Json table_json(const NumberTable& table) {
  Json json = Json::object();
  for (std::size_t k = 0; k < table.columns.size(); ++k) json[table.columns[k]] = list_json(table.values[k]);
  if (table.errors.empty()) return json;
  Json errors = Json::object();
  for (std::size_t k = 0; k < table.columns.size(); ++k)
    if (std::ranges::any_of(table.errors[k], [](double error) { return error > 0.0; }))
      errors[table.columns[k]] = list_json(table.errors[k]);
  json["errors"] = std::move(errors);
  return json;
}

double largest_modulus(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double x : values)
    if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
  return largest;
}

/// Each quantity over its largest modulus: they have nothing else in common. Centres count from amidships, forward.
/// What is zero, centres of hulls that are symmetric fore and aft up to rounding, is left out.
void write_curves_of_form(const std::filesystem::path& path, const NumberTable& table, double amidships,
                          const std::string& unit) {
  svg::Plot plot;
  plot.title = "Curves of form";
  plot.x.label = "quantity / its largest value";
  plot.y.label = with_unit("draught", unit);
  plot.width = 900;
  plot.height = 600;
  for (const char* name : {"displacement", "waterplane_area", "wetted_surface", "vcb", "it", "il", "kmt", "lcb", "lcf",
                           "cb", "cp", "cm", "cwp"}) {
    std::vector<double> values = table.column(name);
    double rounding = 0.0;
    if (name[0] == 'l') {
      for (double& x : values) x -= amidships;
      rounding = 1e-9 * largest_modulus(table.column("length"));
    }
    const double largest = largest_modulus(values);
    if (!(largest > rounding)) continue;
    for (double& x : values) x /= largest;
    plot.series.push_back(line(fmt::format("{} ({:.4g})", name, largest), std::move(values), table.column("draught")));
  }
  svg::write_svg(path, plot);
}

/// A line for each value of the first column.
void write_family(const std::filesystem::path& path, const NumberTable& table, std::string title,
                  const std::string& first, const std::string& x, const std::string& y, const std::string& x_label,
                  const std::string& y_label) {
  svg::Plot plot;
  plot.title = std::move(title);
  plot.x.label = x_label;
  plot.y.label = y_label;
  plot.width = 900;
  plot.height = 600;
  const std::vector<double>& keys = table.column(first);
  for (std::size_t begin = 0; begin < keys.size();) {
    std::size_t end = begin;
    svg::Series series = line(fmt::format("{} {:.6g}", first, keys[begin]), {}, {});
    while (end < keys.size() && keys[end] == keys[begin]) {
      series.x.push_back(table.column(x)[end]);
      series.y.push_back(table.column(y)[end]);
      ++end;
    }
    plot.series.push_back(std::move(series));
    begin = end;
  }
  svg::write_svg(path, plot);
}

void write_righting_arms(const std::filesystem::path& path, const NumberTable& table, const std::string& unit) {
  svg::Plot plot;
  plot.title = "Righting arms";
  plot.x.label = "heel [degrees]";
  plot.y.label = with_unit("GZ; area under it", unit);
  plot.width = 900;
  plot.height = 600;
  plot.series.push_back(line("GZ", table.column("heel"), table.column("arm")));
  svg::Series area = line("area [rad]", table.column("heel"), table.column("area"));
  area.line = svg::Line::dashed;
  plot.series.push_back(std::move(area));
  svg::write_svg(path, plot);
}

}  // namespace

Json hydrostatics_json(const HydrostaticsReport& report) {
  const auto add = [](Json& json, const std::vector<Quantity>& quantities) {
    for (const Quantity& quantity : quantities)
      json[quantity.name] = {{"value", number(quantity.value.values.front())},
                             {"error", quantity.error.empty() ? Json(nullptr) : number(quantity.error.front())}};
  };
  Json json;
  add(json, report.quantities);
  json["baseline"] = number(report.baseline);
  json["origin"] = list_json({report.origin.x(), report.origin.y()});
  json["water_density"] = number(report.water_density);
  for (const NumberTable& table : report.tables) json[table.name] = table_json(table);
  if (!report.righting.empty()) add(json["righting_arms"], report.righting);
  return json;
}

std::string hydrostatics_text(const HydrostaticsReport& report) {
  TextTable table({{"hydrostatics"}, {"value", Align::right}, {"error est.", Align::right}});
  for (const Quantity& quantity : report.quantities)
    table.add_row({quantity.name, exact_number(quantity.value.values.front()),
                   quantity.error.front() > 0.0 ? fmt::format("{:.1e}", quantity.error.front()) : ""});
  for (const Quantity& quantity : report.righting)
    table.add_row({quantity.name, exact_number(quantity.value.values.front()), ""});
  std::string text = table.text(2);
  for (const NumberTable& rows : report.tables)
    text += fmt::format("  {}.csv: {} {}\n", rows.name, rows.rows(), rows.rows() == 1 ? "row" : "rows");
  return text + '\n';
}

void write_hydrostatics(const std::filesystem::path& folder, const HydrostaticsReport& report,
                        const OutputKeys& output) {
  for (const NumberTable& table : report.tables) write_file(folder / (table.name + ".csv"), csv_of(table));
  if (!output.svg) return;
  const std::string& unit = report.unit;
  if (const NumberTable* table = report.find("curves_of_form"))
    write_curves_of_form(folder / "curves_of_form.svg", *table, report.origin.x(), unit);
  if (const NumberTable* table = report.find("bonjean"))
    write_family(folder / "bonjean.svg", *table, "Bonjean's curves", "station", "area", "draught", "immersed area",
                 with_unit("draught", unit));
  if (const NumberTable* table = report.find("righting_arms"))
    write_righting_arms(folder / "righting_arms.svg", *table, unit);
  if (const NumberTable* table = report.find("cross_curves"))
    write_family(folder / "cross_curves.svg", *table, "Cross curves of stability", "displacement", "heel", "arm",
                 "heel [degrees]", with_unit("KN", unit));
}

}  // namespace isorim::io
