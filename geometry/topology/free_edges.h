#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/topology/edge_matching.h"
#include "geometry/topology/orientation.h"

namespace isorim::geometry {

/// The free pieces of a matching, stretches of one curve that follow each other as one, each with the nearest other.
std::vector<FreeEdge<3>> free_edges(const Boundary<3>& boundary, const EdgeMatching& matching);

}  // namespace isorim::geometry
