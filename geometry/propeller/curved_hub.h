#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/propeller/propeller.h"

/// Blades on a hub that is not a cylinder where they stand.
namespace isorim::geometry {

/// The surface of revolution of a profile in (X, distance from the shaft): u, from 0 to 1, turns about the shaft from
/// the Z axis, v runs along the profile.
NurbsSurface<3> turned(const NurbsCurve<2>& profile);

struct HubJoint {
  /// The first blade as far as it stands out of the hub.
  Boundary<3> blade;
  /// What the blades leave of the hub, and the whole of it.
  std::vector<Patch<3>> hub_beside_blades;
  Boundary<3> hub;
  ProfileFeet feet;
};

/// Cuts the blade and its copies, `count` in a turn, from the hub of `profile`: the blade along its foot (BladeFoot),
/// each leg of the hub along the images of the same curves, both within rounding. `blade` as by close_blade(), reaching
/// into the hub; legs are named "hub_1", ... from aft, plane ends "hub_aft" and "hub_forward". Throws GeometryError as
/// Generatrix and BladeFoot do, and where feet cross.
HubJoint joined_to_profile(const Boundary<3>& blade, int count, const std::vector<NurbsCurve<2>>& profile);

}  // namespace isorim::geometry
