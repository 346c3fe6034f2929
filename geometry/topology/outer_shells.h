#pragma once

#include "geometry/topology/orientation.h"

namespace isorim::geometry {

/// What a fluid around a closed solid meets: the solid without its voids, which are sealed, and without what lies in
/// them. `solid` is as orient() gives it and comes back as it is if it has none. Throws as orient().
OrientedBoundary<3> outer_shells(const OrientedBoundary<3>& solid);

}  // namespace isorim::geometry
