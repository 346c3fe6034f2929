#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/trimming/loose_face.h"
#include "geometry/trimming/parameter_rectangle.h"
#include "geometry/vocabulary.h"

/// From the curves of a loop, each wherever its file or its inversion put it, to chains that are continuous in the
/// parameter plane.
namespace isorim::geometry {

/// A parameter curve of a loop.
struct LoopCurve {
  NurbsCurve<2> curve;
  /// Of the file, -1 if none.
  int edge = -1;
  /// The curve is the file's own: its period is meant.
  bool is_given = false;
  /// Counted from 1; 0 for a line that joins two pieces.
  int piece = 0;
  /// By which it was moved from where the file or the inversion put it, whole periods.
  Vector2 shift = Vector2::Zero();
};

/// Curves each of which starts where the one before it ends, at any period of the closed directions.
using LoopRun = std::vector<LoopCurve>;

/// A loop in the parameter plane, whose closed directions go on for ever.
struct CoveringLoop {
  /// One run that ends where it starts (by `winding` periods further on), or several, each of which ends at a pole or
  /// on a seam, where the next one starts at another parameter along it.
  std::vector<LoopRun> runs;
  /// The runs are open.
  bool is_interrupted = false;
  /// An interruption is on a seam: the file left out the curve along it.
  bool lacks_seam = false;
  /// Of a single closed run: how many periods it advances in u and v.
  std::array<int, 2> winding{};
};

struct ChainOptions {
  /// Of the face, in the units of the shape.
  double size = 1.0;
  /// The largest gap, in space, that is bridged by a line.
  double largest_gap = 1e-3;
  /// "loop 2".
  std::string name;
};

/// Puts the curves in order, reverses those that run against the others, moves them by whole periods and joins small
/// gaps by lines. A chain that holds several closed loops is taken apart. Throws GeometryError at a gap that no pole,
/// seam or permitted bridge explains. `repairs` counts what was done.
std::vector<CoveringLoop> chain_loop(std::vector<LoopCurve> curves, const ParameterRectangle& rectangle,
                                     const ChainOptions& options, FaceRepairs& repairs);

/// The same loop run the other way.
CoveringLoop reverse(const CoveringLoop& loop);

/// The curve moved in the parameter plane; itself, bit for bit, for a zero shift.
LoopCurve moved(LoopCurve curve, const Vector2& shift);

}  // namespace isorim::geometry
