#include "io/case/hull_keys.h"
#include "io/case/lines_plan_keys.h"
#include "io/case/shape_schema.h"

/// The declarations of hulls.
namespace isorim::io {

using geometry::SectionParameters;

template <>
const Schema<HullScaleKeys>& schema<HullScaleKeys>() {
  static const auto declared =
      Schema<HullScaleKeys>("scale", "The measures that a hull is scaled to. One that is absent follows the length.")
          .key("length", &HullScaleKeys::length,
               {.text = "Between perpendiculars.", .unit = "length", .range = Range::above(0)})
          .key("beam", &HullScaleKeys::beam, {.text = "Moulded.", .unit = "length", .range = Range::above(0)})
          .key("draught", &HullScaleKeys::draught,
               {.text = "Of the design waterline.", .unit = "length", .range = Range::above(0)});
  return declared;
}

template <>
const Schema<HullShiftKeys>& schema<HullShiftKeys>() {
  static const auto declared =
      Schema<HullShiftKeys>("shift",
                            "The curve of sectional areas that a hull is derived to, by moving its sections along the "
                            "ship (Lackenby). What is absent stays as it is.")
          .key("prismatic", &HullShiftKeys::prismatic,
               {.text = "Prismatic coefficient up to the design draught.", .range = Range::between(0.3, 1)})
          .key("lcb", &HullShiftKeys::lcb,
               {.text = "Centre of buoyancy forward of amidships, in per cent of the length between perpendiculars.",
                .range = Range::between(-10, 10)});
  return declared;
}

template <>
const Schema<HullKeys>& schema<HullKeys>() {
  static const auto declared = with_common_keys(
      Schema<HullKeys>("hull",
                       "A ship's hull through a table of offsets, closed by its deck and ends. x points forward, y to "
                       "port, z up. geometry/hull/README.md explains the surface, io/hull/README.md the tables.")
          .key("offsets", &HullKeys::offsets,
               {.text = "A file of offsets (.csv; a relative path begins at the folder of the case file), the name of "
                        "a hull in the library, or \"wigley\", Wigley's hull as the polynomial that it is.",
                .presence = required})
          .key("library", &HullKeys::library,
               {.text = "A file of hulls, as isorim hulls keeps it; a relative path begins at the folder of the case "
                        "file."})
          .key("scale", &HullKeys::scale, {.text = "Scales length, beam and draught."})
          .key("fair", &HullKeys::fair,
               {.text = "Moves half-breadths, after scaling, by at most this, a length, to the fairest table; absent: "
                        "none is moved. Half the last digit of the table's numbers, say.",
                .unit = "length",
                .range = Range::above(0)})
          .key("shift", &HullKeys::shift, {.text = "Moves the sections along the ship."})
          .choice("parameters", &HullKeys::parameters,
                  {{"automatic", SectionParameters::automatic},
                   {"heights", SectionParameters::heights},
                   {"chord_lengths", SectionParameters::chord_lengths}},
                  {.text = "Of the surface along the sections. automatic: heights where no section leans over by more "
                           "than 2 in 1, else chord lengths."}));
  return declared;
}

namespace {

void check_lines(const LinesPlanKeys& keys, const KeyPlace&, Complaints& complaints) {
  const NumberArray& rows = keys.diagonals;
  if (!rows.values.empty() && rows.columns != 2)
    complaints.add(rows.where, "found a list; expected rows of a height and an angle");
  for (std::size_t k = 1; k < rows.values.size(); k += 2) {
    if (rows.columns == 2 && !(rows.values[k] > 0.0 && rows.values[k] < 90.0))
      complaints.add(rows.where, fmt::format("found a diagonal at {} degrees; expected more than 0 and less than 90",
                                             rows.values[k]));
  }
  for (const double y : keys.buttocks)
    if (!(y > 0.0)) complaints.add(keys.where, fmt::format("found a buttock at {}; expected positive ones", y));
}

}  // namespace

template <>
const Schema<LinesPlanKeys>& schema<LinesPlanKeys>() {
  static const auto declared =
      Schema<LinesPlanKeys>("lines_plan",
                            "The lines of a hull in three views, as lines_plan.svg, .pdf and .dxf, and its lines as "
                            "points in lines.csv. Coordinates are those of the hull before a transform.")
          .key("stations", &LinesPlanKeys::stations, {.text = "x of stations; those of the table if absent."})
          .key("waterlines", &LinesPlanKeys::waterlines, {.text = "z of waterlines; those of the table if absent."})
          .key("buttocks", &LinesPlanKeys::buttocks,
               {.text = "y of buttocks; a quarter, a half and three quarters of half the beam if absent."})
          .key("diagonals", &LinesPlanKeys::diagonals,
               {.text = "Rows [z, angle]: planes that meet the centre plane at this height and fall off outwards, in "
                        "degrees below the horizontal; [the design waterline, 45] if absent."})
          .key("width", &LinesPlanKeys::width,
               {.text = "Of the sheet; the scale is the largest of the usual ones that fits.",
                .unit = "mm",
                .range = Range::at_least(200)})
          .check(check_lines);
  return declared;
}

}  // namespace isorim::io
