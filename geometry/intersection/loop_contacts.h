#pragma once

#include <optional>
#include <vector>

#include "geometry/intersection/plane_pieces.h"
#include "geometry/vocabulary.h"

/// Where closed loops in the plane meet themselves or each other, and whether they cross there.
namespace isorim::geometry {

/// A closed chain of pieces, each ending where the next starts (to within the tolerance), the last before the first;
/// no piece turns more than append_monotone_parts() leaves.
struct PlaneLoop {
  std::vector<PlanePiece> pieces;
  Point2 lower;
  Point2 upper;

  explicit PlaneLoop(std::vector<PlanePiece> parts);
  double diagonal() const { return (upper - lower).norm(); }
};

enum class ContactKind {
  /// The loops pass through each other.
  crossing,
  /// The loops run along each other over a stretch.
  overlap,
};

struct LoopConflict {
  ContactKind kind = ContactKind::crossing;
  int first_loop = 0;
  int second_loop = 0;
  /// Indices into PlaneLoop::pieces.
  int first_piece = 0;
  int second_piece = 0;
  Point2 place;
};

/// The first place found where loops cross or overlap; loops that touch, at a point or tangentially, or penetrate by
/// less than `tolerance`, are no conflict. Pairs of pieces are found by a sweep over their boxes and bisected until
/// they are apart or smaller than the tolerance; a contact is then judged by the order in which the two strands leave a
/// disc about it: they cross exactly if they alternate. The disc starts at a few tolerances and grows until the strands
/// leave it farther apart than the tolerance, so tangential contacts are told from crossings without derivatives.
std::optional<LoopConflict> find_loop_conflict(const std::vector<PlaneLoop>& loops, double tolerance);

}  // namespace isorim::geometry
