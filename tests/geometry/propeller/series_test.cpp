#include "geometry/propeller/series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal;
using ::testing::SizeIs;

SeriesBlade reference_blade(BladeSeries series) {
  SeriesBlade blade;
  blade.series = series;
  blade.diameter = 500.0;
  blade.blades = 4;
  blade.area_ratio = 0.6;
  blade.pitch_ratio = RadialLaw(0.9);
  return blade;
}

struct ReferencePoint {
  double radius_ratio;
  Eigen::Index index;
  Point2 expanded;
  Point3 space;
};

std::vector<ReferencePoint> reference_points() {
  std::ifstream file(ISORIM_SOURCE_DIR "/tests/geometry/propeller/kaplan_reference_profiles.csv");
  std::string line;
  std::getline(file, line);
  std::vector<ReferencePoint> points;
  while (std::getline(file, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream row(line);
    ReferencePoint p;
    row >> p.radius_ratio >> p.index >> p.expanded[0] >> p.expanded[1] >> p.space[0] >> p.space[1] >> p.space[2];
    points.push_back(p);
  }
  return points;
}

TEST(KaplanSeries, HasTheReferenceProfiles) {
  const std::vector<BladeSection> sections = series_sections(reference_blade(BladeSeries::kaplan));
  const std::vector<ReferencePoint> reference = reference_points();
  ASSERT_THAT(reference, SizeIs(225));
  ASSERT_THAT(sections, SizeIs(9));
  for (const ReferencePoint& p : reference) {
    const auto k = static_cast<std::size_t>(std::lround(10.0 * p.radius_ratio)) - 2;
    EXPECT_LE((sections[k].outline.col(p.index) - p.expanded).norm(), 2e-9);
    EXPECT_LE((outline_in_space(sections[k]).col(p.index) - p.space).norm(), 2e-9);
  }
}

TEST(KaplanSeries, ClosesItsProfilesAtTheTrailingEdge) {
  for (const BladeSection& section : series_sections(reference_blade(BladeSeries::kaplan))) {
    const Eigen::Index last = section.outline.cols() - 1;
    EXPECT_EQ(section.outline.col(0), section.outline.col(last));
    EXPECT_EQ(section.outline(0, section.leading_edge_point), section.leading_edge);
    EXPECT_NEAR(section.outline(0, 0), section.leading_edge - section.chord, 1e-13);
  }
}

// The chord times Z integrated over the radius, outside the hub of 1/6 R, over the disc.
TEST(KaplanSeries, HasTheAreaRatioAskedFor) {
  const std::vector<BladeSection> sections = series_sections(reference_blade(BladeSeries::kaplan));
  std::vector<double> radii;
  std::vector<double> chords;
  for (const BladeSection& section : sections) {
    radii.push_back(section.station.radius / 250.0);
    chords.push_back(section.chord);
  }
  const RadialLaw chord("chord", radii, chords);
  double area = 0.0;
  const int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const double r = 1.0 / 6.0 + (i + 0.5) * (5.0 / 6.0) / steps;
    area += chord(r) * 250.0 * (5.0 / 6.0) / steps;
  }
  EXPECT_NEAR(4.0 * area / (3.14159265358979 * 250.0 * 250.0) / 0.6, 0.998, 1e-3);
}

TEST(WageningenSeries, HasTheReferenceOutline) {
  const std::vector<BladeSection> sections = series_sections(reference_blade(BladeSeries::wageningen_b));
  const std::array<double, 8> chord{124.65, 141.15, 153.75, 161.4, 164.025, 160.8, 147.75, 118.65};
  const std::array<double, 8> thickness{18.3, 16.2, 14.1, 12.0, 9.9, 7.8, 5.7, 3.6};
  const std::array<double, 8> leading{76.90905, 86.52495, 92.40375, 94.5804, 92.018025, 84.2592, 68.40825, 41.64615};
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(sections[k].chord, chord[k], 1e-12);
    EXPECT_NEAR(sections[k].max_thickness, thickness[k], 1e-12);
    EXPECT_NEAR(sections[k].leading_edge, leading[k], 1e-12);
    EXPECT_EQ(sections[k].outline.cols(), 39);
    EXPECT_EQ(sections[k].outline.col(0), sections[k].outline.col(38));
  }
}

TEST(WageningenSeries, ReadsItsTables) {
  const BladeSection root = series_sections(reference_blade(BladeSeries::wageningen_b)).front();
  // r / R = 0.2, P = -0.7: V1 = 0.1570 and the corrected V2 = 0.4535, on the back the fifth point from the edge.
  const double x = 76.90905 - 0.35 * 124.65 - 0.7 * 0.65 * 124.65;
  EXPECT_NEAR(root.outline(0, 4), x, 1e-12);
  EXPECT_NEAR(root.outline(1, 4), (0.1570 + 0.4535) * 18.3, 1e-12);
  EXPECT_NEAR(root.outline(0, 34), x, 1e-12);
  EXPECT_NEAR(root.outline(1, 34), 0.1570 * 18.3, 1e-12);
  // The leading edge, where back and face meet.
  EXPECT_NEAR(root.outline(1, root.leading_edge_point), 0.3560 * 18.3, 1e-12);
}

TEST(WageningenSeries, EndsInARoundedTip) {
  const std::vector<BladeSection> sections = series_sections(reference_blade(BladeSeries::wageningen_b));
  ASSERT_THAT(sections, SizeIs(11));
  const BladeSection& tip = sections.back();
  EXPECT_EQ(tip.station.radius, 250.0);
  EXPECT_EQ(tip.chord, 0.0);
  // Where the middle of the chord leads to: the cubic through 0.6, 0.7, 0.8 and 0.9 R.
  const auto middle = [&](std::size_t k) { return sections[k].leading_edge - 0.5 * sections[k].chord; };
  const double place = 4.0 * middle(7) - 6.0 * middle(6) + 4.0 * middle(5) - middle(4);
  for (Eigen::Index i = 0; i < tip.outline.cols(); ++i)
    EXPECT_NEAR((tip.outline.col(i) - Point2(place, 0.0)).norm(), 0, 1e-11);
  // Chords as the root of the distance from the tip, and the thickness of the tables but for the tip's rounding.
  const BladeSection& inner = sections[8];
  const BladeSection& outer = sections[9];
  EXPECT_NEAR(inner.station.radius / 250.0, 1.0 - 0.4 / 9.0, 1e-14);
  EXPECT_NEAR(outer.station.radius / 250.0, 1.0 - 0.1 / 9.0, 1e-14);
  EXPECT_NEAR(inner.chord / outer.chord, 2.0, 0.1);
  const auto of_tables = [](double ratio) { return 500.0 * std::lerp(0.0072, 0.0030, (ratio - 0.9) / 0.1); };
  EXPECT_NEAR(inner.max_thickness / of_tables(1.0 - 0.4 / 9.0), 0.99, 0.005);
  EXPECT_NEAR(outer.max_thickness / of_tables(1.0 - 0.1 / 9.0), 0.88, 0.005);
}

TEST(WageningenSeries, ThreeBladesHaveTheirOwnOutline) {
  SeriesBlade blade = reference_blade(BladeSeries::wageningen_b);
  blade.blades = 3;
  const std::vector<BladeSection> sections = series_sections(blade);
  EXPECT_NEAR(sections[6].chord, 2.127 * 500.0 * 0.6 / 3.0, 1e-12);
  EXPECT_NEAR(sections[6].leading_edge, 0.481 * sections[6].chord, 1e-12);
  EXPECT_NEAR(sections[6].max_thickness, 500.0 * (0.0154 - 3.0 * 0.001), 1e-12);
}

TEST(WageningenSeries, FourBladesMayHaveReducedRootPitch) {
  SeriesBlade blade = reference_blade(BladeSeries::wageningen_b);
  blade.has_reduced_root_pitch = true;
  const std::vector<BladeSection> sections = series_sections(blade);
  EXPECT_NEAR(sections[0].station.pitch, 0.822 * 450.0, 1e-12);
  EXPECT_NEAR(sections[5].station.pitch, 450.0, 1e-12);
}

TEST(SeriesSections, CarryPitchRakeAndSkew) {
  SeriesBlade blade = reference_blade(BladeSeries::kaplan);
  blade.pitch_ratio = RadialLaw("pitch ratio", {0.2, 1.0}, {0.7, 1.1});
  blade.rake = RadialLaw("rake", {0.0, 1.0}, {0.0, 25.0});
  blade.skew = RadialLaw("skew", {0.2, 1.0}, {0.0, 0.4});
  const BladeSection middle = series_sections(blade)[4];
  EXPECT_NEAR(middle.station.pitch, 0.9 * 500.0, 1e-12);
  EXPECT_NEAR(middle.station.rake, 15.0, 1e-13);
  EXPECT_NEAR(middle.station.skew, 0.2, 1e-15);
}

TEST(SeriesSections, RefuseWhatTheSeriesDoesNotKnow) {
  const auto refused = [](auto change) {
    SeriesBlade blade = reference_blade(BladeSeries::kaplan);
    change(blade);
    return refusal([&] { series_sections(blade); });
  };
  EXPECT_THAT(refused([](SeriesBlade& b) { b.blades = 2; }), HasSubstr("2 blades; the series has tables for 3 to 7"));
  EXPECT_THAT(refused([](SeriesBlade& b) { b.diameter = 0.0; }), HasSubstr("diameter is 0"));
  EXPECT_THAT(refused([](SeriesBlade& b) { b.area_ratio = std::numeric_limits<double>::infinity(); }),
              HasSubstr("area ratio is inf"));
  EXPECT_THAT(refused([](SeriesBlade& b) { b.has_reduced_root_pitch = true; }), HasSubstr("reduced root pitch"));
}

TEST(SeriesSections, SayWhatWasNeverTested) {
  EXPECT_THAT(outside_tested_range(reference_blade(BladeSeries::kaplan)), IsEmpty());
  SeriesBlade wide = reference_blade(BladeSeries::wageningen_b);
  wide.area_ratio = 1.2;
  wide.pitch_ratio = RadialLaw(1.6);
  const std::vector<std::string> notes = outside_tested_range(wide);
  ASSERT_THAT(notes, SizeIs(2));
  EXPECT_THAT(notes[0], HasSubstr("area ratio from 0.3 to 1.05; here it is 1.2"));
  EXPECT_THAT(notes[1], HasSubstr("pitch ratio at 0.7 R from 0.5 to 1.4; here it is 1.6"));
}

}  // namespace
}  // namespace isorim::geometry
