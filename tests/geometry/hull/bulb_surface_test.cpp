#include "geometry/hull/bulb_surface.h"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/hull/fairness.h"
#include "geometry/hull/hull.h"
#include "geometry/hull/hull_surface.h"
#include "geometry/hull/sectional_areas.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/hull/bulb_hull.h"

namespace isorim::geometry {
namespace {

struct Bulk {
  double volume = 0.0;
  double centroid = 0.0;
};

/// Between the port half and its image: 2 int y (x_u z_v - x_v z_u), by rules that are exact for bicubics.
Bulk bulk_of(const std::vector<NurbsSurface<3>>& bands) {
  constexpr std::array<double, 6> points{-0.932469514203152, -0.6612093864662645, -0.2386191860831969,
                                         0.2386191860831969, 0.6612093864662645,  0.932469514203152};
  constexpr std::array<double, 6> weights{0.1713244923791704, 0.3607615730481386, 0.467913934572691,
                                          0.467913934572691,  0.3607615730481386, 0.1713244923791704};
  Bulk bulk;
  double moment = 0.0;
  for (const NurbsSurface<3>& band : bands) {
    const std::vector<double> us = band.knots_u().breakpoints();
    const std::vector<double> vs = band.knots_v().breakpoints();
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        const double half_u = 0.5 * (us[i + 1] - us[i]);
        const double half_v = 0.5 * (vs[j + 1] - vs[j]);
        for (std::size_t a = 0; a < points.size(); ++a) {
          for (std::size_t b = 0; b < points.size(); ++b) {
            const SurfaceJet<3> jet =
                evaluate_jet(band, Point2(us[i] + half_u * (1.0 + points[a]), vs[j] + half_v * (1.0 + points[b])));
            const double part = 2.0 * half_u * half_v * weights[a] * weights[b] * jet.point.y() *
                                (jet.du.x() * jet.dv.z() - jet.dv.x() * jet.du.z());
            bulk.volume += part;
            moment += part * jet.point.x();
          }
        }
      }
    }
  }
  bulk.centroid = moment / bulk.volume;
  return bulk;
}

std::vector<NurbsSurface<3>> surface_of(const OffsetTable& table) {
  return hull_surface(hull_sections(table));
}

TEST(BulbSurface, MeetsEveryOffsetAndItsContours) {
  const OffsetTable table = bulb_table(1);
  const std::vector<HullSection> sections = hull_sections(table);
  const std::vector<NurbsSurface<3>> bands = hull_surface(sections);
  ASSERT_EQ(bands.size(), 3u);
  EXPECT_LT(largest_offset_distance(sections, bands), 1e-12);
}

TEST(BulbSurface, PartsMeetBitForBit) {
  const std::vector<NurbsSurface<3>> bands = surface_of(bulb_table(1));
  const auto& below = bands[0];
  const auto& bulb = bands[1];
  const auto& above = bands[2];
  EXPECT_EQ(below.knots_u(), above.knots_u());
  EXPECT_EQ(below.knots_v(), bulb.knots_v());
  EXPECT_EQ(below.homogeneous().rightCols(below.count_u()), above.homogeneous().leftCols(above.count_u()));
  for (Eigen::Index k = 0; k < below.count_v(); ++k) {
    EXPECT_EQ(below.homogeneous().col((k + 1) * below.count_u() - 1), bulb.homogeneous().col(k * bulb.count_u()));
    // The nose and the top of the bulb lie in the centre plane.
    EXPECT_EQ(bulb.homogeneous()(1, (k + 1) * bulb.count_u() - 1), 0.0);
  }
  EXPECT_EQ(bulb.homogeneous().row(1).tail(bulb.count_u()).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(above.homogeneous()(1, above.count_u() - 1), 0.0);
  EXPECT_GE(below.homogeneous().row(1).minCoeff(), -1e-12);
}

// Volume and centroid of the formulas by Gauss-Legendre rules of 40, 80 and 160 points on pieces between all kinks,
// roots at the ends substituted away: the same to 13 digits.
TEST(BulbSurface, HasTheVolumeOfTheFormulas) {
  const Bulk bulk = bulk_of(surface_of(bulb_table(1)));
  EXPECT_NEAR(bulk.volume, 7865.4441621691, 2e-5 * 7865.44);
  EXPECT_NEAR(bulk.centroid, 50.485912144973, 2e-6 * 98.0);
}

// Leave the bulb's stations out, and its nose is all there is: a poorer bulb, but a bulb.
TEST(BulbSurface, TakesABulbWithoutStations) {
  OffsetTable table = bulb_table(1);
  Eigen::Index full = 0;
  while (!is_bulb_station(table, full)) ++full;
  table.stations.resize(static_cast<std::size_t>(full));
  table.station_names.resize(static_cast<std::size_t>(full));
  table.half_breadths = table.half_breadths.leftCols(full).eval();
  table.keel = table.keel.leftCols(full).eval();
  table.deck = table.deck.leftCols(full).eval();
  // From the last station's keel to near the notch.
  const int points = 16;
  table.bulb.resize(2, points + 1);
  for (int k = 0; k <= points; ++k) {
    const double angle = 0.75 * (2.0 * k / points - 1.0);
    table.bulb.col(k) << 82.0 + 24.0 * std::cos(angle), 3.0 + (angle < 0.0 ? 3.0 : 2.2) * std::sin(angle);
  }
  EXPECT_NEAR(bulk_of(surface_of(table)).volume, 7865.4441621691, 2e-3 * 7865.44);
  EXPECT_NO_THROW(hull_solid(table));
}

TEST(BulbSurface, ClosesToOneShell) {
  const Boundary<3> hull = hull_solid(bulb_table(1));
  std::vector<std::string> names;
  for (const Patch<3>& patch : hull.patches) names.push_back(patch.name);
  EXPECT_EQ(names, (std::vector<std::string>{"port_1", "port_2", "port_3", "starboard_1", "starboard_2", "starboard_3",
                                             "deck"}));
  const Topology<3> topology = orient(hull).topology;
  EXPECT_TRUE(topology.closed);
  EXPECT_EQ(topology.shells.size(), 1u);
  EXPECT_LT(topology.largest_gap, 1e-12);
}

/// A forecastle's side, 0.3 outside the hull, from a knuckle at z = 7.5 on.
OffsetTable with_knuckle() {
  OffsetTable table = bulb_table(1);
  KnuckleLine line{"side", Points<2>::Constant(2, table.deck.cols(), std::numeric_limits<double>::quiet_NaN())};
  for (Eigen::Index i = 0; i < line.places.cols(); ++i) {
    const double x = table.stations[static_cast<std::size_t>(i)];
    if (!is_bulb_station(table, i)) line.places.col(i) << BulbHull::half_breadth(x, 7.5), 7.5;
  }
  // The deck goes straight up.
  for (Eigen::Index i = 0; i < line.places.cols(); ++i)
    if (!is_bulb_station(table, i)) table.deck(0, i) = line.places(0, i);
  const auto eighth = static_cast<Eigen::Index>(table.waterlines.size()) - 1;
  table.half_breadths.row(eighth).setConstant(std::numeric_limits<double>::quiet_NaN());
  table.knuckles = {line};
  table.stem_knuckles = {static_cast<int>(table.stem.cols()) - 2};
  return table;
}

TEST(BulbSurface, KnucklesAboveTheBulbMakeBands) {
  const OffsetTable table = with_knuckle();
  const std::vector<HullSection> sections = hull_sections(table);
  const std::vector<NurbsSurface<3>> bands = hull_surface(sections);
  ASSERT_EQ(bands.size(), 4u);
  EXPECT_LT(largest_offset_distance(sections, bands), 1e-12);
  EXPECT_EQ(bands[2].homogeneous().rightCols(bands[2].count_u()), bands[3].homogeneous().leftCols(bands[3].count_u()));
  EXPECT_TRUE(orient(close_hull(bands)).topology.closed);
}

TEST(BulbSurface, IsDerivedAndScaledWithItsBulb) {
  const OffsetTable table = bulb_table(1);
  const SectionalAreas areas = sectional_areas(table);
  // Below z = 6, where the formulas have 4700.6749439932 and 51.100802873368.
  EXPECT_NEAR(areas.volume, 4700.6749439932, 1e-3 * 4700.67);
  EXPECT_NEAR(areas.centroid, 51.100802873368, 0.02);
  const double prismatic = prismatic_coefficient(areas, table) + 0.01;
  const OffsetTable shifted = shift_sections(table, {prismatic, buoyancy_centre(areas, table)});
  EXPECT_NEAR(prismatic_coefficient(sectional_areas(shifted), shifted), prismatic, 1e-9);
  EXPECT_NE(shifted.stem(0, 0), table.stem(0, 0));
  EXPECT_NO_THROW(hull_solid(shifted));
  const OffsetTable larger = scaled(table, Vector3(2.0, 2.0, 2.0));
  EXPECT_NEAR(bulk_of(surface_of(larger)).volume, 8.0 * bulk_of(surface_of(table)).volume, 1e-8);
}

void expect_refused(const OffsetTable& table, const std::string& fragment) {
  try {
    hull_surface(hull_sections(table));
    ADD_FAILURE() << "not refused: " << fragment;
  } catch (const GeometryError& error) {
    EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos) << error.what();
  }
}

TEST(BulbSurface, RefusesBulbsThatCannotBe) {
  const OffsetTable sound = bulb_table(1);
  OffsetTable table = sound;
  table.stem.resize(2, 0);
  expect_refused(table, "there is a bulb but no stem");
  table = sound;
  table.deck(0, table.deck.cols() - 1) = 0.4;
  expect_refused(table, "in the bulb, and ends with the half-breadth 0.4 at height");
  table = sound;
  table.bulb(0, 3) = 100.0;
  expect_refused(table, "point 4 of the bulb lies at x = 100; expected it ahead of all stations");
  table = sound;
  table.stem.row(1).array() += 5.0;
  expect_refused(table, "expected it between the keel and the top (or first knuckle) of station");
  table = sound;
  table.stem.row(0).setConstant(-1.0);
  expect_refused(table, "all stations lie ahead of the stem, which begins at x = -1");
  table = with_knuckle();
  table.knuckles[0].places.col(table.deck.cols() - 1) << 0.1, 3.0;
  expect_refused(table, "which lies in the bulb; expected none there");
  // As one contour from the keel to the deck.
  table = sound;
  table.stem = sound.bulb;
  table.bulb.resize(2, 0);
  table.stem.conservativeResize(2, table.stem.cols() + sound.stem.cols());
  table.stem.rightCols(sound.stem.cols()) = sound.stem;
  expect_refused(table, "give its contour as \"bulb\" and the stem from the notch above it upwards");
}

}  // namespace
}  // namespace isorim::geometry
