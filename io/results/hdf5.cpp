#include "io/results/hdf5.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/analysis/analysis.h"
#include "io/hydrostatics/added_mass_report.h"
#include "io/hydrostatics/hydrostatics_report.h"
#include "io/results/hdf5_parts.h"

namespace isorim::io {

using namespace hdf5;

namespace {

// --- Results --------------------------------------------------------------------------------------------------

void write_entries(hid_t group, const std::string& name, const Entries& entries) {
  std::vector<hsize_t> shape;
  if (entries.values.size() > 1) shape.push_back(static_cast<hsize_t>(entries.rows));
  if (entries.columns > 1) shape.push_back(static_cast<hsize_t>(entries.columns));
  write_dataset(group, name, entries.values, shape);
}

void write_quantity(hid_t parent, const Quantity& quantity) {
  const Handle group = open_group(parent, quantity.name);
  if (!quantity.value.values.empty()) write_entries(group, "value", quantity.value);
  if (!quantity.error.empty()) {
    write_entries(group, "error", {quantity.error, static_cast<int>(quantity.error.size()), 1});
  }
  if (quantity.evaluations) write_attribute<std::int64_t>(group, "evaluations", *quantity.evaluations);
  if (quantity.status) write_text_attribute(group, "status", status_name(*quantity.status));
  if (!quantity.reason.empty()) write_text_attribute(group, "reason", quantity.reason);
}

void write_quantities(hid_t file, const std::string& name, const std::vector<Quantity>& quantities) {
  const Handle group = open_group(file, name);
  for (const Quantity& quantity : quantities) write_quantity(group, quantity);
}

void write_expectations(hid_t file, const std::vector<ExpectationResult>& results) {
  const Handle parent = open_group(file, "expectations");
  for (const ExpectationResult& result : results) {
    const Handle group = open_group(parent, result.quantity);
    if (!result.value.values.empty()) write_entries(group, "value", result.value);
    write_entries(group, "expected", result.expected);
    if (result.error) write_attribute<double>(group, "error", *result.error);
    if (result.difference) write_attribute<double>(group, "difference", *result.difference);
    write_attribute<double>(group, "rtol", result.rtol);
    write_attribute<double>(group, "atol", result.atol);
    write_attribute<std::int8_t>(group, "met", result.met ? 1 : 0);
  }
}

// --- The boundary ---------------------------------------------------------------------------------------------

template <int Dim>
void write_elements(hid_t geometry, const geometry::ElementTable<Dim>& table) {
  const Handle group = open_group(geometry, "elements");
  std::vector<std::int64_t> offsets{0};
  std::vector<std::int32_t> degrees;
  std::vector<std::int32_t> patches;
  std::vector<double> domains;
  std::vector<std::int8_t> orientations;
  std::vector<std::int8_t> polynomial;
  std::vector<std::int32_t> regions;
  std::vector<double> nets;
  for (const geometry::BezierElement<Dim>& element : table.elements) {
    const std::span<const double> net = table.net(element);
    nets.insert(nets.end(), net.begin(), net.end());
    offsets.push_back(offsets.back() + element.control_point_count());
    for (const std::int8_t degree : element.degree) degrees.push_back(degree);
    for (const geometry::Interval& interval : element.domain) {
      domains.insert(domains.end(), {interval.first, interval.last});
    }
    patches.push_back(element.patch);
    orientations.push_back(element.orientation);
    polynomial.push_back(element.polynomial ? 1 : 0);
    regions.push_back(element.region);
  }
  const hsize_t count = table.elements.size();
  write_dataset(group, "nets", nets, {static_cast<hsize_t>(offsets.back()), Dim + 1});
  write_dataset(group, "offsets", offsets, {count + 1});
  write_dataset(group, "degrees", degrees, {count, Dim - 1});
  write_dataset(group, "domains", domains, {count, Dim - 1, 2});
  write_dataset(group, "patch", patches, {count});
  write_dataset(group, "orientation", orientations, {count});
  write_dataset(group, "polynomial", polynomial, {count});
  write_dataset(group, "region", regions, {count});
}

/// The curves that bound the kept parts of cut elements.
void write_regions(hid_t geometry, const std::vector<geometry::TrimmedRegion>& regions) {
  const Handle group = open_group(geometry, "regions");
  std::vector<std::int64_t> offsets{0};
  std::vector<std::int64_t> curve_offsets{0};
  std::vector<double> points;
  for (const geometry::TrimmedRegion& region : regions) {
    for (const geometry::HomogeneousPoints<2>& curve : region.curves) {
      points.insert(points.end(), curve.data(), curve.data() + curve.size());
      curve_offsets.push_back(curve_offsets.back() + curve.cols());
    }
    offsets.push_back(offsets.back() + static_cast<std::int64_t>(region.curves.size()));
  }
  write_dataset(group, "points", points, {static_cast<hsize_t>(curve_offsets.back()), 3});
  write_dataset(group, "curve_offsets", curve_offsets, {curve_offsets.size()});
  write_dataset(group, "offsets", offsets, {offsets.size()});
}

/// One row a patch of a CAD file.
void write_origins(hid_t geometry, const std::vector<PatchOrigin>& origins) {
  std::vector<std::string> entities;
  std::vector<std::int32_t> solids;
  std::vector<std::int32_t> levels;
  std::vector<double> colours;
  for (const PatchOrigin& patch : origins) {
    entities.push_back(patch.origin.entity);
    solids.push_back(patch.solid);
    levels.push_back(patch.origin.level);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const Colour colour = patch.origin.colour.value_or(Colour{none, none, none});
    colours.insert(colours.end(), colour.begin(), colour.end());
  }
  const hsize_t count = origins.size();
  write_texts(geometry, "patch_entities", entities, {count});
  write_dataset(geometry, "patch_solids", solids, {count});
  write_dataset(geometry, "patch_levels", levels, {count});
  write_dataset(geometry, "patch_colours", colours, {count, 3});
}

template <int Dim>
void write_model(hid_t geometry, const Model<Dim>& model) {
  std::vector<std::string> names;
  for (const auto& patch : model.oriented.boundary.patches) names.push_back(patch.name);
  write_texts(geometry, "patch_names", names, {names.size()});
  write_elements(geometry, model.table);
  if (!model.table.regions.empty()) write_regions(geometry, model.table.regions);
  if (!model.origins.empty()) write_origins(geometry, model.origins);
}

void write_geometry(hid_t file, const Report& report, const AnyModel& model) {
  const GeometrySummary& summary = report.geometry;
  const Handle group = open_group(file, "geometry");
  if (report.cad) {
    write_text_attribute(group, "units", report.cad->unit);
    write_text_attribute(group, "reader", report.cad->reader);
    write_text_attribute(group, "format", report.cad->format);
  }
  write_attribute<std::int32_t>(group, "dimension", summary.dimension);
  write_attribute<std::int32_t>(group, "patches", summary.patches);
  write_attribute<std::int64_t>(group, "elements", summary.elements);
  write_attribute<std::int32_t>(group, "trimmed_faces", summary.trimmed_faces);
  write_attribute<std::int32_t>(group, "t_splines", summary.t_splines);
  if (summary.t_splines > 0) write_attribute<double>(group, "partition_defect", summary.partition_defect);
  write_attribute<std::int8_t>(group, "closed", summary.closed ? 1 : 0);
  write_attribute<double>(group, "closure_defect", summary.closure_defect);
  write_attribute<double>(group, "pole_shift", summary.pole_shift);
  write_attribute<std::int32_t>(group, "shells", summary.shells);
  write_attribute<std::int32_t>(group, "voids", summary.voids);
  write_attribute<std::int32_t>(group, "free_edges", summary.free_edges);
  write_attribute<double>(group, "largest_gap", summary.largest_gap);
  write_attribute<double>(group, "edge_tolerance", summary.edge_tolerance);
  std::visit([&](const auto& known) { write_model(group, known); }, model);
}

// --- Analyses -------------------------------------------------------------------------------------------------

/// Points in rows.
void write_columns(hid_t group, const std::string& name, const Eigen::MatrixXd& columns) {
  if (columns.rows() == 0) return;
  const std::vector<double> values(columns.data(), columns.data() + columns.size());
  write_dataset(group, name, values, {static_cast<hsize_t>(columns.cols()), static_cast<hsize_t>(columns.rows())});
}

void write_samples(hid_t parent, const FieldSamples& samples) {
  const Handle group = open_group(parent, samples.name);
  if (samples.image) {
    const std::array<int, 3>& counts = samples.image->counts;
    write_dataset(group, "counts", std::vector<std::int32_t>(counts.begin(), counts.end()), {3});
  }
  write_columns(group, "points", samples.points);
  const std::vector<std::int8_t> location(samples.location.begin(), samples.location.end());
  write_dataset(group, "location", location, {location.size()});
  write_columns(group, "value", samples.value);
  write_columns(group, "gradient", samples.gradient);
  write_columns(group, "stress", samples.stress);
  if (samples.is_elastic()) write_columns(group, "von_mises", samples.von_mises.transpose());
  write_columns(group, "principal", samples.principal);
}

/// The functions of a space and the coefficients of the solution.
template <int Dim>
void write_space(hid_t parent, const Analysis<Dim>& analysis) {
  const solver::FieldSpace<Dim>& space = analysis.setting.space;
  const Handle group = open_group(parent, "space");
  write_elements(group, space.table);
  if (!space.table.regions.empty()) write_regions(group, space.table.regions);
  std::vector<std::int32_t> degrees;
  std::vector<std::int8_t> rational;
  std::vector<std::int64_t> first_functions;
  std::vector<std::int32_t> counts;
  std::vector<std::int64_t> first_rows;
  for (const solver::FieldElement<Dim>& element : space.elements) {
    for (const std::int8_t degree : element.degree) degrees.push_back(degree);
    rational.push_back(element.rational ? 1 : 0);
    first_functions.push_back(static_cast<std::int64_t>(element.first));
    counts.push_back(element.count);
    first_rows.push_back(static_cast<std::int64_t>(element.row));
  }
  const hsize_t count = space.elements.size();
  write_dataset(group, "degrees", degrees, {count, Dim - 1});
  write_dataset(group, "rational", rational, {count});
  write_dataset(group, "first_function", first_functions, {count});
  write_dataset(group, "function_count", counts, {count});
  write_dataset(group, "functions", space.functions, {space.functions.size()});
  write_dataset(group, "first_row", first_rows, {count});
  write_dataset(group, "rows", space.rows, {space.rows.size()});
  write_dataset(group, "condition", analysis.setting.problem.condition_of, {count});
  Eigen::MatrixXd points(Dim, static_cast<Eigen::Index>(space.points.size()));
  for (std::size_t i = 0; i < space.points.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = space.points[i].position;
  }
  write_columns(group, "collocation_points", points);
  write_columns(group, "potential", analysis.solution.potential.transpose());
  write_columns(group, "flux", analysis.solution.flux.transpose());
}

void write_conditions(hid_t parent, const std::vector<ConditionResult>& conditions) {
  const Handle group = open_group(parent, "boundary_conditions");
  for (const ConditionResult& result : conditions) {
    const Handle one = open_group(group, result.name);
    write_text_attribute(one, "kind", result.kind);
    write_attribute<std::int32_t>(one, "elements", result.elements);
    write_attribute<double>(one, "measure", result.measure);
    write_columns(one, result.moment.size() > 0 ? "force" : "flux", result.flux);
    if (result.moment.size() > 0) write_columns(one, "moment", result.moment);
  }
}

/// One entry a step.
void write_history(hid_t parent, const AdaptiveHistory& history) {
  const Handle group = open_group(parent, "adaptive");
  write_attribute<double>(group, "tolerance", history.tolerance);
  write_text_attribute(group, "end", history.end);
  std::vector<std::int64_t> elements;
  std::vector<std::int64_t> unknowns;
  std::vector<double> estimates;
  for (const AdaptiveStepResult& step : history.steps) {
    elements.push_back(static_cast<std::int64_t>(step.elements));
    unknowns.push_back(static_cast<std::int64_t>(step.unknowns));
    estimates.push_back(step.estimate);
  }
  const hsize_t count = history.steps.size();
  write_dataset(group, "elements", elements, {count});
  write_dataset(group, "unknowns", unknowns, {count});
  write_dataset(group, "estimate", estimates, {count});
  for (std::size_t k = 0; k < history.steps.front().errors.size(); ++k) {
    std::vector<double> errors;
    for (const AdaptiveStepResult& step : history.steps) errors.push_back(step.errors[k].second);
    write_dataset(group, history.steps.front().errors[k].first, errors, {count});
  }
}

void write_analysis(hid_t file, const AnalysisReport& report, const AnyAnalysis& fields) {
  const Handle group = open_group(file, "analysis");
  write_text_attribute(group, "equation", report.equation);
  write_text_attribute(group, "method", report.method);
  write_attribute<std::int8_t>(group, "exterior", report.exterior ? 1 : 0);
  write_attribute<std::int64_t>(group, "unknowns", static_cast<std::int64_t>(report.unknowns));
  write_attribute<std::int32_t>(group, "iterations", report.iterations);
  write_attribute<double>(group, "residual", report.residual);
  write_attribute<std::int64_t>(group, "matrix_memory", static_cast<std::int64_t>(report.matrix_memory));
  write_attribute<std::int64_t>(group, "peak_memory", static_cast<std::int64_t>(report.peak_memory));
  if (report.balance) write_attribute<double>(group, "balance", *report.balance);
  if (report.adaptive) write_history(group, *report.adaptive);
  const Handle errors = open_group(group, "errors");
  for (const auto& [name, value] : report.errors) write_attribute<double>(errors, name, value);
  write_conditions(group, report.conditions);
  const Handle probes = open_group(group, "probes");
  for (const FieldSamples& samples : report.probes) write_samples(probes, samples);
  const Handle grids = open_group(group, "grids");
  for (const FieldSamples& samples : report.grids) write_samples(grids, samples);
  std::visit([&](const auto& known) { write_space(group, known); }, fields.known);
}

void write_report(hid_t file, const Report& report, const AnyModel& model) {
  write_text_attribute(file, "isorim", report.version);
  write_text_attribute(file, "case", report.title);
  write_text_attribute(file, "status", status_name(report.status));
  write_attribute<std::int32_t>(file, "threads", report.threads);
  write_texts(file, "resolved_case", {report.resolved_case}, {});
  write_geometry(file, report, model);
  write_quantities(file, "properties", report.properties);
  write_quantities(file, "integrals", report.integrals);
  if (report.fit) write_quantities(file, "fit", report.fit_quantities);
  if (report.hull) write_quantities(file, "hull", report.hull_quantities);
  if (report.propeller) write_quantities(file, "propeller", report.propeller_quantities);
  if (report.hydrostatics) write_quantities(file, "hydrostatics", expected_quantities(*report.hydrostatics));
  if (report.added_mass) write_quantities(file, "added_mass", expected_quantities(*report.added_mass));
  if (report.analysis) write_analysis(file, *report.analysis, *report.fields);
  write_expectations(file, report.expectations);
  const Handle timings = open_group(file, "timings");
  write_attribute<double>(timings, "read", report.timings.read);
  write_attribute<double>(timings, "integrate", report.timings.integrate);
  write_attribute<double>(timings, "write", report.timings.write);
}

}  // namespace

void write_hdf5(const std::filesystem::path& path, const Report& report, const AnyModel& model) {
  write_new_file(path, [&](hid_t file) { write_report(file, report, model); });
}

}  // namespace isorim::io
