#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"

/// Which stretches of which edges of surfaces coincide in space.
namespace isorim::geometry {

/// A curve of a loop of a patch (indices into its ShapeLoops and TrimLoop::curves) that is not degenerate in space.
struct SurfaceEdge {
  int patch = 0;
  int loop = 0;
  int curve = 0;
  double length = 0.0;
};

/// The part of an edge between two neighbouring vertices on it, in the direction of its loop.
struct EdgePiece {
  int edge = 0;
  /// In the parameter of the pcurve.
  Interval domain;
  /// Indices into EdgeMatching::vertices.
  int from = 0;
  int to = 0;
  double length = 0.0;
};

/// Two coincident pieces. same_direction: their loops run the same way there.
struct EdgeJoint {
  int first = 0;
  int second = 0;
  bool same_direction = false;
  /// The largest distance between the pieces.
  double gap = 0.0;
};

struct EdgeMatching {
  std::vector<Point3> vertices;
  std::vector<SurfaceEdge> edges;
  std::vector<EdgePiece> pieces;
  std::vector<EdgeJoint> joints;
  /// Pieces that no other one meets.
  std::vector<int> free_pieces;
  double largest_gap = 0.0;
  /// A point of the joint with the largest gap.
  Point3 largest_gap_place = Point3::Zero();
  /// The largest distance at which pieces were looked for and joined.
  double largest_tolerance = 0.0;
};

struct MatchingOptions {
  /// Up to which edges coincide wherever they are, in the units of the shape.
  double tolerance = 0.0;
  /// Up to which edges that are still free coincide where nothing else is near; 0: the tolerance.
  double largest_gap = 0.0;
  /// As in OrientationOptions.
  SharedEdges shared_edges = {};
  std::vector<int> solids = {};
};

/// Splits every edge at the vertices (ends of other edges) that lie on it and pairs the pieces that coincide: the same
/// two vertices, and everywhere on the exact curves S(c(t)) within a distance.
///
/// The distance grows in levels, from a thousandth of `tolerance` (or rounding) up to it and on to `largest_gap`; each
/// level looks at what the finer ones left free. So features smaller than the tolerance stay apart where the data are
/// better than it. Two pieces are joined at the first level at which each is the other's only partner. Beyond rounding
/// no vertex moves by more than a quarter of the length of an edge that ends there (of a fiftieth of its loop's length
/// for edges shorter than that, which are often the bridges of a gap in a loop); a piece is joined within a quarter of
/// its own length. What is left between vertices that have become one, bridges and the slivers beside T-junctions,
/// disappears.
///
/// An even number of pieces that coincide within `tolerance`, where solids touch, is resolved by the shells to which
/// the patches belong by their other edges; pairs have to lie side by side about the edge. Throws GeometryError if they
/// do not, or if their number is odd; the message says so if a face is there twice.
///
/// Cost: for n edges with s legs each about n (s + log n), a level more for what stays free.
EdgeMatching match_edges(const Boundary<3>& boundary, const MatchingOptions& options);

}  // namespace isorim::geometry
