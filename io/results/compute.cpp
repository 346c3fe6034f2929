#include "io/results/compute.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/topology/outer_shells.h"
#include "io/analysis/analysis.h"
#include "io/case/analysis_checks.h"
#include "io/case/curve_builder.h"
#include "io/case/shape_builder.h"
#include "io/expression.h"
#include "io/hydrostatics/added_mass_report.h"
#include "io/hydrostatics/hydrostatics_report.h"
#include "io/results/hull_report.h"
#include "io/results/plane_sections.h"
#include "io/results/propeller_report.h"
#include "quadrature/parallel.h"
#include "quadrature/rim.h"
#include "solver/properties.h"

namespace isorim::io {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// --- The shape ------------------------------------------------------------------------------------------------

/// Where an open boundary is open: the first free edges, and how many more.
template <int Dim>
std::string describe_free_edges(const geometry::OrientedBoundary<Dim>& oriented) {
  const auto& edges = oriented.topology.free_edges;
  constexpr std::size_t most = 4;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(most, edges.size()); ++i) {
    const std::string& patch = oriented.boundary.patches[std::size_t(edges[i].patch)].name;
    const std::string from = fmt::format("({})", fmt::join(edges[i].from.begin(), edges[i].from.end(), ", "));
    const std::string to = fmt::format("({})", fmt::join(edges[i].to.begin(), edges[i].to.end(), ", "));
    texts.push_back(from == to ? fmt::format("\"{}\" at {}", patch, from)
                               : fmt::format("\"{}\" from {} to {}", patch, from, to));
  }
  if (edges.size() > most) texts.push_back(fmt::format("{} more", edges.size() - most));
  const char* noun =
      Dim == 2 ? (edges.size() == 1 ? "free end" : "free ends") : (edges.size() == 1 ? "free edge" : "free edges");
  return fmt::format("{} {}: {}", edges.size(), noun, fmt::join(texts, "; "));
}

template <int Dim>
void check_roles(const geometry::Topology<Dim>& topology, const std::vector<LoopClaim>& claims) {
  Complaints complaints;
  for (const LoopClaim& claim : claims) {
    if (claim.role == LoopRole::any) continue;
    for (const geometry::Shell<Dim>& shell : topology.shells) {
      if (std::find(shell.patches.begin(), shell.patches.end(), claim.patch) == shell.patches.end()) continue;
      if (shell.is_void == (claim.role == LoopRole::hole)) continue;
      complaints.add(claim.where, shell.is_void ? "the role is \"outer\", but the loop lies inside another one"
                                                : "the role is \"hole\", but the loop lies in no other one");
    }
  }
  complaints.throw_if_any();
}

bool is_refused(const CaseFile& file, bool closed) {
  return !closed && file.keys.properties.open_boundary == OpenBoundary::refuse;
}

/// A domain integral that was asked for by name cannot be given for an open boundary.
template <int Dim>
void check_domain_integrals(const CaseFile& file, const geometry::OrientedBoundary<Dim>& oriented) {
  if (!is_refused(file, oriented.topology.closed)) return;
  Complaints complaints;
  for (const IntegralKeys& integral : file.keys.integral) {
    if (integral.over != IntegralOver::domain) continue;
    complaints.add(integral.where, fmt::format("the integral \"{}\" is over a domain, but the boundary is open: {}; "
                                               "expected a closed boundary, or open_boundary = \"integrate\" in "
                                               "[properties]",
                                               integral.name, describe_free_edges(oriented)));
  }
  complaints.throw_if_any();
}

/// Files are searched for partners of edges beyond the tolerance, since their gaps are what they are.
geometry::OrientationOptions orientation_options(const CaseFile& file) {
  geometry::OrientationOptions options;
  options.tolerance = file.keys.properties.closure_tolerance;
  if (!file.cad) return options;
  options.largest_relative_gap = std::max(options.tolerance, geometry::OrientationOptions::file_gap);
  for (const PatchOrigin& patch : file.cad->patches) options.shared_edges.push_back(patch.edges);
  return options;
}

template <int Dim>
Model<Dim> model_of(const CaseFile& file) {
  const auto& built = std::get<BuiltBoundary<Dim>>(file.shape);
  const KeyPlace& where = common_keys(file.keys.geometry).where;
  Model<Dim> model;
  model.oriented = located(where, [&] { return geometry::orient<Dim>(built.boundary, orientation_options(file)); });
  check_roles(model.oriented.topology, built.claims);
  check_domain_integrals(file, model.oriented);
  model.table = located(where, [&] { return geometry::bezier_elements(model.oriented.boundary); });
  if (file.cad) model.origins = file.cad->patches;
  return model;
}

int count_trimmed(const geometry::Boundary<2>& /*boundary*/) {
  return 0;
}
int count_trimmed(const geometry::Boundary<3>& boundary) {
  return static_cast<int>(std::count_if(boundary.patches.begin(), boundary.patches.end(), [](const auto& patch) {
    return std::holds_alternative<geometry::TrimmedSurface>(patch.shape);
  }));
}

void add_extractions(const geometry::Boundary<2>& /*boundary*/, GeometrySummary& /*summary*/) {}
void add_extractions(const geometry::Boundary<3>& boundary, GeometrySummary& summary) {
  for (const geometry::Patch<3>& patch : boundary.patches) {
    const auto* extracted = std::get_if<geometry::ExtractedSurface>(&patch.shape);
    if (!extracted) continue;
    ++summary.t_splines;
    for (const double defect : partition_defects(*extracted))
      summary.partition_defect = std::max(summary.partition_defect, defect);
  }
}

template <int Dim>
GeometrySummary summary_of(const Model<Dim>& model) {
  const geometry::Topology<Dim>& topology = model.oriented.topology;
  const geometry::BoundingBox<Dim> box = geometry::bounding_box(model.table);
  GeometrySummary summary;
  summary.dimension = Dim;
  summary.patches = static_cast<int>(model.oriented.boundary.patches.size());
  summary.elements = static_cast<std::int64_t>(model.table.elements.size());
  summary.trimmed_faces = count_trimmed(model.oriented.boundary);
  add_extractions(model.oriented.boundary, summary);
  summary.shells = static_cast<int>(topology.shells.size());
  summary.voids = static_cast<int>(
      std::count_if(topology.shells.begin(), topology.shells.end(), [](const auto& shell) { return shell.is_void; }));
  summary.closed = topology.closed;
  summary.free_edges = static_cast<int>(topology.free_edges.size());
  summary.largest_gap = topology.largest_gap;
  if constexpr (Dim == 3) {
    summary.edge_tolerance = topology.largest_tolerance;
    if (topology.largest_gap > 0.0)
      summary.largest_gap_place.assign(topology.largest_gap_place.begin(), topology.largest_gap_place.end());
  } else {
    summary.edge_tolerance = topology.tolerance;
  }
  summary.box_lower.assign(box.lower.begin(), box.lower.end());
  summary.box_upper.assign(box.upper.begin(), box.upper.end());
  return summary;
}

// --- Properties -----------------------------------------------------------------------------------------------

template <class Matrix>
Entries entries(const Matrix& matrix, double factor = 1.0) {
  Entries result{{}, static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols())};
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) result.values.push_back(factor * matrix(i, j));
  }
  return result;
}

template <int Dim>
std::vector<Quantity> domain_quantities(const solver::GeometricProperties<Dim>& properties,
                                        std::optional<double> density) {
  const solver::DomainProperties<Dim>& domain = *properties.domain;
  const double factor = density.value_or(1.0);
  const std::vector<double> centroid_error(domain.centroid_error.begin(), domain.centroid_error.end());
  const double inertia_error = factor * domain.inertia_error;
  std::vector<Quantity> list;
  const auto add = [&](const char* name, Entries value, std::vector<double> error) {
    list.push_back({name, std::move(value), std::move(error), properties.evaluations, properties.domain_status, ""});
  };
  add(Dim == 2 ? "area" : "volume", single(domain.measure.value), {domain.measure.error});
  if (density) add("mass", single(factor * domain.measure.value), {factor * domain.measure.error});
  add("centroid", entries(domain.centroid), centroid_error);
  add("inertia", entries(domain.inertia, factor), {inertia_error});
  // An eigenvalue moves by at most the norm of the change of the tensor.
  add("principal_moments", entries(domain.principal_moments, factor), {Dim * inertia_error});
  list.push_back({"principal_axes", entries(domain.principal_axes), {}, {}, {}, ""});
  return list;
}

std::vector<Quantity> refused_quantities(int dim, bool has_density, const std::string& reason) {
  std::vector<Quantity> list;
  std::vector<const char*> names{dim == 2 ? "area" : "volume"};
  if (has_density) names.push_back("mass");
  names.insert(names.end(), {"centroid", "inertia", "principal_moments"});
  for (const char* name : names) list.push_back({name, {}, {}, {}, {}, reason});
  return list;
}

template <int Dim>
std::optional<geometry::Point<Dim>> pole_of(const std::optional<Coordinates>& coordinates) {
  if (!coordinates) return std::nullopt;
  return point_of<Dim>(*coordinates);
}

/// How to integrate the properties (the stage's name is for the progress).
quadrature::Options integration_options(const PropertiesKeys& keys, const RunOptions& run, std::string stage) {
  quadrature::Options options;
  options.tolerance = keys.tolerance;
  options.fixed_points = keys.gauss_points;
  options.threads = run.threads;
  if (run.progress) {
    options.progress = [report = run.progress, stage = std::move(stage)](double fraction) { report(stage, fraction); };
  }
  return options;
}

template <int Dim>
void add_properties(const CaseFile& file, const Model<Dim>& model, const RunOptions& run, Report& report) {
  using Options = solver::PropertyOptions<Dim>;
  const PropertiesKeys& keys = file.keys.properties;
  const bool refused = is_refused(file, model.oriented.topology.closed);
  Options options;
  options.integration = integration_options(keys, run, "properties");
  options.pole = pole_of<Dim>(keys.pole);
  options.scope = refused ? Options::Scope::boundary_only : Options::Scope::boundary_and_domain;
  const solver::GeometricProperties<Dim> properties = located(
      common_keys(file.keys.geometry).where, [&] { return solver::geometric_properties(model.table, options); });
  report.geometry.closure_defect = properties.closure_defect;
  report.geometry.pole_shift = properties.pole_shift;
  report.properties.push_back({Dim == 2 ? "perimeter" : "area",
                               single(properties.boundary_measure.value),
                               {properties.boundary_measure.error},
                               properties.evaluations,
                               properties.boundary_status,
                               ""});
  std::vector<Quantity> domain;
  if (!refused) {
    domain = domain_quantities(properties, keys.density);
  } else {
    const std::string reason = "the boundary is open, " + describe_free_edges(model.oriented);
    report.warnings.push_back(fmt::format("no {}, centroid and inertia: {}", Dim == 2 ? "area" : "volume", reason));
    domain = refused_quantities(Dim, keys.density.has_value(), reason);
  }
  report.properties.insert(report.properties.end(), domain.begin(), domain.end());
}

// --- Integrals ------------------------------------------------------------------------------------------------

template <int Dim>
Quantity integrate(const CaseFile& file, const IntegralKeys& keys, const Model<Dim>& model, const RunOptions& run) {
  const bool over_domain = keys.over == IntegralOver::domain;
  const quadrature::IntegrandFactory<Dim> integrand = compile_integrand<Dim>(
      keys.integrand, over_domain ? ExpressionScope::domain : ExpressionScope::boundary, file.definitions);
  quadrature::Options options =
      integration_options(file.keys.properties, run, fmt::format("integral \"{}\"", keys.name));
  options.tolerance = keys.tolerance.value_or(file.keys.properties.tolerance);
  const std::optional<Coordinates>& pole = keys.pole ? keys.pole : file.keys.properties.pole;
  try {
    const quadrature::IntegralResult result =
        over_domain ? quadrature::integrate_over_domain<Dim>(model.table, integrand, pole_of<Dim>(pole), options)
                    : quadrature::integrate_over_boundary<Dim>(model.table, integrand, options);
    return {keys.name, single(result.integral.value), {result.integral.error}, result.evaluations, result.status, ""};
  } catch (Error& error) {
    error.add_context(
        fmt::format("{}: the integral \"{}\" of {}", keys.where.place.describe(), keys.name, keys.integrand));
    throw;
  }
}

/// Sound numbers can leave the range of double precision: a mass of a great density, say.
void check_finite(const std::vector<Quantity>& quantities, const std::string& file) {
  for (const Quantity& quantity : quantities) {
    for (const double x : quantity.value.values) {
      if (std::isfinite(x)) continue;
      throw NumericalError(fmt::format("{}: {} is {}; expected a finite number", file, quantity.name, x));
    }
  }
}

// --- Analyses -------------------------------------------------------------------------------------------------

/// Errors that do not say which file they are about learn it.
template <class Action>
auto named_after(const CaseFile& file, Action&& action) {
  try {
    return action();
  } catch (Error& error) {
    const std::string path = file.path.string();
    if (!std::string_view(error.what()).starts_with(path)) error.add_context(path);
    throw;
  }
}

template <int Dim>
void add_analysis(const CaseFile& file, const Model<Dim>& model, const RunOptions& run, Report& report) {
  if (!file.keys.analysis) return;
  Analysis<Dim> analysis = named_after(file, [&] {
    return located(common_keys(file.keys.geometry).where, [&] { return analyse(file, model.oriented, run); });
  });
  report.integrals.insert(report.integrals.end(), analysis.integrals.begin(), analysis.integrals.end());
  report.warnings.insert(report.warnings.end(), analysis.report.messages.begin(), analysis.report.messages.end());
  report.analysis = analysis.report;
  report.fields = std::make_shared<const AnyAnalysis>(AnyAnalysis{std::move(analysis)});
}

// --- Plane sections -------------------------------------------------------------------------------------------

template <int Dim>
void add_sections(const CaseFile& file, const Model<Dim>& model, const RunOptions& run, Report& report) {
  if constexpr (Dim == 3) {
    if (file.keys.section.empty()) return;
    std::function<void(double)> progress;
    if (run.progress) progress = [report = run.progress](double fraction) { report("plane sections", fraction); };
    std::vector<SectionFamily> families = located(common_keys(file.keys.geometry).where, [&] {
      return cut_sections(file, model.oriented.boundary, model.oriented.topology.largest_gap, progress, run.threads);
    });
    for (std::string& warning : section_warnings(families)) report.warnings.push_back(std::move(warning));
    report.sections = std::make_shared<const std::vector<SectionFamily>>(std::move(families));
  }
}

// --- Hydrostatics ---------------------------------------------------------------------------------------------

/// The table of a hull that has not been moved, else null.
const geometry::OffsetTable* hull_table(const CaseFile& file) {
  const auto* keys = std::get_if<HullKeys>(&file.keys.geometry);
  return keys && keys->transform.items.empty() && file.hull ? &file.hull->table : nullptr;
}

/// What is absent, as the table of a hull says: baseline, amidships, length between perpendiculars, moulded beam.
HydrostaticsKeys with_those_of_the_hull(const CaseFile& file, HydrostaticsKeys keys) {
  const geometry::OffsetTable* table = hull_table(file);
  if (!table) return keys;
  if (!keys.baseline) keys.baseline = table->baseline;
  if (!keys.origin) keys.origin = Coordinates{{table->after_perpendicular + 0.5 * table->length, 0.0}, keys.where};
  if (!keys.length) keys.length = table->length;
  if (!keys.beam) keys.beam = table->beam;
  return keys;
}

template <int Dim>
void add_hydrostatics(const CaseFile& file, const Model<Dim>& model, const RunOptions& run, Report& report) {
  if constexpr (Dim == 3) {
    if (!file.keys.hydrostatics) return;
    const HydrostaticsKeys keys = with_those_of_the_hull(file, *file.keys.hydrostatics);
    if (is_refused(file, model.oriented.topology.closed))
      throw InputError(
          fmt::format("{}: hydrostatics need a closed boundary; found {}; expected a closed one, or "
                      "open_boundary = \"integrate\" in [properties]",
                      keys.where.place.describe(), describe_free_edges(model.oriented)));
    std::function<void(double)> progress;
    if (run.progress) progress = [report = run.progress](double fraction) { report("hydrostatics", fraction); };
    const solver::FloatingBodyOptions options{file.keys.properties.tolerance, run.threads};
    HydrostaticsReport result = located(keys.where, [&] {
      const geometry::OrientedBoundary<3> outer = geometry::outer_shells(model.oriented);
      HydrostaticsReport found =
          compute_hydrostatics(keys, outer.boundary, model.oriented.topology.largest_gap, options, progress);
      if (outer.boundary.patches.size() < model.oriented.boundary.patches.size())
        found.warnings.emplace_back(
            "hydrostatics: the voids in the solid are taken as sealed: they displace water as the solid does");
      return found;
    });
    if (file.cad) result.unit = file.cad->unit;
    report.warnings.insert(report.warnings.end(), result.warnings.begin(), result.warnings.end());
    report.hydrostatics = std::make_shared<const HydrostaticsReport>(std::move(result));
  }
}

// --- Added masses ---------------------------------------------------------------------------------------------

template <int Dim>
void add_added_mass(const CaseFile& file, const Model<Dim>& model, const RunOptions& run, Report& report) {
  if constexpr (Dim == 3) {
    if (!file.keys.added_mass) return;
    AddedMassKeys keys = *file.keys.added_mass;
    const geometry::OffsetTable* table = hull_table(file);
    if (keys.draught && !keys.baseline && table) keys.baseline = table->baseline;
    if (!model.oriented.topology.closed)
      throw InputError(fmt::format("{}: added masses need a closed boundary; found {}", keys.where.place.describe(),
                                   describe_free_edges(model.oriented)));
    std::function<void(double)> progress;
    if (run.progress) progress = [report = run.progress](double fraction) { report("added masses", fraction); };
    report.added_mass = located(keys.where, [&] {
      return std::make_shared<const AddedMassReport>(compute_added_mass(keys, model.oriented, run.threads, progress));
    });
  }
}

// --- Fits -----------------------------------------------------------------------------------------------------

void add_fit(const CaseFile& file, Report& report) {
  if (!file.fit) return;
  const FitSummary all = summarise(*file.fit);
  const auto add = [&](const char* name, double value) {
    report.fit_quantities.push_back({name, single(value), {}, {}, {}, ""});
  };
  add("control_points", all.control_points);
  add("max_distance", all.max_distance);
  add("rms_distance", all.rms_distance);
  add("bending_energy", all.bending_energy);
  add("curvature_sign_changes", all.curvature_sign_changes);
  report.fit = file.fit;
  report.warnings.insert(report.warnings.end(), file.fit->warnings.begin(), file.fit->warnings.end());
}

// --- Propellers -----------------------------------------------------------------------------------------------

/// After the properties, which it uses.
void add_propeller(const CaseFile& file, const RunOptions& run, Report& report) {
  if (!file.propeller) return;
  report.propeller = file.propeller;
  report.propeller_quantities = located(common_keys(file.keys.geometry).where, [&] {
    return propeller_quantities(*file.propeller, report.properties,
                                integration_options(file.keys.properties, run, "hub"));
  });
  report.warnings.insert(report.warnings.end(), file.propeller->warnings.begin(), file.propeller->warnings.end());
}

// --- Expectations ---------------------------------------------------------------------------------------------

void compare_expectations(const CaseFile& file, Report& report) {
  const Quantity closure{"closure_defect", single(report.geometry.closure_defect), {}, {}, {}, ""};
  const std::vector<Quantity> of_analysis =
      report.analysis ? expected_quantities(*report.analysis) : std::vector<Quantity>();
  const std::vector<Quantity> of_sections =
      report.sections ? section_quantities(*report.sections) : std::vector<Quantity>();
  const std::vector<Quantity> of_hydrostatics =
      report.hydrostatics ? expected_quantities(*report.hydrostatics) : std::vector<Quantity>();
  const std::vector<Quantity> of_added_mass =
      report.added_mass ? expected_quantities(*report.added_mass) : std::vector<Quantity>();
  const auto find = [&](const std::string& name) -> const Quantity* {
    if (name == closure.name) return &closure;
    const auto added = std::ranges::find(of_added_mass, name, &Quantity::name);
    if (added != of_added_mass.end()) return &*added;
    const auto afloat = std::ranges::find(of_hydrostatics, name, &Quantity::name);
    if (afloat != of_hydrostatics.end()) return &*afloat;
    const auto section = std::ranges::find(of_sections, name, &Quantity::name);
    if (section != of_sections.end()) return &*section;
    const auto found = std::ranges::find(of_analysis, name, &Quantity::name);
    return found == of_analysis.end() ? report.find(name) : &*found;
  };
  for (const auto& [name, keys] : file.keys.expect.quantities) {
    const Quantity* quantity = find(name);
    if (!quantity) throw InputError(fmt::format("{}: no result \"{}\"", keys.where.place.describe(), name));
    report.expectations.push_back(compare(*quantity, {keys.value.values, keys.value.rows, keys.value.columns},
                                          keys.rtol.value_or(0.0), keys.atol.value_or(0.0)));
  }
}

RunStatus overall_status(const Report& report) {
  const auto unreached = [](const Quantity& quantity) {
    return quantity.status == quadrature::Status::tolerance_not_reached;
  };
  if (std::any_of(report.properties.begin(), report.properties.end(), unreached) ||
      std::any_of(report.integrals.begin(), report.integrals.end(), unreached) ||
      (report.hydrostatics && std::ranges::any_of(report.hydrostatics->quantities, unreached)) ||
      (report.analysis && report.analysis->adaptive && !report.analysis->adaptive->is_reached())) {
    return RunStatus::tolerance_not_reached;
  }
  const auto missed = [](const ExpectationResult& result) { return !result.met; };
  return std::any_of(report.expectations.begin(), report.expectations.end(), missed) ? RunStatus::expectation_missed
                                                                                     : RunStatus::ok;
}

template <int Dim>
Report report_of(const CaseFile& file, const Model<Dim>& model, const RunOptions& run) {
  const Clock::time_point start = Clock::now();
  Report report;
  report.version = program_version();
  report.title = file.title();
  report.resolved_case = file.resolved;
  report.threads = quadrature::thread_count(run.threads);
  report.geometry = summary_of(model);
  report.cad = file.cad;
  if (file.cad) report.warnings = file.cad->warnings;
  add_fit(file, report);
  if (file.hull) {
    report.hull = file.hull;
    report.hull_quantities = hull_quantities(*file.hull);
  }
  add_properties(file, model, run, report);
  add_propeller(file, run, report);
  for (const IntegralKeys& keys : file.keys.integral) {
    if (!is_result_integral(file, keys, Dim)) report.integrals.push_back(integrate(file, keys, model, run));
  }
  add_sections(file, model, run, report);
  add_hydrostatics(file, model, run, report);
  add_added_mass(file, model, run, report);
  report.timings.integrate = seconds_since(start);
  add_analysis(file, model, run, report);
  check_finite(report.properties, file.path.string());
  check_finite(report.integrals, file.path.string());
  compare_expectations(file, report);
  report.status = overall_status(report);
  return report;
}

}  // namespace

AnyModel build_model(const CaseFile& file) {
  if (std::holds_alternative<BuiltBoundary<2>>(file.shape)) return model_of<2>(file);
  return model_of<3>(file);
}

GeometrySummary summarise(const AnyModel& model) {
  return std::visit([](const auto& known) { return summary_of(known); }, model);
}

Report compute(const CaseFile& file, const AnyModel& model, const RunOptions& options) {
  return std::visit([&](const auto& known) { return report_of(file, known, options); }, model);
}

Convergence study_convergence(const CaseFile& file, const AnyModel& model, const RunOptions& options) {
  Convergence study;
  if (!file.keys.convergence) return study;
  const std::vector<std::string>& asked = file.keys.convergence->quantities;
  CaseFile fixed = file;
  for (const int points : file.keys.convergence->points.counts) {
    fixed.keys.properties.gauss_points = points;
    const Report report = compute(fixed, model, options);
    study.points.push_back(points);
    std::size_t curve = 0;
    for (const ExpectationResult& result : report.expectations) {
      if (!asked.empty() && std::find(asked.begin(), asked.end(), result.quantity) == asked.end()) continue;
      if (curve == study.curves.size()) study.curves.push_back({result.quantity, {}});
      study.curves[curve++].errors.push_back(
          result.relative_difference.value_or(result.difference.value_or(std::nan(""))));
    }
  }
  return study;
}

}  // namespace isorim::io
