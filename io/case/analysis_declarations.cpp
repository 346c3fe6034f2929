#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "io/case/analysis_keys.h"
#include "io/case/case_file.h"
#include "solver/bem/field_space.h"

/// The declarations of the sections that make a case an analysis.
namespace isorim::io {

namespace {

constexpr auto required = Presence::required;
constexpr Range open_fraction{.least = 0, .most = 0.1, .least_is_open = true};

bool is_blank(const std::string& text) {
  return text.find_first_not_of(" \t\r\n") == std::string::npos;
}

bool is_number(const Value& value) {
  return value.as<double>() != nullptr || value.as<std::int64_t>() != nullptr;
}

}  // namespace

// --- Expressions ------------------------------------------------------------------------------------------------

template <>
struct KeyType<ExpressionText> : PlainKey {
  static std::string type() { return "real or expression"; }
  static bool read(const Value& v, ExpressionText& t, const Range&, const KeyPlace& w, Complaints& c) {
    t.where = w;
    if (is_number(v)) {
      double number = 0.0;
      if (!read_real(v, number, {}, w, c)) return false;
      t.text = fmt::format("{:.17g}", number);
      return true;
    }
    if (!v.as<std::string>()) {
      complain_type(c, w, v, "a real or an expression in quotes");
      return false;
    }
    t.text = *v.as<std::string>();
    if (is_blank(t.text)) c.add(w, "found an empty expression");
    return !is_blank(t.text);
  }
  static std::string print(const ExpressionText& value) { return value.text; }
};

/// A component of a list: "" is a missing one.
static bool read_component(const Value& v, std::optional<ExpressionText>& t, const KeyPlace& w, Complaints& c) {
  const auto* text = v.as<std::string>();
  if (text && is_blank(*text)) return true;
  return KeyType<std::optional<ExpressionText>>::read(v, t, {}, w, c);
}

/// The table form of ComponentTexts.
struct ComponentTable {
  std::optional<ExpressionText> x;
  std::optional<ExpressionText> y;
  std::optional<ExpressionText> z;
  std::optional<ExpressionText> normal;
};

template <>
const Schema<ComponentTable>& schema<ComponentTable>() {
  static const auto declared =
      Schema<ComponentTable>("components", "The components of a vector by name; the others are missing.")
          .key("x", &ComponentTable::x, {.text = "Along x."})
          .key("y", &ComponentTable::y, {.text = "Along y."})
          .key("z", &ComponentTable::z, {.text = "Along z."})
          .key("normal", &ComponentTable::normal,
               {.text = "Along the outward normal, instead of x, y, z; where the boundary is flat."});
  return declared;
}

template <>
struct KeyType<ComponentTexts> {
  static std::string type() { return "real, expression, list or table of them"; }
  static std::vector<const Description*> nested() { return {&schema<ComponentTable>().description()}; }
  static bool read(const Value& v, ComponentTexts& t, const Range&, const KeyPlace& w, Complaints& c) {
    t.where = w;
    if (v.as<Value::Table>()) return read_table(v, t, w, c);
    const auto* list = v.as<Value::Array>();
    if (!list) return KeyType<std::optional<ExpressionText>>::read(v, t.single, {}, w, c);
    if (list->empty() || list->size() > t.axes.size()) {
      complain_type(c, w, v, "a list with an entry for each component");
      return false;
    }
    t.listed = static_cast<int>(list->size());
    bool good = true;
    for (std::size_t i = 0; i < list->size(); ++i) {
      good &= read_component((*list)[i], t.axes[i], w.item(i, (*list)[i].place), c);
    }
    return good;
  }
  static std::string print(const ComponentTexts&) { return ""; }

 private:
  static bool read_table(const Value& v, ComponentTexts& t, const KeyPlace& w, Complaints& c) {
    ComponentTable table;
    if (!schema<ComponentTable>().read(v, table, w, c)) return false;
    t.axes = {table.x, table.y, table.z};
    t.normal = table.normal;
    if (t.normal && t.has_axes()) {
      c.add(w, "found \"normal\" beside x, y or z; expected one or the other");
      return false;
    }
    if (!t.normal && !t.has_axes()) {
      c.add(w, "the table is empty; expected x, y, z or normal");
      return false;
    }
    return true;
  }
};

template <>
const Schema<TensorTexts>& schema<TensorTexts>() {
  static const auto declared =
      Schema<TensorTexts>("tensor", "The components of a symmetric tensor; those that are missing are zero.")
          .key("xx", &TensorTexts::xx, {.text = "Real or expression."})
          .key("yy", &TensorTexts::yy, {.text = "Real or expression."})
          .key("zz", &TensorTexts::zz, {.text = "Real or expression; in the plane it is not compared."})
          .key("xy", &TensorTexts::xy, {.text = "Real or expression."})
          .key("yz", &TensorTexts::yz, {.text = "In space: real or expression."})
          .key("xz", &TensorTexts::xz, {.text = "In space: real or expression."});
  return declared;
}

template <>
const Schema<DefinitionsKeys>& schema<DefinitionsKeys>() {
  static const auto declared =
      Schema<DefinitionsKeys>("definitions",
                              "Names for use in every expression of the case, as name = number or expression in the "
                              "coordinates and the names above it.");
  return declared;
}

bool KeyType<DefinitionsKeys>::read(const Value& v, DefinitionsKeys& t, const Range&, const KeyPlace& w,
                                    Complaints& c) {
  const auto* table = v.as<Value::Table>();
  if (!table) {
    complain_type(c, w, v, "a table");
    return false;
  }
  bool good = true;
  for (const TableEntry& entry : *table) {
    t.entries.emplace_back(entry.key, ExpressionText{});
    good &=
        KeyType<ExpressionText>::read(entry.value, t.entries.back().second, {}, w.key(entry.key, entry.value.place), c);
  }
  return good;
}

std::vector<const Description*> KeyType<DefinitionsKeys>::nested() {
  return {&schema<DefinitionsKeys>().description()};
}

// --- What is solved ---------------------------------------------------------------------------------------------

template <>
const Schema<AnalysisKeys>& schema<AnalysisKeys>() {
  static const auto declared =
      Schema<AnalysisKeys>("analysis", "Makes the case a boundary-element analysis.")
          .choice("equation", &AnalysisKeys::equation, equation_names,
                  {.text = "-div(k grad u) = 0, the same with a [source], or linear elasticity.", .presence = required})
          .choice("state", &AnalysisKeys::state,
                  {{"plane_strain", PlaneState::strain}, {"plane_stress", PlaneState::stress}},
                  {.text = "Elasticity in the plane: plane_strain if absent."})
          .key("exterior", &AnalysisKeys::exterior,
               {.text = "The domain is what lies outside the boundary; there the solution vanishes far away (in the "
                        "plane the potential is bounded). Normals still point out of the body."});
  return declared;
}

template <>
const Schema<MaterialKeys>& schema<MaterialKeys>() {
  static const auto declared =
      Schema<MaterialKeys>("material", "What the domain is made of, in consistent units.")
          .key("conductivity", &MaterialKeys::conductivity,
               {.text = "Of a potential: the flux is conductivity du/dn; 1 if absent.", .range = Range::above(0)})
          .key("young", &MaterialKeys::young, {.text = "Young's modulus.", .range = Range::above(0)})
          .key("poisson", &MaterialKeys::poisson,
               {.text = "Poisson's ratio.",
                .range = {.least = -1, .most = 0.5, .least_is_open = true, .most_is_open = true}})
          .key("density", &MaterialKeys::density,
               {.text = "For gravity and centrifugal loads; that of [properties] if absent.",
                .unit = "mass per volume",
                .range = Range::above(0)})
          .key("expansion", &MaterialKeys::expansion,
               {.text = "Coefficient of linear thermal expansion.", .unit = "per degree"});
  return declared;
}

template <>
const Schema<BoundaryConditionKeys>& schema<BoundaryConditionKeys>() {
  using Keys = BoundaryConditionKeys;
  static const auto declared =
      Schema<Keys>("boundary_condition",
                   "What holds on a part of the boundary. Every part needs one: a condition with \"where\" goes before "
                   "one for named patches, and that before one for all; of the same rank two must not meet.")
          .key("name", &Keys::name,
               {.text = "What results and messages call it; if absent the patch, if it is for one, \"all\", or "
                        "condition_N."})
          .key("on", &Keys::on, {.text = "\"all\", the name of a patch or a list of names; \"all\" if absent."})
          .key("where", &Keys::selection,
               {.text = "Of these, the elements in whose middle this expression in x, y, z, nx, ny, nz is not 0; for "
                        "example \"z > 0.99\"."})
          .choice("kind", &Keys::kind, boundary_kind_names,
                  {.text = "value, flux, robin or symmetry for a potential; displacement, traction, foundation or "
                           "symmetry for elasticity. Symmetry: no flux, or no displacement along the normal of a "
                           "plane and no traction in it.",
                   .presence = required})
          .key("value", &Keys::value,
               {.text = "Of the potential, flux, displacement or traction (n points out of the body); zero if absent. "
                        "In elasticity one expression a component: [\"0\", \"\", \"y\"] or { x = 0, z = \"y\" }; a "
                        "missing component is free of traction. Expressions in x, y, z, nx, ny, nz."})
          .key("coefficient", &Keys::coefficient,
               {.text = "robin, foundation: the flux or traction is coefficient (reference - u); positive. One for all "
                        "components or one for each; a missing component is free of traction."})
          .key("reference", &Keys::reference, {.text = "robin, foundation: zero if absent."})
          .key("traction", &Keys::traction,
               {.text = "displacement, foundation: the traction of the components that are missing there; zero if "
                        "absent."})
          .key("pressure", &Keys::pressure, {.text = "traction: adds -pressure n to the value."});
  return declared;
}

template <>
const Schema<SourceKeys>& schema<SourceKeys>() {
  static const auto declared =
      Schema<SourceKeys>("source", "Poisson's equation: -div(k grad u) = value.")
          .key("value", &SourceKeys::value,
               {.text = "Number or expression in x, y, z, defined also where rays between points of the domain leave "
                        "it.",
                .presence = required})
          .key("citation", &SourceKeys::citation, {.text = "Where the case and its expected values come from."});
  return declared;
}

bool KeyType<SourceEntry>::read(const Value& v, SourceEntry& t, const Range&, const KeyPlace& w, Complaints& c) {
  if (!v.as<Value::Table>()) return read_text(v, t.citation, w, c);
  if (!schema<SourceKeys>().read(v, t.term.emplace(), w, c)) return false;
  t.citation = t.term->citation;
  return true;
}

std::vector<const Description*> KeyType<SourceEntry>::nested() {
  return {&schema<SourceKeys>().description()};
}

template <>
const Schema<CentrifugalKeys>& schema<CentrifugalKeys>() {
  static const auto declared =
      Schema<CentrifugalKeys>("centrifugal", "The load of a steady rotation.")
          .key("point", &CentrifugalKeys::point, {.text = "A point of the axis; the origin if absent."})
          .key("direction", &CentrifugalKeys::direction,
               {.text =
                    "In space: the direction of the axis, of any length; along z if absent, as always in the plane."})
          .key("speed", &CentrifugalKeys::speed,
               {.text = "Angular velocity.", .unit = "radians per time", .presence = required})
          .check([](const CentrifugalKeys& keys, const KeyPlace& where, Complaints& complaints) {
            if (keys.direction && keys.direction->norm() == 0.0)
              complaints.add(where, "the key \"direction\" is [0, 0, 0]");
          });
  return declared;
}

template <>
const Schema<BodyForceKeys>& schema<BodyForceKeys>() {
  static const auto declared =
      Schema<BodyForceKeys>("body_force", "Loads in the domain of an elastic body; their sum acts.")
          .key("gravity", &BodyForceKeys::gravity,
               {.text = "The acceleration as a vector; needs a density.", .unit = "length per time squared"})
          .key("centrifugal", &BodyForceKeys::centrifugal, {.text = "A steady rotation; needs a density."})
          .key("force", &BodyForceKeys::force,
               {.text = "Force per volume: a number or expression in x, y, z for each component."})
          .key("temperature", &BodyForceKeys::temperature,
               {.text = "Above that of the body free of stress: number or expression in x, y, z; needs the material's "
                        "expansion."});
  return declared;
}

// --- How it is solved -------------------------------------------------------------------------------------------

namespace {

constexpr int most_field_degree = solver::DiscretisationOptions<3>::max_degree;
constexpr int most_bisections = solver::DiscretisationOptions<3>::max_refine;

}  // namespace

template <>
const Schema<PatchDiscretisationKeys>& schema<PatchDiscretisationKeys>() {
  using Keys = PatchDiscretisationKeys;
  static const auto declared =
      Schema<Keys>("patch", "Other choices for some patches.")
          .key("on", &Keys::on, {.text = "Name of a patch or list of names.", .presence = required})
          .key("degree", &Keys::degree,
               {.text = "Instead of that of [discretisation].", .range = Range::between(1, most_field_degree)})
          .key("refine", &Keys::refine,
               {.text = "Instead of that of [discretisation].", .range = Range::between(0, most_bisections)})
          .check([](const Keys& patch, const KeyPlace& where, Complaints& complaints) {
            if (!patch.degree && !patch.refine) complaints.add(where, "expected \"degree\", \"refine\" or both");
          });
  return declared;
}

template <>
const Schema<AdaptKeys>& schema<AdaptKeys>() {
  static const auto declared =
      Schema<AdaptKeys>("adapt",
                        "Solves, estimates the error of each element, bisects those where it is largest, and "
                        "begins again.")
          .key("tolerance", &AdaptKeys::tolerance,
               {.text = "Ends when the estimate of the relative error is no larger.", .range = open_fraction})
          .key("max_unknowns", &AdaptKeys::max_unknowns,
               {.text = "Larger systems are not solved, but for the first one.", .range = Range::between(1, 1000000)})
          .key("max_steps", &AdaptKeys::max_steps,
               {.text = "Systems to solve at most.", .range = Range::between(1, 1000)})
          .key("fraction", &AdaptKeys::fraction,
               {.text = "The elements that are bisected are the fewest with this share of the squared error.",
                .range = {.least = 0, .most = 1, .least_is_open = true}});
  return declared;
}

bool KeyType<AdaptEntry>::read(const Value& v, AdaptEntry& t, const Range&, const KeyPlace& w, Complaints& c) {
  if (const bool* wanted = v.as<bool>()) {
    if (*wanted) t.keys.emplace().where = w;
    return true;
  }
  if (v.as<Value::Table>()) return schema<AdaptKeys>().read(v, t.keys.emplace(), w, c);
  complain_type(c, w, v, "true, false or a table");
  return false;
}

std::vector<const Description*> KeyType<AdaptEntry>::nested() {
  return {&schema<AdaptKeys>().description()};
}

template <>
const Schema<DiscretisationKeys>& schema<DiscretisationKeys>() {
  using Keys = DiscretisationKeys;
  static const auto declared =
      Schema<Keys>("discretisation", "The functions that approximate the solution on the boundary.")
          .key("degree", &Keys::degree,
               {.text = "Of the functions, in every direction; that of the geometry if absent, at least 2.",
                .range = Range::between(1, most_field_degree)})
          .key("refine", &Keys::refine,
               {.text = "Bisections of every element.", .range = Range::between(0, most_bisections)})
          .key("patch", &Keys::patch, {.text = "Other choices for some patches: [[discretisation.patch]]."})
          .key("adapt", &Keys::adapt,
               {.text = "Refinement where the error is largest, beginning with the above; true takes the defaults."});
  return declared;
}

template <>
const Schema<SolveKeys>& schema<SolveKeys>() {
  static const auto declared =
      Schema<SolveKeys>("solve", "How the equations are solved.")
          .choice("method", &SolveKeys::method,
                  {{"auto", SolveMethodKind::automatic},
                   {"dense", SolveMethodKind::dense},
                   {"compressed", SolveMethodKind::compressed}},
                  {.text = "A dense matrix and its factors, a compressed one and iterations, or what suits the number "
                           "of unknowns."})
          .key("tolerance", &SolveKeys::tolerance,
               {.text = "Relative error that integrals, compression and iterations aim at.", .range = open_fraction})
          .key("max_iterations", &SolveKeys::max_iterations,
               {.text = "Then the solution counts as not converged.", .range = Range::between(1, 1000000)});
  return declared;
}

// --- Where it is wanted, and what it should be ------------------------------------------------------------------

template <>
const Schema<ProbeKeys>& schema<ProbeKeys>() {
  static const auto declared =
      Schema<ProbeKeys>("probe",
                        "Points at which the solution is wanted: \"points\", or \"from\" and \"to\", or \"file\".")
          .key("name", &ProbeKeys::name, {.text = "Its name in the results.", .presence = required})
          .key("points", &ProbeKeys::points, {.text = "Points inside the domain or on its boundary."})
          .key("from", &ProbeKeys::from, {.text = "First point of a straight line."})
          .key("to", &ProbeKeys::to, {.text = "Last point of a straight line."})
          .key("count", &ProbeKeys::count,
               {.text = "Points on the line, evenly spaced; 101 if absent.", .range = Range::between(2, 1000000)})
          .key("file", &ProbeKeys::file,
               {.text = "A file with a point a line, coordinates separated by commas or blanks; # begins a comment. "
                        "Relative to the case."})
          .check([](const ProbeKeys& probe, const KeyPlace& where, Complaints& complaints) {
            const bool line = probe.from && probe.to;
            if (probe.from.has_value() != probe.to.has_value()) {
              complaints.add(where, "a line needs both \"from\" and \"to\"");
            } else if (line && probe.from->values == probe.to->values) {
              complaints.add(where, "\"from\" and \"to\" are the same point");
            } else if (probe.count && !line) {
              complaints.add(where, "found \"count\", which goes with \"from\" and \"to\"");
            } else if (int{!probe.points.empty()} + int{line} + int{!probe.file.empty()} != 1) {
              complaints.add(where, "expected exactly one of \"points\", \"from\" with \"to\", and \"file\"");
            }
          });
  return declared;
}

template <>
const Schema<GridKeys>& schema<GridKeys>() {
  static const auto declared =
      Schema<GridKeys>("grid",
                       "A grid of points at which the solution is wanted, written as an image for ParaView: a box "
                       "from \"from\" to \"to\", flat in an axis with a count of 1; or \"corner\" and two \"sides\".")
          .key("name", &GridKeys::name, {.text = "Its name in the results.", .presence = required})
          .key("from", &GridKeys::from, {.text = "Lowest corner of a box."})
          .key("to", &GridKeys::to, {.text = "Highest corner of a box."})
          .key("corner", &GridKeys::corner, {.text = "In space: a corner of a rectangle."})
          .key("sides", &GridKeys::sides, {.text = "Its two sides as vectors, at right angles."})
          .key("counts", &GridKeys::counts,
               {.text = "Points along each axis or side.", .range = Range::between(1, 100000), .presence = required})
          .check([](const GridKeys& grid, const KeyPlace& where, Complaints& complaints) {
            const bool box = grid.from && grid.to && !grid.corner && grid.sides.empty();
            const bool rectangle = !grid.from && !grid.to && grid.corner && !grid.sides.empty();
            if (!box && !rectangle) {
              complaints.add(where, "expected either \"from\" and \"to\", or \"corner\" and \"sides\"");
            }
          });
  return declared;
}

template <>
const Schema<ExactKeys>& schema<ExactKeys>() {
  static const auto declared =
      Schema<ExactKeys>("exact",
                        "The exact solution, in expressions: errors against it are reported, relative to its largest "
                        "magnitude or norm, and may be expected.")
          .key("value", &ExactKeys::value, {.text = "Of the potential, in x, y, z."})
          .key("gradient", &ExactKeys::gradient, {.text = "Of the potential: one expression a component."})
          .key("flux", &ExactKeys::flux,
               {.text = "conductivity du/dn on the boundary, in x, y, z, nx, ny, nz; that of the gradient if absent."})
          .key("displacement", &ExactKeys::displacement, {.text = "One expression in x, y, z a component."})
          .key("stress", &ExactKeys::stress, {.text = "{ xx, yy, zz, xy, yz, xz } in x, y, z."})
          .key("traction", &ExactKeys::traction,
               {.text = "On the boundary, in x, y, z, nx, ny, nz, one a component; that of the stress if absent."})
          .check([](const ExactKeys& keys, const KeyPlace& where, Complaints& complaints) {
            if (!keys.value && !keys.gradient && !keys.flux && !keys.displacement && !keys.stress && !keys.traction)
              complaints.add(where, "the section is empty; expected at least one of its keys");
          });
  return declared;
}

}  // namespace isorim::io
