#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/swept_solids.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/measures.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::measures;
using testing::refusal;
constexpr double pi = std::numbers::pi;

/// The same boundary with patches in another order and natural normals turned at random.
Boundary<3> scrambled(Boundary<3> boundary, std::mt19937& random) {
  std::ranges::shuffle(boundary.patches, random);
  for (Patch<3>& patch : boundary.patches) {
    if (random() % 2 == 0)
      patch.shape = reverse(surface_of(patch.shape), random() % 2 == 0 ? Direction::u : Direction::v);
    if (random() % 2 == 0) patch.shape = swap_directions(surface_of(patch.shape));
    if (random() % 2 == 0) patch.orientation = -1;
  }
  return boundary;
}

/// Cuts every patch at the parameters given (fractions of the domain).
Boundary<3> cut(const Boundary<3>& boundary, Direction direction, const std::vector<double>& fractions) {
  Boundary<3> result = boundary;
  for (const double f : fractions) {
    Boundary<3> next;
    for (const Patch<3>& patch : result.patches) {
      const Interval domain = surface_of(patch.shape).knots(direction).domain();
      if (f <= domain.first || f >= domain.last) {
        next.patches.push_back(patch);
        continue;
      }
      const auto [a, b] = split(surface_of(patch.shape), direction, f);
      next.patches.push_back({patch.name + "a", a, patch.orientation});
      next.patches.push_back({patch.name + "b", b, patch.orientation});
    }
    result = next;
  }
  return result;
}

Boundary<3> together(Boundary<3> a, const Boundary<3>& b, const std::string& suffix) {
  for (Patch<3> patch : b.patches) {
    patch.name += suffix;
    a.patches.push_back(std::move(patch));
  }
  return a;
}

void expect_oriented(const Boundary<3>& boundary, double volume, std::size_t shells = 1) {
  const OrientedBoundary<3> oriented = orient(boundary);
  EXPECT_NO_THROW(require_closed(oriented));
  EXPECT_EQ(oriented.topology.shells.size(), shells);
  EXPECT_NEAR(measures(oriented.boundary, 12).content, volume, 1e-8 * std::abs(volume));
}

NurbsSurface<3> flat(const Point3& corner, const Vector3& a, const Vector3& b) {
  Points<3> points(3, 4);
  points << corner, corner + a, corner + b, corner + a + b;
  return NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), points);
}

TEST(OrientShells, TurnsRandomlyFlippedPatchesRight) {
  std::mt19937 random(11);
  const Boundary<3> ring = cut(cut(torus(2.0, 0.5), Direction::u, {0.25, 0.6, 0.8}), Direction::v, {0.3, 0.5});
  const AffineMap<3> move = rotation(Axis{Point3(1, 2, 3), Vector3(1, -1, 0.3)}, 1.1);
  for (int trial = 0; trial < 20; ++trial) {
    expect_oriented(scrambled(box(Vector3(1, 2, 3)), random), 6.0);
    expect_oriented(scrambled(transform(box(Vector3(1, 2, 3)), move), random), 6.0);
    expect_oriented(scrambled(cylinder(1.0, 2.0), random), 2.0 * pi);
    expect_oriented(scrambled(transform(cylinder(1.0, 2.0), move), random), 2.0 * pi);
    expect_oriented(scrambled(ring, random), pi * pi);
    expect_oriented(scrambled(sphere(1.0), random), 4.0 / 3.0 * pi);
    expect_oriented(scrambled(cone(1.0, 0.0, 3.0), random), pi);
  }
}

TEST(OrientShells, InnerShellsAreVoidsAndIslandsSolid) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 10; ++trial) {
    const Boundary<3> hollow = together(sphere(2.0), sphere(1.0, Point3(0.3, 0, 0.2)), "_inner");
    expect_oriented(scrambled(hollow, random), 4.0 / 3.0 * pi * 7.0, 2);
    const Boundary<3> nested =
        together(together(hollow, cube(0.2, Point3(0.3, 0, 0.2)), "_island"), torus(9.0, 1.0), "_apart");
    expect_oriented(scrambled(nested, random), 4.0 / 3.0 * pi * 7.0 + 0.008 + 18.0 * pi * pi, 4);
  }
  const OrientedBoundary<3> oriented = orient(together(sphere(2.0), sphere(1.0), "_inner"));
  EXPECT_FALSE(oriented.topology.shells[0].is_void);
  EXPECT_TRUE(oriented.topology.shells[1].is_void);
}

TEST(OrientShells, ThinShellsAndTouchingShellsNest) {
  expect_oriented(together(sphere(1.0), sphere(0.999), "_inner"), 4.0 / 3.0 * pi * (1.0 - std::pow(0.999, 3)), 2);
  // Touches the wall from inside at one point.
  expect_oriented(together(sphere(1.0), sphere(0.5, Point3(0.5, 0, 0)), "_inner"), 4.0 / 3.0 * pi * 0.875, 2);
  // In the hole of the torus, but not in the torus.
  expect_oriented(together(torus(2.0, 0.5), sphere(1.0), "_apart"), pi * pi + 4.0 / 3.0 * pi, 2);
}

TEST(OrientShells, AnIslandInAHoleOfAPlate) {
  Boundary<2> region = rectangle(Vector2(4, 4));
  for (const auto& [name, radius] : {std::pair{"hole", 1.0}, std::pair{"island", 0.5}}) {
    region.patches.push_back({name, circle_curve(radius, Point2(2, 2))});
  }
  std::mt19937 random(5);
  expect_oriented(scrambled(extrude(region, Vector3(0, 0, 2)), random), 2.0 * (16.0 - 0.75 * pi), 2);
}

TEST(OrientShells, EdgesMeetSeveralShorterOnes) {
  std::mt19937 random(13);
  // Each face of the box cut differently: hanging vertices on every edge.
  Boundary<3> pieces;
  const Boundary<3> whole = box(Vector3(1, 1, 1));
  for (std::size_t i = 0; i < whole.patches.size(); ++i) {
    const Boundary<3> face{{whole.patches[i]}};
    const double f = 0.2 + 0.1 * static_cast<double>(i);
    const Boundary<3> parts = cut(cut(face, Direction::u, {f, 0.9}), Direction::v, {0.31 * f, 0.5});
    pieces.patches.insert(pieces.patches.end(), parts.patches.begin(), parts.patches.end());
  }
  expect_oriented(scrambled(pieces, random), 1.0);
  // Curved: a cylinder with the side in three parts and the discs turned and cut elsewhere.
  Boundary<3> drum = cylinder(1.0, 1.0);
  const Boundary<3> side = cut({{drum.patches[1]}}, Direction::u, {0.11, 0.52});
  const AffineMap<3> turn = rotation(Axis{}, 0.9);
  const Boundary<3> discs =
      cut(transform(Boundary<3>{{drum.patches[0], drum.patches[2]}}, turn), Direction::v, {0.4, 0.77});
  expect_oriented(scrambled(together(side, discs, "_disc"), random), pi);
}

TEST(OrientShells, OpenShellsReportTheirFreeEdges) {
  Boundary<3> open = box(Vector3(1, 2, 3));
  open.patches.pop_back();
  const OrientedBoundary<3> oriented = orient(open);
  EXPECT_FALSE(oriented.topology.closed);
  ASSERT_EQ(oriented.topology.free_edges.size(), 4U);
  for (const FreeEdge<3>& edge : oriented.topology.free_edges) {
    EXPECT_EQ(edge.from.z(), 3.0);
    EXPECT_EQ(edge.to.z(), 3.0);
  }
  EXPECT_THAT(refusal([&] { require_closed(oriented); }),
              AllOf(HasSubstr("the boundary is not closed: 'x_min' has a free edge"),
                    HasSubstr("from (0, 0, 3) to (0, 2, 3)")));
  // Consistent all the same.
  const Boundary<3> tube{{cylinder(1.0, 1.0).patches[1]}};
  EXPECT_EQ(orient(tube).topology.free_edges.size(), 2U);
  for (std::size_t i = 0; i < open.patches.size(); ++i) {
    EXPECT_EQ(oriented.boundary.patches[i].orientation, oriented.boundary.patches[0].orientation);
  }
}

TEST(OrientShells, AHoleInAFaceIsFree) {
  // A face in two parts, one of which is missing: the edges around it are free, the others joined.
  Boundary<3> open = box(Vector3(1, 1, 1));
  const auto [kept, lost] = split(surface_of(open.patches[5].shape), Direction::u, 0.25);
  open.patches[5].shape = kept;
  const OrientedBoundary<3> oriented = orient(open);
  EXPECT_EQ(oriented.topology.free_edges.size(), 4U);
  double length = 0.0;
  for (const FreeEdge<3>& edge : oriented.topology.free_edges) length += (edge.to - edge.from).norm();
  EXPECT_NEAR(length, 3.5, 1e-14);
}

TEST(OrientShells, TakesEdgesWithinTheToleranceAsOne) {
  Boundary<3> loose = box(Vector3(1, 1, 1));
  loose.patches[0].shape = transform(loose.patches[0].shape, translation<3>(Vector3(0, 1e-6, 0)));
  const OrientedBoundary<3> oriented = orient(loose);
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_NEAR(oriented.topology.largest_gap, 1e-6, 1e-12);
  EXPECT_FALSE(orient(loose, {1e-7}).topology.closed);
}

TEST(OrientShells, RefusesAMoebiusStrip) {
  // A band of ruled pieces that turns by half a turn on its way round.
  const int count = 12;
  Boundary<3> strip;
  const auto rung = [&](int i, double s) {
    const double t = 2.0 * pi * i / count;
    const Vector3 e(std::cos(t), std::sin(t), 0.0);
    return Point3(2.0 * e + s * (std::cos(0.5 * t) * e + std::sin(0.5 * t) * Vector3::UnitZ()));
  };
  for (int i = 0; i < count; ++i) {
    Points<3> points(3, 4);
    points << rung(i, -0.5), rung(i, 0.5), rung(i + 1, -0.5), rung(i + 1, 0.5);
    strip.patches.push_back(
        {fmt::format("m{}", i), NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), points)});
  }
  EXPECT_THAT(refusal([&] { orient(strip); }),
              AllOf(HasSubstr("cannot be oriented"), HasSubstr("Moebius"), HasSubstr("at (")));
  Boundary<3> open = strip;
  open.patches.pop_back();
  EXPECT_NO_THROW(orient(open));
  // The same as a single patch that meets itself.
  Points<3> points(3, 2 * (count + 1));
  for (int i = 0; i <= count; ++i) {
    points.col(2 * i) = rung(i, -0.5);
    points.col(2 * i + 1) = rung(i, 0.5);
  }
  const Boundary<3> single{
      {{"band", NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::clamped_uniform(1, count), points)}}};
  EXPECT_THAT(refusal([&] { orient(single); }), HasSubstr("patch 'band' meets itself"));
}

TEST(OrientShells, RefusesThreePatchesOnAnEdge) {
  Boundary<3> fin = box(Vector3(1, 1, 1));
  fin.patches.push_back({"fin", flat(Point3(1, 1, 0), Vector3(1, 1, 0), Vector3(0, 0, 1))});
  EXPECT_THAT(refusal([&] { orient(fin); }),
              AllOf(HasSubstr("'fin'"), HasSubstr("share the edge from (1, 1, "), HasSubstr("two patches at most")));
  // Along a part of the edge as well.
  fin.patches.back().shape = flat(Point3(1, 1, 0.25), Vector3(1, 1, 0), Vector3(0, 0, 0.5));
  EXPECT_THAT(refusal([&] { orient(fin); }), HasSubstr("share the edge from (1, 1, 0."));
}

TEST(OrientShells, RefusesShellsWithoutVolume) {
  const NurbsSurface<3> sheet = flat(Point3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0));
  EXPECT_THAT(refusal([&] {
                orient(Boundary<3>{{{"front", sheet}, {"back", sheet}}});
              }),
              HasSubstr("patches 'front' and 'back' are the same face, given twice"));
  const auto [left, right] = split(sheet, Direction::u, 0.3);
  EXPECT_THAT(refusal([&] {
                orient(Boundary<3>{{{"front", sheet}, {"left", left}, {"right", right}}});
              }),
              HasSubstr("the closed shell of patch 'front' and 2 more encloses no volume"));
  EXPECT_THAT(refusal([] { orient(Boundary<3>{}); }), HasSubstr("has no patches"));
}

TEST(OrientShells, TenThousandPatchesTakeLessThanTwoSeconds) {
  Boundary<3> ring;
  // 100 x 100 bilinear patches through points of a torus.
  const NurbsSurface<3> surface = surface_of(torus(2.0, 0.7).patches[0].shape);
  const auto node = [&](int i, int j) { return evaluate(surface, Point2((i % 100) / 100.0, (j % 100) / 100.0)); };
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      Points<3> points(3, 4);
      points << node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1);
      ring.patches.push_back({fmt::format("p{}", 100 * i + j),
                              NurbsSurface<3>::from_points(KnotVector::bezier(1), KnotVector::bezier(1), points)});
    }
  }
  std::mt19937 random(1);
  ring = scrambled(ring, random);
  // Of this process: other work on the machine does not count.
  const std::clock_t start = std::clock();
  const OrientedBoundary<3> oriented = orient(ring);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_EQ(oriented.topology.shells.size(), 1U);
  EXPECT_GT(measures(oriented.boundary, 2).content, 0.99 * 2.0 * pi * pi * 2.0 * 0.49);
  EXPECT_LT(seconds, 2.0);
}

}  // namespace
}  // namespace isorim::geometry
