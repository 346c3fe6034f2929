#include "io/case/case_file.h"

#include <algorithm>
#include <cstddef>
#include <memory>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/case/analysis_checks.h"
#include "io/expression.h"
#include "io/fit/fit_shape.h"
#include "io/hull/hull_shape.h"
#include "io/propeller/propeller_shape.h"

namespace isorim::io {
namespace {

std::string shape_text(int rows, int columns) {
  if (columns > 1) return fmt::format("{} rows of {} reals", rows, columns);
  return rows > 1 ? fmt::format("a list of {} reals", rows) : "a real";
}

/// Rows and columns of a quantity's value.
std::pair<int, int> value_shape(const std::string& quantity, int dim) {
  if (quantity == "centroid" || quantity == "principal_moments") return {dim, 1};
  if (quantity == "inertia" || quantity == "principal_axes") return {dim, dim};
  return {1, 1};
}

/// Properties, and what kinds of shapes have besides.
std::vector<std::string> shape_quantity_names(const CaseKeys& keys, int dim) {
  std::vector<std::string> names = property_names(dim);
  std::vector<std::string> more;
  if (std::holds_alternative<FitKeys>(keys.geometry)) more = fit_quantity_names();
  if (std::holds_alternative<PropellerKeys>(keys.geometry)) more = propeller_quantity_names();
  if (std::holds_alternative<HullKeys>(keys.geometry)) more = hull_quantity_names();
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

std::vector<std::string> quantity_names(const CaseKeys& keys, int dim) {
  std::vector<std::string> names = shape_quantity_names(keys, dim);
  for (const IntegralKeys& integral : keys.integral) names.push_back(integral.name);
  for (AnalysisQuantity& quantity : analysis_quantities(keys, dim)) names.push_back(std::move(quantity.name));
  for (const PlaneSectionKeys& section : keys.section)
    for (const std::string& quantity : section_quantity_names()) names.push_back(section.name + "." + quantity);
  if (keys.hydrostatics)
    for (std::string& name : hydrostatics_quantity_names(*keys.hydrostatics)) names.push_back(std::move(name));
  if (keys.added_mass)
    for (std::string& name : added_mass_quantity_names()) names.push_back(std::move(name));
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void complain_unknown_quantity(const std::string& name, const std::vector<std::string>& known, const KeyPlace& where,
                               Complaints& complaints) {
  complaints.add(where, fmt::format("found the quantity \"{}\"{}; expected one of {}", name, did_you_mean(name, known),
                                    fmt::join(known, ", ")));
}

void check_integrals(const CaseKeys& keys, int dim, Complaints& complaints) {
  std::vector<std::string> taken = shape_quantity_names(keys, dim);
  const std::vector<std::string> reserved = taken;
  for (const IntegralKeys& integral : keys.integral) {
    // Already complained of.
    if (integral.name.empty()) continue;
    if (contains(taken, integral.name)) {
      complaints.add(integral.where,
                     fmt::format("the name \"{}\" is taken by {}", integral.name,
                                 contains(reserved, integral.name) ? "a property" : "another integral"));
    }
    taken.push_back(integral.name);
  }
}

/// Rows and columns that the expected value of a quantity must have; -1 rows: any number.
std::pair<int, int> expected_shape(const CaseKeys& keys, const std::string& name, int dim) {
  for (const AnalysisQuantity& quantity : analysis_quantities(keys, dim)) {
    if (quantity.name != name) continue;
    // The row of a single point is written as a plain list.
    if (quantity.rows == 1) return {quantity.columns, 1};
    return {quantity.rows, quantity.columns};
  }
  for (const PlaneSectionKeys& section : keys.section)
    for (const std::string& quantity : section_quantity_names())
      if (section.name + "." + quantity == name) return {static_cast<int>(section_offsets(section).size()), 1};
  if (name == "added_mass.matrix") return {6, 6};
  if (name.starts_with("added_mass.")) return {1, 1};
  // Of tables as many as there are rows.
  if (keys.hydrostatics && name.find('.') != std::string::npos) return {-1, 1};
  return value_shape(name, dim);
}

void check_sections(const CaseKeys& keys, int dim, Complaints& complaints) {
  std::vector<std::string> taken;
  for (const PlaneSectionKeys& section : keys.section) {
    if (dim == 2) complaints.add(section.where, "plane sections are for solids; the shape is plane");
    if (contains(taken, section.name))
      complaints.add(section.where, fmt::format("the name \"{}\" is taken by another section", section.name));
    taken.push_back(section.name);
  }
  if (dim == 2 && keys.moulds) complaints.add(keys.moulds->where, "moulds are for solids; the shape is plane");
}

void check_expectations(const CaseKeys& keys, int dim, Complaints& complaints) {
  const std::vector<std::string> known = quantity_names(keys, dim);
  for (const auto& [name, expectation] : keys.expect.quantities) {
    if (!contains(known, name)) {
      complain_unknown_quantity(name, known, expectation.where, complaints);
      continue;
    }
    if (name == "mass" && !keys.properties.density) {
      complaints.add(expectation.where, "a mass is expected but [properties] has no density");
    }
    const auto [rows, columns] = expected_shape(keys, name, dim);
    if (expectation.value.values.empty() || rows < 0) continue;
    if (expectation.value.rows != rows || expectation.value.columns != columns) {
      complaints.add(expectation.value.where,
                     fmt::format("found {}; expected {}", shape_text(expectation.value.rows, expectation.value.columns),
                                 shape_text(rows, columns)));
    }
  }
}

void check_convergence(const CaseKeys& keys, int dim, Complaints& complaints) {
  if (!keys.convergence) return;
  const std::vector<std::string> known = quantity_names(keys, dim);
  const auto is_expected = [&](const std::string& name) {
    return std::any_of(keys.expect.quantities.begin(), keys.expect.quantities.end(),
                       [&](const auto& expected) { return expected.first == name; });
  };
  for (const std::string& name : keys.convergence->quantities) {
    if (!contains(known, name)) {
      complain_unknown_quantity(name, known, keys.convergence->where, complaints);
    } else if (!is_expected(name)) {
      complaints.add(keys.convergence->where,
                     fmt::format("the quantity \"{}\" has no expected value to compare with in [expect]", name));
    }
  }
  if (keys.expect.quantities.empty()) {
    complaints.add(keys.convergence->where, "found no expected values to compare with; expected a section [expect]");
  }
}

/// Parses an integrand; over the boundary of an analysis it may name the solution.
void parse_integrand(const CaseFile& file, const IntegralKeys& integral, int dim) {
  const auto scope = integral.over == IntegralOver::domain ? ExpressionScope::domain : ExpressionScope::boundary;
  if (is_result_integral(file, integral, dim)) {
    compile_function(integral.integrand, result_names(file.keys.analysis->equation, dim), dim, file.definitions);
  } else if (dim == 2) {
    compile_integrand<2>(integral.integrand, scope, file.definitions);
  } else {
    compile_integrand<3>(integral.integrand, scope, file.definitions);
  }
}

/// Every integrand must parse; an empty one has been complained of.
void check_integrands(const CaseFile& file, int dim, Complaints& complaints) {
  for (const IntegralKeys& integral : file.keys.integral) {
    if (integral.integrand.empty()) continue;
    try {
      parse_integrand(file, integral, dim);
    } catch (const InputError& error) {
      complaints.add(integral.where.key("integrand", integral.where.place), error.what());
    }
  }
}

std::vector<std::string> patch_names(const AnyBoundary& shape) {
  std::vector<std::string> names;
  std::visit(
      [&](const auto& known) {
        for (const auto& patch : known.boundary.patches) names.push_back(patch.name);
      },
      shape);
  return names;
}

void check_output(const CaseKeys& keys, int dim, Complaints& complaints) {
  if (keys.output.stl && dim == 2)
    complaints.add(keys.output.where, "found stl = true; a mesh (.stl) is that of a solid, and the shape is plane");
}

void check_poles(const CaseKeys& keys, int dim, Complaints& complaints) {
  const auto check = [&](const std::optional<Coordinates>& pole) {
    if (!pole || pole->values.empty() || static_cast<int>(pole->values.size()) == dim) return;
    complaints.add(pole->where, fmt::format("found {} coordinates; expected {}", pole->values.size(), dim));
  };
  check(keys.properties.pole);
  for (const IntegralKeys& integral : keys.integral) check(integral.pole);
}

void check_lines_plan(const CaseKeys& keys, Complaints& complaints) {
  if (!keys.lines_plan || std::holds_alternative<HullKeys>(keys.geometry)) return;
  complaints.add(keys.lines_plan->where, "found a lines plan of a shape that is no hull; expected type = \"hull\"");
}

/// The section [geometry] is there and nothing is wrong with its keys.
bool has_sound_geometry(const Value& root) {
  const Value* geometry = root.find("geometry");
  GeometryKeys keys;
  Complaints complaints;
  return geometry && KeyType<GeometryKeys>::read(*geometry, keys, {}, {geometry->place, "geometry"}, complaints);
}

/// Builds the shape; its dimension is known then, for a file only if it could be read.
std::optional<int> build_shape(CaseFile& file, const FileShapeOptions& options, Complaints& complaints) {
  const std::optional<int> dim = dimension(file.keys.geometry);
  try {
    if (auto* keys = std::get_if<FileKeys>(&file.keys.geometry)) {
      keys->folder = file.path.parent_path();
      FileShape read = build_file_shape(*keys, options);
      file.shape = std::move(read.boundary);
      file.cad = std::move(read.facts);
      return std::holds_alternative<BuiltBoundary<2>>(file.shape) ? 2 : 3;
    }
    if (auto* keys = std::get_if<FitKeys>(&file.keys.geometry)) {
      keys->folder = file.path.parent_path();
      FitShape fitted = build_fit_shape(*keys);
      file.shape = std::move(fitted.boundary);
      file.fit = std::move(fitted.facts);
      return dim;
    }
    if (auto* keys = std::get_if<PropellerKeys>(&file.keys.geometry)) {
      keys->folder = file.path.parent_path();
      PropellerShape built = build_propeller_shape(*keys);
      file.shape = std::move(built.boundary);
      file.propeller = std::make_shared<const PropellerFacts>(std::move(built.facts));
      return dim;
    }
    if (auto* keys = std::get_if<HullKeys>(&file.keys.geometry)) {
      keys->folder = file.path.parent_path();
      HullShape hull = build_hull_shape(*keys);
      file.shape = std::move(hull.boundary);
      file.hull = std::make_shared<const HullFacts>(std::move(hull.facts));
      return dim;
    }
    if (dim == 2) {
      file.shape = build_boundary<2>(file.keys.geometry);
    } else {
      file.shape = build_boundary<3>(file.keys.geometry);
    }
  } catch (const InputError& error) {
    complaints.add(error.what());
  }
  return dim;
}

/// The case that a CAD file makes by itself.
Value case_of_cad_file(const std::filesystem::path& path) {
  const Place place{std::make_shared<const std::string>(path.string())};
  const auto text = [&](std::string content) { return Value{std::move(content), place}; };
  Value geometry{Value::Table{{"type", text("file")}, {"path", text(path.filename().string())}}, place};
  Value properties{Value::Table{{"tolerance", Value{cad_file_tolerance, place}}}, place};
  return {Value::Table{{"geometry", std::move(geometry)}, {"properties", std::move(properties)}}, place};
}

}  // namespace

std::vector<std::string> property_names(int dim) {
  const std::string boundary = dim == 2 ? "perimeter" : "area";
  const std::string domain = dim == 2 ? "area" : "volume";
  return {boundary, domain, "centroid", "inertia", "principal_moments", "mass", "closure_defect"};
}

std::vector<std::string> fit_quantity_names() {
  return {"control_points", "max_distance", "rms_distance", "bending_energy", "curvature_sign_changes"};
}

std::vector<std::string> hull_quantity_names() {
  return {"prismatic", "lcb", "offset_distance", "bending_energy", "curvature_sign_changes"};
}

std::vector<std::string> propeller_quantity_names() {
  return {"expanded_area_ratio", "developed_area_ratio", "projected_area_ratio", "blade_volume",
          "hub_volume",          "control_points_round", "control_points_across"};
}

CaseFile read_case(const Value& root, const std::filesystem::path& path, const FileShapeOptions& options) {
  CaseFile file;
  file.path = path;
  file.resolved = to_toml(root);
  Complaints complaints;
  schema<CaseKeys>().read(root, file.keys, {root.place, ""}, complaints);
  if (has_sound_geometry(root)) {
    if (const std::optional<int> dim = build_shape(file, options, complaints)) {
      check_definitions(file, *dim, complaints);
      check_integrals(file.keys, *dim, complaints);
      check_integrands(file, *dim, complaints);
      check_analysis(file, *dim, patch_names(file.shape), complaints);
      check_sections(file.keys, *dim, complaints);
      if (file.keys.hydrostatics && *dim == 2)
        complaints.add(file.keys.hydrostatics->where, "hydrostatics are for solids; the shape is plane");
      if (file.keys.added_mass && *dim == 2)
        complaints.add(file.keys.added_mass->where, "added masses are for solids; the shape is plane");
      check_expectations(file.keys, *dim, complaints);
      check_convergence(file.keys, *dim, complaints);
      check_poles(file.keys, *dim, complaints);
      check_output(file.keys, *dim, complaints);
    }
  }
  check_lines_plan(file.keys, complaints);
  complaints.throw_if_any();
  return file;
}

CaseFile read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                   const FileShapeOptions& options) {
  Value root = read_toml(path);
  for (const std::string& assignment : overrides) apply_override(root, assignment);
  return read_case(root, path, options);
}

CaseFile read_case_or_cad(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          const FileShapeOptions& options) {
  if (!has_cad_extension(path)) return read_case(path, overrides, options);
  Value root = case_of_cad_file(path);
  for (const std::string& assignment : overrides) apply_override(root, assignment);
  return read_case(root, path, options);
}

}  // namespace isorim::io
