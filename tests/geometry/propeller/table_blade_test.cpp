#include "geometry/propeller/table_blade.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/propeller/blade_areas.h"
#include "geometry/propeller/propeller.h"
#include "geometry/propeller/series.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

/// A blade of one metre whose chord is that of an ellipse near the tip.
TableBlade elliptic(double tip_chord = 0.0) {
  TableBlade blade;
  for (const double r : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0}) {
    BladeTableRow row;
    row.radius_ratio = r;
    row.chord = r == 1.0 ? tip_chord : 0.3 * std::sqrt(1.0 - r * r) + tip_chord;
    row.pitch = 1.0 - 0.2 * (r - 0.7);
    row.skew = 0.3 * r * r;
    row.rake = 0.05 * r;
    row.max_thickness = 0.045 - 0.04 * r;
    row.max_camber = 0.02 * row.chord;
    blade.rows.push_back(row);
  }
  return blade;
}

TEST(TableSections, HaveTheMeasuresOfTheirRows) {
  const TableBlade blade = elliptic(0.02);
  const std::vector<BladeSection> sections = table_sections(blade);
  ASSERT_EQ(sections.size(), blade.rows.size());
  for (std::size_t k = 0; k < sections.size(); ++k) {
    EXPECT_EQ(sections[k].station.radius, 0.5 * blade.rows[k].radius_ratio);
    EXPECT_EQ(sections[k].station.pitch, blade.rows[k].pitch);
    EXPECT_EQ(sections[k].station.skew, blade.rows[k].skew);
    EXPECT_EQ(sections[k].chord, blade.rows[k].chord);
    EXPECT_EQ(sections[k].outline.cols(), 49);
  }
}

// An ellipse r^2 + (c / 0.3)^2 = 1 is a smooth function of the root of the distance from the tip.
TEST(TableSections, EndInARoundTipWithoutChord) {
  const std::vector<BladeSection> sections = table_sections(elliptic());
  ASSERT_EQ(sections.size(), 12u);
  for (const std::size_t k : {9u, 10u}) {
    const double r = 2.0 * sections[k].station.radius;
    EXPECT_NEAR(sections[k].chord, 0.3 * std::sqrt(1.0 - r * r), 2e-5) << r;
    EXPECT_GT(sections[k].max_thickness, 0.0);
  }
  EXPECT_EQ(sections.back().chord, 0.0);
  EXPECT_EQ(sections.back().outline.norm(), 0.0);
  // The area of the ellipse outside the root.
  const double exact = 0.3 * 0.5 * (0.25 * 3.14159265358979 - 0.5 * (0.2 * std::sqrt(0.96) + std::asin(0.2)));
  EXPECT_NEAR(blade_areas(sections, 0.1).expanded, exact, 2e-4 * exact);
}

TEST(TableSections, MakeClosedScrewsWithAndWithoutHub) {
  for (const double tip_chord : {0.0, 0.02}) {
    for (const ThicknessForm form : {ThicknessForm::naca_66_mod, ThicknessForm::naca_16, ThicknessForm::naca_4_digit}) {
      TableBlade blade = elliptic(tip_chord);
      blade.thickness = form;
      Propeller screw;
      screw.sections = table_sections(blade);
      screw.blades = 3;
      // Both require a closed boundary.
      EXPECT_GE(propeller(screw).patches.size(), 9u);
      screw.hub = Hub{0.12};
      EXPECT_GE(propeller(screw).patches.size(), 9u);
    }
  }
}

TEST(TableSections, RefuseTablesThatMakeNoBlade) {
  const auto refused = [](auto change) {
    TableBlade blade = elliptic();
    change(blade.rows);
    return refusal([&] { table_sections(blade); });
  };
  EXPECT_THAT(refused([](auto& rows) { rows.resize(2); }), HasSubstr("2 row(s), at least 3 are needed"));
  EXPECT_THAT(refused([](auto& rows) { rows.pop_back(); }), HasSubstr("the last row has r/R = 0.95; expected the tip"));
  EXPECT_THAT(refused([](auto& rows) { std::swap(rows[2], rows[3]); }), HasSubstr("row 4 (r/R = 0.4): the row before"));
  EXPECT_THAT(refused([](auto& rows) { rows[3].chord = 0.0; }),
              HasSubstr("row 4 (r/R = 0.5): the chord is 0; expected a positive one, or 0 at the tip"));
  EXPECT_THAT(refused([](auto& rows) { rows[3].radius_ratio = 40.0; }), HasSubstr("r/R lies between 0 and 1"));
  EXPECT_THAT(refused([](auto& rows) { rows[0].max_thickness = 0.0; }), HasSubstr("row 1 (r/R = 0.2): the thickness"));
  EXPECT_THAT(refused([](auto& rows) { rows[0].pitch = NAN; }), HasSubstr("found nan; expected numbers"));
}

TEST(PointSection, IsTheSameAsTheSeriesOwn) {
  SeriesBlade series;
  series.diameter = 500.0;
  for (const BladeSection& section : series_sections(series)) {
    const BladeSection again = point_section(section.station, section.outline);
    EXPECT_NEAR(again.chord, section.chord, 1e-12);
    EXPECT_EQ(again.leading_edge, section.leading_edge);
    EXPECT_EQ(again.leading_edge_point, section.leading_edge_point);
    EXPECT_NEAR(again.max_thickness, section.max_thickness, 1e-9);
  }
}

Points<2> small_outline() {
  Points<2> outline(2, 5);
  outline << 0, 1, 2, 1, 0, 0, 0.2, 0, -0.1, 0;
  return outline;
}

std::string refused_points(const Points<2>& points) {
  return refusal([&] { point_section({}, points); });
}

TEST(PointSection, RefusesOutlinesThatAreNone) {
  EXPECT_EQ(point_section({}, small_outline()).leading_edge_point, 2);
  EXPECT_THAT(refused_points(small_outline().leftCols(4)), HasSubstr("4 points, at least 5"));
  EXPECT_THAT(refused_points(small_outline().rowwise().reverse()), HasSubstr("run along the face first"));
  EXPECT_THAT(refused_points(-small_outline()), HasSubstr("the leading edge, where x is largest, is point"));
}

}  // namespace
}  // namespace isorim::geometry
