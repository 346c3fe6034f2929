#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/nurbs/curve.h"
#include "geometry/topology/orientation.h"
#include "geometry/vocabulary.h"

/// Which stretches of which edges of surfaces coincide in space.
namespace isorim::geometry {

/// One of the four boundary curves of a patch (in the order of boundary_curves()), not degenerate.
struct SurfaceEdge {
  int patch = 0;
  int side = 0;
  NurbsCurve<3> curve;
  /// +1 if the curve runs counter-clockwise about the patch's parameter rectangle.
  int direction = 1;
  /// Box of the control points.
  Point3 lower;
  Point3 upper;
  /// Its ends among the vertices.
  int from = 0;
  int to = 0;
};

/// The part of an edge between two neighbouring vertices on it.
struct EdgePiece {
  int edge = 0;
  Interval domain;
  int from = 0;
  int to = 0;
};

/// Two coincident pieces. same_direction: their edges' parameters run the same way there.
struct EdgeJoint {
  int first = 0;
  int second = 0;
  bool same_direction = false;
};

struct EdgeMatching {
  std::vector<SurfaceEdge> edges;
  std::vector<EdgePiece> pieces;
  std::vector<EdgeJoint> joints;
  /// Pieces that no other one meets.
  std::vector<int> free_pieces;
  double largest_gap = 0.0;
};

/// Splits every edge at the vertices (ends of other edges) that lie on it and pairs the pieces that coincide: the same
/// two vertices, and inner points within `tolerance` of each other. Edges not larger than `tolerance` (poles) are left
/// out. Vertices are found by hashing and the candidates on an edge by a grid, so the cost grows as the number of
/// edges. Throws GeometryError if three pieces or more coincide.
EdgeMatching match_edges(const Boundary<3>& boundary, double tolerance);

}  // namespace isorim::geometry
