#pragma once

#include <optional>
#include <span>

#include "geometry/intersection/plane_pieces.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

/// A point well inside the kernel of a counter-clockwise loop: (C - a) x C' >= 0 for all pieces C, certified by
/// Bernstein coefficients. Empty if the kernel is empty or next to nothing, or not certain with the pieces as they are
/// (halved pieces say more).
std::optional<Point2> kernel_point(std::span<const PlanePiece> loop);

/// Whether the piece runs counter-clockwise about the apex all the way (to within rounding); certain if true.
bool is_visible_from(const PlanePiece& piece, const Point2& apex);

}  // namespace isorim::geometry
