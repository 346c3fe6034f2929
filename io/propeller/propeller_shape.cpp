#include "io/propeller/propeller_shape.h"

#include <optional>
#include <utility>
#include <vector>

#include "geometry/propeller/propeller.h"
#include "io/case/curve_builder.h"
#include "io/propeller/propeller_blade.h"

namespace isorim::io {
namespace {

/// Over the diameter: 0.05 mm on a screw of 500 mm.
constexpr double default_removal_tolerance = 1e-4;

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
  if (!keys.hub_profile.empty()) {
    std::vector<geometry::NurbsCurve<2>> profile;
    for (const CurveKeys& curve : keys.hub_profile)
      for (geometry::NurbsCurve<2>& piece : plane_curves(curve)) profile.push_back(std::move(piece));
    return geometry::hub_by_profile(profile);
  }
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
  PropellerBlade blade = propeller_blade(keys);
  facts.diameter = keys.diameter;
  facts.asked_area_ratio = keys.area_ratio;
  facts.warnings = std::move(blade.warnings);
  facts.screw.blades = keys.blades;
  facts.screw.surface = surface_options(keys);
  facts.screw.surface.edits = blade_edits(keys, blade.sections);
  facts.screw.sections = std::move(blade.sections);
  facts.screw.hub = hub(keys);
  facts.hub_radius = facts.screw.hub ? radius_at_generator_line(*facts.screw.hub, facts.screw.sections)
                                     : facts.screw.sections.front().station.radius;
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
    facts.feet = model.feet;
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
