#include "io/moulds/mould_sheets.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/drawing/annotations.h"
#include "io/svg/markup.h"

namespace isorim::io {
namespace {

using drawing::Drawing;
using drawing::Layer;
using drawing::LineType;
using drawing::Path;
using drawing::Rectangle;
using drawing::Text;
using geometry::Point2;
using geometry::Vector2;
using svg::number;

constexpr double margin_part = 0.1;
constexpr double least_margin = 5.0;
constexpr double text_height = 2.5;
constexpr double line_height = 4.5;
/// Round the rectangle on its sheet.
constexpr double sheet_margin = 10.0;

constexpr drawing::Colour section_colour{180, 0, 0};
constexpr drawing::Colour upper_colour{0, 70, 160};

std::string mm(double value) {
  return number(value, 4);
}

/// Every curve of the section: the spline that was fitted to it, or the pieces that it is made of.
std::vector<Path> paths_of(const MouldSection& section) {
  std::vector<Path> paths;
  if (!section.measured.section) return paths;
  const geometry::PlaneSection& cut = *section.measured.section;
  const auto add = [&](const geometry::SectionCurve& curve, const std::optional<geometry::SectionSpline>& spline) {
    paths.push_back(spline ? Path{{spline->curve}} : Path{curve.plane_curves.curves});
  };
  for (std::size_t i = 0; i < cut.loops.size(); ++i) add(cut.loops[i].curve, section.measured.loops[i]);
  for (std::size_t i = 0; i < cut.chains.size(); ++i) add(cut.chains[i], section.measured.chains[i]);
  for (std::size_t i = 0; i < cut.touching.size(); ++i) add(cut.touching[i], section.measured.touching[i]);
  return paths;
}

/// The part of the straight line through both points that lies in the rectangle (Liang and Barsky 1984).
drawing::Polyline across(const Rectangle& rectangle, const geometry::PartingLine& parting) {
  const Vector2 along = parting.to - parting.from;
  double first = -INFINITY;
  double last = INFINITY;
  for (const Eigen::Index i : {0, 1}) {
    if (along(i) == 0.0) continue;
    const double a = (rectangle.lower(i) - parting.from(i)) / along(i);
    const double b = (rectangle.upper(i) - parting.from(i)) / along(i);
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return drawing::line(parting.from + first * along, parting.from + last * along);
}

Rectangle hub_outline(const HubRectangle& hub) {
  return {{hub.x.first, -hub.half_width}, {hub.x.last, hub.half_width}};
}

/// What the layers of a section are drawn with.
struct Style {
  drawing::Colour colour = section_colour;
  double line_width = 0.35;
  LineType line_type = LineType::continuous;
};

void add_section(const MouldSection& section, const Rectangle& rectangle, const Style& style, Drawing& target) {
  const std::string name = section_layer(section.height);
  const std::vector<Path> paths = paths_of(section);
  if (!paths.empty()) {
    const std::size_t layer = target.add_layer({name, style.colour, style.line_width, style.line_type});
    for (const Path& path : paths) target.add(layer, path);
  }
  const bool is_upper = style.line_type != LineType::continuous;
  if (is_upper) return;
  if (section.hub) {
    const std::size_t layer = target.add_layer({name + "hub", drawing::black, 0.25});
    target.add(layer, drawing::outline(hub_outline(*section.hub)));
  }
  if (section.parting) {
    const std::size_t layer = target.add_layer({name + "parting", drawing::green, 0.25, LineType::chain});
    target.add(layer, across(rectangle, *section.parting));
  }
}

std::size_t add_base(const Rectangle& rectangle, Drawing& target) {
  const std::size_t base = target.add_layer({"base", drawing::black, 0.5});
  target.add(base, drawing::outline(rectangle));
  return base;
}

/// The lines of text below a board's rectangle.
std::vector<std::string> texts_of(const MouldStack& stack, std::size_t i, const std::string& title) {
  const MouldSection& lower = stack.sections[i];
  std::vector<std::string> lines;
  if (stack.board_thickness) {
    const MouldSection& upper = stack.sections[i + 1];
    lines.push_back(fmt::format("{}: board {} of {}, z = {} to {} mm", title, i + 1, stack.boards(), mm(lower.height),
                                mm(upper.height)));
    lines.emplace_back("full: lower face; dashed: upper face. Cut to the outer of both; fill the steps.");
    for (const MouldSection* face : {&lower, &upper})
      if (!face->remark.empty()) lines.push_back(face->remark);
  } else {
    lines.push_back(
        fmt::format("{}: section {} of {}, z = {} mm", title, i + 1, stack.sections.size(), mm(lower.height)));
    if (!lower.remark.empty()) lines.push_back(lower.remark);
  }
  if (lower.parting) lines.emplace_back("chain line: cut the board in two along it, from edge to edge");
  if (lower.hub)
    lines.push_back(fmt::format("rectangle: hub, {} x {} mm", number(lower.hub->x.length(), 2),
                                number(2.0 * lower.hub->half_width, 2)));
  return lines;
}

/// Arrows of the axes in the rectangle's upper left corner, so that no board is turned over unseen.
void add_axes(const Rectangle& rectangle, std::size_t layer, Drawing& target) {
  const Point2 corner(rectangle.lower.x() + 3.0, rectangle.upper.y() - 11.0);
  for (const Vector2& axis : {Vector2(8.0, 0.0), Vector2(0.0, 8.0)}) {
    target.add(layer, drawing::line(corner, corner + axis));
    drawing::add_arrow(target, layer, corner + axis, axis, 2.0);
  }
  target.add(layer, Text{"X", corner + Vector2(8.5, 1.2), 1.8});
  target.add(layer, Text{"Y", corner + Vector2(1.2, 6.5), 1.8});
}

drawing::Sheet sheet_of(const MouldStack& stack, std::size_t i, const Rectangle& rectangle, const std::string& title) {
  Drawing sheet;
  add_base(rectangle, sheet);
  if (stack.board_thickness)
    add_section(stack.sections[i + 1], rectangle, {upper_colour, 0.25, LineType::dashed}, sheet);
  add_section(stack.sections[i], rectangle, {}, sheet);
  const std::size_t notes = sheet.add_layer({"notes", drawing::black, 0.18});
  add_axes(rectangle, notes, sheet);
  double y = rectangle.lower.y() - line_height - 1.0;
  for (const std::string& text : texts_of(stack, i, title)) {
    sheet.add(notes, Text{text, {rectangle.lower.x(), y}, text_height});
    y -= line_height;
  }
  drawing::add_scale_bar(sheet, notes, {rectangle.lower.x() + 1.0, y - 5.0}, 50.0, "50 mm", 1.8);
  const std::string name = stack.board_thickness ? fmt::format("{}, board {} of {}", title, i + 1, stack.boards())
                                                 : fmt::format("{}, z = {} mm", title, mm(stack.sections[i].height));
  return drawing::sheet_round(name, std::move(sheet), sheet_margin);
}

}  // namespace

Rectangle mould_rectangle(const MouldStack& stack) {
  Rectangle bounds;
  const auto add = [&](const Rectangle& part) {
    bounds.lower = bounds.lower.cwiseMin(part.lower);
    bounds.upper = bounds.upper.cwiseMax(part.upper);
  };
  for (const MouldSection& section : stack.sections) {
    for (const Path& path : paths_of(section)) add(drawing::extent(drawing::Entity(path)));
    if (section.hub) add(hub_outline(*section.hub));
  }
  if (bounds.is_empty()) throw InputError("moulds: no plane meets the body");
  const Vector2 margin = (margin_part * (bounds.upper - bounds.lower)).cwiseMax(least_margin);
  return {bounds.lower - margin, bounds.upper + margin};
}

Drawing mould_overlay(const MouldStack& stack) {
  const Rectangle rectangle = mould_rectangle(stack);
  Drawing overlay;
  add_base(rectangle, overlay);
  for (const MouldSection& section : stack.sections)
    add_section(section, rectangle, {section_colour, 0.18, LineType::continuous}, overlay);
  return overlay;
}

std::vector<drawing::Sheet> mould_sheets(const MouldStack& stack, const std::string& title) {
  const Rectangle rectangle = mould_rectangle(stack);
  const std::size_t count = stack.board_thickness ? stack.boards() : stack.sections.size();
  std::vector<drawing::Sheet> sheets;
  for (std::size_t i = 0; i < count; ++i) sheets.push_back(sheet_of(stack, i, rectangle, title));
  return sheets;
}

std::string mould_table(const MouldStack& stack) {
  std::string table =
      "number,z_lower,z_upper,area_lower,area_upper,hub_half_width,parting_from_x,parting_from_y,"
      "parting_to_x,parting_to_y,remark\n";
  const std::size_t count = stack.board_thickness ? stack.boards() : stack.sections.size();
  const auto area = [](const MouldSection& section) {
    return !section.measured.section || section.measured.section->loops.empty() ? "" : mm(section.measured.area.value);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const MouldSection& lower = stack.sections[i];
    const MouldSection* upper = stack.board_thickness ? &stack.sections[i + 1] : nullptr;
    fmt::format_to(std::back_inserter(table), "{},{},{},{},{},{},", i + 1, mm(lower.height),
                   upper ? mm(upper->height) : "", area(lower), upper ? area(*upper) : "",
                   lower.hub ? mm(lower.hub->half_width) : "");
    if (lower.parting) {
      const auto& [from, to] = *lower.parting;
      table += fmt::format("{},{},{},{},", mm(from.x()), mm(from.y()), mm(to.x()), mm(to.y()));
    } else {
      table += ",,,,";
    }
    std::string remark = lower.remark;
    if (upper && !upper->remark.empty()) remark += (remark.empty() ? "" : "; ") + upper->remark;
    table += remark.empty() ? "\n" : "\"" + remark + "\"\n";
  }
  return table;
}

}  // namespace isorim::io
