#include "io/vtk/region_triangles.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/spline/bspline.h"

namespace isorim::io {
namespace {

using geometry::ElementTable;
using geometry::HomogeneousPoints;
using geometry::Point2;
using geometry::Point3;
using geometry::TrimmedRegion;
constexpr double pi = std::numbers::pi;

HomogeneousPoints<2> line(const Point2& from, const Point2& to) {
  HomogeneousPoints<2> net(3, 2);
  net << from, to, 1.0, 1.0;
  return net;
}

void append_polygon(TrimmedRegion& region, const std::vector<Point2>& corners) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    region.curves.push_back(line(corners[i], corners[(i + 1) % corners.size()]));
}

/// Four rational quarters, clockwise if the region lies outside.
void append_circle(TrimmedRegion& region, const Point2& centre, double radius, bool clockwise) {
  auto circle = geometry::circle_curve(radius, centre);
  if (clockwise) circle = reverse(circle);
  for (const auto& segment : geometry::bezier_segments({circle.knots(), circle.homogeneous()}))
    region.curves.emplace_back(segment.coefficients);
}

void append_square(TrimmedRegion& region) {
  append_polygon(region, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
}

/// The first element of a boundary with a region of its own.
ElementTable<3> cut(const geometry::Boundary<3>& boundary, TrimmedRegion region) {
  ElementTable<3> table = bezier_elements(boundary);
  table.elements.resize(1);
  table.elements[0].region = 0;
  table.regions.push_back(std::move(region));
  return table;
}

double doubled_area(const RegionTriangles& mesh, const std::array<int, 3>& t) {
  const Point2 a = mesh.parameters.col(t[0]), b = mesh.parameters.col(t[1]), c = mesh.parameters.col(t[2]);
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double area(const RegionTriangles& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) sum += 0.5 * doubled_area(mesh, t);
  return sum;
}

/// Every triangle runs counter-clockwise, every edge borders two triangles at most, in opposite directions. Returns the
/// number of edges that border one.
int expect_conforming(const RegionTriangles& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : mesh.triangles) {
    EXPECT_GT(doubled_area(mesh, t), 0.0);
    for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  int border = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    if (!uses.contains({edge.second, edge.first})) ++border;
  }
  return border;
}

/// Samples of every triangle are within the tolerance of the sphere.
void expect_near_sphere(const RegionTriangles& mesh, double radius, double tolerance) {
  for (Eigen::Index i = 0; i < mesh.points.cols(); ++i) EXPECT_NEAR(mesh.points.col(i).norm(), radius, 1e-15 * radius);
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i <= 6; ++i) {
      for (int j = 0; i + j <= 6; ++j) {
        const Point3 x =
            (i * mesh.points.col(t[0]) + j * mesh.points.col(t[1]) + (6 - i - j) * mesh.points.col(t[2])) / 6;
        EXPECT_LT(radius - x.norm(), 1.5 * tolerance);
      }
    }
  }
}

TEST(RegionTriangles, ADiscOnASphere) {
  TrimmedRegion region;
  append_circle(region, {0.5, 0.4}, 0.35, false);
  const ElementTable<3> table = cut(geometry::sphere(2.0), region);
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const RegionTriangles mesh = triangulate_region(table, table.elements[0], tolerance);
    const int border = expect_conforming(mesh);
    // Euler: a disc.
    const auto edges = (3 * static_cast<int>(mesh.triangles.size()) + border) / 2;
    EXPECT_EQ(static_cast<int>(mesh.points.cols()) - edges + static_cast<int>(mesh.triangles.size()), 1);
    expect_near_sphere(mesh, 2.0, tolerance);
    EXPECT_NEAR(area(mesh), pi * 0.35 * 0.35, 0.5 * tolerance);
  }
}

TEST(RegionTriangles, ASquareWithTwoHoles) {
  TrimmedRegion region;
  append_square(region);
  append_circle(region, {0.3, 0.3}, 0.2, true);
  append_circle(region, {0.7, 0.6}, 0.15, true);
  const ElementTable<3> table = cut(geometry::sphere(1.0), region);
  const RegionTriangles mesh = triangulate_region(table, table.elements[0], 1e-3);
  const int border = expect_conforming(mesh);
  const auto edges = (3 * static_cast<int>(mesh.triangles.size()) + border) / 2;
  EXPECT_EQ(static_cast<int>(mesh.points.cols()) - edges + static_cast<int>(mesh.triangles.size()), -1);
  expect_near_sphere(mesh, 1.0, 1e-3);
  EXPECT_NEAR(area(mesh), 1.0 - pi * (0.04 + 0.0225), 1e-3);
}

TEST(RegionTriangles, FlatOnesStayFew) {
  TrimmedRegion region;
  append_square(region);
  append_polygon(region, {{0.25, 0.25}, {0.25, 0.75}, {0.75, 0.75}, {0.75, 0.25}});
  const ElementTable<3> table = cut(geometry::box({1, 1, 1}), region);
  const RegionTriangles mesh = triangulate_region(table, table.elements[0], 1e-6);
  EXPECT_EQ(mesh.triangles.size(), 8U);
  EXPECT_EQ(expect_conforming(mesh), 8);
  EXPECT_NEAR(area(mesh), 0.75, 1e-15);
}

/// Among all triangulations Delaunay's has the roundest triangles: the angles against each inner edge add up to at most
/// half a turn. Returns the number of inner edges.
int expect_delaunay(const RegionTriangles& mesh) {
  std::map<std::pair<int, int>, double> angles;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point2 apex = mesh.parameters.col(t[(k + 2) % 3]);
      const Point2 a = mesh.parameters.col(t[k]) - apex, b = mesh.parameters.col(t[(k + 1) % 3]) - apex;
      angles[{t[k], t[(k + 1) % 3]}] = std::acos(a.dot(b) / (a.norm() * b.norm()));
    }
  }
  int inner = 0;
  for (const auto& [edge, angle] : angles) {
    const auto other = angles.find({edge.second, edge.first});
    if (other == angles.end() || edge.first > edge.second) continue;
    ++inner;
    EXPECT_LT(angle + other->second, pi + 1e-6) << edge.first << " to " << edge.second;
  }
  return inner;
}

TEST(RegionTriangles, FlatOnesAreDelaunay) {
  TrimmedRegion region;
  append_square(region);
  append_circle(region, {0.3, 0.35}, 0.2, true);
  append_circle(region, {0.72, 0.6}, 0.13, true);
  const ElementTable<3> table = cut(geometry::box({1, 1, 1}), region);
  const RegionTriangles mesh = triangulate_region(table, table.elements[0], 1e-5);
  const int border = expect_conforming(mesh);
  // No vertex lies inside: each is an end of two border edges.
  EXPECT_EQ(border, static_cast<int>(mesh.points.cols()));
  EXPECT_GT(border, 300);
  EXPECT_EQ(expect_delaunay(mesh), (3 * static_cast<int>(mesh.triangles.size()) - border) / 2);
}

// What ear clipping may stumble over.
TEST(RegionTriangles, LoopsThatTouch) {
  TrimmedRegion corner_to_corner;
  append_polygon(corner_to_corner, {{0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}});
  append_polygon(corner_to_corner, {{0.5, 0.5}, {1, 0.5}, {1, 1}, {0.5, 1}});
  TrimmedRegion hole_at_the_edge;
  append_square(hole_at_the_edge);
  append_polygon(hole_at_the_edge, {{0.5, 0}, {0.3, 0.4}, {0.7, 0.4}});
  TrimmedRegion holes_that_touch;
  append_square(holes_that_touch);
  append_circle(holes_that_touch, {0.3, 0.5}, 0.2, true);
  append_circle(holes_that_touch, {0.7, 0.5}, 0.2, true);
  TrimmedRegion nothing_but_a_sliver;
  append_polygon(nothing_but_a_sliver, {{0, 0}, {1, 0}, {1, 1e-9}, {0, 1e-9}});
  const std::vector<std::pair<TrimmedRegion*, double>> regions{{&corner_to_corner, 0.5},
                                                               {&hole_at_the_edge, 1.0 - 0.08},
                                                               {&holes_that_touch, 1.0 - 0.08 * pi},
                                                               {&nothing_but_a_sliver, 1e-9}};
  for (const auto& [region, expected] : regions) {
    const ElementTable<3> table = cut(geometry::box({1, 1, 1}), *region);
    const RegionTriangles mesh = triangulate_region(table, table.elements[0], 1e-4);
    for (const auto& t : mesh.triangles) EXPECT_GT(doubled_area(mesh, t), 0.0);
    EXPECT_NEAR(area(mesh), expected, 3e-4 * expected);
  }
}

TEST(RegionTriangles, CurvesInAnyOrder) {
  TrimmedRegion region;
  append_square(region);
  append_circle(region, {0.5, 0.5}, 0.3, true);
  std::swap(region.curves[1], region.curves[6]);
  std::swap(region.curves[2], region.curves[4]);
  const ElementTable<3> table = cut(geometry::box({1, 1, 1}), region);
  const RegionTriangles mesh = triangulate_region(table, table.elements[0], 1e-4);
  expect_conforming(mesh);
  EXPECT_NEAR(area(mesh), 1.0 - 0.09 * pi, 1e-4);
}

}  // namespace
}  // namespace isorim::io
