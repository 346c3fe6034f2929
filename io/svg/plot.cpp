#include "io/svg/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"

namespace isorim::io::svg {

namespace {

/// Okabe and Ito's colours, told apart by colour-blind readers (M. Okabe and K. Ito, Color Universal Design, 2008),
/// in an order that keeps neighbours apart; yellow is left out as too pale for lines.
constexpr std::array<std::string_view, 7> palette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                  "#e69f00", "#56b4e9", "#000000"};
constexpr std::array markers{Marker::circle, Marker::square, Marker::triangle, Marker::diamond, Marker::cross};
/// Positive numbers below this count as zero on a logarithmic axis.
constexpr double smallest = 1e-300;

std::string_view colour(std::size_t series) {
  return palette[series % palette.size()];
}

Marker marker_of(const Plot& plot, std::size_t series) {
  return plot.series[series].marker.value_or(markers[series % markers.size()]);
}

/// Colours that come round again are told from the first by the other kind of line.
Line line_of(const Plot& plot, std::size_t series) {
  const Line line = plot.series[series].line;
  if (line == Line::none || series / palette.size() % 2 == 0) return line;
  return line == Line::solid ? Line::dashed : Line::solid;
}

/// A point of the plot in pixels.
struct PlottedPoint {
  enum class Kind { inside, floor, left_out } kind = Kind::inside;
  double x = 0.0;
  double y = 0.0;
};

bool is_below(const Axis& axis, double value) {
  return axis.scale == Scale::logarithmic && value < smallest;
}

AxisRange given_range(const PlotAxis& axis, const char* name) {
  const geometry::Interval range = *axis.range;
  const bool usable = std::isfinite(range.first) && std::isfinite(range.last) && range.first < range.last &&
                      !is_below(axis, range.first);
  if (!usable) {
    throw InputError(fmt::format("the plot's {} axis has the range [{}, {}], expected finite increasing{} limits", name,
                                 range.first, range.last, axis.scale == Scale::logarithmic ? " positive" : ""));
  }
  return {axis.scale, range.first, range.last};
}

/// The range that shows all values. With values for the floor of a logarithmic axis there is room below the others.
AxisRange range_of(const PlotAxis& axis, const char* name, const std::vector<Series>& series,
                   std::vector<double> Series::*values) {
  if (axis.range) return given_range(axis, name);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  bool has_floor = false;
  for (const Series& s : series) {
    for (const double value : s.*values) {
      if (!std::isfinite(value)) continue;
      if (is_below(axis, value)) {
        has_floor = true;
      } else {
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  if (low > high) return round_range(axis.scale, 1.0, 1.0);
  AxisRange range = round_range(axis.scale, low, high);
  if (has_floor) range.first = round_range(axis.scale, std::max(smallest, 0.3 * range.first), range.last).first;
  return range;
}

PlottedPoint plotted(const Plot& plot, const Frame& frame, double x, double y) {
  PlottedPoint point;
  if (!std::isfinite(x) || !std::isfinite(y)) {
    point.kind = PlottedPoint::Kind::left_out;
    return point;
  }
  const bool x_below = is_below(plot.x, x);
  const bool y_below = is_below(plot.y, y);
  if (x_below || y_below) point.kind = PlottedPoint::Kind::floor;
  point.x = x_below ? frame.box.left : frame.pixel_x(x);
  point.y = y_below ? frame.box.bottom : frame.pixel_y(y);
  return point;
}

using PlottedSeries = std::vector<std::vector<PlottedPoint>>;

PlottedSeries plotted_series(const Plot& plot, const Frame& frame) {
  PlottedSeries result;
  for (const Series& series : plot.series) {
    std::vector<PlottedPoint>& points = result.emplace_back();
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      points.push_back(plotted(plot, frame, series.x[i], series.y[i]));
    }
  }
  return result;
}

std::size_t count(const PlottedSeries& all, PlottedPoint::Kind kind) {
  std::size_t result = 0;
  for (const auto& points : all) {
    result += static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [&](const PlottedPoint& p) { return p.kind == kind; }));
  }
  return result;
}

std::string draw_marker(Marker marker, double x, double y) {
  const auto path = [&](std::string_view shape) {
    return fmt::format("<path d=\"M{} {}{}\"/>\n", number(x), number(y), shape);
  };
  switch (marker) {
    case Marker::circle:
      return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3.5\"/>\n", number(x), number(y));
    case Marker::square:
      return path("m-3.2 -3.2h6.4v6.4h-6.4z");
    case Marker::triangle:
      return path("m0 -4.4l4 7h-8z");
    case Marker::diamond:
      return path("m0 -4.6l4.6 4.6l-4.6 4.6l-4.6 -4.6z");
    case Marker::cross:
      return path("m-3.2 -3.2l6.4 6.4m0 -6.4l-6.4 6.4");
    case Marker::none:
      break;
  }
  return "";
}

std::string draw_markers(Marker marker, std::string_view paint, std::string_view fill,
                         const std::vector<PlottedPoint>& points, PlottedPoint::Kind kind) {
  std::string shapes;
  for (const PlottedPoint& point : points) {
    if (point.kind == kind) shapes += draw_marker(marker, point.x, point.y);
  }
  if (shapes.empty()) return "";
  return fmt::format("<g fill=\"{}\" stroke=\"{}\" stroke-width=\"1.4\">\n{}</g>\n", fill, paint, shapes);
}

/// Path data through the points, interrupted where one is left out or on the floor.
std::string line_path(const std::vector<PlottedPoint>& points) {
  std::string path;
  bool pen_down = false;
  for (const PlottedPoint& point : points) {
    const bool shown = point.kind == PlottedPoint::Kind::inside;
    if (shown) path += fmt::format("{}{} {}", pen_down ? 'L' : 'M', number(point.x), number(point.y));
    pen_down = shown;
  }
  return path;
}

std::string draw_line(Line line, std::string_view paint, const std::string& path) {
  if (line == Line::none || path.empty()) return "";
  return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.6" stroke-linejoin="round"{}/>)", path,
                     paint, line == Line::dashed ? " stroke-dasharray=\"6 4\"" : "") +
         "\n";
}

/// Points on the floor keep their whole marker: only what lies inside is clipped.
std::string draw_series(const Plot& plot, const PlottedSeries& all, const Box& box) {
  std::string clipped;
  std::string floor;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Marker marker = marker_of(plot, i);
    const Marker hollow = marker == Marker::none || marker == Marker::cross ? Marker::circle : marker;
    clipped +=
        fmt::format("<g class=\"series\">\n{}{}</g>\n", draw_line(line_of(plot, i), colour(i), line_path(all[i])),
                    draw_markers(marker, colour(i), marker == Marker::cross ? "none" : colour(i), all[i],
                                 PlottedPoint::Kind::inside));
    floor += draw_markers(hollow, colour(i), "#fff", all[i], PlottedPoint::Kind::floor);
  }
  constexpr double marker_room = 6.0;
  return fmt::format(
      "<clipPath id=\"frame\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n"
      "<g clip-path=\"url(#frame)\">\n{}</g>\n{}",
      number(box.left - marker_room), number(box.top - marker_room), number(box.width() + 2 * marker_room),
      number(box.height() + 2 * marker_room), clipped, floor);
}

/// One row: what the sample looks like and what it means.
struct LegendEntry {
  std::string text;
  std::string_view paint;
  std::string_view fill;
  Line line = Line::none;
  Marker marker = Marker::none;
};

constexpr double legend_row = 18.0;
constexpr double legend_padding = 8.0;
constexpr double legend_sample = 30.0;

std::vector<LegendEntry> legend_entries(const Plot& plot, const PlottedSeries& all) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    if (plot.series[i].name.empty()) continue;
    const Marker marker = marker_of(plot, i);
    entries.push_back(
        {plot.series[i].name, colour(i), marker == Marker::cross ? "none" : colour(i), line_of(plot, i), marker});
  }
  if (count(all, PlottedPoint::Kind::floor) > 0) {
    entries.push_back({"hollow: zero or less, at the floor", "#666", "#fff", Line::none, Marker::circle});
  }
  if (const std::size_t left_out = count(all, PlottedPoint::Kind::left_out); left_out > 0) {
    entries.push_back({fmt::format("{} not finite, left out", left_out), "#666", "none", Line::none, Marker::none});
  }
  return entries;
}

struct Size {
  double width = 0.0;
  double height = 0.0;
};

Size legend_size(const std::vector<LegendEntry>& entries) {
  double text = 0.0;
  for (const LegendEntry& entry : entries) text = std::max(text, text_width(entry.text, font_size));
  return {text + legend_sample + 6.0 + 2 * legend_padding,
          legend_row * static_cast<double>(entries.size()) + legend_padding};
}

std::string draw_legend(const std::vector<LegendEntry>& entries, const Box& box) {
  std::string result = fmt::format(
      R"(<g class="legend"><rect x="{}" y="{}" width="{}" height="{}" fill="#fff" fill-opacity="0.9" stroke="#ccc" )"
      "stroke-width=\"0.8\"/>\n",
      number(box.left), number(box.top), number(box.width()), number(box.height()));
  double y = box.top + 0.5 * (legend_padding + legend_row);
  const double left = box.left + legend_padding;
  for (const LegendEntry& entry : entries) {
    const PlottedPoint sample{PlottedPoint::Kind::inside, left + 0.5 * legend_sample, y};
    result +=
        draw_line(entry.line, entry.paint, fmt::format("M{} {}h{}", number(left), number(y), number(legend_sample)));
    result += draw_markers(entry.marker, entry.paint, entry.fill, {sample}, PlottedPoint::Kind::inside);
    result += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", number(left + legend_sample + 6.0),
                          number(y + 0.35 * font_size), escape(entry.text));
    y += legend_row;
  }
  return result + "</g>\n";
}

/// Whether a point or a line of the data passes through the box; lines are probed every few pixels.
bool hides_data(const Box& box, const PlottedSeries& all) {
  constexpr double room = 7.0;
  const auto is_in_box = [&](double x, double y) {
    return x > box.left - room && x < box.right + room && y > box.top - room && y < box.bottom + room;
  };
  for (const auto& points : all) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].kind == PlottedPoint::Kind::left_out) continue;
      if (is_in_box(points[i].x, points[i].y)) return true;
      if (i == 0 || points[i - 1].kind != PlottedPoint::Kind::inside) continue;
      const double dx = points[i].x - points[i - 1].x;
      const double dy = points[i].y - points[i - 1].y;
      const int probes = static_cast<int>(std::min(1000.0, std::hypot(dx, dy) / 4.0));
      for (int k = 1; k < probes; ++k) {
        const double t = static_cast<double>(k) / probes;
        if (is_in_box(points[i - 1].x + t * dx, points[i - 1].y + t * dy)) return true;
      }
    }
  }
  return false;
}

/// The first free corner: top right, top left, bottom right, bottom left.
std::optional<Box> free_corner(const Box& frame, Size size, const PlottedSeries& all) {
  constexpr double gap = 10.0;
  if (size.width + 2 * gap > frame.width() || size.height + 2 * gap > frame.height()) return std::nullopt;
  for (const bool top : {true, false}) {
    for (const bool right : {true, false}) {
      Box box;
      box.left = right ? frame.right - gap - size.width : frame.left + gap;
      box.top = top ? frame.top + gap : frame.bottom - gap - size.height;
      box.right = box.left + size.width;
      box.bottom = box.top + size.height;
      if (!hides_data(box, all)) return box;
    }
  }
  return std::nullopt;
}

void require_valid(const Plot& plot) {
  if (plot.width < 200 || plot.height < 150) {
    throw InputError(fmt::format("the plot's size is {} x {}, expected at least 200 x 150", plot.width, plot.height));
  }
  for (const Series& series : plot.series) {
    if (series.x.size() != series.y.size()) {
      throw InputError(
          fmt::format("the series '{}' has {} x and {} y values", series.name, series.x.size(), series.y.size()));
    }
  }
}

}  // namespace

std::string to_svg(const Plot& plot) {
  require_valid(plot);
  Frame frame;
  frame.x = range_of(plot.x, "x", plot.series, &Series::x);
  frame.y = range_of(plot.y, "y", plot.series, &Series::y);
  const FrameTicks ticks = frame_ticks(frame.x, frame.y);
  const Box margins = frame_margins(ticks, plot.title, plot.x, plot.y);
  frame.box = {margins.left, margins.top, plot.width - margins.right, plot.height - margins.bottom};

  PlottedSeries all = plotted_series(plot, frame);
  const std::vector<LegendEntry> entries = legend_entries(plot, all);
  std::string legend;
  if (!entries.empty()) {
    const Size size = legend_size(entries);
    std::optional<Box> place = free_corner(frame.box, size, all);
    if (!place) {
      frame.box.right = std::max(frame.box.left + 100.0, frame.box.right - size.width - 4.0);
      all = plotted_series(plot, frame);
      const double left = frame.box.right + 10.0;
      place = Box{left, frame.box.top, left + size.width, frame.box.top + size.height};
    }
    legend = draw_legend(entries, *place);
  }
  return open_document(plot.width, plot.height, plot.title) + draw_frame(frame, ticks, plot.title, plot.x, plot.y) +
         draw_series(plot, all, frame.box) + legend + "</svg>\n";
}

void write_svg(const std::filesystem::path& path, const Plot& plot) {
  write_file(path, to_svg(plot));
}

}  // namespace isorim::io::svg
