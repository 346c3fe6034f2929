#include <algorithm>
#include <cctype>
#include <cstddef>

#include <fmt/format.h>

#include "io/case/case_file.h"
#include "io/excerpt.h"
#include "quadrature/gauss_legendre.h"

/// The declarations of the sections of a case file.
namespace isorim::io {

namespace {

constexpr auto required = Presence::required;

struct CountRange {
  int from = 1;
  int to = 0;
  int step = 1;
};

}  // namespace

template <>
const Schema<CountRange>& schema<CountRange>();

template <>
const Schema<PropertiesKeys>& schema<PropertiesKeys>() {
  static const auto declared =
      Schema<PropertiesKeys>("properties", "How the properties and integrals are computed.")
          .key("tolerance", &PropertiesKeys::tolerance,
               {.text = "Relative error aimed at.", .range = {.least = 0, .most = 0.1, .least_is_open = true}})
          .key("density", &PropertiesKeys::density,
               {.text = "Adds the mass, and makes inertia and principal_moments those of the mass; without it they "
                        "are for density 1.",
                .unit = "mass per area or volume",
                .range = Range::above(0)})
          .key("pole", &PropertiesKeys::pole,
               {.text = "Pole of the radial integration; the middle of the bounding box if absent."})
          .key("gauss_points", &PropertiesKeys::gauss_points,
               {.text = "n > 0: the fixed n-point Gauss rule per knot span and direction instead of adaptive "
                        "integration.",
                .range = Range::between(0, quadrature::max_fixed_points)})
          .choice("open_boundary", &PropertiesKeys::open_boundary,
                  {{"refuse", OpenBoundary::refuse}, {"integrate", OpenBoundary::integrate}},
                  {.text = "A boundary with free edges encloses nothing: its domain is refused, or integrated as if "
                           "cones from the pole to the free edges closed it (the numbers then depend on the pole)."})
          .key("closure_tolerance", &PropertiesKeys::closure_tolerance,
               {.text = "Ends and edges nearer than this count as the same, relative to the size of the shape.",
                .range = {.least = 0, .most = 0.1, .least_is_open = true}});
  return declared;
}

template <>
const Schema<IntegralKeys>& schema<IntegralKeys>() {
  static const auto declared =
      Schema<IntegralKeys>("integral", "An integral over the domain or the boundary; any number of them.")
          .key("name", &IntegralKeys::name, {.text = "Its name in the results.", .presence = required})
          .choice("over", &IntegralKeys::over, {{"domain", IntegralOver::domain}, {"boundary", IntegralOver::boundary}},
                  {.text = "What to integrate over."})
          .key("integrand", &IntegralKeys::integrand,
               {.text = "Expression in x, y (and z in space), on a boundary also the outward normal nx, ny (nz); "
                        "constants pi, e; functions sqrt, exp, ln, sin, atan2, ...",
                .presence = required})
          .key("tolerance", &IntegralKeys::tolerance,
               {.text = "Instead of that of [properties].", .range = {.least = 0, .most = 0.1, .least_is_open = true}})
          .key("pole", &IntegralKeys::pole, {.text = "Over a domain: instead of that of [properties]."})
          .check([](const IntegralKeys& integral, const KeyPlace& where, Complaints& complaints) {
            const bool is_plain = std::all_of(integral.name.begin(), integral.name.end(), [](char c) {
              return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
            });
            if (integral.name.empty() || !is_plain) {
              complaints.add(where.key("name", where.place),
                             fmt::format("found \"{}\"; expected letters, digits, _ and -", excerpt(integral.name)));
            }
            if (integral.integrand.empty()) {
              complaints.add(where.key("integrand", where.place), "found an empty expression");
            }
            if (integral.pole && integral.over == IntegralOver::boundary) {
              complaints.add(integral.pole->where, "an integral over a boundary has no pole");
            }
          });
  return declared;
}

template <>
const Schema<ExpectationKeys>& schema<ExpectationKeys>() {
  static const auto declared =
      Schema<ExpectationKeys>("expectation",
                              "What a quantity should be: met if |value - expected| <= atol + rtol max|expected| for "
                              "each entry. At least one of rtol and atol.")
          .key("value", &ExpectationKeys::value, {.text = "Expected value.", .presence = required})
          .key("rtol", &ExpectationKeys::rtol, {.text = "Relative tolerance.", .range = Range::at_least(0)})
          .key("atol", &ExpectationKeys::atol, {.text = "Absolute tolerance.", .range = Range::at_least(0)})
          .check([](const ExpectationKeys& expectation, const KeyPlace& where, Complaints& complaints) {
            if (!expectation.rtol && !expectation.atol) {
              complaints.add(where, "found no tolerance; expected at least one of \"rtol\" and \"atol\"");
            }
          });
  return declared;
}

template <>
const Schema<ExpectKeys>& schema<ExpectKeys>() {
  static const auto declared =
      Schema<ExpectKeys>("expect",
                         "Expected values, one a quantity (perimeter, area, volume, centroid, inertia, "
                         "principal_moments, mass, closure_defect or the name of an integral; of an analysis "
                         "unknowns, iterations, residual, balance, errors against [exact] such as boundary_l2, "
                         "and \"NAME.value\" of a probe or boundary condition; of plane sections \"NAME.area\", "
                         "perimeter, loops, ..., one value a plane), as "
                         "quantity = { value, rtol, atol }.");
  return declared;
}

/// [expect] has no keys of its own: every key is the name of a quantity.
template <>
struct KeyType<ExpectKeys> {
  static std::string type() { return "table"; }
  static std::vector<const Description*> nested() {
    return {&schema<ExpectKeys>().description(), &schema<ExpectationKeys>().description()};
  }
  static bool read(const Value& v, ExpectKeys& t, const Range&, const KeyPlace& w, Complaints& c) {
    const auto* table = v.as<Value::Table>();
    if (!table) {
      complain_type(c, w, v, "a table");
      return false;
    }
    bool good = true;
    for (const TableEntry& entry : *table) {
      t.quantities.emplace_back(entry.key, ExpectationKeys{});
      good &= schema<ExpectationKeys>().read(entry.value, t.quantities.back().second,
                                             w.key(entry.key, entry.value.place), c);
    }
    return good;
  }
  static std::string print(const ExpectKeys&) { return ""; }
};

template <>
const Schema<OutputKeys>& schema<OutputKeys>() {
  static const auto declared =
      Schema<OutputKeys>("output", "What is written besides results.json.")
          .key("vtk", &OutputKeys::vtk,
               {.text = "boundary.vtu and edges.vtu: exact rational Bézier cells for ParaView."})
          .key("hdf5", &OutputKeys::hdf5, {.text = "results.h5: the results and the Bézier elements."})
          .key(
              "svg", &OutputKeys::svg,
              {.text = "boundary.svg: a picture of a region of the plane. tmesh_PATCH.svg: the T-mesh of each T-spline "
                       "that the case gives."})
          .key("stl", &OutputKeys::stl, {.text = "boundary.stl: a watertight mesh of a solid, for printers and mills."})
          .key("stl_tolerance", &OutputKeys::stl_tolerance,
               {.text = "How far the triangles of a mesh may lie from the boundary; 0: 1e-4 of its diagonal.",
                .unit = "length",
                .range = Range::at_least(0)});
  return declared;
}

template <>
const Schema<CountRange>& schema<CountRange>() {
  static const auto declared =
      Schema<CountRange>("range", "Counts from one number to another.")
          .key("from", &CountRange::from, {.text = "First.", .range = Range::between(1, quadrature::max_fixed_points)})
          .key("to", &CountRange::to,
               {.text = "Last.", .range = Range::between(1, quadrature::max_fixed_points), .presence = required})
          .key("step", &CountRange::step, {.text = "Stride.", .range = Range::between(1, quadrature::max_fixed_points)})
          .check([](const CountRange& range, const KeyPlace& where, Complaints& complaints) {
            if (range.from > range.to) {
              complaints.add(where, fmt::format("found from = {} above to = {}", range.from, range.to));
            }
          });
  return declared;
}

template <>
struct KeyType<PointCounts> {
  static std::string type() { return "list of integers or table"; }
  static std::vector<const Description*> nested() { return {&schema<CountRange>().description()}; }
  static bool read(const Value& v, PointCounts& t, const Range& r, const KeyPlace& w, Complaints& c) {
    if (!v.as<Value::Table>()) return KeyType<std::vector<int>>::read(v, t.counts, r, w, c);
    CountRange range;
    if (!schema<CountRange>().read(v, range, w, c)) return false;
    for (int n = range.from; n <= range.to; n += range.step) t.counts.push_back(n);
    return true;
  }
  static std::string print(const PointCounts&) { return ""; }
};

template <>
const Schema<ConvergenceKeys>& schema<ConvergenceKeys>() {
  static const auto declared =
      Schema<ConvergenceKeys>("convergence",
                              "Runs fixed Gauss rules and writes the relative errors against the expected "
                              "values as convergence.csv and convergence.svg.")
          .key("points", &ConvergenceKeys::points,
               {.text = "Numbers of points per knot span and direction.",
                .range = Range::between(1, quadrature::max_fixed_points),
                .presence = required})
          .key("quantities", &ConvergenceKeys::quantities,
               {.text = "Properties or integrals that have an expected value; all that have one if absent."})
          .check([](const ConvergenceKeys& convergence, const KeyPlace& where, Complaints& complaints) {
            if (convergence.points.counts.empty()) complaints.add(where, "the list \"points\" is empty");
          });
  return declared;
}

template <>
const Schema<CaseKeys>& schema<CaseKeys>() {
  static const auto declared =
      Schema<CaseKeys>("case", "A case file: the keys and sections at its top.")
          .key("title", &CaseKeys::title, {.text = "What the case is; the file's name if absent."})
          .key(
              "source", &CaseKeys::source,
              {.text =
                   "Where the shape and its expected values come from; or the section [source] of Poisson's equation."})
          .key("geometry", &CaseKeys::geometry, {.text = "The shape, by its \"type\".", .presence = required})
          .key("properties", &CaseKeys::properties, {.text = "How the integrals are computed."})
          .key("integral", &CaseKeys::integral, {.text = "Integrals: [[integral]], any number."})
          .key("section", &CaseKeys::section, {.text = "Plane sections of a solid: [[section]], any number."})
          .key("lines_plan", &CaseKeys::lines_plan, {.text = "The lines plan of a hull."})
          .key("drawings", &CaseKeys::drawings, {.text = "Workshop drawings."})
          .key("moulds", &CaseKeys::moulds, {.text = "Templates of the boards of a mould."})
          .key("hydrostatics", &CaseKeys::hydrostatics, {.text = "A solid afloat."})
          .key("added_mass", &CaseKeys::added_mass, {.text = "The inertia of the fluid around a solid."})
          .key("expect", &CaseKeys::expect, {.text = "Expected values."})
          .key("output", &CaseKeys::output, {.text = "What is written."})
          .key("convergence", &CaseKeys::convergence, {.text = "A study of fixed Gauss rules."})
          .key("definitions", &CaseKeys::definitions, {.text = "Names for use in the expressions of the case."})
          .key("analysis", &CaseKeys::analysis, {.text = "A boundary-element analysis: what is solved."})
          .key("material", &CaseKeys::material, {.text = "Analysis: the material."})
          .key("boundary_condition", &CaseKeys::boundary_condition,
               {.text = "Analysis: what holds on the boundary, [[boundary_condition]], any number."})
          .key("body_force", &CaseKeys::body_force, {.text = "Elasticity: loads in the domain."})
          .key("discretisation", &CaseKeys::discretisation, {.text = "Analysis: the functions on the boundary."})
          .key("solve", &CaseKeys::solve, {.text = "Analysis: how the equations are solved."})
          .key("probe", &CaseKeys::probe, {.text = "Analysis: points where the solution is wanted, [[probe]]."})
          .key("grid", &CaseKeys::grid, {.text = "Analysis: grids of such points, [[grid]]."})
          .key("exact", &CaseKeys::exact, {.text = "Analysis: the exact solution, to measure errors."});
  return declared;
}

}  // namespace isorim::io
