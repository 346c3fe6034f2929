#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vocabulary.h"

/// Edges that more than two patches share.
namespace isorim::geometry {

/// A patch that ends at an edge, seen at one point of it.
struct FanLeaf {
  /// Patches of one component are joined by other edges; their natural normals times `sign` are consistent.
  int component = 0;
  int sign = 1;
  /// Direction of the patch's loop along the edge; unit length.
  Vector3 tangent;
  /// Into the patch, at right angles to the edge; unit length.
  Vector3 inward;
};

/// Pairs the leaves about an edge so that each pair belongs to one component, is consistently oriented, and no two
/// pairs cross: leaves of the same component lie side by side about the edge, as where solids, or parts of one, touch
/// along it. Of two ways to pair four or more leaves of one component the one with the smaller angles is taken: both
/// bound the same solid. Two leaves that are left over, each the only one of its component, make a pair. Empty if there
/// is no such pairing. Leaves within 1e-3 of each other's angle may stand in any order.
std::optional<std::vector<std::pair<int, int>>> pair_fan(std::span<const FanLeaf> leaves);

/// Where two solids touch along a whole face, nothing but its own edges joins that face to either: four leaves of four
/// components, two of them (the face, once for each solid) at one angle. Pairs each of these with one of the others;
/// which way round is a matter of taste, but has to be the same along all edges of the face. Empty in all other cases.
std::optional<std::vector<std::pair<int, int>>> pair_touching_faces(std::span<const FanLeaf> leaves);

}  // namespace isorim::geometry
