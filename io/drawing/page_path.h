#pragma once

#include <vector>

#include "io/drawing/drawing.h"
#include "io/svg/bezier_path.h"

/// What writers of vector pages share.
namespace isorim::io::drawing {

/// Of curves that a page cannot draw exactly, in mm. With the rounding of coordinates what is drawn stays within
/// 0.001 mm.
inline constexpr double page_tolerance = 0.0005;
/// Of coordinates in mm.
inline constexpr int page_decimals = 4;

/// Bézier segments of degree 3 at most, each starting where the one before ends.
struct Subpath {
  std::vector<svg::PathSegment> segments;
  bool is_closed = false;
};

/// The chain cut where a curve jumps by more than 0.001 mm.
std::vector<Subpath> subpaths(const Chain& chain);

}  // namespace isorim::io::drawing
