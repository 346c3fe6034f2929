#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "io/case/hydrostatics_keys.h"
#include "io/hydrostatics/hydrostatics_tables.h"

namespace isorim::io {
namespace {

constexpr int most_values = 10000;
/// Of a step: what rounding may add to a whole number of them.
constexpr double whole_step = 1e-9;
constexpr Presence required = Presence::required;

struct NumberRange {
  double from = 0.0;
  double to = 0.0;
  std::optional<double> step;
  std::optional<int> count;
  KeyPlace where;
};

std::vector<double> values_of(const NumberRange& range) {
  std::vector<double> values;
  const int steps =
      range.count ? *range.count - 1 : static_cast<int>(std::floor((range.to - range.from) / *range.step + whole_step));
  for (int k = 0; k <= steps; ++k)
    values.push_back(range.count ? range.from + (range.to - range.from) * k / std::max(1, steps)
                                 : range.from + k * *range.step);
  const bool is_at_end = range.count || std::abs(values.back() - range.to) <= whole_step * *range.step;
  if (is_at_end && steps > 0) values.back() = range.to;
  return values;
}

/// Rising and not empty; what is wrong with the type has been said.
void check_list(const NumberList& list, const char* name, bool must_rise, const KeyPlace& where,
                Complaints& complaints) {
  const KeyPlace place = where.key(name, where.place);
  if (complaints.concern(place.path)) return;
  if (list.values.empty()) complaints.add(place, "the list is empty");
  for (std::size_t i = 1; must_rise && i < list.values.size(); ++i)
    if (!(list.values[i] > list.values[i - 1])) {
      complaints.add(place,
                     fmt::format("found {} after {}; expected rising numbers", list.values[i], list.values[i - 1]));
      return;
    }
}

void check_coordinates(const Coordinates& coordinates, std::size_t count, Complaints& complaints) {
  if (coordinates.values.empty() || coordinates.values.size() == count) return;
  complaints.add(coordinates.where, fmt::format("found {} coordinates; expected {}", coordinates.values.size(), count));
}

}  // namespace

template <>
const Schema<NumberRange>& schema<NumberRange>() {
  static const auto declared =
      Schema<NumberRange>("numbers", "Numbers from one to another, instead of a list.")
          .key("from", &NumberRange::from, {.text = "The first.", .presence = required})
          .key("to", &NumberRange::to,
               {.text = "The last, if a whole number of steps leads to it.", .presence = required})
          .key("step", &NumberRange::step, {.text = "From one to the next.", .range = Range::above(0)})
          .key("count", &NumberRange::count,
               {.text = "Instead of a step: how many, equally spaced, both ends among them.",
                .range = Range::between(2, most_values)})
          .check([](const NumberRange& range, const KeyPlace& where, Complaints& complaints) {
            if (range.step.has_value() == range.count.has_value())
              complaints.add(where, "expected either \"step\" or \"count\"");
            else if (!(range.to > range.from))
              complaints.add(
                  where, fmt::format("found from = {} and to = {}; expected a range that rises", range.from, range.to));
            else if (range.step && (range.to - range.from) / *range.step > most_values)
              complaints.add(where, fmt::format("more than {} numbers", most_values));
          });
  return declared;
}

template <>
struct KeyType<NumberList> {
  static std::string type() { return "list of reals or table"; }
  static std::vector<const Description*> nested() { return {&schema<NumberRange>().description()}; }
  static bool read(const Value& v, NumberList& t, const Range& r, const KeyPlace& w, Complaints& c) {
    if (!v.as<Value::Table>()) return KeyType<std::vector<double>>::read(v, t.values, r, w, c);
    NumberRange range;
    if (!schema<NumberRange>().read(v, range, w, c)) return false;
    t.values = values_of(range);
    return true;
  }
  static std::string print(const NumberList&) { return ""; }
};

template <>
const Schema<LoadingKeys>& schema<LoadingKeys>() {
  static const auto declared =
      Schema<LoadingKeys>("loading", "What the body weighs.")
          .key("mass", &LoadingKeys::mass,
               {.text = "In the units of the water's density: it displaces mass / water_density.",
                .range = Range::above(0),
                .presence = required})
          .key("centre_of_gravity", &LoadingKeys::centre_of_gravity,
               {.text = "In the coordinates of the shape.", .unit = "length", .presence = required})
          .check([](const LoadingKeys& keys, const KeyPlace&, Complaints& complaints) {
            check_coordinates(keys.centre_of_gravity, 3, complaints);
          });
  return declared;
}

template <>
const Schema<CurvesOfFormKeys>& schema<CurvesOfFormKeys>() {
  static const auto declared =
      Schema<CurvesOfFormKeys>("curves_of_form", "The hydrostatics over the draught.")
          .key("draughts", &CurvesOfFormKeys::draughts,
               {.text = "At the trim and heel of [hydrostatics].", .unit = "length", .presence = required})
          .check([](const CurvesOfFormKeys& keys, const KeyPlace& where, Complaints& complaints) {
            check_list(keys.draughts, "draughts", true, where, complaints);
          });
  return declared;
}

template <>
const Schema<BonjeanKeys>& schema<BonjeanKeys>() {
  static const auto declared =
      Schema<BonjeanKeys>("bonjean", "Immersed areas of transverse sections over the draught, upright.")
          .key("stations", &BonjeanKeys::stations,
               {.text = "x of the sections.", .unit = "length", .presence = required})
          .key("draughts", &BonjeanKeys::draughts, {.text = "Draughts.", .unit = "length", .presence = required})
          .check([](const BonjeanKeys& keys, const KeyPlace& where, Complaints& complaints) {
            check_list(keys.stations, "stations", true, where, complaints);
            check_list(keys.draughts, "draughts", true, where, complaints);
          });
  return declared;
}

template <>
const Schema<RightingArmsKeys>& schema<RightingArmsKeys>() {
  static const auto declared =
      Schema<RightingArmsKeys>("righting_arms", "The curve of righting arms GZ of the body with its loading.")
          .key("heels", &RightingArmsKeys::heels,
               {.text = "Angles of heel, to starboard positive.", .unit = "degrees", .presence = required})
          .choice("trim", &RightingArmsKeys::trim, {{"free", TrimChoice::free}, {"fixed", TrimChoice::fixed}},
                  {.text = "Whether the body trims at each heel until its centres are in line, or keeps its trim."})
          .check([](const RightingArmsKeys& keys, const KeyPlace& where, Complaints& complaints) {
            check_list(keys.heels, "heels", true, where, complaints);
          });
  return declared;
}

template <>
const Schema<CrossCurvesKeys>& schema<CrossCurvesKeys>() {
  static const auto declared =
      Schema<CrossCurvesKeys>("cross_curves", "Cross curves of stability: arms KN about the origin on the baseline.")
          .key("displacements", &CrossCurvesKeys::displacements,
               {.text = "Masses of the displaced water.", .range = Range::above(0), .presence = required})
          .key("heels", &CrossCurvesKeys::heels, {.text = "Angles of heel.", .unit = "degrees", .presence = required})
          .check([](const CrossCurvesKeys& keys, const KeyPlace& where, Complaints& complaints) {
            check_list(keys.displacements, "displacements", true, where, complaints);
            check_list(keys.heels, "heels", true, where, complaints);
          });
  return declared;
}

template <>
const Schema<HydrostaticsKeys>& schema<HydrostaticsKeys>() {
  static const auto declared =
      Schema<HydrostaticsKeys>("hydrostatics",
                               "A closed solid afloat: x points forward, y to port, z up. Results in results.json, "
                               "tables as CSV, curves as SVG.")
          .key("draught", &HydrostaticsKeys::draught,
               {.text = "From the baseline to the water at the origin; that of the loading if absent.",
                .unit = "length"})
          .key("trim", &HydrostaticsKeys::trim,
               {.text = "Angle between the x axis and the water, positive by the stern.",
                .unit = "degrees",
                .range = Range::between(-90, 90)})
          .key("heel", &HydrostaticsKeys::heel,
               {.text = "Turn about the x axis, positive to starboard.",
                .unit = "degrees",
                .range = Range::between(-180, 180)})
          .key("water_density", &HydrostaticsKeys::water_density,
               {.text = "The displacement is this times the volume.", .range = Range::above(0)})
          .key("baseline", &HydrostaticsKeys::baseline,
               {.text = "z from which draughts and heights count; that of a hull's table, else of the lowest point, if "
                        "absent.",
                .unit = "length"})
          .key("origin", &HydrostaticsKeys::origin,
               {.text = "x and y at which the draught is measured; amidships of a hull's table, else the middle of the "
                        "shape's "
                        "box, if absent. The section there is the midship section.",
                .unit = "length"})
          .key(
              "length", &HydrostaticsKeys::length,
              {.text = "For the coefficients; that between a hull's perpendiculars, else of the waterplane, if absent.",
               .unit = "length",
               .range = Range::above(0)})
          .key("beam", &HydrostaticsKeys::beam,
               {.text = "For the coefficients; the moulded one of a hull, else that of the waterplane, if absent.",
                .unit = "length",
                .range = Range::above(0)})
          .key("loading", &HydrostaticsKeys::loading, {.text = "The body's mass: where it comes to rest."})
          .key("curves_of_form", &HydrostaticsKeys::curves_of_form, {.text = "Hydrostatics over the draught."})
          .key("bonjean", &HydrostaticsKeys::bonjean, {.text = "Immersed areas of sections."})
          .key("righting_arms", &HydrostaticsKeys::righting_arms, {.text = "GZ over the heel; needs a loading."})
          .key("cross_curves", &HydrostaticsKeys::cross_curves, {.text = "KN over heel and displacement."})
          .check([](const HydrostaticsKeys& keys, const KeyPlace& where, Complaints& complaints) {
            if (keys.origin) check_coordinates(*keys.origin, 2, complaints);
            if (!keys.draught && !keys.loading && !complaints.concern(where.path + ".loading"))
              complaints.add(where, "expected a \"draught\" or a \"loading\"");
            if (keys.righting_arms && !keys.loading && !complaints.concern(where.path + ".loading"))
              complaints.add(keys.righting_arms->where, "righting arms need a \"loading\" in [hydrostatics]");
          });
  return declared;
}

std::vector<std::string> hydrostatics_quantity_names(const HydrostaticsKeys& keys) {
  std::vector<std::string> names;
  const auto add = [&](const char* table, const std::vector<std::string>& columns) {
    for (const std::string& column : columns) names.push_back(fmt::format("{}.{}", table, column));
  };
  add("hydrostatics", hydrostatics_columns());
  if (keys.curves_of_form) add("curves_of_form", hydrostatics_columns());
  if (keys.bonjean) add("bonjean", bonjean_columns());
  if (keys.loading) add("equilibria", equilibrium_columns());
  if (keys.righting_arms) add("righting_arms", righting_columns());
  if (keys.righting_arms) add("righting_arms", righting_scalars());
  if (keys.cross_curves) add("cross_curves", cross_columns());
  return names;
}

}  // namespace isorim::io
