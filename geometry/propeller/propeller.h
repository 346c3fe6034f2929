#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/propeller/blade_surface.h"

namespace isorim::geometry {

/// A round hub about the shaft (the X axis): the cylinder that the blades stand on, and what lies beyond it; or a whole
/// profile.
struct Hub {
  /// Of the cylinder; of a hub by its profile 0 where that has none.
  double radius = 0.0;
  /// X of the after and the forward end; absent: a quarter of the radius beyond the blades.
  std::optional<double> aft = std::nullopt;
  std::optional<double> forward = std::nullopt;
  /// Profiles in (X, distance from the shaft), curve after curve, from the cylinder's end to the shaft or to a plane
  /// end of the hub; empty: the cylinder has a plane end. With them `aft` and `forward` must be there.
  std::vector<NurbsCurve<2>> beyond_aft = {};
  std::vector<NurbsCurve<2>> beyond_forward = {};
  /// The whole profile, from aft to forward, in legs without corners. Blades whose feet do not lie on the cylinder
  /// stand on it.
  std::vector<NurbsCurve<2>> profile = {};
};

/// The hub of a profile in (X, distance from the shaft), curves one after the other from end to end; straight ones may
/// have corners. Its cylinder is the longest piece parallel to the shaft. Throws GeometryError for gaps and points
/// beyond the shaft, and if no piece of the profile runs along the shaft (see Generatrix).
Hub hub_by_profile(const std::vector<NurbsCurve<2>>& profile);

/// The hub's radius where the blades' generator line (X = -rake) meets it: that of the cylinder, or found on the
/// profile to rounding, with RadialLaw between the sections.
double radius_at_generator_line(const Hub& hub, std::span<const BladeSection> sections);

/// A screw: equal blades, a turn over their number apart, the first along Z.
struct Propeller {
  /// From the root to the tip.
  std::vector<BladeSection> sections;
  int blades = 4;
  BladeSurfaceOptions surface;
  /// Without one the blades stand alone, each closed at its root.
  std::optional<Hub> hub;
};

/// Where blades stand on a hub's profile.
struct ProfileFeet {
  /// Their X.
  Interval extent;
  /// Of the hub over that extent.
  double largest_radius = 0.0;
};

/// A screw's boundary and what is known of its parts.
struct PropellerModel {
  Boundary<3> boundary;
  BladeKnots knots;
  /// The hub alone, as if there were no blades: closed, oriented outward.
  std::optional<Boundary<3>> hub;
  /// If the blades stand on the hub's profile and not on its cylinder.
  std::optional<ProfileFeet> feet = std::nullopt;
};

/// The screw as one closed boundary, oriented outward. The patches of blade k are "blade_k", and "blade_k_tip",
/// "blade_k_trailing_edge", without a hub also "blade_k_root", where blade_solid() has such; those of the hub "hub",
/// "hub_aft" and "hub_forward", or of its profile "hub_aft_1", .. from the cylinder on; where the blades do not stand
/// on the profile's cylinder, "hub_1", "hub_2", .. from aft, and "hub_aft", "hub_forward" at plane ends.
///
/// Blades end on the hub along curves that are traced to rounding: blade and hub are trimmed along the same curve.
/// Where the first section does not reach into the hub the blade's surface continues inward as the polynomial that it
/// is. On a profile the feet may lie across its corners, on pieces along which X rises.
///
/// Throws GeometryError as blade_solid() does; for blades < 1; for a hub whose measures are not positive, which the
/// blades do not reach, which is larger than they, or whose ends cut them.
PropellerModel propeller_model(const Propeller& propeller);
Boundary<3> propeller(const Propeller& propeller);

}  // namespace isorim::geometry
