#include "geometry/propeller/blade_frames.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace isorim::geometry {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

BladeStation random_station(std::mt19937& random) {
  std::uniform_real_distribution<double> number(0.0, 1.0);
  return {0.05 + 2.0 * number(random), 3.0 * number(random) - 0.5, number(random) - 0.3, number(random) - 0.5};
}

TEST(BladeFrames, GoBothWays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int trial = 0; trial < 1000; ++trial) {
    const BladeStation station = random_station(random);
    // Less than half a turn to either side of the section's origin.
    const Point2 expanded = 0.45 * two_pi / std::sqrt(2.0) * station.radius * Point2(number(random), number(random));
    for (const Hand hand : {Hand::right, Hand::left}) {
      const Point3 space = to_space(station, expanded, hand);
      EXPECT_NEAR(std::hypot(space.y(), space.z()), station.radius, 1e-15 * (1.0 + station.radius) * 4.0);
      EXPECT_LE((to_expanded(station, space, hand) - expanded).norm(), 1e-14 * (1.0 + station.radius) * 10.0);
    }
  }
}

TEST(BladeFrames, ATurnAlongThePitchLineAdvancesByThePitch) {
  const BladeStation station{0.7, 1.3, 0.0, 0.0};
  const double turn = std::hypot(1.3, two_pi * 0.7);
  const CylindricalPoint start = to_cylinder(station, Point2(0.1, 0.05));
  const CylindricalPoint end = to_cylinder(station, Point2(0.1 + turn, 0.05));
  EXPECT_NEAR(end.axial - start.axial, 1.3, 1e-14);
  EXPECT_NEAR(end.angle - start.angle, two_pi, 1e-14);
}

// The map is an isometry of the plane onto the cylinder: unit tangents at right angles to each other and to the radius.
TEST(BladeFrames, UnrollTheCylinderWithoutStretching) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const BladeStation station = random_station(random);
    const Point2 place(0.3 * station.radius, -0.2 * station.radius);
    const double h = 1e-5 * station.radius;
    const auto derivative = [&](const Vector2& direction) -> Vector3 {
      return (to_space(station, place + h * direction) - to_space(station, place - h * direction)) / (2.0 * h);
    };
    const Vector3 along = derivative(Vector2::UnitX());
    const Vector3 across = derivative(Vector2::UnitY());
    const Point3 at = to_space(station, place);
    const Vector3 radial = Vector3(0.0, at.y(), at.z()) / station.radius;
    EXPECT_NEAR(along.norm(), 1.0, 1e-9);
    EXPECT_NEAR(across.norm(), 1.0, 1e-9);
    EXPECT_NEAR(along.dot(across), 0.0, 1e-9);
    // x^L x y^L points outward: right-handed with the radius.
    EXPECT_NEAR(along.cross(across).dot(radial), 1.0, 1e-9);
  }
}

TEST(BladeFrames, SkewMovesASectionBackAlongItsHelixAndRakeAft) {
  const BladeStation plain{0.4, 0.9, 0.0, 0.0};
  const BladeStation skewed{0.4, 0.9, 0.25, 0.0};
  const double back = 0.25 * 0.4 / std::cos(plain.pitch_angle());
  const Point2 place(0.03, 0.01);
  EXPECT_LE((to_space(skewed, place) - to_space(plain, place - Vector2(back, 0.0))).norm(), 1e-15);
  const BladeStation raked{0.4, 0.9, 0.0, 0.07};
  EXPECT_LE((to_space(raked, place) - to_space(plain, place) - Vector3(-0.07, 0.0, 0.0)).norm(), 1e-16);
}

// Looking forward from astern at a blade that stands up, a right-handed screw has its leading edge to starboard: at
// negative Y, since Y = Z x X points to port.
TEST(BladeFrames, HandPutsTheLeadingEdgeToStarboardOrPort) {
  const BladeStation station{1.0, 1.0, 0.0, 0.0};
  const Point2 leading(0.2, 0.0);
  EXPECT_LT(to_space(station, leading, Hand::right).y(), 0.0);
  EXPECT_GT(to_space(station, leading, Hand::right).x(), 0.0);
  const Point3 mirrored = to_space(station, leading, Hand::left);
  EXPECT_LE((mirrored - to_space(station, leading).cwiseProduct(Vector3(1.0, -1.0, 1.0))).norm(), 1e-16);
}

TEST(BladeFrames, TakeTheAngleNearestToTheSection) {
  // Skewed by more than half a turn, where the angle about the shaft jumps.
  const BladeStation station{1.0, 0.8, 3.3, 0.0};
  const Point2 place(0.2, 0.1);
  EXPECT_LE((to_expanded(station, to_space(station, place)) - place).norm(), 1e-14);
}

}  // namespace
}  // namespace isorim::geometry
