#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"

/// From a face as CAD files give it to a patch: loops in parameter space that close, lie in the domain, and keep what
/// is meant to be kept.
namespace isorim::geometry {

/// A piece of a loop as a file gives it, already turned into the direction in which the loop runs. At least one of the
/// curves is there.
struct LoosePiece {
  /// In the parameter space of the surface.
  std::optional<NurbsCurve<2>> pcurve;
  /// In space.
  std::optional<NurbsCurve<3>> model_curve;
  /// Of the edge that the file says two faces share (510 loops over a 504 list); -1 if it says nothing.
  int edge = -1;
};

/// A chain of pieces. Files leave out what is degenerate (the side of a parameter rectangle that a pole collapses to)
/// and may give the pieces of one loop on different periods of a closed surface.
struct LooseLoop {
  std::vector<LoosePiece> pieces;
};

/// What a file says about which side of the loops is kept.
enum class LoopSides {
  /// Nothing reliable: the first loop is the outer one, the others are holes (IGES 144).
  outer_first,
  /// The kept part lies on the left of every loop, seen along the surface's natural normal (IGES 141, 508).
  left,
  /// Nothing: found from the nesting alone.
  nested,
};

struct LooseFace {
  NurbsSurface<3> surface;
  /// Without loops the whole surface is kept.
  std::vector<LooseLoop> loops;
  LoopSides sides = LoopSides::outer_first;
  /// The surface's own boundary is the outer loop, all loops are holes (IGES 144 with N1 = 0).
  bool natural_outer_boundary = false;
};

struct FaceOptions {
  /// How far a curve in space may lie from the surface, in the units of the shape, before it is refused; 0: 1e-3 of the
  /// face's size.
  double largest_deviation = 0.0;
  /// To which the parameter curves of pieces without one are computed, relative to the face's size.
  double inversion_tolerance = 1e-12;
};

/// What had to be done to a face.
struct FaceRepairs {
  /// Pieces whose parameter curve was computed from the curve in space.
  int inverted_pieces = 0;
  /// The largest distance of such a curve from the surface, in the units of the shape.
  double largest_deviation = 0.0;
  /// The largest distance, in space, between a given parameter curve's image and the given curve in space.
  double largest_disagreement = 0.0;
  /// Ends joined by straight lines in parameter space along a pole or a seam.
  int bridged_ends = 0;
  /// The largest distance in space that such a line bridges elsewhere: a real gap in the loop.
  double largest_bridge = 0.0;
  /// Curves moved by a period, clipped to the domain or split at a seam.
  int shifted_curves = 0;
  /// Loops that ran the wrong way round.
  int reversed_loops = 0;
  /// In words, for the report; empty if all was well.
  std::vector<std::string> notes;
};

struct AssembledFace {
  /// The whole surface if the loops only run round its domain.
  PatchShape<3> shape;
  /// For each loop and curve of the shape the file's edge it came from, or -1. Empty for a whole surface.
  std::vector<std::vector<int>> edges;
  FaceRepairs repairs;
};

/// Makes a patch of a loose face. The given parameter curves are kept bit for bit wherever they lie in the domain.
///
/// Missing parameter curves are computed by inverting the curve in space: exactly where the surface is an affine image
/// of its parameters, else fitted until the image lies within the tolerance. Loops that wind around a closed surface
/// are closed along its seam, loops that are open at a pole along the pole. Throws GeometryError, naming loop and
/// piece (counted from 1) and the place, if a loop has a gap that no seam or pole explains and that is larger than the
/// allowed deviation; if a curve is farther off the surface than allowed; or if the loops bound nothing.
AssembledFace assemble_face(const LooseFace& face, const FaceOptions& options = {});

}  // namespace isorim::geometry
