#pragma once

#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/fitting/section_alignment.h"
#include "geometry/fitting/section_uniformisation.h"
#include "geometry/nurbs/curve.h"

/// From the sections of a body to the body.
namespace isorim::geometry {

/// Closed curves in one plane that bound the material there: one, or an outer one with holes, ...
struct BodySection {
  /// What messages call it: a file, a height.
  std::string name;
  std::vector<NurbsCurve<3>> loops;
};

/// Where the body ends.
enum class BodyEnds {
  /// Plane caps on the first and the last section, which must be plane; none where it is a point (see point_section()).
  caps,
  /// The last section is followed by the first, as of a ring.
  closed,
};

struct BodyOptions {
  StartRule start = StartRule::least_twist;
  UniformisationOptions knots = {};
  /// Across the sections, at least 1; closed bodies take 1, 3 or 5. 3 gives continuous curvature.
  int degree = 3;
  BodyEnds ends = BodyEnds::caps;
};

struct Body {
  /// Walls "side" ("side_1", .. where sections have several loops), caps "start_cap", "end_cap" (with "_1", "_2", .. if
  /// there are several patches). Closed, natural normals outward.
  Boundary<3> boundary;
  /// Control points along and across of the wall with most of them.
  int control_points_along = 0;
  int control_points_across = 0;
  int knots_inserted = 0;
  int knots_removed = 0;
  /// A bound on how far the uniformisation moved any point of a section.
  double uniformisation_error = 0.0;
};

/// A section that is a single point: the tip of a body.
NurbsCurve<3> point_section(const Point3& point);

/// Skins the sections: loops of neighbouring sections are matched by their centroids and areas, each chain aligned
/// (align_sections()), uniformised and interpolated across (loft()). At least two sections, three if closed.
///
/// Throws GeometryError, naming the sections, if the number of loops changes (the body branches), if a loop is not
/// closed or crosses another, if loops cannot be matched one to one, and as uniformise(), loft(), fill() and orient()
/// do.
Body body_of_sections(const std::vector<BodySection>& sections, const BodyOptions& options = {});

}  // namespace isorim::geometry
