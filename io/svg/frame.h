#pragma once

#include <string>

#include "io/svg/axis.h"

namespace isorim::io::svg {

struct Axis {
  std::string label;
  Scale scale = Scale::linear;
};

/// A rectangle of the picture, in pixels, y downwards.
struct Box {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

inline constexpr double font_size = 12.0;
inline constexpr double title_font_size = 15.0;

/// The rectangle that data are drawn in, with its grid, ticks and labels round it.
struct Frame {
  Box box;
  AxisRange x;
  AxisRange y;

  double pixel_x(double value) const { return box.left + x.fraction(value) * box.width(); }
  double pixel_y(double value) const { return box.bottom - y.fraction(value) * box.height(); }
};

/// The ticks of one frame and the room that they need.
struct FrameTicks {
  Ticks x;
  Ticks y;
};
FrameTicks frame_ticks(const AxisRange& x, const AxisRange& y);

/// What has to stay free round a frame of these ticks and texts, as distances from the picture's edges.
Box frame_margins(const FrameTicks& ticks, const std::string& title, const Axis& x, const Axis& y);

/// Grid, tick labels, axis labels and title; what lies under the data.
std::string draw_frame(const Frame& frame, const FrameTicks& ticks, const std::string& title, const Axis& x,
                       const Axis& y);

}  // namespace isorim::io::svg
