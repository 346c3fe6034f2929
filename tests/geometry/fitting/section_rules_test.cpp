#include "geometry/fitting/section_rules.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/fitting/measured_sections.h"

namespace isorim::geometry {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using testing::measured_sections;
using ::testing::Pointwise;
using testing::worked_section;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Half a unit of the last printed digit, and some of the one before: the prints were made from rounded numbers.
constexpr double printed = 6e-5;

TEST(SectionRules, RadiiOfTheWorkedExample) {
  const std::vector<double> expected{
      infinity, infinity, infinity, 9.2195,   infinity, 45.5748, 4.3690,  26.3688, 32.5960,  14.9164,  infinity,
      7.9057,   3.5355,   7.9057,   16.3248,  5.3600,   31.5062, 17.9920, 31.0456, 3.5355,   81.4900,  125.7927,
      33.0941,  infinity, 39.1352,  15.0520,  55.0142,  32.5000, 26.9258, 5.0000,  infinity, infinity, 22.9810,
      19.0394,  7.9057,   infinity, infinity, 9.2195,   26.9258, 2.2361,  2.2361,  19.0394,  infinity};
  const std::vector<double> radii = circle_radii(worked_section());
  ASSERT_EQ(radii.size(), expected.size());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (std::isinf(expected[i]))
      EXPECT_TRUE(std::isinf(radii[i])) << i;
    else
      EXPECT_NEAR(radii[i], expected[i], printed) << i;
  }
  const RadiusStatistics statistics = radius_statistics(radii);
  EXPECT_NEAR(statistics.mean, 24.4294585020, 1e-9);
  EXPECT_NEAR(statistics.deviation, 25.4479464715, 1e-9);
  EXPECT_NEAR(statistics.largest(), 49.8774049734, 1e-9);
}

TEST(SectionRules, WeightsOfTheWorkedExample) {
  const std::vector<double> expected{22.3059, 22.3059, 22.3059, 5.4100,  22.3059, 1.0944,  11.4163, 1.8915, 1.5302,
                                     3.3438,  22.3059, 6.3090,  14.1075, 6.3090,  3.0553,  9.3054,  1.5831, 2.7722,
                                     1.6066,  14.1075, 22.3059, 22.3059, 1.5071,  22.3059, 1.2745,  3.3137, 22.3059,
                                     1.5347,  1.8524,  9.9755,  22.3059, 22.3059, 2.1704,  2.6197,  6.3090, 22.3059,
                                     22.3059, 5.4100,  1.8524,  22.3059, 22.3059, 2.6197,  22.3059};
  EXPECT_THAT(curvature_weights(circle_radii(worked_section())), Pointwise(DoubleNear(printed), expected));
}

TEST(SectionRules, AnglesOfTheWorkedExample) {
  const std::vector<double> expected{
      180.0000, 180.0000, 180.0000, 147.5288, 180.0000, 172.3039, 102.0948, 169.6952, 169.6952, 161.5651, 180.0000,
      161.5651, 143.1301, 161.5651, 168.6901, 137.7263, 171.6743, 165.1545, 173.9910, 45.0000,  175.6013, 176.6822,
      170.7890, 180.0000, 175.2364, 164.9315, 176.8202, 172.8750, 171.8699, 135.0000, 180.0000, 180.0000, 171.8699,
      171.8699, 161.5651, 180.0000, 180.0000, 161.5651, 171.8699, 108.4349, 108.4349, 171.8699, 180.0000};
  const std::vector<double> angles = interior_angles(worked_section());
  EXPECT_THAT(angles, Pointwise(DoubleNear(printed), expected));
  EXPECT_NEAR(angle_statistics(angles).mean, 162.2945, 5e-5);
  EXPECT_NEAR(angle_statistics(angles).deviation, 26.9321, 5e-5);
  EXPECT_NEAR(angle_statistics(angles).threshold(), 175.7606, 5e-5);
  EXPECT_THAT(aligned_points(angles), ElementsAre(0, 1, 2, 4, 10, 21, 23, 26, 30, 31, 35, 36, 42));
}

TEST(SectionRules, ControlPointsOfTheExamples) {
  std::vector<int> inversions;
  std::vector<int> control_points;
  for (const testing::MeasuredSection& section : measured_sections()) {
    inversions.push_back(curvature_inversions(section.points));
    control_points.push_back(inversion_control_points(section.points));
  }
  EXPECT_THAT(inversions, ElementsAre(17, 9, 29, 17));
  EXPECT_THAT(control_points, ElementsAre(28, 21, 54, 37));
  EXPECT_EQ(curvature_inversions(worked_section()), 30);
}

/// The plane of the section must not matter.
TEST(SectionRules, AreTheSameInSpace) {
  const Points<2> plane = measured_sections()[1].points;
  const Vector3 a = Vector3(1, 2, 2) / 3.0;
  const Vector3 b = Vector3(2, 1, -2) / 3.0;
  const Points<3> space = a * plane.row(0) + b * plane.row(1);
  EXPECT_EQ(curvature_inversions(space), curvature_inversions(plane));
  EXPECT_THAT(circle_radii(space), Pointwise(DoubleNear(1e-9), circle_radii(plane)));
  EXPECT_THAT(interior_angles(space), Pointwise(DoubleNear(1e-9), interior_angles(plane)));
}

TEST(SectionRules, ARegularPolygonHasEqualWeights) {
  Points<2> points(2, 12);
  for (int i = 0; i < 12; ++i)
    points.col(i) << 3 * std::cos(2 * std::numbers::pi * i / 12), 3 * std::sin(2 * std::numbers::pi * i / 12);
  for (const double radius : circle_radii(points)) EXPECT_NEAR(radius, 3.0, 1e-13);
  const std::vector<double> weights = curvature_weights(circle_radii(points));
  for (const double weight : weights) EXPECT_NEAR(weight, 1.0, 1e-12);
}

TEST(SectionRules, RefuseWhatIsNoSection) {
  EXPECT_GEOMETRY_ERROR(circle_radii(Points<2>(Points<2>::Random(2, 2))), "2 points given; expected 3 or more");
  Points<2> repeated(2, 4);
  repeated << 0, 1, 1, 0, 0, 0, 0, 1;
  EXPECT_GEOMETRY_ERROR(interior_angles(repeated), "points 1 and 2 are the same");
}

}  // namespace
}  // namespace isorim::geometry
