#include "geometry/propeller/blade_section.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

ProfileSection example() {
  return {{0.3, 0.5, 0.0, 0.0}, 0.2, 0.02, 0.006, ThicknessForm::naca_16, MeanLine::parabola};
}

TEST(ProfileSection, RunsFromTheTrailingEdgeAlongTheBackToTheFace) {
  const BladeSection section = profile_section(example(), 21);
  ASSERT_EQ(section.outline.cols(), 41);
  EXPECT_EQ(section.leading_edge_point, 20);
  EXPECT_LE((section.outline.col(20) - Point2(0.1, 0.0)).norm(), 1e-16);
  // The trailing edge is as thick as the form says, about the chord's end.
  EXPECT_LE((0.5 * (section.outline.col(0) + section.outline.col(40)) - Point2(-0.1, 0.0)).norm(), 1e-16);
  EXPECT_NEAR((section.outline.col(0) - section.outline.col(40)).norm(), 0.02 * 0.02, 1e-15);
  for (Eigen::Index i = 1; i < 20; ++i) EXPECT_GT(section.outline(1, i), section.outline(1, 40 - i));
}

// Half way between back and face lies the mean line; the distance is the thickness.
TEST(ProfileSection, LaysTheThicknessOffAtRightAnglesToTheMeanLine) {
  const BladeSection section = profile_section(example(), 31);
  for (Eigen::Index i = 0; i <= 30; ++i) {
    const Point2 back = section.outline.col(30 - i);
    const Point2 face = section.outline.col(30 + i);
    const Point2 middle = 0.5 * (back + face);
    const double x = (0.1 - middle.x()) / 0.2;
    EXPECT_NEAR(middle.y(), 0.006 * 4.0 * x * (1.0 - x), 1e-16);
    EXPECT_NEAR((back - face).norm(), 2.0 * 0.02 * half_thickness(ThicknessForm::naca_16, x), 1e-12);
    // The mean line's tangent towards the trailing edge, x being counted from the nose.
    const Vector2 tangent(-0.2, 0.006 * (4.0 - 8.0 * x));
    EXPECT_NEAR(tangent.dot(back - face), 0.0, 1e-16);
  }
}

TEST(ProfileSection, RefusesWhatIsNoProfile) {
  const auto refused = [](auto change, int points = 25) {
    ProfileSection profile = example();
    change(profile);
    return refusal([&] { profile_section(profile, points); });
  };
  EXPECT_THAT(refused([](ProfileSection& p) { p.chord = -1.0; }), HasSubstr("chord is -1"));
  EXPECT_THAT(refused([](ProfileSection& p) { p.max_thickness = 0.0; }), HasSubstr("thickness is 0"));
  EXPECT_THAT(refused([](ProfileSection& p) { p.max_camber = NAN; }), HasSubstr("camber is nan"));
  EXPECT_THAT(refused([](ProfileSection&) {}, 2), HasSubstr("2 points a side"));
}

}  // namespace
}  // namespace isorim::geometry
