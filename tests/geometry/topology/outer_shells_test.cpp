#include "geometry/topology/outer_shells.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"

namespace isorim::geometry {
namespace {

/// Balls about points of the x axis, one boundary, oriented.
OrientedBoundary<3> balls(const std::vector<std::pair<double, double>>& places_and_radii) {
  Boundary<3> all;
  for (const auto& [x, radius] : places_and_radii)
    for (Patch<3> patch : sphere(radius, {x, 0.0, 0.0}).patches) {
      patch.name = "ball_" + std::to_string(all.patches.size() + 1);
      all.patches.push_back(std::move(patch));
    }
  return orient(all);
}

TEST(OuterShells, AreThoseThatAFluidMeets) {
  // Two bodies; in the first a void, in that a body with a void of its own, and beside it another void.
  const OrientedBoundary<3> solid = balls({{0.5, 0.5}, {0.0, 4.0}, {0.5, 2.0}, {9.0, 1.0}, {0.5, 1.0}, {-2.8, 0.6}});
  const OrientedBoundary<3> outer = outer_shells(solid);
  ASSERT_EQ(outer.boundary.patches.size(), 2u);
  EXPECT_EQ(outer.boundary.patches[0].name, "ball_2");
  EXPECT_EQ(outer.boundary.patches[1].name, "ball_4");
  for (const Patch<3>& patch : outer.boundary.patches) EXPECT_EQ(patch.orientation, 1);
  EXPECT_EQ(outer.topology.shells.size(), 2u);
}

TEST(OuterShells, OfSolidsWithoutVoidsAreAllOfThem) {
  const OrientedBoundary<3> solid = balls({{0.0, 1.0}, {3.0, 1.0}});
  EXPECT_EQ(outer_shells(solid).boundary.patches.size(), 2u);
}

}  // namespace
}  // namespace isorim::geometry
