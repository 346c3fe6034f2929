#pragma once

#include <numbers>
#include <span>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/transforms.h"
#include "geometry/vocabulary.h"

/// Closed solids swept from plane regions or through sections. Natural normals point outward. Caps are the patches of
/// fill(), so they are exact, and are named "start_cap" and "end_cap", with "_1", "_2", ... where there are several
/// patches. All throw GeometryError as orient() and fill() do.
namespace isorim::geometry {

/// The region (in the plane z = 0) moved along `by`. Walls keep the names of the region's curves; "start_cap" lies at
/// z = 0. Throws GeometryError if `by` is parallel to the plane.
Boundary<3> extrude(const Boundary<2>& region, const Vector3& by);

/// The solid that a plane region sweeps as it turns by `angle` (right-handed, from where it lies) about an axis in its
/// plane. The region is given by its boundary curves in space, in any order and direction; a chain of curves both of
/// whose ends lie on the axis is closed along the axis. A full turn has no caps. Curves on the axis itself sweep
/// nothing. Walls are named "side", or "side_1", "side_2", ... in the order of the curves.
///
/// Throws GeometryError if the curves do not lie in one plane with the axis, lie on both sides of it, or leave the
/// region open, and if the angle is outside (0, 2 pi].
Boundary<3> revolve_solid(std::span<const NurbsCurve<3>> curves, const Axis& axis,
                          double angle = 2.0 * std::numbers::pi);

/// The same for a region in the plane z = 0; the axis must lie in that plane. Walls keep the names of the curves.
Boundary<3> revolve(const Boundary<2>& region, const Axis& axis, double angle = 2.0 * std::numbers::pi);

/// Throws GeometryError if a full turn of the profile about the axis sweeps a surface that crosses itself: the profile
/// lies on both sides of the axis, or encloses (with the axis, if it ends there) a region whose loops cross. A profile
/// that does not lie in one plane with the axis is passed over.
void require_simple_profile(std::span<const NurbsCurve<3>> curves, const Axis& axis);

/// The loft() through closed sections, wall "side", with plane caps on the first and the last; a section that is a
/// single point needs none. A first or last section that is not plane is refused.
Boundary<3> loft_solid(std::span<const NurbsCurve<3>> sections, const LoftOptions& options = {});

/// The same for sections of several loops: a list of sections for each wall, all of the same length. Walls are named
/// "side", or "side_1", "side_2", ...; caps have the holes that the loops make. A closed loft has no caps.
Boundary<3> loft_solid(std::span<const std::vector<NurbsCurve<3>>> walls, const LoftOptions& options = {});

}  // namespace isorim::geometry
