#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"

/// Boundaries of trimmed surfaces with exact trimming curves.
namespace isorim::quadrature::testing {

/// The part of a patch's surface within the loops.
inline geometry::Patch<3> trimmed(geometry::Patch<3> patch, std::vector<geometry::TrimLoop> loops) {
  patch.shape = geometry::TrimmedSurface(geometry::surface_of(patch.shape), std::move(loops));
  return patch;
}

inline geometry::TrimLoop loop(geometry::NurbsCurve<2> curve) {
  return {{std::move(curve)}};
}

/// The box [-1, 1] x [-1, 1] x [0, height] with a through hole of the radius about the z axis: circles cut its top and
/// its bottom, one element each.
inline geometry::Boundary<3> box_with_round_hole(double radius, double height) {
  geometry::Boundary<3> solid = geometry::box({2.0, 2.0, height}, {-1.0, -1.0, 0.0});
  for (geometry::Patch<3>& patch : solid.patches) {
    if (patch.name != "z_min" && patch.name != "z_max") continue;
    const geometry::NurbsSurface<3>& surface = geometry::surface_of(patch.shape);
    const geometry::NurbsCurve<2> circle = geometry::circle_curve(0.5 * radius, geometry::Point2(0.5, 0.5));
    patch = trimmed(patch, {geometry::domain_loop(surface), loop(geometry::reverse(circle))});
  }
  geometry::Boundary<3> hole = geometry::cylinder(radius, height);
  for (geometry::Patch<3>& patch : hole.patches) {
    if (patch.name != "side") continue;
    patch.orientation = -patch.orientation;
    patch.name = "hole";
    solid.patches.push_back(patch);
  }
  return solid;
}

}  // namespace isorim::quadrature::testing
