#pragma once

#include <array>
#include <vector>

#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"

namespace isorim::geometry {

struct TessellationOptions {
  /// How far triangles may lie from the boundary, in its units; 0: default_chord of the diagonal of its box.
  double chord_tolerance = 0.0;

  static constexpr double default_chord = 1e-4;
};

/// Triangles in space, counter-clockwise as seen from outside.
struct TriangleMesh {
  /// 3 x n, on the boundary (of edges: on the first of the patches that meet there).
  Points<3> vertices;
  std::vector<std::array<int, 3>> triangles;
  /// The patch that each triangle belongs to.
  std::vector<int> patches;
};

/// A watertight mesh of a closed boundary of any kind: every edge of a triangle is that of exactly one other, which
/// runs through it the other way.
///
/// Edges of the boundary are divided once for both faces that share them, whatever gap there is between these; each
/// face is filled in its parameters (ConstrainedDelaunay), first with the points of its edges, then with points of its
/// own until edges' and triangles' middles are within the tolerance of it and triangles look where the face looks.
/// Where chords of a thin face cross, its edges are divided further.
///
/// Throws GeometryError if the boundary is open or the tolerance is not positive, NumericalError, naming the patch, if
/// a face cannot be filled.
TriangleMesh tessellate(const OrientedBoundary<3>& oriented, const TessellationOptions& options = {});

}  // namespace isorim::geometry
