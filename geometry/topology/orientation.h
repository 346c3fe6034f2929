#pragma once

#include <string>
#include <vector>

#include "geometry/boundary.h"

/// From loose patches to an oriented boundary. Conventions: the outward normal of a boundary points out of the
/// material. In the plane an outer loop runs counter-clockwise and a hole clockwise; in space an inner shell is a
/// void, its normals point into the void.
namespace isorim::geometry {

/// A stretch of an edge (Dim = 3) or an end of a curve (Dim = 2) that no other patch continues.
template <int Dim>
struct FreeEdge {
  int patch = 0;
  /// Dim = 3: which of the four boundary curves, in the order of boundary_curves(). Dim = 2: 0 start, 1 end.
  int side = 0;
  /// Ends of the stretch (equal points for Dim = 2).
  Point<Dim> from;
  Point<Dim> to;
};

/// A loop (Dim = 2) or shell (Dim = 3): patches connected by shared ends or edges.
template <int Dim>
struct Shell {
  /// Indices into Boundary::patches; for Dim = 2 in the order in which the loop is run through.
  std::vector<int> patches;
  bool closed = false;
  /// The shell bounds a hole or void inside another one.
  bool is_void = false;
};

template <int Dim>
struct Topology {
  std::vector<Shell<Dim>> shells;
  std::vector<FreeEdge<Dim>> free_edges;
  /// The largest distance between ends or edges that were taken as the same.
  double largest_gap = 0.0;
  /// Distances up to this counted as coincidence, in the units of the shape.
  double tolerance = 0.0;
  /// Every shell is closed.
  bool closed = false;
};

struct OrientationOptions {
  /// Ends and edges nearer than this count as the same; relative to the diagonal of the bounding box. 1e-6 is far
  /// above what 9 printed decimals cost and far below a feature.
  double tolerance = 1e-6;
};

template <int Dim>
struct OrientedBoundary {
  /// The patches as given, with their `orientation` set.
  Boundary<Dim> boundary;
  Topology<Dim> topology;
};

/// Finds loops or shells by matching ends or edges geometrically (an edge may meet several shorter ones), makes the
/// orientations consistent within each, and turns each so that its normals point out of the material: by nesting
/// depth, odd levels are voids. An open shell keeps consistent orientations.
///
/// Throws GeometryError, naming patches and place, for: an edge shared by more than two patches; a shell that cannot
/// be oriented (a Moebius strip); a closed shell without content; a boundary whose coordinates coincidence_tolerance()
/// refuses; for Dim = 2 also loops that cross themselves or one another (touching is allowed); for Dim = 3 shells that
/// cross one another so far that a few points of one, spread over it, see it (that is no proof that they do not).
template <int Dim>
OrientedBoundary<Dim> orient(const Boundary<Dim>& boundary, const OrientationOptions& options = {});

/// Returns if the boundary is closed; throws GeometryError otherwise, which names up to five free ends (Dim = 2) or
/// stretches of edges (Dim = 3) with their places, and for each the nearest other one and the size of the gap.
template <int Dim>
void require_closed(const OrientedBoundary<Dim>& oriented);

}  // namespace isorim::geometry
