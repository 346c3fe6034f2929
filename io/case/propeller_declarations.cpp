#include "io/case/shape_schema.h"

/// The declarations of propellers.
namespace isorim::io {
namespace {

using geometry::Hand;
using geometry::MeanLine;
using geometry::ThicknessForm;

void check_law(const NumberArray& law, Complaints& complaints) {
  if (law.values.size() <= 1 || (law.rows > 1 && law.columns == 2)) return;
  complaints.add(law.where, "found a list; expected one number, or a list of rows [r/R, value], at least two");
}

void check_source(const PropellerKeys& keys, const KeyPlace& where, Complaints& complaints) {
  const bool is_series = keys.series != BladeSource::own;
  const int sources =
      int{is_series} + int{keys.table.has_value()} + int{!keys.table_file.empty()} + int{!keys.sections.empty()};
  if (sources != 1) {
    complaints.add(where, fmt::format("found {} of \"series\", \"table\", \"table_file\" and \"section\"; expected "
                                      "exactly one",
                                      sources == 0 ? "none" : fmt::format("{}", sources)));
    return;
  }
  if (is_series && !keys.area_ratio) complaints.add(where, "the key \"area_ratio\" is missing; a series needs it");
  if (!is_series && keys.area_ratio)
    complaints.add(where, "found \"area_ratio\"; blades of the case's own have the areas that come of their chords");
  if (keys.pitch_ratio.values.empty() && (is_series || !keys.sections.empty()))
    complaints.add(where, "the key \"pitch_ratio\" is missing");
  if (!is_series && keys.has_reduced_root_pitch)
    complaints.add(where, "found \"reduced_root_pitch\", which belongs to series = \"b_troost\"");
  if (is_series && (keys.blades < 3 || keys.blades > 7))
    complaints.add(
        where.key("blades", where.place),
        fmt::format("found {}; expected a number from 3 to 7, for which the series has tables", keys.blades));
}

void check_propeller(const PropellerKeys& keys, const KeyPlace& where, Complaints& complaints) {
  check_source(keys, where, complaints);
  if (keys.removal_tolerance && keys.uniformisation != BladeUniformisation::insert_and_remove)
    complaints.add(where, "found \"removal_tolerance\"; expected uniformisation = \"insert_and_remove\" beside it");
  if (!keys.hub_profile.empty() && keys.hub_ends)
    complaints.add(where, "found \"hub_ends\" beside \"hub_profile\", which says where the hub ends");
  for (const NumberArray* law : {&keys.pitch_ratio, &keys.rake, &keys.skew}) check_law(*law, complaints);
}

void check_edit(const BladeEditKeys& edit, const KeyPlace& where, Complaints& complaints) {
  if (int{edit.move_x.has_value()} + int{edit.move_y.has_value()} + int{edit.smooth} != 1)
    complaints.add(where, "expected exactly one of \"move_x\", \"move_y\" and smooth = true");
}

}  // namespace

template <>
const Schema<BladeTableKeys>& schema<BladeTableKeys>() {
  static const auto declared = [] {
    Schema<BladeTableKeys> columns("blade table",
                                   "The columns of a blade's table, one value a radius. Of those that say the same in "
                                   "different measures at most one; skew, rake and camber are 0 if absent.");
    for (const BladeColumn& column : blade_columns)
      columns.key(std::string(column.name), column.values,
                  {.text = std::string(column.text),
                   .presence = column.name == "r/R" ? Presence::required : Presence::optional});
    return columns;
  }();
  return declared;
}

template <>
const Schema<BladeSectionKeys>& schema<BladeSectionKeys>() {
  static const auto declared =
      Schema<BladeSectionKeys>("blade section", "A section by the points of its outline.")
          .key("r/R", &BladeSectionKeys::radius_ratio,
               {.text = "Its radius over that of the tip.",
                .range = {.least = 0, .most = 1, .least_is_open = true},
                .presence = required})
          .key("file", &BladeSectionKeys::file,
               {.text = "Lines of x, y on the expanded plane (x along the pitch line from the generator line towards "
                        "the leading edge, y towards the back), from the trailing edge along the back to the leading "
                        "edge and along the face back; as many in every section.",
                .presence = required});
  return declared;
}

template <>
const Schema<BladeEditKeys>& schema<BladeEditKeys>() {
  static const auto declared =
      Schema<BladeEditKeys>("blade edit", "Moves a control point of the curve of one section.")
          .key("r/R", &BladeEditKeys::radius_ratio, {.text = "Of the section.", .presence = required})
          .key("point", &BladeEditKeys::point,
               {.text = "Number of the control point, from 1 at the trailing edge along the back.",
                .range = Range::at_least(1),
                .presence = required})
          .key("move_x", &BladeEditKeys::move_x, {.text = "By how much, along the shaft.", .unit = "length"})
          .key("move_y", &BladeEditKeys::move_y,
               {.text = "By how much in y, on the point's cylinder about the shaft: z follows.", .unit = "length"})
          .key("smooth", &BladeEditKeys::smooth,
               {.text = "To where the third derivative does not jump any more at the knot in the middle of the point's "
                        "support."})
          .check(check_edit);
  return declared;
}

template <>
const Schema<PropellerKeys>& schema<PropellerKeys>() {
  static const auto declared = with_common_keys(
      Schema<PropellerKeys>(
          "propeller",
          "A screw, blades and hub as one closed solid: of a systematic series, by a table of its own, "
          "or by the points of its sections. X points forward along the shaft, the first blade along "
          "Z. geometry/propeller/README.md explains it.")
          .choice("series", &PropellerKeys::series,
                  {{"kaplan", BladeSource::kaplan}, {"b_troost", BladeSource::b_troost}},
                  {.text = "The ducted Ka series, or Wageningen B."})
          .key("table", &PropellerKeys::table, {.text = "The blade by columns against r/R."})
          .key("table_file", &PropellerKeys::table_file,
               {.text = "The same as a file: a line of the columns' names, and lines of numbers."})
          .key("section", &PropellerKeys::sections, {.text = "The blade by the points of its sections, root to tip."})
          .choice("thickness_form", &PropellerKeys::thickness_form,
                  {{"naca66mod", ThicknessForm::naca_66_mod},
                   {"naca16", ThicknessForm::naca_16},
                   {"naca4", ThicknessForm::naca_4_digit}},
                  {.text = "Of the sections of a table."})
          .choice("mean_line", &PropellerKeys::mean_line,
                  {{"a=0.8", MeanLine::naca_a08}, {"a=1.0", MeanLine::naca_a10}, {"parabola", MeanLine::parabola}},
                  {.text = "Of the sections of a table."})
          .key("points_a_side", &PropellerKeys::points_a_side,
               {.text = "Of the sections of a table: points on the back, and as many on the face.",
                .range = Range::between(5, 500)})
          .key("diameter", &PropellerKeys::diameter,
               {.text = "Of the screw.", .unit = "length", .range = Range::above(0), .presence = required})
          .key("blades", &PropellerKeys::blades,
               {.text = "Their number; of a series 3 to 7.", .range = Range::between(1, 20), .presence = required})
          .key("area_ratio", &PropellerKeys::area_ratio,
               {.text = "Of a series: expanded area of the blades over the area of the disc, AE/A0.",
                .range = Range::above(0)})
          .key("pitch_ratio", &PropellerKeys::pitch_ratio,
               {.text = "Pitch over diameter: one number, or rows [r/R, P/D] (between them the cubic that keeps rising "
                        "rows rising). Not where a table has a column for it."})
          .key("rake", &PropellerKeys::rake,
               {.text = "Aft: the generator line's angle in degrees, or rows [r/R, length]."})
          .key("skew", &PropellerKeys::skew,
               {.text =
                    "Against the rotation, in addition to a series' own: degrees at the tip, growing with the square "
                    "of the distance from the hub, or rows [r/R, degrees]."})
          .key("reduced_root_pitch", &PropellerKeys::has_reduced_root_pitch,
               {.text = "The pitch falls off towards the root as on the four-bladed screws of the B series."})
          .key("hub_ratio", &PropellerKeys::hub_ratio,
               {.text = "Radius of the round hub over that of the screw; 0: no hub, blades closed at their first "
                        "section.",
                .range = Range::between(0, 0.6)})
          .key("hub_ends", &PropellerKeys::hub_ends,
               {.text = "X of the hub's after and forward end; absent: a quarter of its radius beyond the blades.",
                .unit = "length"})
          .key("hub_profile", &PropellerKeys::hub_profile,
               {.text =
                    "Instead of hub_ratio and hub_ends: curves from end to end of the hub with x along the shaft and "
                    "y the distance from it. The blades may stand on any part along which x rises. A profile that ends "
                    "off the shaft is closed by a plane."})
          .choice("hand", &PropellerKeys::hand, {{"right", Hand::right}, {"left", Hand::left}},
                  {.text = "Seen from astern, a right-handed screw turns clockwise when the ship goes ahead."})
          .choice("uniformisation", &PropellerKeys::uniformisation,
                  {{"averaged", BladeUniformisation::averaged},
                   {"merge", BladeUniformisation::merge},
                   {"insert_and_remove", BladeUniformisation::insert_and_remove}},
                  {.text = "How the sections come to the same knots. averaged: by one set of parameters, the mean of "
                           "their own. The others leave each section its own parameters: merge gives all of them all "
                           "knots, insert_and_remove even ones and what cannot be removed."})
          .key("inserted_knots", &PropellerKeys::inserted_knots,
               {.text = "uniformisation = \"insert_and_remove\": number of even knots.", .range = Range::at_least(1)})
          .key("removal_tolerance", &PropellerKeys::removal_tolerance,
               {.text =
                    "uniformisation = \"insert_and_remove\": by how much it may move any point of a section; 1e-4 of "
                    "the diameter if absent.",
                .unit = "length",
                .range = Range::at_least(0)})
          .key("edit", &PropellerKeys::edits,
               {.text = "Changes of control points by hand, one after the other, before the sections' knots are made "
                        "the same."})
          .check(check_propeller));
  return declared;
}

}  // namespace isorim::io
