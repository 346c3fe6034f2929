#include "geometry/propeller/blade_areas.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/propeller/series.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

/// Measures that are cubics of the radius at most, so that splines across the sections meet them.
struct Laws {
  static double leading(double r) { return 0.2 + 0.1 * r - 0.15 * r * r; }
  static double trailing(double r) { return -0.25 + 0.05 * r; }
  static double pitch(double r) { return 1.1 + 0.3 * r; }
  static double skew(double r) { return 0.4 * r; }
};

/// Thin sections, not a point at the tip.
std::vector<BladeSection> lawful_sections() {
  std::vector<BladeSection> sections;
  for (int k = 0; k <= 8; ++k) {
    const double r = 0.2 + 0.1 * k;
    BladeSection section;
    section.station = {r, Laws::pitch(r), Laws::skew(r), 0.1 * r};
    section.leading_edge = Laws::leading(r);
    section.chord = Laws::leading(r) - Laws::trailing(r);
    section.max_thickness = 0.01;
    section.outline.resize(2, 5);
    section.outline << Laws::trailing(r), 0.0, Laws::leading(r), 0.0, Laws::trailing(r), 0.0, 0.01, 0.0, -0.01, 0.0;
    section.leading_edge_point = 2;
    sections.push_back(section);
  }
  return sections;
}

/// What a closed polygon encloses whose points run up the leading edge and down the trailing edge.
double enclosed(const std::function<Point2(double r, double x)>& place, double first) {
  constexpr int steps = 4000;
  std::vector<Point2> points;
  const auto radius = [&](int i) { return std::lerp(first, 1.0, static_cast<double>(i) / steps); };
  for (int i = 0; i <= steps; ++i) points.push_back(place(radius(i), Laws::leading(radius(i))));
  // Across the tip and the root along the radius.
  for (int i = 1; i < steps; ++i)
    points.push_back(place(1.0, std::lerp(Laws::leading(1.0), Laws::trailing(1.0), static_cast<double>(i) / steps)));
  for (int i = steps; i >= 0; --i) points.push_back(place(radius(i), Laws::trailing(radius(i))));
  for (int i = 1; i < steps; ++i)
    points.push_back(
        place(first, std::lerp(Laws::trailing(first), Laws::leading(first), static_cast<double>(i) / steps)));
  double doubled = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2& a = points[i];
    const Point2& b = points[(i + 1) % points.size()];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(0.5 * doubled);
}

TEST(BladeAreas, AreThoseOfTheOutlinesDrawnByTheirDefinitions) {
  const BladeAreas areas = blade_areas(lawful_sections(), 0.25);
  EXPECT_NEAR(areas.expanded, enclosed([](double r, double x) { return Point2(x, r); }, 0.25), 1e-7);
  const auto projected = [](double r, double x) {
    const Point3 point = to_space(BladeStation{r, Laws::pitch(r), Laws::skew(r), 0.0}, Point2(x, 0.0));
    return Point2(point.y(), point.z());
  };
  EXPECT_NEAR(areas.projected, enclosed(projected, 0.25), 1e-7);
  // Along the arc of the helix's radius of curvature that crosses the generator line at r.
  const auto developed = [](double r, double x) {
    const double angle = BladeStation{r, Laws::pitch(r), 0.0, 0.0}.pitch_angle();
    const double curvature_radius = r / std::pow(std::cos(angle), 2);
    const double along = x - Laws::skew(r) * r / std::cos(angle);
    return Point2(curvature_radius * std::sin(along / curvature_radius),
                  r - curvature_radius * (1.0 - std::cos(along / curvature_radius)));
  };
  EXPECT_NEAR(areas.developed, enclosed(developed, 0.25), 1e-7);
}

TEST(BladeAreas, AreOneAndTheSameWithoutPitch) {
  std::vector<BladeSection> sections = lawful_sections();
  for (BladeSection& section : sections) section.station.pitch = 0.0;
  const BladeAreas areas = blade_areas(sections, 0.1);
  EXPECT_NEAR(areas.projected, areas.expanded, 1e-9);
  EXPECT_NEAR(areas.developed, areas.expanded, 1e-9);
}

SeriesBlade series_blade(BladeSeries series, int blades) {
  SeriesBlade blade;
  blade.series = series;
  blade.diameter = 500.0;
  blade.blades = blades;
  blade.area_ratio = 0.6;
  blade.pitch_ratio = RadialLaw(0.9);
  return blade;
}

/// Of what was asked for, outside a hub.
double recovered(const SeriesBlade& blade, double hub_ratio) {
  const BladeAreas areas = blade_areas(series_sections(blade), 0.5 * hub_ratio * blade.diameter);
  return areas.scaled(blade.blades / disc_area(blade.diameter)).expanded / blade.area_ratio;
}

// The tables give chords that are rounded to three or four digits; the series' hub has a sixth of the diameter.
TEST(BladeAreas, OfTheSeriesComeBackOutsideTheirHub) {
  EXPECT_NEAR(recovered(series_blade(BladeSeries::kaplan, 4), 1.0 / 6.0), 0.9980, 1e-4);
  EXPECT_NEAR(recovered(series_blade(BladeSeries::wageningen_b, 4), 1.0 / 6.0), 1.0011, 2e-4);
  EXPECT_NEAR(recovered(series_blade(BladeSeries::wageningen_b, 3), 1.0 / 6.0), 1.0069, 3e-4);
  // Of the area, 2 to 3 % lie between there and a hub of a fifth.
  EXPECT_NEAR(recovered(series_blade(BladeSeries::kaplan, 4), 0.2), 0.970, 1e-2);
}

// To the last bit the splines of the laws meet a first section at the hub's radius or lie beside it.
TEST(BladeAreas, OfABladeThatBeginsOnTheHubAreComputed) {
  for (const double area : {0.55, 0.6, 0.65, 0.7, 0.75}) {
    for (const double pitch : {0.5, 0.6, 0.9, 1.2, 1.8}) {
      SeriesBlade blade = series_blade(BladeSeries::kaplan, 4);
      blade.area_ratio = area;
      blade.pitch_ratio = RadialLaw(pitch);
      EXPECT_NEAR(recovered(blade, 0.2), 0.9706, 1e-4);
    }
  }
}

// Taylor's empirical relation between projected and expanded area, Ap / Ae = 1.067 - 0.229 P / D.
TEST(BladeAreas, ProjectedAreaFollowsTaylorsRelation) {
  for (const double pitch : {0.7, 0.9, 1.1}) {
    SeriesBlade blade = series_blade(BladeSeries::wageningen_b, 4);
    blade.pitch_ratio = RadialLaw(pitch);
    const BladeAreas areas = blade_areas(series_sections(blade), 0.18 * 250.0);
    EXPECT_NEAR(areas.projected / areas.expanded, 1.067 - 0.229 * pitch, 0.02);
  }
}

TEST(BladeAreas, RefusesAHubThatCoversTheBlade) {
  EXPECT_THAT(refusal([] { blade_areas(lawful_sections(), 1.0); }), HasSubstr("a hub of radius 1 covers the blade"));
}

}  // namespace
}  // namespace isorim::geometry
