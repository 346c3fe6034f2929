#pragma once

#include <optional>

#include "geometry/boundary.h"
#include "geometry/intersection/plane_section.h"

/// What a pattern maker needs besides the sections of a blade: Garcia 1999, sections 5.5 and 7.4.
namespace isorim::geometry {

/// Along which a mould is cut in two halves, in the coordinates of the section's plane.
struct PartingLine {
  /// At the trailing edge.
  Point2 from = Point2::Zero();
  /// At the leading edge.
  Point2 to = Point2::Zero();
};

/// The parting line of a blade's section: from the point where it crosses the trailing edge, u = 0, to its point with
/// 0.2 < u < 0.8 farthest from the origin of the plane; u in parts of the domain of the surface of patch `blade`.
/// Where the section lacks one of the two, since it lies beyond an end of that edge, it is the section's point farthest
/// from the other. Points are found to `sag`. Absent if the section has no two points on the blade.
std::optional<PartingLine> parting_line(const PlaneSection& section, const Boundary<3>& boundary, int blade,
                                        double sag);

/// Half the width of what a plane at a height leaves of a round shaft: sqrt(radius^2 - height^2) (Garcia 1999, eq.
/// 5-11); absent if the plane passes it by or only touches it.
std::optional<double> hub_half_width(double radius, double height);

/// The least and the greatest X of the patch's edges on the cylinder of a radius about the X axis (to within 1e-6 of
/// it); absent if there are none. Found to 1e-9 of the radius.
std::optional<Interval> root_extent(const SurfaceShape& blade, double radius);

}  // namespace isorim::geometry
