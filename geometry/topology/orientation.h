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
struct FreeEdge;

template <>
struct FreeEdge<2> {
  int patch = 0;
  /// 0 start, 1 end.
  int side = 0;
  /// Both the free end.
  Point2 from;
  Point2 to;
};

template <>
struct FreeEdge<3> {
  int patch = 0;
  /// Indices into the patch's ShapeLoops and TrimLoop::curves; for a whole surface `curve` is the side, in the order of
  /// boundary_curves(), and for an extracted one `loop` is the element.
  int loop = 0;
  int curve = 0;
  /// In the parameter of that pcurve.
  Interval domain;
  /// Ends of the stretch in the direction of the loop, the kept part on its left.
  Point3 from = Point3::Zero();
  Point3 to = Point3::Zero();
  double length = 0.0;
  /// The free edge that its middle lies nearest to, and how far: the size of the gap. -1 if there is no other.
  int nearest = -1;
  double gap = 0.0;
};

/// One side of an edge of a boundary in space: the stretch of a loop that runs along it.
struct EdgeUse {
  int patch = 0;
  /// Indices into the patch's ShapeLoops and TrimLoop::curves.
  int loop = 0;
  int curve = 0;
  /// In the parameter of that pcurve.
  Interval domain;
  /// The loop runs from the edge's first vertex to its last. (Whether the patch is turned over plays no part.)
  bool forward = true;
};

/// Where two patches meet, or a patch itself along a seam, between two vertices.
struct BoundaryEdge {
  /// Indices into Topology::vertices; equal for a closed edge.
  int from = 0;
  int to = 0;
  EdgeUse first;
  EdgeUse second;
  /// The largest distance between the two uses.
  double gap = 0.0;
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
  /// Dim = 3: where edges end, and every edge that two patches share. Curves of loops that are on neither list are
  /// degenerate (poles), or bridge gaps.
  std::vector<Point<Dim>> vertices;
  std::vector<BoundaryEdge> edges;
  /// The largest distance between ends or edges that were taken as the same, and (Dim = 3) a point there.
  double largest_gap = 0.0;
  Point<Dim> largest_gap_place = Point<Dim>::Zero();
  /// Distances up to this counted as coincidence, in the units of the shape.
  double tolerance = 0.0;
  /// Dim = 3: the distance up to which edges that nothing else came near had to be searched for their partners; equal
  /// to `tolerance` where that was enough.
  double largest_tolerance = 0.0;
  /// Every shell is closed.
  bool closed = false;
};

/// For each patch, loop and curve of its ShapeLoops the number of the edge, shared by two curves, that the file names
/// there, or -1; an inner list may be empty.
using SharedEdges = std::vector<std::vector<std::vector<int>>>;

struct OrientationOptions {
  /// Ends and edges nearer than this count as the same; relative to the diagonal of the bounding box. 1e-6 is far
  /// above what 9 printed decimals cost and far below a feature.
  double tolerance = 1e-6;
  /// Dim = 3: edges that are free within the tolerance are searched for partners up to this distance, relative to the
  /// diagonal, and locally bounded (match_edges()); 0: not at all. For files, of which a fifth need more than 1e-5:
  /// file_gap.
  double largest_relative_gap = 0.0;
  /// Dim = 3: edges that the file says are shared. Believed if the curves run along each other to a tenth of their
  /// length.
  SharedEdges shared_edges = {};
  /// Dim = 3: the number of the solid to which the file says that each patch belongs, -1 for none; empty: nothing is
  /// known. Patches with different numbers are not joined.
  std::vector<int> solids = {};

  /// What CAD files call closed: above the gaps that are met in practice, below most features.
  static constexpr double file_gap = 1e-3;
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
/// Throws GeometryError, naming patches and place, for: edges shared by more than two patches, unless these are solids
/// that touch there (match_edges()); the same face twice; a shell that cannot be oriented (a Moebius strip), or an
/// extracted surface whose elements look to different sides; a closed shell without content; a boundary whose
/// coordinates coincidence_tolerance() refuses; for Dim = 2 also loops that cross themselves or one another (touching
/// is allowed); for Dim = 3 shells that cross one another so far that a few points of one, spread over it, see it (that
/// is no proof that they do not).
template <int Dim>
OrientedBoundary<Dim> orient(const Boundary<Dim>& boundary, const OrientationOptions& options = {});

/// Returns if the boundary is closed; throws GeometryError otherwise, which names up to five free ends (Dim = 2) or
/// stretches of edges (Dim = 3) with their places, and for each the nearest other one and the size of the gap.
template <int Dim>
void require_closed(const OrientedBoundary<Dim>& oriented);

}  // namespace isorim::geometry
