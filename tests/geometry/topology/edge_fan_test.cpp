#include "geometry/topology/edge_fan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace isorim::geometry {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// A leaf at an angle about the z axis, its loop running up or down.
FanLeaf leaf(int component, double degrees, bool up, int sign = 1) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return {component, sign, Vector3(0, 0, up ? 1 : -1), Vector3(std::cos(angle), std::sin(angle), 0)};
}

Pairs sorted(const std::optional<Pairs>& pairs) {
  Pairs result;
  if (!pairs) return result;
  for (const auto& [a, b] : *pairs) result.emplace_back(std::min(a, b), std::max(a, b));
  std::ranges::sort(result);
  return result;
}

TEST(EdgeFan, PairsTheLeavesOfEachSolid) {
  const std::vector<FanLeaf> touching{leaf(0, 0, true), leaf(1, 180, true), leaf(0, 90, false), leaf(1, 270, false)};
  EXPECT_EQ(sorted(pair_fan(touching)), (Pairs{{0, 2}, {1, 3}}));
  // Inside each other, as a wedge in a notch.
  const std::vector<FanLeaf> nested{leaf(0, 10, true), leaf(1, 30, true), leaf(1, 60, false), leaf(0, 80, false)};
  EXPECT_EQ(sorted(pair_fan(nested)), (Pairs{{0, 3}, {1, 2}}));
  // With faces in one plane.
  const std::vector<FanLeaf> stacked{leaf(0, 0, true), leaf(0, 90, false), leaf(1, 90, true), leaf(1, 180, false)};
  EXPECT_EQ(sorted(pair_fan(stacked)), (Pairs{{0, 1}, {2, 3}}));
}

TEST(EdgeFan, RefusesCrossingSolids) {
  const std::vector<FanLeaf> crossing{leaf(0, 0, true), leaf(1, 45, true), leaf(0, 90, false), leaf(1, 135, false)};
  EXPECT_FALSE(pair_fan(crossing));
}

TEST(EdgeFan, RefusesInconsistentPairs) {
  EXPECT_FALSE(pair_fan(std::vector{leaf(0, 0, true), leaf(0, 90, true), leaf(1, 180, true), leaf(1, 270, false)}));
  // The sign of a patch within its component counts.
  EXPECT_TRUE(pair_fan(std::vector{leaf(0, 0, true), leaf(0, 90, true, -1), leaf(1, 180, true), leaf(1, 270, false)}));
}

TEST(EdgeFan, PairsNeighboursOfOneSolid) {
  const std::vector<FanLeaf> self{leaf(0, 300, false), leaf(0, 0, true), leaf(0, 80, false), leaf(0, 200, true)};
  EXPECT_EQ(sorted(pair_fan(self)), (Pairs{{0, 1}, {2, 3}}));
}

TEST(EdgeFan, RefusesOddNumbersAndStrangers) {
  EXPECT_FALSE(pair_fan(std::vector{leaf(0, 0, true), leaf(0, 90, false), leaf(1, 180, true)}));
  EXPECT_FALSE(pair_fan(std::vector{leaf(0, 0, true), leaf(1, 90, false), leaf(2, 180, true), leaf(3, 270, false)}));
  // The last two belong together if the others do.
  EXPECT_EQ(sorted(pair_fan(std::vector{leaf(0, 0, true), leaf(1, 180, true), leaf(0, 90, false), leaf(2, 270, true)})),
            (Pairs{{0, 2}, {1, 3}}));
}

TEST(EdgeFan, FindsTheFaceAlongWhichSolidsTouch) {
  const std::vector<FanLeaf> touching{leaf(0, 0, true), leaf(1, 90, false), leaf(2, 90, true), leaf(3, 180, false)};
  const Pairs pairs = sorted(pair_touching_faces(touching));
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_NE(pairs[0], (std::pair{0, 3}));
  EXPECT_NE(pairs[1], (std::pair{1, 2}));
  // A whole solid twice.
  EXPECT_FALSE(
      pair_touching_faces(std::vector{leaf(0, 0, true), leaf(1, 90, false), leaf(2, 90, true), leaf(3, 0, false)}));
}

}  // namespace
}  // namespace isorim::geometry
