#include "geometry/tessellation/constrained_delaunay.h"

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace isorim::geometry {
namespace {

double doubled_area(const ConstrainedDelaunay& mesh, const ConstrainedDelaunay::Triangle& t) {
  const Point2 a = mesh.point(t.vertices[0]);
  const Vector2 x = mesh.point(t.vertices[1]) - a;
  const Vector2 y = mesh.point(t.vertices[2]) - a;
  return x.x() * y.y() - x.y() * y.x();
}

/// Neighbours know each other, and all triangles together cover the rectangle beyond which the corners lie.
void expect_sound(const ConstrainedDelaunay& mesh) {
  double sum = 0.0;
  for (std::size_t k = 0; k < mesh.triangles().size(); ++k) {
    const auto& t = mesh.triangles()[k];
    EXPECT_GT(doubled_area(mesh, t), 0.0);
    sum += doubled_area(mesh, t);
    for (const int n : t.neighbours) {
      if (n < 0) continue;
      const auto& back = mesh.triangles()[static_cast<std::size_t>(n)].neighbours;
      EXPECT_NE(std::find(back.begin(), back.end(), static_cast<int>(k)), back.end());
    }
  }
  EXPECT_NEAR(sum, 2.0 * 1.5 * 1.5, 1e-9);
}

bool has_segment(const ConstrainedDelaunay& mesh, int from, int to) {
  for (const auto& t : mesh.triangles())
    for (std::size_t i = 0; i < 3; ++i)
      if (t.vertices[(i + 1) % 3] == from && t.vertices[(i + 2) % 3] == to) return t.is_segment[i];
  return false;
}

TEST(ConstrainedDelaunay, HasNoVertexInACircumcircle) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  ConstrainedDelaunay mesh({0.0, 0.0}, {1.0, 1.0}, {1.0, 1.0});
  for (int i = 0; i < 200; ++i) mesh.insert({place(random), place(random)});
  expect_sound(mesh);
  for (const auto& t : mesh.triangles()) {
    const Point2 a = mesh.point(t.vertices[0]);
    const Vector2 b = mesh.point(t.vertices[1]) - a;
    const Vector2 c = mesh.point(t.vertices[2]) - a;
    const double d = 2.0 * (b.x() * c.y() - b.y() * c.x());
    const Point2 centre = a + Vector2(c.y() * b.squaredNorm() - b.y() * c.squaredNorm(),
                                      b.x() * c.squaredNorm() - c.x() * b.squaredNorm()) /
                                  d;
    const double radius = (centre - a).norm();
    for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_GE((mesh.point(v) - centre).norm(), radius * (1.0 - 1e-9));
  }
}

// Points on lines and in a lattice, where many are on a circle or in line.
TEST(ConstrainedDelaunay, TakesPointsInSpecialPlaces) {
  ConstrainedDelaunay mesh({0.0, 0.0}, {1.0, 1.0}, {3.0, 1.0});
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 16; ++j) mesh.insert({i / 16.0, j / 16.0});
  EXPECT_EQ(mesh.vertex_count(), 4 + 17 * 17);
  expect_sound(mesh);
  EXPECT_EQ(mesh.insert({0.5, 0.25}).value(), mesh.insert({0.5, 0.25}).value());
  EXPECT_EQ(mesh.vertex_count(), 4 + 17 * 17);
}

TEST(ConstrainedDelaunay, KeepsSegmentsAndFindsWhatTheyEnclose) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  ConstrainedDelaunay mesh({0.0, 0.0}, {1.0, 1.0}, {1.0, 1.0});
  for (int i = 0; i < 300; ++i) mesh.insert({place(random), place(random)});
  // A star round the middle, counter-clockwise, and a triangle in it, clockwise.
  std::vector<int> star;
  double expected = 0.0;
  std::vector<Point2> corners;
  for (int k = 0; k < 14; ++k) {
    const double radius = k % 2 == 0 ? 0.48 : 0.21;
    corners.emplace_back(0.5 + radius * std::cos(k * 0.4487989505128276),
                         0.5 + radius * std::sin(k * 0.4487989505128276));
    star.push_back(mesh.insert(corners.back()).value());
  }
  for (std::size_t k = 0; k < 14; ++k) {
    ASSERT_TRUE(mesh.add_segment(star[k], star[(k + 1) % 14]));
    const Point2& a = corners[k];
    const Point2& b = corners[(k + 1) % 14];
    expected += a.x() * b.y() - a.y() * b.x();
  }
  const std::vector<int> hole{mesh.insert({0.45, 0.45}).value(), mesh.insert({0.5, 0.58}).value(),
                              mesh.insert({0.56, 0.46}).value()};
  for (std::size_t k = 0; k < 3; ++k) ASSERT_TRUE(mesh.add_segment(hole[k], hole[(k + 1) % 3]));
  expected -= std::abs((0.05) * (0.01) - (0.13) * (0.11));
  mesh.find_windings();
  expect_sound(mesh);
  double inside = 0.0;
  for (const auto& t : mesh.triangles()) {
    EXPECT_TRUE(t.winding == 0 || t.winding == 1);
    if (t.winding == 1) inside += doubled_area(mesh, t);
  }
  EXPECT_NEAR(inside, expected, 1e-10);
  // Later points leave segments alone and know on which side they are.
  for (int i = 0; i < 300; ++i) mesh.insert({place(random), place(random)});
  expect_sound(mesh);
  for (std::size_t k = 0; k < 14; ++k) EXPECT_TRUE(has_segment(mesh, star[k], star[(k + 1) % 14]));
  double still_inside = 0.0;
  for (const auto& t : mesh.triangles())
    if (t.winding == 1) still_inside += doubled_area(mesh, t);
  EXPECT_NEAR(still_inside, expected, 1e-10);
}

TEST(ConstrainedDelaunay, RefusesSegmentsThatCrossAndPointsOnThem) {
  ConstrainedDelaunay mesh({0.0, 0.0}, {1.0, 1.0}, {1.0, 1.0});
  const int a = mesh.insert({0.0, 0.0}).value();
  const int b = mesh.insert({1.0, 1.0}).value();
  const int c = mesh.insert({0.0, 1.0}).value();
  const int d = mesh.insert({1.0, 0.0}).value();
  EXPECT_TRUE(mesh.add_segment(a, b));
  EXPECT_FALSE(mesh.add_segment(c, d));
  EXPECT_FALSE(mesh.insert({0.5, 0.5}).has_value());
  EXPECT_FALSE(mesh.insert({5.0, 0.5}).has_value());
}

}  // namespace
}  // namespace isorim::geometry
