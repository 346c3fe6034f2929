#pragma once

#include "geometry/boundary.h"

namespace isorim::geometry {

/// Whether two patches are the same face given twice: every edge of each has one of the other within `tolerance` at its
/// middle, where both lie on the same side of it, and beside the edges one lies on the surface of the other. (Faces on
/// the two sides of one edge, or a disc and a cap with the same rim, are not.) Slow: for messages.
bool is_same_face(const Patch<3>& a, const Patch<3>& b, double tolerance);

}  // namespace isorim::geometry
