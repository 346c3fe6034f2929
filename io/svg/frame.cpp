#include "io/svg/frame.h"

#include <algorithm>

#include <fmt/format.h>

namespace isorim::io::svg {

namespace {

constexpr int most_ticks = 9;
constexpr double tick_gap = 6.0;

double widest_label(const std::vector<Tick>& ticks) {
  double width = 0.0;
  for (const Tick& tick : ticks) width = std::max(width, tick.label.width(font_size));
  return width;
}

std::string grid_path(const Frame& frame, const std::vector<double>& xs, const std::vector<double>& ys) {
  std::string path;
  for (const double x : xs) {
    path += fmt::format("M{} {}V{}", number(frame.pixel_x(x)), number(frame.box.top), number(frame.box.bottom));
  }
  for (const double y : ys) {
    path += fmt::format("M{} {}H{}", number(frame.box.left), number(frame.pixel_y(y)), number(frame.box.right));
  }
  return path;
}

std::vector<double> values(const std::vector<Tick>& ticks) {
  std::vector<double> result;
  for (const Tick& tick : ticks) result.push_back(tick.value);
  return result;
}

std::string draw_grid(const Frame& frame, const FrameTicks& ticks) {
  std::string result;
  const std::string minor = grid_path(frame, ticks.x.minor, ticks.y.minor);
  if (!minor.empty()) {
    result +=
        fmt::format(R"(<path class="minor grid" d="{}" fill="none" stroke="#f1f1f1" stroke-width="0.7"/>)", minor) +
        "\n";
  }
  result += fmt::format(R"(<path class="grid" d="{}" fill="none" stroke="#dadada" stroke-width="0.8"/>)",
                        grid_path(frame, values(ticks.x.major), values(ticks.y.major)));
  return result + "\n";
}

std::string draw_tick_labels(const Frame& frame, const FrameTicks& ticks) {
  std::string result = "<g class=\"x ticks\" text-anchor=\"middle\">\n";
  for (const Tick& tick : ticks.x.major) {
    result += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", number(frame.pixel_x(tick.value)),
                          number(frame.box.bottom + tick_gap + font_size), tick.label.markup(font_size));
  }
  result += "</g>\n<g class=\"y ticks\" text-anchor=\"end\">\n";
  for (const Tick& tick : ticks.y.major) {
    result += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", number(frame.box.left - tick_gap),
                          number(frame.pixel_y(tick.value) + 0.35 * font_size), tick.label.markup(font_size));
  }
  return result + "</g>\n";
}

std::string draw_axis_labels(const Frame& frame, const FrameTicks& ticks, const Axis& x, const Axis& y) {
  const Box& box = frame.box;
  std::string result;
  if (!x.label.empty()) {
    result += fmt::format(
        "<text class=\"x label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"13\">{}</text>\n",
        number(0.5 * (box.left + box.right)), number(box.bottom + tick_gap + 2.9 * font_size), escape(x.label));
  }
  if (!y.label.empty()) {
    const double left = box.left - tick_gap - widest_label(ticks.y.major) - 10.0;
    result += fmt::format(
        "<text class=\"y label\" transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\" "
        "font-size=\"13\">{}</text>\n",
        number(left), number(0.5 * (box.top + box.bottom)), escape(y.label));
  }
  return result;
}

}  // namespace

FrameTicks frame_ticks(const AxisRange& x, const AxisRange& y) {
  return {ticks(x, most_ticks), ticks(y, most_ticks)};
}

Box frame_margins(const FrameTicks& ticks, const std::string& title, const Axis& x, const Axis& y) {
  Box margins;
  margins.left = 14.0 + tick_gap + widest_label(ticks.y.major) + (y.label.empty() ? 0.0 : 22.0);
  margins.right = 14.0 + (ticks.x.major.empty() ? 0.0 : 0.5 * ticks.x.major.back().label.width(font_size));
  margins.top = title.empty() ? 16.0 : 44.0;
  margins.bottom = 18.0 + font_size + (x.label.empty() ? 0.0 : 22.0);
  return margins;
}

std::string draw_frame(const Frame& frame, const FrameTicks& ticks, const std::string& title, const Axis& x,
                       const Axis& y) {
  std::string result = draw_grid(frame, ticks);
  const Box& box = frame.box;
  result += fmt::format(
      R"(<rect class="frame" x="{}" y="{}" width="{}" height="{}" fill="none" stroke="#888" stroke-width="0.8"/>)"
      "\n",
      number(box.left), number(box.top), number(box.width()), number(box.height()));
  result += draw_tick_labels(frame, ticks) + draw_axis_labels(frame, ticks, x, y);
  if (!title.empty()) {
    result += fmt::format("<text class=\"title\" x=\"{}\" y=\"{}\" font-size=\"{}\" font-weight=\"bold\">{}</text>\n",
                          number(box.left), number(box.top - 16.0), number(title_font_size), escape(title));
  }
  return result;
}

}  // namespace isorim::io::svg
