#pragma once

#include <vector>

#include "geometry/intersection/plane_section.h"

/// For plane_section.cpp: the directed edges of what a plane cuts, before they are chained.
namespace isorim::geometry {

struct SectionEdge {
  /// In the direction in which the solid lies on the left as seen against the normal.
  SectionPiece piece;
  /// An edge of the patch that lies in the plane (not a curve across the patch): others may run along it.
  bool is_on_loop = false;
  /// An edge of a face in the plane.
  bool is_of_coplanar_face = false;
};

/// Divides edges on loops where others end on them, then takes out pairs that run along each other in opposite
/// directions and one of each pair that run in the same one, within `distance`. Pairs of opposite edges that are not of
/// coplanar faces are curves along which the boundary touches the plane: they are appended to `touching`, once.
std::vector<SectionEdge> cancel_opposite_edges(std::vector<SectionEdge> edges, double distance,
                                               std::vector<SectionPiece>& touching);

SectionPiece reversed(const SectionPiece& piece);

/// The point of the piece next to x, by its parameter and distance (to about 1e-9 of the piece's length).
struct NearestOnPiece {
  double t = 0.0;
  double distance = 0.0;
};
NearestOnPiece nearest_on(const SectionPiece& piece, const Point3& x);

Point3 point_on(const SectionPiece& piece, double t);

}  // namespace isorim::geometry
