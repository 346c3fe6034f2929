#include "geometry/hull/sectional_areas.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/hull/hull.h"
#include "tests/geometry/hull/wigley.h"

namespace isorim::geometry {
namespace {

TEST(SectionalAreas, AreExactOnWigleysHull) {
  const std::vector<NurbsSurface<3>> bands{wigley_surface(10.0, 1.0, 0.625)};
  // u runs over [0, 1]; up to the height h the section has B X(x) (z^2 - z^3 / 3T) / T with z = h.
  for (const double height : {0.1, 0.3125, 0.625, 0.9}) {
    const double z = std::min(height, 0.625);
    const double expected = 0.75 * (z * z - z * z * z / (3.0 * 0.625)) / 0.625;
    EXPECT_NEAR(section_area(bands, 0.25, height), expected, 1e-14);
  }
}

TEST(SectionalAreas, OfWigleysHullArePrismaticByTwoThirds) {
  const OffsetTable table = wigley_table(11, 6);
  const SectionalAreas areas = sectional_areas(table);
  EXPECT_NEAR(areas.volume, 4.0 / 9.0 * 6.25, 1e-13);
  EXPECT_NEAR(prismatic_coefficient(areas, table), 2.0 / 3.0, 1e-14);
  EXPECT_NEAR(buoyancy_centre(areas, table), 0.0, 1e-15);
}

TEST(SectionShift, GivesThePrismaticCoefficientAndTheCentreAskedFor) {
  const OffsetTable table = wigley_table(21, 9);
  const OffsetTable moved = shift_sections(table, {0.69, 0.012});
  const SectionalAreas areas = sectional_areas(moved);
  EXPECT_NEAR(prismatic_coefficient(areas, moved), 0.69, 1e-12);
  EXPECT_NEAR(buoyancy_centre(areas, moved), 0.012, 1e-12);
  // Sections are moved, not changed; ends and the largest one stay.
  EXPECT_EQ(moved.half_breadths, table.half_breadths);
  EXPECT_EQ(moved.stations.front(), table.stations.front());
  EXPECT_EQ(moved.stations[10], table.stations[10]);
  EXPECT_EQ(moved.stations.back(), table.stations.back());
}

TEST(SectionShift, AgreesWithLackenbysFirstOrder) {
  // Of half a ship, A = X(s) = 1 - s^2: phi = 2/3, its centroid at 3/8. With p = 0 a change of phi asks for
  // c = d phi / A, A = phi (1 - 2 x) (Lackenby 1950, eq. 5).
  const OffsetTable table = wigley_table(41, 5);
  constexpr double change = 1e-6;
  const OffsetTable moved = shift_sections(table, {2.0 / 3.0 + change, 0.0});
  const double factor = change / (2.0 / 3.0 * (1.0 - 0.75));
  for (std::size_t i = 20; i < 41; ++i) {
    const double s = table.stations[i] / 5.0;
    EXPECT_NEAR(moved.stations[i] - table.stations[i], 5.0 * factor * s * (1.0 - s), 1e-4 * factor);
  }
}

TEST(SectionShift, LeavesTheHullAsItIsIfNothingIsAskedFor) {
  const OffsetTable table = wigley_table(11, 6);
  EXPECT_EQ(shift_sections(table, {prismatic_coefficient(sectional_areas(table), table), 0.0}).stations.size(), 11u);
  const OffsetTable same = shift_sections(table, {2.0 / 3.0, 0.0});
  for (std::size_t i = 0; i < 11; ++i) EXPECT_NEAR(same.stations[i], table.stations[i], 1e-12);
}

TEST(SectionShift, RefusesWhatWouldCrossStations) {
  try {
    shift_sections(wigley_table(21, 9), {0.95, 0.0});
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_NE(std::string(error.what()).find("move stations past one another"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace isorim::geometry
