#pragma once

#include <vector>

#include "geometry/vocabulary.h"

/// Directed curves joined end to start where gaps of unknown size are between them.
namespace isorim::geometry {

/// What has to be known of a curve to join it with others.
struct ChainLink {
  Point2 start;
  Point2 end;
  /// Towards the inside of the curve, seen from either end.
  Vector2 leaving;
  Vector2 arriving;
  double length = 0.0;
};

struct LinkChain {
  /// Indices of links in their order.
  std::vector<int> links;
  bool is_closed = false;
};

/// Joins ends with starts, the nearest first: by distances up to `finest`, then ten times that, and so on up to
/// `coarsest`. Where several curves meet, the first one clockwise from where a curve comes follows, so that chains with
/// a region on their left touch but do not cross. No curve is closed by a gap longer than a tenth of itself.
std::vector<LinkChain> join_links(const std::vector<ChainLink>& links, double finest, double coarsest);

}  // namespace isorim::geometry
