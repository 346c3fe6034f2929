#pragma once

#include <span>
#include <vector>

#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/trimmed_surface.h"

namespace isorim::geometry {

/// The loop as rational Bézier pieces in its order, each ending where the next one starts: straight lines join the ends
/// that differ by more than rounding (16 units in the last place of the loop's largest coordinate). Curves that
/// are single points are left out.
std::vector<PlanePiece> loop_pieces(const TrimLoop& loop);
/// Of all loops, one after the other.
std::vector<PlanePiece> loop_pieces(std::span<const TrimLoop> loops);

/// A straight piece.
PlanePiece line_piece(const Point2& from, const Point2& to);

}  // namespace isorim::geometry
