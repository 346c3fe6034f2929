#pragma once

#include <span>

#include "quadrature/lanes.h"
#include "quadrature/region_moments.h"

/// For the kernel of element_sums.cpp.
namespace isorim::quadrature {

/// The weights W_ab of up to kernel_lanes regions, lane by lane, at a nodes[1] + b. Both numbers of nodes are even and
/// do not exceed any region's counts. The packets are the calling thread's, until its next call.
std::span<const Packet> weights_of_regions(std::span<const RegionMoments* const> regions, const Orders<2>& nodes);

}  // namespace isorim::quadrature
