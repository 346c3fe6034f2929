#pragma once

#include <array>
#include <map>
#include <vector>

#include "geometry/topology/orientation.h"
#include "geometry/topology/shape_loops.h"

/// The edges of a boundary as chords; for tessellate().
namespace isorim::geometry {

/// Vertex numbers along one use of an edge, with the parameters of its curve, in the direction of its loop.
struct DividedUse {
  Interval domain;
  std::vector<double> parameters;
  std::vector<int> vertices;
};

/// Patch, loop and curve, as in EdgeUse.
using CurveKey = std::array<int, 3>;

struct DividedEdges {
  /// The vertices of the topology first.
  std::vector<Point3> vertices;
  /// Of each curve in the order of its parameter. Curves without uses are degenerate.
  std::map<CurveKey, std::vector<DividedUse>> uses;
};

/// Divides every edge until its chords are within `tolerance` of it, over the refinement of its patches (one factor a
/// patch, at least 1). Curved edges have at least two chords, closed ones four.
DividedEdges divide_edges(const OrientedBoundary<3>& oriented, const std::vector<ShapeLoops>& loops, double tolerance,
                          const std::vector<double>& refinement);

}  // namespace isorim::geometry
