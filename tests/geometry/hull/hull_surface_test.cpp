#include "geometry/hull/hull_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/geometry/hull/wigley.h"

namespace isorim::geometry {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The largest distance of a point of the sections from the nearest band.
double largest_distance(const std::vector<HullSection>& sections, const std::vector<NurbsSurface<3>>& bands) {
  double largest = 0.0;
  for (const HullSection& section : sections) {
    for (Eigen::Index i = 0; i < section.points.cols(); ++i) {
      double nearest = std::numeric_limits<double>::max();
      for (const NurbsSurface<3>& band : bands)
        nearest = std::min(nearest, closest_point<3>(band, section.points.col(i)).distance);
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

/// A full form: flat of bottom, bilge, wall side, parallel middle body; the lower waterlines end before the stern.
OffsetTable full_form() {
  OffsetTable table;
  table.name = "full";
  table.length = 8.0;
  table.beam = 2.0;
  table.draught = 1.0;
  table.has_tangent_bottom = true;
  table.stations = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};
  table.station_names = {"0", "1", "2", "3", "4", "5", "6", "7", "8"};
  table.waterlines = {0.25, 0.5, 0.75, 1.0, 1.25};
  const std::vector<double> fullness{0.35, 0.6, 0.85, 1.0, 1.0, 1.0, 0.9, 0.6, 0.0};
  table.half_breadths.resize(5, 9);
  table.keel.resize(2, 9);
  for (Eigen::Index i = 0; i < 9; ++i) {
    const double f = fullness[static_cast<std::size_t>(i)];
    const std::vector<double> rise{0.85, 0.95, 1.0, 1.0, 1.0};
    for (Eigen::Index j = 0; j < 5; ++j) table.half_breadths(j, i) = f * rise[static_cast<std::size_t>(j)];
    table.keel.col(i) << 0.6 * f, 0.0;
  }
  return table;
}

TEST(HullSurface, MeetsEveryOffset) {
  for (const SectionParameters parameters : {SectionParameters::heights, SectionParameters::chord_lengths}) {
    const std::vector<HullSection> sections = hull_sections(full_form());
    EXPECT_LT(largest_distance(sections, hull_surface(sections, {parameters})), 1e-14);
  }
}

TEST(HullSurface, ReproducesWigleysHull) {
  const OffsetTable table = wigley_table(11, 6);
  const std::vector<NurbsSurface<3>> bands = hull_surface(hull_sections(table));
  ASSERT_EQ(bands.size(), 1u);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(-5.0, 5.0);
  std::uniform_real_distribution<double> v(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const Point2 uv(x(random), v(random));
    const Point3 point = evaluate(bands.front(), uv);
    const double z = point.z() / 0.625 - 1.0;
    EXPECT_NEAR(point.x(), uv.x(), 1e-14);
    EXPECT_NEAR(point.y(), 0.5 * (1.0 - std::pow(point.x() / 5.0, 2)) * (1.0 - z * z), 1e-14);
  }
}

TEST(HullSurface, KeepsFlatPartsFlat) {
  const std::vector<HullSection> sections = hull_sections(full_form());
  const NurbsSurface<3> surface = hull_surface(sections).front();
  for (double u = 3.0; u <= 5.0; u += 0.0625) {
    // The middle body is parallel: the same section everywhere, level at the flat of bottom, upright at the side.
    for (double v = 0.0; v <= 1.0; v += 0.0625)
      EXPECT_NEAR(evaluate(surface, Point2(u, v)).y(), evaluate(surface, Point2(4.0, v)).y(), 1e-15);
    const SurfaceJet<3> bottom = evaluate_jet(surface, Point2(u, 0.0));
    EXPECT_DOUBLE_EQ(bottom.point.y(), 0.6);
    EXPECT_NEAR(bottom.dv.z(), 0.0, 1e-14);
    EXPECT_GT(bottom.dv.y(), 0.1);
  }
  int on_side = 0;
  for (double v = 0.0; v <= 1.0; v += 0.03125) {
    const Point3 point = evaluate(surface, Point2(4.5, v));
    if (point.z() < 0.75) continue;
    EXPECT_DOUBLE_EQ(point.y(), 1.0);
    ++on_side;
  }
  EXPECT_GT(on_side, 5);
}

TEST(HullSurface, StaysOnItsSideNextToItsEnds) {
  // A hollow run: the waterlines leave the end so slowly that a cubic through the offsets would cross over.
  OffsetTable table = wigley_table(11, 6);
  for (Eigen::Index j = 1; j < 6; ++j) {
    table.half_breadths(j, 1) = 0.002;
    table.half_breadths(j, 2) *= 0.6;
  }
  const std::vector<HullSection> sections = hull_sections(table);
  const NurbsSurface<3> surface = hull_surface(sections).front();
  const Interval domain = surface.knots_u().domain();
  double lowest = 1.0;
  for (int i = 0; i <= 400; ++i) {
    for (int j = 0; j <= 40; ++j)
      lowest = std::min(lowest, evaluate(surface, Point2(domain.first + domain.length() * i / 400, j / 40.0)).y());
  }
  EXPECT_GE(lowest, 0.0);
  EXPECT_LT(largest_distance(sections, {surface}), 1e-14);
}

TEST(HullSurface, IsCurvatureContinuousWithinABand) {
  const NurbsSurface<3> surface = hull_surface(hull_sections(full_form())).front();
  for (const Direction direction : {Direction::u, Direction::v}) {
    const KnotVector& knots = surface.knots(direction);
    EXPECT_EQ(knots.degree(), 3);
    const std::vector<double> breaks = knots.breakpoints();
    for (std::size_t k = 1; k + 1 < breaks.size(); ++k) EXPECT_EQ(knots.multiplicity(breaks[k]), 1);
  }
}

/// Wigley's hull with a chine put on it and everything above pulled in.
OffsetTable chined_form() {
  OffsetTable table = wigley_table(9, 7);
  KnuckleLine chine{"chine", Points<2>(2, 9)};
  for (Eigen::Index i = 0; i < 9; ++i) {
    const double x = table.stations[static_cast<std::size_t>(i)] / 5.0;
    const double height = 0.33 + 0.02 * x;
    chine.places.col(i) << 0.45 * (1.0 - x * x), height;
    for (Eigen::Index j = 0; j < 7; ++j) {
      if (table.waterlines[static_cast<std::size_t>(j)] > height) table.half_breadths(j, i) = 0.44 * (1.0 - x * x);
    }
  }
  table.knuckles = {chine};
  return table;
}

TEST(HullSurface, BandsMeetExactlyAlongAKnuckle) {
  const std::vector<HullSection> sections = hull_sections(chined_form());
  const std::vector<NurbsSurface<3>> bands = hull_surface(sections);
  ASSERT_EQ(bands.size(), 2u);
  EXPECT_EQ(bands[0].knots_u(), bands[1].knots_u());
  const Eigen::Index width = bands[0].count_u();
  EXPECT_EQ(bands[0].homogeneous().rightCols(width), bands[1].homogeneous().leftCols(width));
  EXPECT_LT(largest_distance(sections, bands), 1e-14);
  // It is an edge.
  const Vector3 below = evaluate_jet(bands[0], Point2(0.5, 1.0)).dv.normalized();
  const Vector3 above = evaluate_jet(bands[1], Point2(0.5, 0.0)).dv.normalized();
  EXPECT_GT((below - above).norm(), 0.3);
}

TEST(HullSurface, TakesSectionsThatStartWhereTheKeelRises) {
  OffsetTable table = wigley_table(13, 9);
  table.keel = Points<2>::Constant(2, 13, none);
  // The after stations begin at a keel that rises; the lower waterlines do not reach them.
  for (Eigen::Index i = 1; i <= 3; ++i) {
    const double height = 0.04 * static_cast<double>(4 - i) + 0.013;
    table.keel.col(i) << 0.0, height;
    for (Eigen::Index j = 0; j < 9; ++j) {
      const double z = table.waterlines[static_cast<std::size_t>(j)];
      if (z <= height) {
        table.half_breadths(j, i) = none;
      } else {
        const double t = (z - height) / (0.625 - height) - 1.0;
        const double x = table.stations[static_cast<std::size_t>(i)] / 5.0;
        table.half_breadths(j, i) = 0.5 * (1.0 - x * x) * (1.0 - t * t);
      }
    }
  }
  const std::vector<HullSection> sections = hull_sections(table);
  EXPECT_EQ(sections[1].points.cols(), 8);
  const std::vector<NurbsSurface<3>> bands = hull_surface(sections);
  EXPECT_LT(largest_distance(sections, bands), 1e-13);
}

TEST(HullSurface, EndsOnContours) {
  OffsetTable table = wigley_table(11, 6);
  // The same hull, its last station replaced by a raked stem.
  table.stations.pop_back();
  table.station_names.pop_back();
  table.half_breadths = table.half_breadths.leftCols(10).eval();
  table.stem.resize(2, 6);
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double z = table.waterlines[static_cast<std::size_t>(j)];
    table.stem.col(j) << 4.9 + 0.4 * z, z;
  }
  const std::vector<HullSection> sections = hull_sections(table);
  EXPECT_TRUE(sections.back().is_contour);
  const NurbsSurface<3> surface = hull_surface(sections).front();
  EXPECT_LT(largest_distance(sections, {surface}), 1e-14);
  const double end = surface.knots_u().domain().last;
  for (double v = 0.0; v <= 1.0; v += 0.125) {
    const Point3 point = evaluate(surface, Point2(end, v));
    EXPECT_EQ(point.y(), 0.0);
    EXPECT_NEAR(point.x(), 4.9 + 0.4 * point.z(), 1e-14);
  }
}

void expect_refused(const OffsetTable& table, const std::string& fragment) {
  try {
    hull_surface(hull_sections(table));
    ADD_FAILURE() << "not refused: " << fragment;
  } catch (const GeometryError& error) {
    EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos) << error.what();
  }
}

TEST(HullSurface, OfAScaledTableIsTheScaledSurface) {
  const Vector3 factors(2.0, 0.5, 4.0);
  const OffsetTable table = chined_form();
  const OffsetTable larger = scaled(table, factors);
  EXPECT_EQ(larger.length, 20.0);
  EXPECT_EQ(larger.beam, 0.5);
  EXPECT_EQ(larger.draught, 2.5);
  EXPECT_EQ(larger.after_perpendicular, -10.0);
  const HullSurfaceOptions heights{SectionParameters::heights};
  const std::vector<NurbsSurface<3>> before = hull_surface(hull_sections(table), heights);
  const std::vector<NurbsSurface<3>> after = hull_surface(hull_sections(larger), heights);
  for (std::size_t band = 0; band < 2; ++band) {
    for (double u = -5.0; u <= 5.0; u += 0.7) {
      const Point3 expected = factors.cwiseProduct(evaluate(before[band], Point2(u, 0.4)));
      EXPECT_LT((evaluate(after[band], Point2(2.0 * u, 0.4)) - expected).norm(), 1e-13);
    }
  }
}

TEST(HullSurface, RefusesTablesThatContradictThemselves) {
  const OffsetTable sound = chined_form();
  OffsetTable table = sound;
  table.draught = 0.0;
  expect_refused(table, "the draught is 0; expected a positive number");
  table = sound;
  table.stations[4] = table.stations[3];
  expect_refused(table, "station 5 lies at");
  table = sound;
  table.waterlines.pop_back();
  expect_refused(table, "7 x 9 half-breadths for 6 waterlines and 9 stations");
  table = sound;
  table.half_breadths(2, 3) = -0.1;
  expect_refused(table, "station 3, height");
  table = sound;
  table.half_breadths.col(4).setConstant(none);
  table.half_breadths(0, 4) = 0.1;
  expect_refused(table, "station 4: knuckle \"chine\"");
  table = sound;
  table.knuckles[0].places(1, 2) = table.waterlines[3];
  expect_refused(table, "leave that half-breadth out");
  table = wigley_table(9, 7);
  table.half_breadths(1, 4) = 0.0;
  expect_refused(table, "station 4 has no thickness between the heights 0 and");
  table = wigley_table(9, 7);
  table.stem.resize(2, 2);
  table.stem << 5.0, 5.1, 0.0, 0.6;
  expect_refused(table, "point 1 of the stem lies at x = 5; expected it ahead of all stations");
}

}  // namespace
}  // namespace isorim::geometry
