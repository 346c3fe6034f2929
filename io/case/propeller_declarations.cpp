#include "io/case/shape_schema.h"

/// The declarations of propellers.
namespace isorim::io {
namespace {

void check_law(const NumberArray& law, Complaints& complaints) {
  if (law.values.size() <= 1 || (law.rows > 1 && law.columns == 2)) return;
  complaints.add(law.where, "found a list; expected one number, or a list of rows [r/R, value], at least two");
}

void check_propeller(const PropellerKeys& keys, const KeyPlace& where, Complaints& complaints) {
  if (keys.removal_tolerance && keys.uniformisation != BladeUniformisation::insert_and_remove)
    complaints.add(where, "found \"removal_tolerance\"; expected uniformisation = \"insert_and_remove\" beside it");
  for (const NumberArray* law : {&keys.pitch_ratio, &keys.rake, &keys.skew}) check_law(*law, complaints);
}

}  // namespace

template <>
const Schema<PropellerKeys>& schema<PropellerKeys>() {
  using geometry::BladeSeries;
  using geometry::Hand;
  static const auto declared =
      with_common_keys(
          Schema<PropellerKeys>("propeller",
                                "A screw of a systematic series, blades and hub as one closed solid. X points forward "
                                "along the shaft, the first blade along Z. geometry/propeller/README.md explains it.")
              .choice("series", &PropellerKeys::series,
                      {{"kaplan", BladeSeries::kaplan}, {"b_troost", BladeSeries::wageningen_b}},
                      {.text = "The ducted Ka series, or Wageningen B.", .presence = required})
              .key("diameter", &PropellerKeys::diameter,
                   {.text = "Of the screw.", .unit = "length", .range = Range::above(0), .presence = required})
              .key("blades", &PropellerKeys::blades,
                   {.text = "Their number.", .range = Range::between(3, 7), .presence = required})
              .key("area_ratio", &PropellerKeys::area_ratio,
                   {.text = "Expanded area of the blades over the area of the disc, AE/A0.",
                    .range = Range::above(0),
                    .presence = required})
              .key("pitch_ratio", &PropellerKeys::pitch_ratio,
                   {.text = "Pitch over diameter: one number, or rows [r/R, P/D] (between them the cubic that keeps "
                            "rising rows rising).",
                    .presence = required})
              .key("rake", &PropellerKeys::rake,
                   {.text = "Aft: the generator line's angle in degrees, or rows [r/R, length]."})
              .key("skew", &PropellerKeys::skew,
                   {.text = "Against the rotation, in addition to the series' own: degrees at the tip, growing with "
                            "the square of the distance from the hub, or rows [r/R, degrees]."})
              .key("reduced_root_pitch", &PropellerKeys::has_reduced_root_pitch,
                   {.text = "The pitch falls off towards the root as on the four-bladed screws of the B series."})
              .key("hub_ratio", &PropellerKeys::hub_ratio,
                   {.text = "Radius of the round hub over that of the screw; 0: no hub, blades closed at r/R = 0.2.",
                    .range = Range::between(0, 0.6)})
              .key("hub_ends", &PropellerKeys::hub_ends,
                   {.text = "X of the hub's after and forward end; absent: a quarter of its radius beyond the blades.",
                    .unit = "length"})
              .choice("hand", &PropellerKeys::hand, {{"right", Hand::right}, {"left", Hand::left}},
                      {.text = "Seen from astern, a right-handed screw turns clockwise when the ship goes ahead."})
              .choice("uniformisation", &PropellerKeys::uniformisation,
                      {{"averaged", BladeUniformisation::averaged},
                       {"merge", BladeUniformisation::merge},
                       {"insert_and_remove", BladeUniformisation::insert_and_remove}},
                      {.text = "How the sections come to the same knots. averaged: by one set of parameters, the mean "
                               "of their own. The others leave each section its own parameters: merge gives all of "
                               "them all knots, insert_and_remove even ones and what cannot be removed."})
              .key("inserted_knots", &PropellerKeys::inserted_knots,
                   {.text = "uniformisation = \"insert_and_remove\": number of even knots.",
                    .range = Range::at_least(1)})
              .key("removal_tolerance", &PropellerKeys::removal_tolerance,
                   {.text = "uniformisation = \"insert_and_remove\": by how much it may move any point of a section; "
                            "1e-4 of the diameter if absent.",
                    .unit = "length",
                    .range = Range::at_least(0)}))
          .check(check_propeller);
  return declared;
}

}  // namespace isorim::io
