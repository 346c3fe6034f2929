#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "io/case/drawing_keys.h"

/// The declarations of workshop drawings.
namespace isorim::io {

namespace {

constexpr std::array formats{DrawingFormat::pdf, DrawingFormat::svg, DrawingFormat::dxf};
constexpr int most_sections = 5000;

void check_formats(const DrawingKeys& keys, const KeyPlace& where, Complaints& complaints) {
  for (const std::string& name : keys.formats) {
    if (std::ranges::none_of(formats, [&](DrawingFormat format) { return name == name_of(format); }))
      complaints.add(where.key("formats", where.place),
                     fmt::format("found \"{}\"; expected \"pdf\", \"svg\" or \"dxf\"", name));
  }
}

void check_moulds(const MouldKeys& keys, const KeyPlace& where, Complaints& complaints) {
  const bool has_heights = !keys.heights.empty() || keys.step;
  if (keys.board_thickness.has_value() == has_heights) {
    complaints.add(where, "expected either \"board_thickness\", or \"heights\", or \"from\", \"to\" and \"step\"");
    return;
  }
  if (!keys.heights.empty() && (keys.from || keys.to || keys.step)) {
    complaints.add(where, "found both \"heights\" and a range; expected one of them");
    return;
  }
  if (!std::ranges::is_sorted(keys.heights, std::ranges::less_equal()))
    complaints.add(where.key("heights", where.place), "expected heights that rise");
  if (keys.step && (!keys.from || !keys.to)) complaints.add(where, "expected \"from\" and \"to\" with \"step\"");
  if (!keys.from || !keys.to) return;
  if (!(*keys.from < *keys.to)) {
    complaints.add(where, fmt::format("found from = {} not below to = {}", *keys.from, *keys.to));
    return;
  }
  const double step = keys.step ? *keys.step : *keys.board_thickness;
  if ((*keys.to - *keys.from) / step > most_sections)
    complaints.add(where, fmt::format("more than {} sections", most_sections));
}

}  // namespace

const char* name_of(DrawingFormat format) {
  return format == DrawingFormat::pdf ? "pdf" : format == DrawingFormat::svg ? "svg" : "dxf";
}

bool DrawingKeys::has(DrawingFormat format) const {
  return formats.empty() || std::ranges::find(formats, name_of(format)) != formats.end();
}

template <>
const Schema<DrawingKeys>& schema<DrawingKeys>() {
  static const auto declared =
      Schema<DrawingKeys>("drawings",
                          "Workshop drawings, in true size or at a scale. Of a propeller overview.pdf, .svg and .dxf; "
                          "of [moulds] moulds.pdf, .dxf and moulds/*.svg.")
          .choice("unit", &DrawingKeys::millimetres, {{"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}, {"in", 25.4}},
                  {.text = "Of the lengths of the case: drawings are in millimetres."})
          .key("formats", &DrawingKeys::formats, {.text = "Out of pdf, svg, dxf; all if absent."})
          .choice(
              "sheets", &DrawingKeys::sheets, {{"whole", SheetCut::whole}, {"a4", SheetCut::a4}},
              {.text = "Of PDF files: a page as large as the drawing, or pages of A4 with overlaps and registration "
                       "marks."})
          .key("overview", &DrawingKeys::overview, {.text = "An overview, of shapes that have one."})
          .key("scale", &DrawingKeys::scale,
               {.text = "Of the overview, 1 to this; 0: as it fits on A3.", .range = Range::at_least(0)})
          .check(check_formats);
  return declared;
}

template <>
const Schema<MouldKeys>& schema<MouldKeys>() {
  static const auto declared =
      Schema<MouldKeys>("moulds",
                        "Templates of female moulds: plane sections at heights z, of a propeller of its first blade, "
                        "with the rectangle of the hub and the line along which to part the mould. [drawings] says in "
                        "which formats.")
          .key("board_thickness", &MouldKeys::board_thickness,
               {.text = "Boards between z = multiples of this, from below the shape to above it.",
                .unit = "length",
                .range = Range::above(0)})
          .key("heights", &MouldKeys::heights, {.text = "Instead: sections at these z, no boards.", .unit = "length"})
          .key("from", &MouldKeys::from,
               {.text =
                    "The first section: of a range, or of boards if they shall not begin at the shape's lowest point.",
                .unit = "length"})
          .key("to", &MouldKeys::to, {.text = "The last one.", .unit = "length"})
          .key("step", &MouldKeys::step,
               {.text = "Instead of heights: from section to section.", .unit = "length", .range = Range::above(0)})
          .check(check_moulds);
  return declared;
}

}  // namespace isorim::io
