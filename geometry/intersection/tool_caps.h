#pragma once

#include <functional>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/intersection/clip.h"
#include "geometry/intersection/plane_section.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

/// The parts of a tool's surface that close what it has cut; for clip() and for what joins solids along such cuts.
namespace isorim::geometry {

/// An edge of a cap: an edge of a face along the tool, over [0, 1], with the cap on the left of its direction as seen
/// against the outward normal of what is kept.
struct CapEdge {
  NurbsSurface<3> surface;
  NurbsCurve<2> curve;
};

/// The plane of the tool, its origin next to a point, so that coordinates are no larger than the solid.
PlaneFrame cap_frame(const PlaneTool& plane, const Point3& near);

/// The edges in the coordinates of the plane, joined to loops. Edges along lines of constant u or v are exact; others
/// are met to rounding by polynomials. `size`: the diagonal of the solid's box.
std::vector<TrimLoop> plane_loops(const PlaneFrame& frame, const std::vector<CapEdge>& edges, double size,
                                  const ClipOptions& options);

/// Trimmed parts of the plane, one for each connected part, natural normals along the plane's.
std::vector<Patch<3>> plane_caps(const PlaneFrame& frame, const std::vector<TrimLoop>& loops);

/// Tells whether a point lies in the solid.
using PointTest = std::function<bool(const Point3&)>;

/// Trimmed parts of round tools.
std::vector<Patch<3>> sphere_caps(const SphereTool& tool, const std::vector<CapEdge>& edges, double size,
                                  const ClipOptions& options, const PointTest& is_inside);
std::vector<Patch<3>> cylinder_caps(const CylinderTool& tool, const std::vector<CapEdge>& edges, double size,
                                    const ClipOptions& options);
/// The place on a quarter of circle_curve() at an angle in [0, pi / 2] from its start, as a part of its span.
double part_of_quarter(double angle);
/// The loops of the part of a round surface (u round, from 0 to 1) that lies on the left of curves in its parameters,
/// closed along the borders of its domain; `scale`: parameters per length, `size` as above.
std::vector<TrimLoop> loops_on_side(const NurbsSurface<3>& side, const std::vector<NurbsCurve<2>>& curves,
                                    const Vector2& scale, double size);
/// What a cap on a cylinder leaves of it: the loops of the rest of `side`, the cap's surface over larger heights.
/// `size` as above.
std::vector<TrimLoop> loops_beside(const TrimmedSurface& cap, const NurbsSurface<3>& side, double size);
std::vector<Patch<3>> cone_caps(const ConeTool& tool, const std::vector<CapEdge>& edges, double size,
                                const ClipOptions& options);

}  // namespace isorim::geometry
