#include "io/drawing/page_path.h"

namespace isorim::io::drawing {

namespace {

/// Ends this near to each other count as one, in mm.
constexpr double same_point = 0.001;

bool meet(const svg::PathSegment& segment, const svg::PathSegment& next) {
  return (segment.rightCols<1>() - next.leftCols<1>()).norm() <= same_point;
}

}  // namespace

std::vector<Subpath> subpaths(const Chain& chain) {
  std::vector<Subpath> result;
  for (svg::PathSegment& segment : svg::path_segments(chain, page_tolerance)) {
    if (result.empty() || !meet(result.back().segments.back(), segment)) result.emplace_back();
    result.back().segments.push_back(std::move(segment));
  }
  for (Subpath& subpath : result) subpath.is_closed = meet(subpath.segments.back(), subpath.segments.front());
  return result;
}

}  // namespace isorim::io::drawing
