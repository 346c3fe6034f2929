#include "geometry/propeller/propeller.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/intersection/clip.h"
#include "geometry/intersection/tool_caps.h"
#include "geometry/propeller/blade_foot.h"
#include "geometry/propeller/curved_hub.h"
#include "geometry/propeller/generatrix.h"
#include "geometry/shapes/checks.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "geometry/trimming/trimmed_surface.h"

namespace isorim::geometry {
namespace {

/// The part of the hub's radius that the blades' inner ends stay below, so that the hub cuts them cleanly.
constexpr double reach = 0.97;
/// How far a blade's surface may be continued inward, as a part of its domain.
constexpr double longest_extension = 0.25;
/// Of the hub beyond the blades, in its radii.
constexpr double overhang = 0.25;

void check_propeller(const Propeller& screw) {
  if (screw.blades < 1) throw GeometryError(fmt::format("propeller: {} blades, at least 1 is needed", screw.blades));
  if (!screw.hub) return;
  if (screw.hub->profile.empty()) checks::positive("propeller hub", "radius", screw.hub->radius);
  if (screw.hub->aft) checks::finite("propeller hub", "aft", *screw.hub->aft);
  if (screw.hub->forward) checks::finite("propeller hub", "forward", *screw.hub->forward);
}

/// Largest distance of the surface's inner edge from the shaft, as a part of the hub's radius there.
double inner_reach(const NurbsSurface<3>& surface, const std::function<double(double x)>& hub_radius) {
  const NurbsCurve<3> edge = isoparametric_curve(surface, Direction::u, surface.knots_v().domain().first);
  const Interval domain = edge.domain();
  double largest = 0.0;
  constexpr int samples = 200;
  for (int i = 0; i <= samples; ++i) {
    const Point3 point = evaluate(edge, std::lerp(domain.first, domain.last, static_cast<double>(i) / samples));
    largest = std::max(largest, std::hypot(point.y(), point.z()) / hub_radius(point.x()));
  }
  return largest;
}

/// The surface, continued inward until its inner edge lies inside the hub.
NurbsSurface<3> into_hub(const NurbsSurface<3>& surface, const std::function<double(double x)>& hub_radius) {
  const double given = inner_reach(surface, hub_radius);
  if (given <= reach) return surface;
  const Interval domain = surface.knots_v().domain();
  for (double part = 0.01; part <= longest_extension; part *= 1.25) {
    const NurbsSurface<3> extended =
        extend(surface, Direction::v, {domain.first - part * domain.length(), domain.last});
    if (inner_reach(extended, hub_radius) <= reach) return extended;
  }
  const Point3 inner = evaluate(surface, {surface.knots_u().domain().first, domain.first});
  throw GeometryError(fmt::format(
      "propeller: the blades start at a radius of {:.6g}, too far outside the hub of radius {:.6g} to be continued "
      "into it; add a section farther in",
      std::hypot(inner.y(), inner.z()), hub_radius(inner.x())));
}

std::string blade_patch_name(const std::string& part, int blade) {
  return part == "blade" ? fmt::format("blade_{}", blade) : fmt::format("blade_{}_{}", blade, part);
}

/// Copies about the shaft.
Boundary<3> all_blades(const Boundary<3>& blade, int count) {
  Boundary<3> result;
  for (int k = 0; k < count; ++k) {
    const Axis shaft{Point3::Zero(), Vector3::UnitX()};
    Boundary<3> turned = transform(blade, rotation(shaft, 2.0 * std::numbers::pi * k / count));
    for (Patch<3>& patch : turned.patches) {
      patch.name = blade_patch_name(patch.name, k + 1);
      result.patches.push_back(std::move(patch));
    }
  }
  return result;
}

/// The hub with and without the places where the blades stand on it.
struct HubParts {
  std::vector<Patch<3>> beside_blades;
  Boundary<3> whole;
};

/// What closes the hub beyond an edge of its cylinder.
std::vector<Patch<3>> hub_end(const std::string& name, const NurbsCurve<3>& edge,
                              const std::vector<NurbsCurve<2>>& profile) {
  const auto disc = [](const NurbsCurve<3>& rim, double x) { return fan<3>(rim, Point3(x, 0.0, 0.0)); };
  if (profile.empty()) return {{name, disc(edge, evaluate(edge, edge.domain().first).x())}};
  std::vector<Patch<3>> patches;
  const auto next_name = [&] { return fmt::format("{}_{}", name, patches.size() + 1); };
  for (const NurbsCurve<2>& curve : profile) patches.push_back({next_name(), turned(curve)});
  const Point2 last = evaluate(profile.back(), profile.back().domain().last);
  if (last.y() > 1e-12 * std::abs(last.x())) {
    const NurbsCurve<3> rim = boundary_curves(surface_of(patches.back().shape))[2];
    patches.push_back({next_name(), disc(rim, last.x())});
  }
  return patches;
}

/// The hub's side and ends, given the part of the side that the blades cover.
HubParts hub_parts(const TrimmedSurface& covered, const Hub& hub) {
  const Interval blades = covered.surface().knots_v().domain();
  const Interval ends{hub.aft.value_or(blades.first - overhang * hub.radius),
                      hub.forward.value_or(blades.last + overhang * hub.radius)};
  if (blades.first < ends.first || ends.last < blades.last) {
    throw GeometryError(fmt::format(
        "propeller hub: it runs from X = {:.6g} to {:.6g}; the blades on it need {:.6g} to {:.6g}, with a margin",
        ends.first, ends.last, blades.first, blades.last));
  }
  const NurbsSurface<3> side = extend(covered.surface(), Direction::v, ends);
  const double size = 2.0 * hub.radius + ends.length();
  std::vector<TrimLoop> loops = loops_beside(covered, side, size);
  const std::array<NurbsCurve<3>, 4> edges = boundary_curves(side);
  HubParts parts{{{"hub", TrimmedSurface(side, std::move(loops))}}, {{{"hub", side}}}};
  for (const std::vector<Patch<3>>& end :
       {hub_end("hub_aft", edges[0], hub.beyond_aft), hub_end("hub_forward", edges[2], hub.beyond_forward)}) {
    parts.beside_blades.insert(parts.beside_blades.end(), end.begin(), end.end());
    parts.whole.patches.insert(parts.whole.patches.end(), end.begin(), end.end());
  }
  return parts;
}

/// The blades outside the hub, and the hub outside the blades; the hub alone.
struct Joined {
  Boundary<3> screw;
  Boundary<3> hub;
};

Joined joined(const Boundary<3>& blades, const Hub& hub) {
  const CylinderTool tool{Point3::Zero(), Vector3::UnitX(), hub.radius, KeptSide::outside};
  Joined result;
  std::optional<HubParts> parts;
  for (Patch<3>& patch : clip(blades, tool).patches) {
    if (patch.name == "cap")
      parts = hub_parts(std::get<TrimmedSurface>(patch.shape), hub);
    else
      result.screw.patches.push_back(std::move(patch));
  }
  if (!parts)
    throw GeometryError(fmt::format("propeller: the blades do not reach the hub of radius {:.6g}", hub.radius));
  for (Patch<3>& patch : parts->beside_blades) result.screw.patches.push_back(std::move(patch));
  result.hub = std::move(parts->whole);
  return result;
}

/// The feet lie on the cylinder of a hub by its profile, with a little more than the margin that joined() keeps.
bool stands_on_cylinder(const NurbsSurface<3>& blade, const Hub& hub) {
  if (!(hub.radius > 0.0)) return false;
  const Generatrix profile(hub.profile);
  const NurbsSurface<3> reaching = into_hub(blade, [&](double x) { return profile.radius(x); });
  const Interval feet = BladeFoot(reaching, profile).extent();
  const double margin = 0.025 * feet.length() + 1.2e-3 * hub.radius;
  return *hub.aft <= feet.first - margin && feet.last + margin <= *hub.forward;
}

Boundary<3> closed(const Boundary<3>& boundary) {
  OrientedBoundary<3> oriented = orient(boundary);
  require_closed(oriented);
  return std::move(oriented.boundary);
}

}  // namespace

PropellerModel propeller_model(const Propeller& screw) {
  check_propeller(screw);
  const BladeSkin skin = skin_blade(screw.sections, screw.surface);
  const double leading_edge = leading_edge_parameter(screw.sections);
  if (!screw.hub) return {closed(all_blades(close_blade(skin.surface, leading_edge), screw.blades)), skin.knots, {}};
  const Hub& hub = *screw.hub;
  if (hub.profile.empty() || stands_on_cylinder(skin.surface, hub)) {
    const NurbsSurface<3> reaching = into_hub(skin.surface, [&](double) { return hub.radius; });
    const Joined parts = joined(all_blades(close_blade(reaching, leading_edge), screw.blades), hub);
    return {closed(parts.screw), skin.knots, closed(parts.hub)};
  }
  const Generatrix profile(hub.profile);
  const NurbsSurface<3> reaching = into_hub(skin.surface, [&](double x) { return profile.radius(x); });
  HubJoint joint = joined_to_profile(close_blade(reaching, leading_edge), screw.blades, hub.profile);
  Boundary<3> whole = all_blades(joint.blade, screw.blades);
  for (Patch<3>& patch : joint.hub_beside_blades) whole.patches.push_back(std::move(patch));
  return {closed(whole), skin.knots, closed(joint.hub), joint.feet};
}

Boundary<3> propeller(const Propeller& screw) {
  return propeller_model(screw).boundary;
}

}  // namespace isorim::geometry
