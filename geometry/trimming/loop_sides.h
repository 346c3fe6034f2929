#pragma once

#include <vector>

#include "geometry/trimming/domain_walk.h"
#include "geometry/trimming/loop_chaining.h"
#include "geometry/trimming/loose_face.h"
#include "geometry/trimming/parameter_rectangle.h"

/// Which side of its loops a face keeps.
namespace isorim::geometry {

/// Closed loops in the rectangle with the kept part on their left, from the loops of the face and what its file says
/// about their sides. Loops that close in the rectangle stay as they are; if one crosses a seam, winds around the
/// surface or turns about a pole, all are walked (walk_domain()), in the direction that leaves no open side of the
/// surface without a curve. Where the file's orientation cannot be trusted, nesting decides, and of loops that wind
/// around the surface every other one is turned.
///
/// Throws GeometryError if the loops bound nothing.
std::vector<ClosedLoop> closed_loops(const std::vector<CoveringLoop>& loops, const LooseFace& face,
                                     const ParameterRectangle& rectangle, FaceRepairs& repairs);

}  // namespace isorim::geometry
