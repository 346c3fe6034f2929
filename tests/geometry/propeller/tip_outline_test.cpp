#include "geometry/propeller/tip_outline.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

// A cubic in s = sqrt(1 - r / R): its even part is linear in r / R, so the tip is met as well.
double cubic(double s) {
  return 0.3 + s * (0.8 + s * (-0.25 + s * 0.4));
}

RoundedOutline cubic_outline() {
  const std::vector<double> radii{0.2, 0.35, 0.5, 0.7, 0.9};
  std::vector<OutlineEdges> edges;
  for (const double r : radii) edges.push_back({cubic(std::sqrt(1.0 - r)), cubic(-std::sqrt(1.0 - r))});
  return {radii, edges};
}

TEST(RoundedOutline, ReproducesCubicsInTheRootOfTheDistanceFromTheTip) {
  const RoundedOutline outline = cubic_outline();
  for (const double r : {0.2, 0.3, 0.62, 0.9, 0.96, 0.9999, 1.0}) {
    EXPECT_NEAR(outline(r).leading, cubic(std::sqrt(1.0 - r)), 1e-13) << r;
    EXPECT_NEAR(outline(r).trailing, cubic(-std::sqrt(1.0 - r)), 1e-13) << r;
  }
}

TEST(RoundedOutline, RunsRoundTheTipWithContinuousTangentAndCurvature) {
  const RoundedOutline outline = cubic_outline();
  // Against s, from the trailing edge (s < 0) to the leading edge.
  const auto x = [&](double s) { return s < 0.0 ? outline(1.0 - s * s).trailing : outline(1.0 - s * s).leading; };
  EXPECT_EQ(outline(1.0).leading, outline(1.0).trailing);
  const double h = 1e-3;
  EXPECT_NEAR((x(h) - x(0.0)) / h, (x(0.0) - x(-h)) / h, 2.0 * 0.25 * h + 1e-9);
  const double second = (x(h) - 2.0 * x(0.0) + x(-h)) / (h * h);
  EXPECT_NEAR(second, -0.5, 1e-6);
}

TEST(TipRadii, AreEvenlySpacedInTheRootOfTheDistance) {
  const std::vector<double> radii = tip_radii(0.91);
  ASSERT_EQ(radii.size(), 3u);
  EXPECT_NEAR(std::sqrt(1.0 - radii[0]), 0.2, 1e-14);
  EXPECT_NEAR(std::sqrt(1.0 - radii[1]), 0.1, 1e-14);
  EXPECT_EQ(radii[2], 1.0);
}

TEST(TipThickness, FallsFromTheTableToNothing) {
  EXPECT_EQ(tip_thickness_factor(0.9, 0.9, 0.006), 1.0);
  EXPECT_EQ(tip_thickness_factor(1.0, 0.9, 0.006), 0.0);
  EXPECT_NEAR(tip_thickness_factor(1.0 - 0.006, 0.9, 0.006), std::tanh(1.0), 1e-3);
}

TEST(RoundedOutline, RefusesTablesThatReachTheTip) {
  const std::vector<OutlineEdges> two(2);
  EXPECT_THAT(refusal([&] { RoundedOutline(std::vector<double>{0.2, 1.0}, two); }), HasSubstr("r/R is 1 in row 2"));
  EXPECT_THAT(refusal([&] { RoundedOutline(std::vector<double>{0.5, 0.4}, two); }), HasSubstr("r/R is 0.4 in row 2"));
  EXPECT_THAT(refusal([&] { RoundedOutline(std::vector<double>{0.5}, two); }), HasSubstr("2 rows for 1 radii"));
}

}  // namespace
}  // namespace isorim::geometry
