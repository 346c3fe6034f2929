#include "io/hydrostatics/hydrostatics_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/hydrostatics/hydrostatics_tables.h"
#include "quadrature/parallel.h"
#include "solver/hydrostatics/hydrostatics.h"
#include "solver/hydrostatics/stability.h"

namespace isorim::io {
namespace {

using quadrature::Estimate;
using solver::Attitude;
using solver::Hydrostatics;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180.0;

std::vector<double> in_radians(std::vector<double> angles) {
  for (double& angle : angles) angle *= degree;
  return angles;
}

Estimate exact(double value) {
  return {value, 0.0};
}

Estimate scaled(const Estimate& estimate, double factor) {
  return {factor * estimate.value, factor * estimate.error};
}

Estimate optional_estimate(const std::optional<Estimate>& estimate) {
  return estimate.value_or(Estimate{nan, nan});
}

/// In the order of hydrostatics_columns().
std::vector<Estimate> row_of(const Hydrostatics& h, double density) {
  const solver::ImmersedBody& body = h.immersed;
  return {exact(h.attitude.draught),
          exact(h.attitude.trim / degree),
          exact(h.attitude.heel / degree),
          scaled(body.volume, density),
          body.volume,
          h.lcb,
          h.tcb,
          h.vcb,
          body.waterplane.area,
          h.lcf,
          h.tcf,
          h.it,
          h.il,
          h.itl,
          h.bmt,
          h.bml,
          h.kmt,
          h.kml,
          h.wetted_surface,
          h.midship_area,
          exact(h.length.value_or(nan)),
          exact(h.beam.value_or(nan)),
          optional_estimate(h.cb),
          optional_estimate(h.cp),
          optional_estimate(h.cm),
          optional_estimate(h.cwp)};
}

NumberTable table_of(std::string name, const std::vector<std::string>& columns) {
  NumberTable table{std::move(name), columns, {}, {}};
  table.values.resize(columns.size());
  return table;
}

void add_row(NumberTable& table, const std::vector<double>& row) {
  for (std::size_t k = 0; k < row.size(); ++k) table.values[k].push_back(row[k]);
}

void add_row(NumberTable& table, const std::vector<Estimate>& row) {
  table.errors.resize(row.size());
  for (std::size_t k = 0; k < row.size(); ++k) {
    table.values[k].push_back(row[k].value);
    table.errors[k].push_back(row[k].error);
  }
}

class Maker {
 public:
  Maker(const HydrostaticsKeys& keys, const geometry::Boundary<3>& boundary, double largest_gap,
        const solver::FloatingBodyOptions& options, const std::function<void(double)>& progress)
      : keys_(keys),
        body_(boundary, options),
        cutter_(boundary, bridging(largest_gap, body_.box().diagonal())),
        threads_(options.threads),
        progress_(progress) {
    frame_ = solver::default_frame(body_);
    if (keys.baseline) frame_.baseline = *keys.baseline;
    if (keys.origin) frame_.origin << keys.origin->values[0], keys.origin->values[1];
    coefficients_ = {keys.length, keys.beam};
    midship_ = solver::station_section(cutter_, frame_.origin.x());
    if (keys.loading) {
      loading_.volume = keys.loading->mass / keys.water_density;
      loading_.centre_of_gravity = geometry::Point3(keys.loading->centre_of_gravity.values.data());
    }
    report_.baseline = frame_.baseline;
    report_.origin = frame_.origin;
    report_.water_density = keys.water_density;
  }

  HydrostaticsReport make() {
    std::optional<Attitude> attitude;
    if (keys_.draught) attitude = Attitude{*keys_.draught, keys_.trim * degree, keys_.heel * degree};
    if (keys_.loading) {
      const std::optional<Attitude> rest = find_rest();
      if (!attitude) attitude = rest;
    }
    if (attitude) add_hydrostatics(*attitude);
    if (keys_.curves_of_form) add_curves_of_form();
    if (keys_.bonjean) add_bonjean();
    if (keys_.righting_arms) add_righting_arms();
    if (keys_.cross_curves) add_cross_curves();
    return std::move(report_);
  }

 private:
  static geometry::SectionOptions bridging(double largest_gap, double size) {
    geometry::SectionOptions options;
    options.gap_tolerance = std::max(options.gap_tolerance, 2.0 * largest_gap / size);
    return options;
  }

  Hydrostatics at(const Attitude& attitude) const {
    return solver::hydrostatics(body_, midship_, frame_, attitude, coefficients_);
  }

  void add_hydrostatics(const Attitude& attitude) {
    const Hydrostatics h = at(attitude);
    const std::vector<Estimate> row = row_of(h, keys_.water_density);
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (!std::isfinite(row[k].value)) continue;
      Quantity quantity{hydrostatics_columns()[k], single(row[k].value), {row[k].error}, {}, {}, ""};
      if (h.unfinished > 0) quantity.status = quadrature::Status::tolerance_not_reached;
      report_.quantities.push_back(std::move(quantity));
    }
    if (h.unfinished > 0)
      report_.warnings.push_back(
          fmt::format("hydrostatics: on {} pieces of elements the tolerance is not reached", h.unfinished));
    if (h.immersed.closure_defect > 1e-9)
      report_.warnings.push_back(
          fmt::format("hydrostatics: the wetted surface does not close, by {:.2g} of its area (gaps between patches)",
                      h.immersed.closure_defect));
  }

  /// The attitude at rest: the stable one, if one is found.
  std::optional<Attitude> find_rest() {
    const auto found =
        solver::find_equilibria(body_, loading_, solver::up_direction(keys_.trim * degree, keys_.heel * degree));
    NumberTable table = table_of("equilibria", equilibrium_columns());
    std::optional<Attitude> rest;
    for (const solver::Equilibrium& one : found) {
      if (one.state.status != solver::FlotationStatus::converged) {
        report_.warnings.push_back(
            one.state.status == solver::FlotationStatus::sinks
                ? "hydrostatics: the body sinks: it weighs more than the water that it can displace"
                : "hydrostatics: no equilibrium was found");
        continue;
      }
      const Attitude attitude = solver::attitude_of(frame_, one.state.plane);
      if (!rest || one.is_stable) rest = rest && found.front().is_stable ? rest : std::optional(attitude);
      add_row(table, std::vector<double>{attitude.draught, attitude.trim / degree, attitude.heel / degree,
                                         one.state.transverse_metacentric_height(), one.state.metacentric_heights(0, 0),
                                         one.is_stable ? 1.0 : 0.0});
      if (!one.is_stable)
        report_.warnings.push_back(
            fmt::format("hydrostatics: the equilibrium at a heel of {:.4g} degrees is not stable: its smallest "
                        "metacentric height is {:.4g}",
                        attitude.heel / degree, one.state.smallest_metacentric_height()));
    }
    report_.tables.push_back(std::move(table));
    return rest;
  }

  void add_curves_of_form() {
    const std::vector<double>& draughts = keys_.curves_of_form->draughts.values;
    std::vector<Hydrostatics> results(draughts.size());
    quadrature::parallel_for(
        draughts.size(), threads_,
        [&](std::size_t i, int /*thread*/) {
          results[i] = at({draughts[i], keys_.trim * degree, keys_.heel * degree});
        },
        progress_);
    NumberTable table = table_of("curves_of_form", hydrostatics_columns());
    for (const Hydrostatics& h : results) add_row(table, row_of(h, keys_.water_density));
    report_.tables.push_back(std::move(table));
  }

  void add_bonjean() {
    const solver::BonjeanCurves curves = solver::bonjean_curves(cutter_, frame_, keys_.bonjean->stations.values,
                                                                keys_.bonjean->draughts.values, threads_);
    NumberTable table = table_of("bonjean", bonjean_columns());
    for (std::size_t i = 0; i < curves.stations.size(); ++i)
      for (std::size_t k = 0; k < curves.draughts.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(i);
        const auto column = static_cast<Eigen::Index>(k);
        add_row(table, std::vector<Estimate>{exact(curves.stations[i]),
                                             exact(curves.draughts[k]),
                                             {curves.areas(row, column), curves.errors(row, column)},
                                             {curves.heights(row, column), nan}});
      }
    report_.tables.push_back(std::move(table));
  }

  solver::RightingOptions righting_options(TrimChoice trim) const {
    solver::RightingOptions options;
    options.mode = trim == TrimChoice::free ? solver::TrimMode::free : solver::TrimMode::fixed;
    options.trim = keys_.trim * degree;
    options.threads = threads_;
    options.progress = progress_;
    return options;
  }

  void add_righting_arms() {
    if (loading_.volume > body_.volume()) return;
    const solver::RightingCurve curve = solver::righting_curve(
        body_, loading_, in_radians(keys_.righting_arms->heels.values), righting_options(keys_.righting_arms->trim));
    NumberTable table = table_of("righting_arms", righting_columns());
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const solver::RightingPoint& point = curve.points[i];
      const Attitude attitude = solver::attitude_of(frame_, point.state.plane);
      add_row(table, std::vector<double>{keys_.righting_arms->heels.values[i], point.arm, point.area, attitude.draught,
                                         attitude.trim / degree, point.state.transverse_metacentric_height()});
      if (point.state.status != solver::FlotationStatus::converged)
        report_.warnings.push_back(fmt::format("hydrostatics: at a heel of {:.4g} degrees no trim was found",
                                               keys_.righting_arms->heels.values[i]));
    }
    const auto add = [&](const char* name, double value) {
      report_.righting.push_back({name, single(value), {}, {}, {}, ""});
    };
    add("largest_arm", curve.largest_arm);
    add("heel_of_largest_arm", curve.heel_of_largest_arm / degree);
    if (curve.vanishing_heel) add("vanishing_heel", *curve.vanishing_heel / degree);
    report_.tables.push_back(std::move(table));
  }

  void add_cross_curves() {
    std::vector<double> volumes = keys_.cross_curves->displacements.values;
    for (double& volume : volumes) volume /= keys_.water_density;
    const solver::CrossCurves curves = solver::cross_curves(
        body_, frame_, volumes, in_radians(keys_.cross_curves->heels.values), righting_options(TrimChoice::fixed));
    NumberTable table = table_of("cross_curves", cross_columns());
    for (std::size_t i = 0; i < volumes.size(); ++i)
      for (std::size_t k = 0; k < curves.heels.size(); ++k)
        add_row(table,
                std::vector<double>{keys_.cross_curves->displacements.values[i], keys_.cross_curves->heels.values[k],
                                    curves.arms(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k))});
    report_.tables.push_back(std::move(table));
  }

  const HydrostaticsKeys& keys_;
  solver::FloatingBody body_;
  geometry::PlaneCutter cutter_;
  int threads_;
  const std::function<void(double)>& progress_;
  solver::ShipFrame frame_;
  solver::HydrostaticOptions coefficients_;
  solver::StationSection midship_;
  solver::Loading loading_;
  HydrostaticsReport report_;
};

}  // namespace

const std::vector<std::string>& hydrostatics_columns() {
  static const std::vector<std::string> names{
      "draught", "trim", "heel", "displacement", "volume", "lcb", "tcb", "vcb", "waterplane_area", "lcf",
      "tcf",     "it",   "il",   "itl",          "bmt",    "bml", "kmt", "kml", "wetted_surface",  "midship_area",
      "length",  "beam", "cb",   "cp",           "cm",     "cwp"};
  return names;
}

const std::vector<std::string>& bonjean_columns() {
  static const std::vector<std::string> names{"station", "draught", "area", "height"};
  return names;
}

const std::vector<std::string>& equilibrium_columns() {
  static const std::vector<std::string> names{"draught", "trim", "heel", "gmt", "gml", "stable"};
  return names;
}

const std::vector<std::string>& righting_columns() {
  static const std::vector<std::string> names{"heel", "arm", "area", "draught", "trim", "gmt"};
  return names;
}

const std::vector<std::string>& righting_scalars() {
  static const std::vector<std::string> names{"largest_arm", "heel_of_largest_arm", "vanishing_heel"};
  return names;
}

const std::vector<std::string>& cross_columns() {
  static const std::vector<std::string> names{"displacement", "heel", "arm"};
  return names;
}

const std::vector<double>& NumberTable::column(const std::string& column_name) const {
  const auto found = std::ranges::find(columns, column_name);
  return values[static_cast<std::size_t>(found - columns.begin())];
}

const NumberTable* HydrostaticsReport::find(const std::string& name) const {
  const auto found = std::ranges::find(tables, name, &NumberTable::name);
  return found == tables.end() ? nullptr : &*found;
}

HydrostaticsReport compute_hydrostatics(const HydrostaticsKeys& keys, const geometry::Boundary<3>& boundary,
                                        double largest_gap, const solver::FloatingBodyOptions& options,
                                        const std::function<void(double)>& progress) {
  return Maker(keys, boundary, largest_gap, options, progress).make();
}

std::vector<Quantity> expected_quantities(const HydrostaticsReport& report) {
  std::vector<Quantity> list;
  for (const Quantity& quantity : report.quantities) {
    list.push_back(quantity);
    list.back().name = "hydrostatics." + quantity.name;
  }
  for (const NumberTable& table : report.tables)
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      Quantity column{table.name + "." + table.columns[k],
                      {table.values[k], static_cast<int>(table.rows()), 1},
                      table.errors.empty() ? std::vector<double>{} : table.errors[k],
                      {},
                      {},
                      ""};
      column.is_sequence = true;
      list.push_back(std::move(column));
    }
  for (const Quantity& quantity : report.righting) {
    list.push_back(quantity);
    list.back().name = "righting_arms." + quantity.name;
  }
  return list;
}

}  // namespace isorim::io
