#include "io/propeller/propeller_shape.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/propeller/propeller.h"
#include "geometry/propeller/radial_law.h"
#include "geometry/propeller/series.h"
#include "io/case/curve_builder.h"

namespace isorim::io {
namespace {

using geometry::RadialLaw;

constexpr double degree = std::numbers::pi / 180.0;
/// Over the diameter: 0.05 mm on a screw of 500 mm.
constexpr double default_removal_tolerance = 1e-4;

/// Rows of r / R and a value, each value times `unit`.
RadialLaw table(const NumberArray& rows, const char* quantity, double unit) {
  std::vector<double> radii;
  std::vector<double> values;
  for (std::size_t i = 0; i < rows.values.size(); i += 2) {
    radii.push_back(rows.values[i]);
    values.push_back(rows.values[i + 1] * unit);
  }
  return located(rows.where, [&] { return RadialLaw(quantity, std::move(radii), std::move(values)); });
}

bool is_number(const NumberArray& given) {
  return given.values.size() == 1;
}

/// A straight generator line that leans aft by an angle.
RadialLaw rake_law(const PropellerKeys& keys) {
  if (keys.rake.values.empty()) return RadialLaw(0.0);
  if (!is_number(keys.rake)) return table(keys.rake, "rake", 1.0);
  const double at_tip = 0.5 * keys.diameter * std::tan(keys.rake.values.front() * degree);
  return {"rake", {0.0, 1.0}, {0.0, at_tip}};
}

/// Growing from the hub with the square of the distance.
RadialLaw skew_law(const PropellerKeys& keys) {
  if (keys.skew.values.empty()) return RadialLaw(0.0);
  if (!is_number(keys.skew)) return table(keys.skew, "skew", degree);
  std::vector<double> radii;
  std::vector<double> values;
  for (int k = 0; k <= 40; ++k) {
    radii.push_back(keys.hub_ratio + (1.0 - keys.hub_ratio) * k / 40.0);
    values.push_back(keys.skew.values.front() * degree * std::pow(k / 40.0, 2));
  }
  return {"skew", radii, values};
}

geometry::SeriesBlade series_blade(const PropellerKeys& keys) {
  geometry::SeriesBlade blade;
  blade.series = keys.series;
  blade.diameter = keys.diameter;
  blade.blades = keys.blades;
  blade.area_ratio = keys.area_ratio;
  blade.pitch_ratio = is_number(keys.pitch_ratio) ? RadialLaw(keys.pitch_ratio.values.front())
                                                  : table(keys.pitch_ratio, "pitch_ratio", 1.0);
  blade.rake = rake_law(keys);
  blade.skew = skew_law(keys);
  blade.has_reduced_root_pitch = keys.has_reduced_root_pitch;
  return blade;
}

geometry::BladeSurfaceOptions surface_options(const PropellerKeys& keys) {
  geometry::BladeSurfaceOptions options;
  options.hand = keys.hand;
  if (keys.uniformisation == BladeUniformisation::averaged) return options;
  options.fit = geometry::BladeFit::own_parameters;
  if (keys.uniformisation == BladeUniformisation::insert_and_remove) {
    const double tolerance = keys.removal_tolerance.value_or(default_removal_tolerance * keys.diameter);
    options.uniformisation = {geometry::Uniformisation::insert_and_remove, keys.inserted_knots, tolerance};
  }
  return options;
}

std::optional<geometry::Hub> hub(const PropellerKeys& keys) {
  if (keys.hub_ratio == 0.0) return std::nullopt;
  geometry::Hub hub{0.5 * keys.diameter * keys.hub_ratio};
  if (keys.hub_ends) {
    hub.aft = (*keys.hub_ends)(0);
    hub.forward = (*keys.hub_ends)(1);
  }
  return hub;
}

/// The screw, and what is known of its blades before it is built.
PropellerFacts facts_of(const PropellerKeys& keys) {
  PropellerFacts facts;
  facts.diameter = keys.diameter;
  facts.screw.blades = keys.blades;
  facts.screw.surface = surface_options(keys);
  facts.screw.hub = hub(keys);
  const geometry::SeriesBlade blade = series_blade(keys);
  facts.screw.sections = geometry::series_sections(blade);
  facts.asked_area_ratio = keys.area_ratio;
  facts.warnings = geometry::outside_tested_range(blade);
  facts.hub_radius = facts.screw.hub ? facts.screw.hub->radius : facts.screw.sections.front().station.radius;
  return facts;
}

}  // namespace

PropellerShape build_propeller_shape(const PropellerKeys& keys) {
  return located(keys.where, [&] {
    PropellerShape shape;
    PropellerFacts& facts = shape.facts;
    facts = facts_of(keys);
    geometry::PropellerModel model = geometry::propeller_model(facts.screw);
    facts.knots = model.knots;
    facts.hub = std::move(model.hub);
    facts.area_ratios = geometry::blade_areas(facts.screw.sections, facts.hub_radius)
                            .scaled(keys.blades / geometry::disc_area(keys.diameter));
    if (keys.transform.items.empty() && keys.clip.items.empty()) {
      shape.boundary.boundary = finished<3>(std::move(model.boundary), keys);
    } else {
      shape.boundary.boundary = finished_solid(model.boundary, keys);
      facts.whole = std::move(model.boundary);
    }
    return shape;
  });
}

}  // namespace isorim::io
