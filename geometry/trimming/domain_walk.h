#pragma once

#include <optional>
#include <vector>

#include "geometry/intersection/plane_pieces.h"
#include "geometry/trimming/loop_chaining.h"
#include "geometry/trimming/parameter_rectangle.h"

/// From loops in the endless parameter plane to closed loops in the rectangle of a surface.
namespace isorim::geometry {

/// A closed loop in the parameter rectangle.
struct ClosedLoop {
  LoopRun curves;
  /// Doubled and signed, in the parameter plane.
  double area = 0.0;
};

/// The loop itself, moved by whole periods into the rectangle, its interruptions at poles closed by straight lines
/// along them. Empty if it does not fit, winds around the surface, or encloses nothing.
std::optional<ClosedLoop> close_directly(const CoveringLoop& loop, const ParameterRectangle& rectangle);

struct WalkedLoops {
  std::vector<ClosedLoop> loops;
  /// Ends joined along the sides of the rectangle.
  int bridged_ends = 0;
  /// The length of open sides (each side counts 1) along which ends were joined: edges of the surface that no curve of
  /// the face covers.
  double open_length = 0.0;
  /// False if the orientations contradict each other: no region lies on the left of all loops.
  bool is_consistent = true;
};

/// Cuts loops at the seams, moves the parts into the rectangle, and joins their ends along its sides: from where one
/// leaves the rectangle counter-clockwise to where the next one enters, so that the region on the left of the loops is
/// on the left of the result. Lines along poles are made anew, curves that run up and down a seam are left out (what is
/// needed of the seam comes from the walk). Curves that run along a seam once go to that side of the rectangle which
/// has its inside on their left.
WalkedLoops walk_domain(const std::vector<CoveringLoop>& loops, const ParameterRectangle& rectangle);

/// The loop's Bézier pieces, ends that do not meet joined by straight lines.
std::vector<PlanePiece> plane_pieces(const LoopRun& curves);

/// Doubled signed area of the closed chain; zero if it is there and back, to within 1e-9 of the chain's box.
double signed_area(const LoopRun& curves, const ParameterRectangle& rectangle);

}  // namespace isorim::geometry
