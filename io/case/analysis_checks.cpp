#include "io/case/analysis_checks.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io {
namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

bool is_elastic(const CaseKeys& keys) {
  return keys.analysis && keys.analysis->equation == EquationKind::elasticity;
}

/// Complaints about the sections of one case.
class AnalysisChecker {
 public:
  AnalysisChecker(const CaseFile& file, int dim, const std::vector<std::string>& patches, Complaints& complaints)
      : keys_(file.keys), definitions_(file.definitions), dim_(dim), patches_(patches), complaints_(complaints) {}

  void check() {
    if (!keys_.analysis) {
      check_absence();
      return;
    }
    check_equation();
    check_material();
    check_loads();
    check_conditions();
    check_discretisation();
    check_points();
    check_exact();
    check_names();
  }

 private:
  void complain(const KeyPlace& where, const std::string& message) { complaints_.add(where, message); }

  /// Sections that mean nothing without [analysis].
  void check_absence() {
    if (complaints_.concern("analysis")) return;
    const auto refuse = [&](const KeyPlace& where) {
      complain(where, "found no section [analysis]; expected it, with an \"equation\"");
    };
    if (keys_.source.term) refuse(keys_.source.term->where);
    if (keys_.material) refuse(keys_.material->where);
    if (!keys_.boundary_condition.empty()) refuse(keys_.boundary_condition.front().where);
    if (keys_.body_force) refuse(keys_.body_force->where);
    if (keys_.discretisation) refuse(keys_.discretisation->where);
    if (keys_.solve) refuse(keys_.solve->where);
    if (!keys_.probe.empty()) refuse(keys_.probe.front().where);
    if (!keys_.grid.empty()) refuse(keys_.grid.front().where);
    if (keys_.exact) refuse(keys_.exact->where);
  }

  void check_equation() {
    const AnalysisKeys& analysis = *keys_.analysis;
    if (analysis.state && (!is_elastic(keys_) || dim_ == 3)) {
      complain(analysis.where, "found a \"state\", which only elasticity in the plane has");
    }
    if (analysis.equation == EquationKind::poisson && !keys_.source.term && !complaints_.concern("source")) {
      complain(analysis.where, "Poisson's equation has no source; expected a section [source] with a \"value\"");
    }
    if (keys_.convergence) complain(keys_.convergence->where, "a study of Gauss rules knows no analysis");
  }

  void check_material() {
    if (is_elastic(keys_) && (!keys_.material || !keys_.material->young || !keys_.material->poisson) &&
        !complaints_.concern("material")) {
      complain(keys_.material ? keys_.material->where : keys_.analysis->where,
               "elasticity needs \"young\" and \"poisson\" in [material]");
    }
    if (!keys_.material) return;
    const MaterialKeys& material = *keys_.material;
    if (is_elastic(keys_) && material.conductivity) {
      complain(material.where, "found \"conductivity\", which an elastic material does not have here");
    }
    if (!is_elastic(keys_) && (material.young || material.poisson || material.expansion)) {
      complain(material.where, "found an elastic constant; a potential has \"conductivity\" alone");
    }
  }

  void check_loads() {
    const AnalysisKeys& analysis = *keys_.analysis;
    if (keys_.source.term) {
      const SourceKeys& source = *keys_.source.term;
      if (analysis.equation != EquationKind::poisson) {
        complain(source.where, "found a source; expected equation = \"poisson\" with it");
      }
      check_exterior(source.where);
      check_expression(source.value, ExpressionScope::domain);
    }
    if (!keys_.body_force) return;
    check_exterior(keys_.body_force->where);
    if (!is_elastic(keys_)) {
      complain(keys_.body_force->where, "found a body force; expected equation = \"elasticity\" with it");
      return;
    }
    check_body_force(*keys_.body_force);
  }

  void check_exterior(const KeyPlace& where) {
    if (keys_.analysis->exterior) complain(where, "loads are not available in a domain that reaches to infinity");
  }

  void check_body_force(const BodyForceKeys& force) {
    const bool has_density = (keys_.material && keys_.material->density) || keys_.properties.density;
    if ((force.gravity || force.centrifugal) && !has_density && !complaints_.concern("material")) {
      complain(force.where, "gravity and centrifugal loads need a \"density\" in [material]");
    }
    if (keys_.material && keys_.material->density && keys_.properties.density &&
        *keys_.material->density != *keys_.properties.density) {
      complain(force.where,
               fmt::format("found two densities, {:g} in [material] and {:g} in [properties]; expected one",
                           *keys_.material->density, *keys_.properties.density));
    }
    if (force.temperature && !(keys_.material && keys_.material->expansion) && !complaints_.concern("material")) {
      complain(force.where, "a temperature needs \"expansion\" in [material]");
    }
    if (force.gravity) check_coordinates(*force.gravity);
    if (force.centrifugal) check_rotation(*force.centrifugal);
    if (force.temperature) check_expression(*force.temperature, ExpressionScope::domain);
    if (force.force) {
      check_vector(*force.force, ExpressionScope::domain);
      if (force.force->normal) complain(force.force->where, "a domain has no normal; expected x, y or z");
    }
    if (!force.gravity && !force.centrifugal && !force.force && !force.temperature) {
      complain(force.where, "expected at least one of gravity, centrifugal, force and temperature");
    }
  }

  void check_rotation(const CentrifugalKeys& keys) {
    if (!keys.point.values.empty()) check_coordinates(keys.point);
    if (dim_ == 2 && keys.direction && keys.direction->head<2>().norm() > 0.0) {
      complain(keys.where, "found a \"direction\" off z; in the plane the axis is along z");
    }
  }

  void check_coordinates(const Coordinates& point) {
    if (point.values.empty() || static_cast<int>(point.values.size()) == dim_) return;
    complain(point.where, fmt::format("found {} coordinates; expected {}", point.values.size(), dim_));
  }

  bool check_expression(const ExpressionText& expression, ExpressionScope scope) {
    try {
      if (dim_ == 2) {
        compile_integrand<2>(expression.text, scope, definitions_);
      } else {
        compile_integrand<3>(expression.text, scope, definitions_);
      }
      return true;
    } catch (const InputError& error) {
      complain(expression.where, error.what());
      return false;
    }
  }

  /// Expressions for the components of a vector: a list of the right length, or a table.
  void check_vector(const ComponentTexts& texts, ExpressionScope scope) {
    if (texts.single) {
      complain(texts.where, fmt::format("found a single expression; expected a list of {} or a table", dim_));
    }
    if (texts.listed > 0 && texts.listed != dim_) {
      complain(texts.where, fmt::format("found a list of {}; expected {} components", texts.listed, dim_));
    }
    if (texts.listed == 0 && dim_ == 2 && texts.axes[2]) complain(texts.where, "found \"z\" in the plane");
    for (int i = 0; i < dim_; ++i) {
      if (texts.axes[std::size_t(i)]) check_expression(*texts.axes[std::size_t(i)], scope);
    }
    if (texts.normal) check_expression(*texts.normal, scope);
  }

  /// A value of the unknown's kind.
  void check_value(const std::optional<ComponentTexts>& texts, const char* key) {
    if (!texts) return;
    if (is_elastic(keys_)) {
      check_vector(*texts, ExpressionScope::boundary);
    } else if (!texts->single) {
      complain(texts->where, fmt::format("a potential is one number; expected a single expression as \"{}\"", key));
    } else {
      check_expression(*texts->single, ExpressionScope::boundary);
    }
  }

  void check_on(const OneOrMany<std::string>& on, const KeyPlace& where, bool all_is_known) {
    if (on.is_empty_list) complain(where, "\"on\" is an empty list; expected names of patches");
    std::set<std::string> seen;
    for (const std::string& name : on.items) {
      if (all_is_known && name == "all" && on.items.size() == 1) continue;
      if (!seen.insert(name).second) complain(where, fmt::format("found the patch \"{}\" twice", name));
      if (std::find(patches_.begin(), patches_.end(), name) != patches_.end()) continue;
      complain(where, fmt::format("found the patch \"{}\"{}; expected one of {}", name, did_you_mean(name, patches_),
                                  some(patches_)));
    }
  }

  /// A list that stays readable.
  static std::string some(const std::vector<std::string>& names) {
    constexpr std::size_t most = 20;
    const std::size_t count = std::min(most, names.size());
    std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(count), ", "));
    if (names.size() > most) text += fmt::format(", ... ({} in all)", names.size());
    return text;
  }

  void check_conditions() {
    if (keys_.boundary_condition.empty() && !complaints_.concern("boundary_condition")) {
      complain(keys_.analysis->where, "found no boundary condition; expected [[boundary_condition]]");
    }
    for (const BoundaryConditionKeys& condition : keys_.boundary_condition) check_condition(condition);
  }

  void check_condition(const BoundaryConditionKeys& condition) {
    check_on(condition.on, condition.where, true);
    if (condition.selection) check_expression(*condition.selection, ExpressionScope::boundary);
    check_kind(condition);
    check_value(condition.value, "value");
    check_value(condition.reference, "reference");
    if (condition.coefficient && condition.coefficient->single) {
      check_expression(*condition.coefficient->single, ExpressionScope::boundary);
    } else {
      check_value(condition.coefficient, "coefficient");
    }
    if (condition.traction) check_value(condition.traction, "traction");
    check_components(condition);
    if (condition.pressure) check_expression(*condition.pressure, ExpressionScope::boundary);
  }

  /// Of displacement and foundation: some are given, and what goes with the others is not given for these.
  void check_components(const BoundaryConditionKeys& condition) {
    const bool rests = condition.kind == BoundaryKind::foundation;
    if (!rests && condition.kind != BoundaryKind::displacement) return;
    const std::optional<ComponentTexts>& given = rests ? condition.coefficient : condition.value;
    if (given && given->listed > 0 && !given->has_axes()) {
      complain(given->where, "found no component; expected at least one");
    }
    // A frame along the normal has other components than x, y and z.
    if (given && given->normal) return;
    for (std::size_t i = 0; i < std::size_t(dim_); ++i) {
      const bool holds = !given || given->single || given->axes[i];
      if (holds && condition.traction && condition.traction->axes[i]) {
        complain(condition.traction->where, fmt::format("found a traction along {}, where the {} is given",
                                                        axis_names[i], rests ? "foundation" : "displacement"));
      }
      if (rests && !holds && condition.reference && condition.reference->axes[i]) {
        complain(condition.reference->where,
                 fmt::format("found a reference along {}, which has no coefficient", axis_names[i]));
      }
    }
  }

  void check_kind(const BoundaryConditionKeys& condition) {
    const BoundaryKind kind = condition.kind;
    const KeyPlace where = condition.where.key("kind", condition.where.place);
    const bool for_potential = kind == BoundaryKind::value || kind == BoundaryKind::flux || kind == BoundaryKind::robin;
    if (for_potential && is_elastic(keys_)) {
      complain(where, fmt::format("found \"{}\"; elasticity has displacement, traction, foundation and symmetry",
                                  name_of(kind, boundary_kind_names)));
    } else if (!for_potential && kind != BoundaryKind::symmetry && !is_elastic(keys_)) {
      complain(where, fmt::format("found \"{}\"; a potential has value, flux, robin and symmetry",
                                  name_of(kind, boundary_kind_names)));
    }
    const bool is_robin = kind == BoundaryKind::robin || kind == BoundaryKind::foundation;
    const bool mixes = kind == BoundaryKind::displacement || kind == BoundaryKind::foundation;
    const auto refuse = [&](bool found, const char* key, const char* expected) {
      if (found) complain(condition.where, fmt::format("found \"{}\", which goes with {}", key, expected));
    };
    if (is_robin && !condition.coefficient) complain(condition.where, "the key \"coefficient\" is missing");
    refuse(!is_robin && condition.coefficient, "coefficient", "robin or foundation");
    refuse(!is_robin && condition.reference, "reference", "robin or foundation");
    refuse(!mixes && condition.traction, "traction", "displacement or foundation");
    refuse(kind != BoundaryKind::traction && condition.pressure, "pressure", "traction");
    refuse((is_robin || kind == BoundaryKind::symmetry) && condition.value, "value",
           "value, flux, displacement or traction");
  }

  void check_discretisation() {
    if (!keys_.discretisation) return;
    std::set<std::string> seen;
    for (const PatchDiscretisationKeys& patch : keys_.discretisation->patch) {
      check_on(patch.on, patch.where, false);
      for (const std::string& name : patch.on.items) {
        if (!seen.insert(name).second) complain(patch.where, fmt::format("the patch \"{}\" has choices above", name));
      }
    }
    const AdaptKeys* adapt = adapt_keys(keys_);
    const double solved = keys_.solve.value_or(SolveKeys{}).tolerance;
    if (adapt && adapt->tolerance < solved) {
      complain(adapt->where, fmt::format("found the tolerance {:g}, which is below that of [solve], {:g}; expected it "
                                         "no lower",
                                         adapt->tolerance, solved));
    }
  }

  void check_points() {
    for (const ProbeKeys& probe : keys_.probe) {
      for (const Coordinates& point : probe.points) check_coordinates(point);
      if (probe.from) check_coordinates(*probe.from);
      if (probe.to) check_coordinates(*probe.to);
    }
    for (const GridKeys& grid : keys_.grid) check_grid(grid);
  }

  void check_grid(const GridKeys& grid) {
    if (grid.from) check_coordinates(*grid.from);
    if (grid.to) check_coordinates(*grid.to);
    if (grid.corner) {
      check_coordinates(*grid.corner);
      for (const Coordinates& side : grid.sides) check_coordinates(side);
      check_sides(grid);
    }
    const std::size_t counts = grid.corner ? 2 : static_cast<std::size_t>(dim_);
    if (grid.counts.size() != counts) {
      complain(grid.where, fmt::format("found {} counts; expected {}", grid.counts.size(), counts));
      return;
    }
    constexpr double most_points = 1e7;
    double points = 1.0;
    for (const int count : grid.counts) points *= count;
    if (points > most_points) {
      complain(grid.where, fmt::format("found {:g} points; expected no more than {:g}", points, most_points));
    }
    if (grid.from && grid.to && grid.from->values.size() == counts && grid.to->values.size() == counts) {
      for (std::size_t i = 0; i < counts; ++i) {
        if (grid.counts[i] == 1 || grid.from->values[i] < grid.to->values[i]) continue;
        complain(grid.where, fmt::format("\"from\" is not below \"to\" in {}", axis_names[i]));
      }
    }
  }

  void check_sides(const GridKeys& grid) {
    if (dim_ == 2 || grid.sides.size() != 2 || grid.sides[0].values.size() != 3 || grid.sides[1].values.size() != 3) {
      complain(grid.where, "expected a corner and two sides, in space");
      return;
    }
    const Eigen::Map<const Eigen::Vector3d> a(grid.sides[0].values.data());
    const Eigen::Map<const Eigen::Vector3d> b(grid.sides[1].values.data());
    if (a.norm() == 0.0 || b.norm() == 0.0) {
      complain(grid.where, "found a side of length 0");
    } else if (std::abs(a.dot(b)) > 1e-9 * a.norm() * b.norm()) {
      complain(grid.where, "the sides are not at right angles");
    }
  }

  void check_exact() {
    if (!keys_.exact) return;
    const ExactKeys& exact = *keys_.exact;
    if (is_elastic(keys_) && (exact.value || exact.gradient || exact.flux)) {
      complain(exact.where, "elasticity has an exact displacement, stress and traction");
      return;
    }
    if (!is_elastic(keys_) && (exact.displacement || exact.stress || exact.traction)) {
      complain(exact.where, "a potential has an exact value, gradient and flux");
      return;
    }
    if (exact.value) check_expression(*exact.value, ExpressionScope::domain);
    if (exact.flux) check_expression(*exact.flux, ExpressionScope::boundary);
    check_exact_vector(exact.gradient, ExpressionScope::domain);
    check_exact_vector(exact.displacement, ExpressionScope::domain);
    check_exact_vector(exact.traction, ExpressionScope::boundary);
    if (exact.stress) check_tensor(*exact.stress);
  }

  void check_exact_vector(const std::optional<ComponentTexts>& texts, ExpressionScope scope) {
    if (!texts) return;
    check_vector(*texts, scope);
    if (texts->normal) complain(texts->where, "expected x, y and z, not \"normal\"");
  }

  void check_tensor(const TensorTexts& stress) {
    if (dim_ == 2 && (stress.zz || stress.yz || stress.xz)) complain(stress.where, "found a component off the plane");
    for (const auto* entry : {&stress.xx, &stress.yy, &stress.zz, &stress.xy, &stress.yz, &stress.xz}) {
      if (*entry) check_expression(**entry, ExpressionScope::domain);
    }
  }

  /// Probes, grids and conditions name files and results.
  void check_names() {
    std::set<std::string> taken;
    const auto check = [&](const std::string& name, const KeyPlace& where) {
      const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
      });
      if (!plain && !(name.empty() && complaints_.concern(where.path)))
        complain(where, fmt::format("found the name \"{}\"; expected letters, digits, _ and -", name));
      if (!taken.insert(name).second) complain(where, fmt::format("the name \"{}\" is taken", name));
    };
    for (const IntegralKeys& integral : keys_.integral) {
      for (const AnalysisQuantity& quantity : analysis_quantities(keys_, dim_)) {
        if (integral.name == quantity.name)
          complain(integral.where, fmt::format("the name \"{}\" is that of a result of the analysis", integral.name));
      }
    }
    for (const ProbeKeys& probe : keys_.probe) check(probe.name, probe.where);
    for (const GridKeys& grid : keys_.grid) check(grid.name, grid.where);
    for (const BoundaryConditionKeys& condition : keys_.boundary_condition) {
      if (!condition.name.empty()) check(condition.name, condition.where);
    }
  }

  const CaseKeys& keys_;
  const Definitions& definitions_;
  int dim_;
  const std::vector<std::string>& patches_;
  Complaints& complaints_;
};

void append_errors(const CaseKeys& keys, std::vector<AnalysisQuantity>& list) {
  if (!keys.exact) return;
  const ExactKeys& exact = *keys.exact;
  const auto add = [&](bool known, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if (known) list.push_back({name});
    }
  };
  const bool has_points = !keys.probe.empty();
  add(exact.value || exact.displacement, {"boundary_l2", "boundary_max"});
  add(exact.gradient || exact.flux || exact.stress || exact.traction, {"flux_l2", "flux_max"});
  add(has_points && (exact.value || exact.displacement), {"probe_max"});
  add(has_points && exact.gradient, {"probe_gradient_max"});
  add(has_points && exact.stress, {"probe_stress_max"});
  add(!keys.grid.empty() && (exact.value || exact.displacement), {"grid_max"});
}

}  // namespace

const AdaptKeys* adapt_keys(const CaseKeys& keys) {
  if (!keys.discretisation || !keys.discretisation->adapt.keys) return nullptr;
  return &*keys.discretisation->adapt.keys;
}

int component_count(const CaseKeys& keys, int dim) {
  return is_elastic(keys) ? dim : 1;
}

std::string condition_name(const CaseKeys& keys, std::size_t index) {
  const BoundaryConditionKeys& condition = keys.boundary_condition[index];
  if (!condition.name.empty()) return condition.name;
  const auto place = [](const BoundaryConditionKeys& keys_of_one) {
    const std::vector<std::string>& on = keys_of_one.on.items;
    return on.empty() ? std::string("all") : on.size() == 1 ? on.front() : std::string();
  };
  const std::string own = place(condition);
  const auto rivals = std::count_if(keys.boundary_condition.begin(), keys.boundary_condition.end(),
                                    [&](const BoundaryConditionKeys& other) {
                                      return other.name == own || (other.name.empty() && place(other) == own);
                                    });
  if (!own.empty() && !condition.selection && rivals == 1) return own;
  return fmt::format("condition_{}", index + 1);
}

std::vector<std::string> result_names(EquationKind equation, int dim) {
  std::vector<std::string> names;
  for (const char* prefix : {"", "n"}) {
    for (int i = 0; i < dim; ++i) names.push_back(std::string(prefix) + axis_names[std::size_t(i)]);
  }
  if (equation != EquationKind::elasticity) {
    names.insert(names.end(), {"u", "q"});
    return names;
  }
  for (const char* prefix : {"u", "t"}) {
    for (int i = 0; i < dim; ++i) names.push_back(std::string(prefix) + axis_names[std::size_t(i)]);
  }
  return names;
}

bool is_result_integral(const CaseFile& file, const IntegralKeys& integral, int dim) {
  if (!file.keys.analysis || integral.over != IntegralOver::boundary) return false;
  try {
    if (dim == 2) {
      compile_integrand<2>(integral.integrand, ExpressionScope::boundary, file.definitions);
    } else {
      compile_integrand<3>(integral.integrand, ExpressionScope::boundary, file.definitions);
    }
    return false;
  } catch (const InputError&) {
    return true;
  }
}

std::vector<AnalysisQuantity> analysis_quantities(const CaseKeys& keys, int dim) {
  std::vector<AnalysisQuantity> list;
  if (!keys.analysis) return list;
  const bool elastic = is_elastic(keys);
  for (const char* name : {"unknowns", "iterations", "residual", "balance", "matrix_memory"}) list.push_back({name});
  if (adapt_keys(keys)) {
    for (const char* name : {"steps", "estimate"}) list.push_back({name});
  }
  append_errors(keys, list);
  for (const ProbeKeys& probe : keys.probe) {
    const int rows = probe.points.empty() ? -1 : static_cast<int>(probe.points.size());
    list.push_back({probe.name + ".value", rows, component_count(keys, dim)});
    list.push_back({probe.name + ".gradient", rows, component_count(keys, dim) * dim});
    if (!elastic) continue;
    list.push_back({probe.name + ".stress", rows, dim == 2 ? 4 : 6});
    list.push_back({probe.name + ".von_mises", rows, 1});
    list.push_back({probe.name + ".principal", rows, 3});
  }
  for (std::size_t i = 0; i < keys.boundary_condition.size(); ++i) {
    const std::string name = condition_name(keys, i);
    if (elastic) {
      list.push_back({name + ".force", dim, 1});
      list.push_back({name + ".moment", dim == 2 ? 1 : 3, 1});
    } else {
      list.push_back({name + ".flux"});
    }
  }
  return list;
}

void check_analysis(const CaseFile& file, int dim, const std::vector<std::string>& patches, Complaints& complaints) {
  AnalysisChecker(file, dim, patches, complaints).check();
}

void check_definitions(CaseFile& file, int dim, Complaints& complaints) {
  for (const auto& [name, expression] : file.keys.definitions.entries) {
    const bool twice = std::any_of(file.definitions.begin(), file.definitions.end(),
                                   [&, &known = name](const Definition& other) { return other.name == known; });
    if (twice) continue;
    if (expression.text.empty()) continue;
    file.definitions.push_back({name, expression.text});
    try {
      check_last_definition(file.definitions, dim);
    } catch (const InputError& error) {
      complaints.add(expression.where, error.what());
      file.definitions.pop_back();
    }
  }
}

}  // namespace isorim::io
