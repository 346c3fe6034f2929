#include "geometry/hull/hull.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/hull/wigley.h"

namespace isorim::geometry {
namespace {

std::vector<std::string> names(const Boundary<3>& boundary) {
  std::vector<std::string> result;
  for (const Patch<3>& patch : boundary.patches) result.push_back(patch.name);
  return result;
}

using Names = std::vector<std::string>;

TEST(Hull, WigleysHullIsClosedByItsDeck) {
  const Boundary<3> hull = close_hull(std::vector{wigley_surface(10.0, 1.0, 0.625)});
  EXPECT_EQ(names(hull), (Names{"port", "starboard", "deck"}));
  EXPECT_EQ(names(hull_solid(wigley_table(11, 6))), (Names{"port", "starboard", "deck"}));
}

TEST(Hull, HasABottomAndATransomWhereItIsBroadThere) {
  OffsetTable table = wigley_table(9, 6);
  // Aft the hull ends in a transom that tapers to a point at half its height; forward in a stem.
  for (Eigen::Index j = 0; j < 6; ++j) table.half_breadths(j, 0) = j < 3 ? 0.0 : 0.02 * static_cast<double>(j - 2);
  table.keel = Points<2>::Zero(2, 9);
  for (Eigen::Index i = 2; i <= 6; ++i) table.keel(0, i) = 0.03;
  const Boundary<3> hull = hull_solid(table);
  EXPECT_EQ(names(hull), (Names{"port", "starboard", "bottom", "deck", "stern"}));
  const Topology<3> topology = orient(hull).topology;
  EXPECT_TRUE(topology.closed);
  EXPECT_EQ(topology.shells.size(), 1u);
  EXPECT_LT(topology.largest_gap, 1e-14);
}

TEST(Hull, NumbersTheBandsBetweenKnuckles) {
  OffsetTable table = wigley_table(9, 6);
  KnuckleLine line{"sheer", Points<2>(2, 9)};
  for (Eigen::Index i = 0; i < 9; ++i) line.places.col(i) << 1.02 * table.half_breadths(4, i), 0.51;
  table.knuckles = {line};
  const Boundary<3> hull = hull_solid(table);
  EXPECT_EQ(names(hull), (Names{"port_1", "port_2", "starboard_1", "starboard_2", "deck"}));
}

TEST(Hull, ABargeIsABox) {
  OffsetTable table;
  table.name = "barge";
  table.length = 4.0;
  table.beam = 2.0;
  table.draught = 1.0;
  table.stations = {0.0, 4.0};
  table.station_names = {"0", "1"};
  table.waterlines = {0.0, 1.5};
  table.half_breadths = Eigen::MatrixXd::Constant(2, 2, 1.0);
  const Boundary<3> hull = hull_solid(table);
  EXPECT_EQ(hull.patches.size(), 6u);
  EXPECT_TRUE(orient(hull).topology.closed);
}

TEST(Hull, WigleyRefusesLengthsThatAreNotPositive) {
  EXPECT_THROW(wigley_surface(10.0, 0.0, 1.0), GeometryError);
}

}  // namespace
}  // namespace isorim::geometry
