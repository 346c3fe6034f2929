#include "io/drawing/annotations.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "io/drawing/text_metrics.h"

namespace isorim::io::drawing {

namespace {

using geometry::Point2;
using geometry::Points;
using geometry::Vector2;

/// Width to length of an arrow head: 15 degrees in all, as ISO 129-1 has it.
const double arrow_slope = std::tan(7.5 * std::numbers::pi / 180.0);
/// How far extension lines go beyond the dimension line.
constexpr double beyond = 1.5;

Vector2 left_of(const Vector2& direction) {
  return {-direction.y(), direction.x()};
}

/// In (-90, 90]: so that a text along the direction is read from below or from the right.
double reading_angle(const Vector2& direction) {
  double angle = std::atan2(direction.y(), direction.x()) * 180.0 / std::numbers::pi;
  if (angle > 90.0 + 1e-9) angle -= 180.0;
  if (angle <= -90.0 + 1e-9) angle += 180.0;
  return angle;
}

/// The line with its arrows: inwards between the ends if there is room, otherwise from outside.
void add_arrowed_line(Drawing& drawing, std::size_t layer, const Point2& from, const Point2& to, double arrow) {
  const Vector2 along = (to - from).normalized();
  const bool is_wide = (to - from).norm() >= 3.0 * arrow;
  const double overhang = is_wide ? 0.0 : 2.5 * arrow;
  drawing.add(layer, line(from - overhang * along, to + overhang * along));
  add_arrow(drawing, layer, from, is_wide ? -along : along, arrow);
  add_arrow(drawing, layer, to, is_wide ? along : -along, arrow);
}

constexpr double block_padding = 3.0;
constexpr double block_title_height = 3.5;
constexpr double block_text_height = 2.5;
constexpr double block_line = 5.5;
constexpr double least_block_width = 70.0;

std::vector<std::pair<std::string, std::string>> lines_of(const TitleBlock& block) {
  auto lines = block.fields;
  lines.emplace_back("scale", block.scale);
  return lines;
}

/// Of the names' column.
double name_width(const std::vector<std::pair<std::string, std::string>>& lines) {
  double width = 0.0;
  for (const auto& [name, value] : lines) width = std::max(width, text_width(name, block_text_height));
  return width + 2.0 * block_padding;
}

}  // namespace

void add_arrow(Drawing& drawing, std::size_t layer, const Point2& tip, const Vector2& direction, double length) {
  const Vector2 along = direction.normalized();
  const Vector2 half = arrow_slope * length * left_of(along);
  const Point2 foot = tip - length * along;
  Points<2> corners(2, 4);
  corners << tip, foot + half, foot - half, tip;
  drawing.add(layer, Fill{{{geometry::polyline<2>(corners)}}, drawing.layers().at(layer).colour});
}

void add_dimension(Drawing& drawing, std::size_t layer, const Point2& from, const Point2& to, double distance,
                   const std::string& text, const DimensionStyle& style) {
  if (!((to - from).norm() > 0.0)) throw InputError("dimension: its two points coincide");
  const Vector2 along = (to - from).normalized();
  const Vector2 away = distance < 0.0 ? Vector2(-left_of(along)) : left_of(along);
  const Vector2 shift = std::abs(distance) * away;
  for (const Point2& end : {from, to}) {
    if (std::abs(distance) > style.gap) drawing.add(layer, line(end + style.gap * away, end + shift + beyond * away));
  }
  add_arrowed_line(drawing, layer, from + shift, to + shift, style.arrow);
  const double angle = reading_angle(along);
  const double radians = angle * std::numbers::pi / 180.0;
  const Vector2 above = left_of({std::cos(radians), std::sin(radians)});
  drawing.add(layer, Text{text, 0.5 * (from + to) + shift + 0.4 * style.text_height * above, style.text_height,
                          Horizontal::centre, Vertical::baseline, angle});
}

void add_leader(Drawing& drawing, std::size_t layer, const Point2& target, const Point2& knee, const std::string& text,
                const DimensionStyle& style) {
  const bool goes_right = knee.x() >= target.x();
  const Vector2 step(goes_right ? style.text_height : -style.text_height, 0.0);
  Polyline bent;
  bent.points.resize(2, 3);
  bent.points << target, knee, knee + step;
  drawing.add(layer, bent);
  add_arrow(drawing, layer, target, target - knee, style.arrow);
  drawing.add(layer, Text{text, knee + 1.4 * step, style.text_height, goes_right ? Horizontal::left : Horizontal::right,
                          Vertical::middle});
}

void add_scale_bar(Drawing& drawing, std::size_t layer, const Point2& place, double length, const std::string& text,
                   double text_height) {
  if (!std::isfinite(length) || length <= 0.0)
    throw InputError(fmt::format("scale bar: its length is {} mm, expected more than 0", length));
  const double step = length < 300.0 ? 10.0 : 50.0;
  const double tick = 0.8 * text_height;
  drawing.add(layer, line(place, place + Vector2(length, 0.0)));
  const int ticks = static_cast<int>(std::ceil(length / step - 1e-9));
  for (int i = 0; i <= ticks; ++i) {
    const double x = std::min(i * step, length);
    const double height = i == 0 || i == ticks ? 1.5 * tick : tick;
    drawing.add(layer, line(place + Vector2(x, 0.0), place + Vector2(x, height)));
  }
  const double y = 1.4 * text_height;
  drawing.add(layer, Text{"0", place + Vector2(0.0, y), text_height, Horizontal::centre});
  drawing.add(layer, Text{text, place + Vector2(length, y), text_height, Horizontal::centre});
}

void add_registration_mark(Drawing& drawing, std::size_t layer, const Point2& place, double size) {
  const Vector2 across(0.5 * size, 0.0);
  const Vector2 up(0.0, 0.5 * size);
  drawing.add(layer, line(place - across, place + across));
  drawing.add(layer, line(place - up, place + up));
  drawing.add(layer, Circle{place, 0.25 * size});
}

Vector2 title_block_size(const TitleBlock& block) {
  const auto lines = lines_of(block);
  double width = text_width(block.title, block_title_height) + 2.0 * block_padding;
  for (const auto& [name, value] : lines)
    width = std::max(width, name_width(lines) + text_width(value, block_text_height) + 2.0 * block_padding);
  return {std::max(width, least_block_width), block_line * static_cast<double>(lines.size()) + 2.0 * block_line};
}

void add_title_block(Drawing& drawing, std::size_t layer, const TitleBlock& block, const Point2& corner) {
  const Vector2 size = title_block_size(block);
  const Point2 lower = corner - Vector2(size.x(), 0.0);
  drawing.add(layer, outline({lower, lower + size}));
  const auto lines = lines_of(block);
  const double names = name_width(lines);
  double y = lower.y() + size.y() - 2.0 * block_line;
  drawing.add(layer, Text{block.title,
                          {lower.x() + block_padding, y + block_line},
                          block_title_height,
                          Horizontal::left,
                          Vertical::middle});
  for (const auto& [name, value] : lines) {
    drawing.add(layer, line({lower.x(), y}, {corner.x(), y}));
    const double middle = y - 0.5 * block_line;
    drawing.add(layer,
                Text{name, {lower.x() + block_padding, middle}, block_text_height, Horizontal::left, Vertical::middle});
    drawing.add(
        layer,
        Text{
            value, {lower.x() + names + block_padding, middle}, block_text_height, Horizontal::left, Vertical::middle});
    y -= block_line;
  }
  drawing.add(layer,
              line({lower.x() + names, lower.y()}, {lower.x() + names, lower.y() + size.y() - 2.0 * block_line}));
}

}  // namespace isorim::io::drawing
