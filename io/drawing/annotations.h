#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "io/drawing/drawing.h"

/// What a drawing says besides its lines: dimensions, leaders, scale bars, title blocks. All lengths in mm on paper.
namespace isorim::io::drawing {

struct DimensionStyle {
  double text_height = 2.5;
  /// Length of the arrow heads.
  double arrow = 2.5;
  /// Between the measured points and the lines that lead away from them.
  double gap = 1.0;
};

/// The distance of two points along the line through them, drawn at `distance` to the left of the way from `from` to
/// `to` (negative: to the right): extension lines, an arrow at each end, and the text above the line, read from below
/// or from the right (ISO 129-1). Where the arrows do not fit between the ends they stand outside. Throws InputError
/// if the points coincide.
void add_dimension(Drawing& drawing, std::size_t layer, const geometry::Point2& from, const geometry::Point2& to,
                   double distance, const std::string& text, const DimensionStyle& style = {});

/// A line with an arrow at `target`, bent at `knee`, with the text beside its end.
void add_leader(Drawing& drawing, std::size_t layer, const geometry::Point2& target, const geometry::Point2& knee,
                const std::string& text, const DimensionStyle& style = {});

/// A full arrow head whose point is `tip`, looking along `direction` (any length but zero).
void add_arrow(Drawing& drawing, std::size_t layer, const geometry::Point2& tip, const geometry::Vector2& direction,
               double length);

/// A bar to be measured on the paper, `length` mm long, with a tick every 10 mm (every 50 mm from 300 on), labelled 0
/// and with what its length means: `text`, e.g. "100 mm", or "5 m" at a scale of 1:50. `place` is its left end; ticks
/// and texts stand above it, at most 2.5 text heights high. Throws InputError if the length is not positive.
void add_scale_bar(Drawing& drawing, std::size_t layer, const geometry::Point2& place, double length,
                   const std::string& text, double text_height = 2.5);

/// A cross of lines `size` long with a circle half as wide round it.
void add_registration_mark(Drawing& drawing, std::size_t layer, const geometry::Point2& place, double size = 6.0);

/// What the block in the lower right corner of a sheet says.
struct TitleBlock {
  std::string title;
  /// "1:1"
  std::string scale = "1:1";
  /// Lines of name and value, from the top.
  std::vector<std::pair<std::string, std::string>> fields = {};
};

/// The size of the block with its frame: it is as wide as its texts need, at least 70 mm.
geometry::Vector2 title_block_size(const TitleBlock& block);

/// Draws the block on the layer with its lower right corner at `corner`.
void add_title_block(Drawing& drawing, std::size_t layer, const TitleBlock& block, const geometry::Point2& corner);

}  // namespace isorim::io::drawing
