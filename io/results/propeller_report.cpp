#include "io/results/propeller_report.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "geometry/bezier/element_table.h"
#include "geometry/propeller/blade_section.h"
#include "solver/properties.h"

namespace isorim::io {
namespace {

quadrature::Estimate volume_of(const geometry::Boundary<3>& solid, const quadrature::Options& options) {
  solver::PropertyOptions<3> property_options;
  property_options.integration = options;
  return solver::geometric_properties(geometry::bezier_elements(solid), property_options).domain->measure;
}

/// Of the whole screw; nothing if its boundary counts as open.
std::optional<quadrature::Estimate> whole_volume(const PropellerFacts& facts, const std::vector<Quantity>& properties,
                                                 const quadrature::Options& options) {
  if (facts.whole) return volume_of(*facts.whole, options);
  const auto found = std::ranges::find(properties, "volume", &Quantity::name);
  if (found == properties.end() || found->value.values.empty()) return std::nullopt;
  return quadrature::Estimate{found->value.values.front(), found->largest_error()};
}

bool is_knot_count(const std::string& name) {
  return name.starts_with("control_points");
}

Json section_json(const PropellerFacts& facts, const geometry::BladeSection& section) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  return {{"radius_ratio", number(2.0 * section.station.radius / facts.diameter)},
          {"chord", number(section.chord)},
          {"leading_edge", number(section.leading_edge)},
          {"max_thickness", number(section.max_thickness)},
          {"pitch", number(section.station.pitch)},
          {"pitch_angle", number(section.station.pitch_angle() * degrees)},
          {"skew", number(section.station.skew * degrees)},
          {"rake", number(section.station.rake)}};
}

}  // namespace

std::vector<Quantity> propeller_quantities(const PropellerFacts& facts, const std::vector<Quantity>& properties,
                                           const quadrature::Options& options) {
  std::vector<Quantity> list;
  const auto add = [&](const char* name, double value) { list.push_back({name, single(value), {}, {}, {}, ""}); };
  add("expanded_area_ratio", facts.area_ratios.expanded);
  add("developed_area_ratio", facts.area_ratios.developed);
  add("projected_area_ratio", facts.area_ratios.projected);
  const quadrature::Estimate hub = facts.hub ? volume_of(*facts.hub, options) : quadrature::Estimate{0.0, 0.0};
  if (const auto whole = whole_volume(facts, properties, options)) {
    const double blades = facts.screw.blades;
    list.push_back({"blade_volume",
                    single((whole->value - hub.value) / blades),
                    {(whole->error + hub.error) / blades},
                    {},
                    {},
                    ""});
  } else {
    list.push_back({"blade_volume", {}, {}, {}, {}, "the boundary is open"});
  }
  list.push_back({"hub_volume", single(hub.value), {hub.error}, {}, {}, ""});
  add("control_points_round", facts.knots.control_points_round);
  add("control_points_across", facts.knots.control_points_across);
  return list;
}

Json propeller_json(const PropellerFacts& facts, const std::vector<Quantity>& quantities) {
  Json json{{"blades", facts.screw.blades},
            {"hand", facts.screw.surface.hand == geometry::Hand::right ? "right" : "left"},
            {"diameter", number(facts.diameter)},
            {"areas_outside_radius", number(facts.hub_radius)}};
  if (facts.asked_area_ratio) json["asked_area_ratio"] = number(*facts.asked_area_ratio);
  for (const Quantity& quantity : quantities) {
    if (is_knot_count(quantity.name)) continue;
    if (quantity.value.values.empty())
      json[quantity.name] = {{"value", nullptr}, {"reason", quantity.reason}};
    else if (quantity.error.empty())
      json[quantity.name] = number(quantity.value.values.front());
    else
      json[quantity.name] = {{"value", number(quantity.value.values.front())},
                             {"error", number(quantity.error.front())}};
  }
  json["control_points"] = {facts.knots.control_points_round, facts.knots.control_points_across};
  json["merged_control_points"] = facts.knots.merged_control_points;
  json["knots_inserted"] = facts.knots.inserted;
  json["knots_removed"] = facts.knots.removed;
  json["removal_error"] = number(facts.knots.removal_error);
  json["sections"] = Json::array();
  for (const geometry::BladeSection& section : facts.screw.sections)
    json["sections"].push_back(section_json(facts, section));
  return json;
}

std::string propeller_text(const PropellerFacts& facts) {
  const geometry::BladeKnots& knots = facts.knots;
  std::string text = fmt::format("  {} blades, {}-handed; {} x {} control points a blade", facts.screw.blades,
                                 facts.screw.surface.hand == geometry::Hand::right ? "right" : "left",
                                 knots.control_points_round, knots.control_points_across);
  if (knots.removed > 0)
    text += fmt::format(" ({} if all knots were merged; {} removed, which moved points by at most {:.2e})",
                        knots.merged_control_points, knots.removed, knots.removal_error);
  return text + "\n";
}

}  // namespace isorim::io
