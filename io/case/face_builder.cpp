#include "io/case/face_builder.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "geometry/intersection/clip.h"
#include "geometry/intersection/directed_loops.h"
#include "geometry/trimming/trimmed_surface.h"
#include "io/case/curve_builder.h"
#include "io/case/shape_builder.h"

namespace isorim::io {
namespace {

using geometry::Boundary;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::OrientedBoundary;
using geometry::Patch;
using geometry::TrimLoop;

const geometry::Shell<2>& shell_of(const OrientedBoundary<2>& oriented, int patch) {
  return *std::find_if(oriented.topology.shells.begin(), oriented.topology.shells.end(),
                       [patch](const geometry::Shell<2>& shell) {
                         return std::find(shell.patches.begin(), shell.patches.end(), patch) != shell.patches.end();
                       });
}

/// Some loop that is said to be a hole lies in no other one.
bool has_outermost_hole(const OrientedBoundary<2>& oriented, const std::vector<LoopClaim>& claims) {
  return std::any_of(claims.begin(), claims.end(), [&](const LoopClaim& claim) {
    return claim.role == LoopRole::hole && !shell_of(oriented, claim.patch).is_void;
  });
}

void check_roles(const OrientedBoundary<2>& oriented, const std::vector<LoopClaim>& claims) {
  for (const LoopClaim& claim : claims) {
    const bool is_void = shell_of(oriented, claim.patch).is_void;
    if (claim.role == LoopRole::outer && is_void)
      refuse(claim.where, "the role is \"outer\", but the loop lies inside another one");
    if (claim.role == LoopRole::hole && !is_void)
      refuse(claim.where, "the role is \"hole\", but the loop lies inside another hole");
  }
}

/// The loops, outer ones and holes by their nesting; the domain's rectangle around them if one is a hole by its role.
OrientedBoundary<2> oriented_loops(const NurbsSurface<3>& surface, const BuiltBoundary<2>& region) {
  OrientedBoundary<2> oriented = geometry::orient(region.boundary);
  if (!has_outermost_hole(oriented, region.claims)) return oriented;
  Boundary<2> with_domain = region.boundary;
  int number = 0;
  for (const NurbsCurve<2>& side : geometry::domain_loop(surface).curves) {
    with_domain.patches.push_back({fmt::format("domain_{}", ++number), side});
  }
  return geometry::orient(with_domain);
}

struct ToolBuilder {
  geometry::ClipTool operator()(const PlaneClipKeys& keys) const {
    return geometry::PlaneTool{keys.point, keys.normal};
  }
  geometry::ClipTool operator()(const SphereClipKeys& keys) const {
    return geometry::SphereTool{keys.centre, keys.radius, keys.keep};
  }
  geometry::ClipTool operator()(const CylinderClipKeys& keys) const {
    return geometry::CylinderTool{keys.point, keys.axis, keys.radius, keys.keep};
  }
  geometry::ClipTool operator()(const ConeClipKeys& keys) const {
    return geometry::ConeTool{keys.apex, keys.axis, keys.half_angle * (std::numbers::pi / 180.0), keys.keep};
  }
};

}  // namespace

geometry::SurfaceShape trimmed(const NurbsSurface<3>& surface, const std::vector<LoopKeys>& trims,
                               const KeyPlace& where) {
  if (trims.empty()) return surface;
  RegionKeys keys;
  keys.loops = trims;
  keys.where = where;
  const BuiltBoundary<2> region = build_region(keys);
  return located(where, [&]() -> geometry::SurfaceShape {
    const OrientedBoundary<2> oriented = oriented_loops(surface, region);
    geometry::require_closed(oriented);
    check_roles(oriented, region.claims);
    std::vector<NurbsCurve<2>> curves;
    for (const Patch<2>& patch : oriented.boundary.patches)
      curves.push_back(patch.orientation > 0 ? patch.shape : geometry::reverse(patch.shape));
    const geometry::Vector2 extent(surface.knots_u().domain().length(), surface.knots_v().domain().length());
    return geometry::TrimmedSurface(surface, geometry::chain_directed_curves(curves, extent, 1e-7, 0.0));
  });
}

Boundary<3> clipped(const Boundary<3>& solid, const OneOrMany<ClipKeys>& tools, const KeyPlace& where,
                    const geometry::OrientationOptions& options) {
  if (tools.items.empty()) return solid;
  OrientedBoundary<3> oriented = located(where, [&] {
    OrientedBoundary<3> found = geometry::orient(solid, options);
    geometry::require_closed(found);
    return found;
  });
  geometry::ClipOptions clipping;
  const double size = oriented.topology.tolerance / options.tolerance;
  clipping.gap_tolerance = std::max(clipping.gap_tolerance, 4.0 * oriented.topology.largest_gap / size);
  Boundary<3> left = std::move(oriented.boundary);
  for (const ClipKeys& tool : tools.items) {
    std::visit(
        [&](const auto& keys) {
          left = located(keys.where, [&] { return geometry::clip(left, ToolBuilder{}(keys), clipping); });
        },
        tool);
  }
  return left;
}

}  // namespace isorim::io
