#include "io/drawing/ink.h"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "geometry/shapes/curves.h"
#include "io/drawing/page_path.h"

namespace isorim::io::drawing {
namespace {

using geometry::Point2;

/// The longest side of a box round a piece of a line, in mm.
constexpr double longest_side = 2.0;
/// Of one segment into pieces.
constexpr int most_bisections = 16;

/// Boxes of one layer.
class Boxes {
 public:
  Boxes(double line_width, std::vector<Rectangle>& boxes) : half_width_(0.5 * line_width), boxes_(boxes) {}

  void operator()(const Path& path) const { add(path.chain); }
  void operator()(const Polyline& polyline) const {
    const Eigen::Index count = polyline.points.cols();
    for (Eigen::Index i = 0; i < (polyline.is_closed ? count : count - 1); ++i) {
      svg::PathSegment side(2, 2);
      side << polyline.points.col(i), polyline.points.col((i + 1) % count);
      add(side, most_bisections);
    }
  }
  void operator()(const Circle& circle) const { add({geometry::circle_curve(circle.radius, circle.centre)}); }
  void operator()(const Fill& fill) const { add(extent(Entity(fill))); }
  void operator()(const Text& text) const { add(extent(Entity(text))); }

 private:
  void add(const Rectangle& box) const {
    boxes_.push_back({box.lower.array() - half_width_, box.upper.array() + half_width_});
  }
  void add(const Chain& chain) const {
    for (const Subpath& subpath : subpaths(chain))
      for (const svg::PathSegment& segment : subpath.segments) add(segment, most_bisections);
  }
  /// The box of the control points, or those of both halves.
  void add(const svg::PathSegment& segment, int bisections) const {
    const Rectangle box{segment.rowwise().minCoeff(), segment.rowwise().maxCoeff()};
    if (bisections == 0 || (box.upper - box.lower).maxCoeff() <= longest_side) return add(box);
    svg::PathSegment first = segment;
    svg::PathSegment second = segment;
    const Eigen::Index last = segment.cols() - 1;
    for (Eigen::Index round = 1; round <= last; ++round) {
      for (Eigen::Index i = 0; i <= last - round; ++i) second.col(i) = 0.5 * (second.col(i) + second.col(i + 1)).eval();
      first.col(round) = second.col(0);
    }
    add(first, bisections - 1);
    add(second, bisections - 1);
  }

  double half_width_;
  std::vector<Rectangle>& boxes_;
};

}  // namespace

Ink::Ink(const Drawing& drawing) {
  for (std::size_t i = 0; i < drawing.layers().size(); ++i) {
    const Boxes boxes(drawing.layers()[i].line_width, boxes_);
    for (const Entity& entity : drawing.entities(i)) std::visit(boxes, entity);
  }
}

bool Ink::meets(const Rectangle& rectangle) const {
  return std::ranges::any_of(boxes_, [&](const Rectangle& box) {
    return (box.lower.array() <= rectangle.upper.array()).all() && (rectangle.lower.array() <= box.upper.array()).all();
  });
}

}  // namespace isorim::io::drawing
