#include "geometry/intersection/angle_gap.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace isorim::geometry {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

TEST(AngleGap, IsTheWidestOfAllGaps) {
  const double seam = angle_in_widest_gap({3.0, 0.5, 1.0}, turn);
  EXPECT_GT(seam, 3.0 + 0.4 * (turn - 2.5));
  EXPECT_LT(seam, 3.0 + 0.5 * (turn - 2.5));
  const double between = angle_in_widest_gap({0.1, 4.0, 6.0}, turn);
  EXPECT_GT(between, 0.1 + 0.4 * 3.9);
  EXPECT_LT(between, 0.1 + 0.5 * 3.9);
}

TEST(AngleGap, AnglesArePeriodic) {
  const double seam = angle_in_widest_gap({0.2, 0.9, 2.0}, turn);
  EXPECT_NEAR(angle_in_widest_gap({0.2 - turn, 0.9 + 2.0 * turn, 2.0 - 3.0 * turn}, turn), seam, 1e-14);
  EXPECT_NEAR(angle_in_widest_gap({0.2, 0.9}, 1.0), angle_in_widest_gap({-0.8, 7.9}, 1.0), 1e-14);
}

TEST(AngleGap, OfOneAngleIsTheWholeTurn) {
  const double seam = angle_in_widest_gap({1.0}, turn);
  EXPECT_GT(seam, 1.0 + 0.4 * turn);
  EXPECT_LT(seam, 1.0 + 0.5 * turn);
}

}  // namespace
}  // namespace isorim::geometry
