#include "geometry/tessellation/tessellation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/propeller/propeller.h"
#include "geometry/propeller/series.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/swept_solids.h"
#include "geometry/tspline/extraction.h"
#include "tests/geometry/refusals.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using testing::refusal;

constexpr double pi = std::numbers::pi;

/// Every edge of a triangle is that of one other, the other way.
bool is_watertight(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    const auto partner = edges.find({edge.second, edge.first});
    if (count != 1 || partner == edges.end() || partner->second != 1) return false;
  }
  return !edges.empty();
}

double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices.col(t[0]).dot(mesh.vertices.col(t[1]).cross(mesh.vertices.col(t[2])));
  return sum / 6.0;
}

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles)
    sum += (mesh.vertices.col(t[1]) - mesh.vertices.col(t[0]))
               .cross(mesh.vertices.col(t[2]) - mesh.vertices.col(t[0]))
               .norm();
  return 0.5 * sum;
}

TriangleMesh mesh_of(const Boundary<3>& solid, double chord = 0.0) {
  return tessellate(orient(solid), {.chord_tolerance = chord});
}

/// Watertight, and of a volume that a shift of the surface by the tolerance accounts for.
void expect_mesh(const Boundary<3>& solid, double exact_volume, double exact_area, double chord) {
  const TriangleMesh mesh = mesh_of(solid, chord);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume(mesh), exact_volume, exact_area * chord);
  EXPECT_NEAR(area(mesh), exact_area, 0.02 * exact_area);
}

TEST(Tessellation, OfSphereTorusCylinderConeAndBox) {
  expect_mesh(sphere(1.0), 4.0 * pi / 3.0, 4.0 * pi, 1e-3);
  expect_mesh(six_patch_sphere(1.0), 4.0 * pi / 3.0, 4.0 * pi, 1e-3);
  expect_mesh(torus(2.0, 0.5), pi * pi, 4.0 * pi * pi, 1e-3);
  expect_mesh(cylinder(0.5, 2.0), 0.5 * pi, 2.5 * pi, 1e-3);
  expect_mesh(cone(1.0, 0.0, 1.0), pi / 3.0, pi * (1.0 + std::sqrt(2.0)), 1e-3);
  const TriangleMesh box_mesh = mesh_of(box({1.0, 2.0, 3.0}));
  EXPECT_EQ(box_mesh.triangles.size(), 12u);
  EXPECT_NEAR(volume(box_mesh), 6.0, 1e-14);
}

TEST(Tessellation, OfSpheresWithinRoundingOfTheToleranceWhateverItIs) {
  for (const double chord : {0.3, 0.05, 1e-2, 1e-3, 3e-4}) {
    const TriangleMesh mesh = mesh_of(sphere(1.0), chord);
    EXPECT_TRUE(is_watertight(mesh));
    double deepest = 0.0;
    for (const auto& t : mesh.triangles) {
      const Point3 middle = (mesh.vertices.col(t[0]) + mesh.vertices.col(t[1]) + mesh.vertices.col(t[2])) / 3.0;
      deepest = std::max(deepest, 1.0 - middle.norm());
    }
    EXPECT_LE(deepest, 1.5 * chord) << chord;
  }
}

// A sphere with a hole off its centre, crossed holes in a box, and a figure of eight where a plane touches a torus from
// inside.
/// A bar whose bottom is level but for one control point of many, so that few parameters of its edge tell; its ends are
/// flat, so what they are divided by is their edges alone.
TEST(Tessellation, FindsWhatHappensBetweenTwoKnots) {
  constexpr int spans = 50;
  constexpr double height = 0.05;
  std::vector<double> breaks;
  for (int i = 0; i <= spans; ++i) breaks.push_back(static_cast<double>(i) / spans);
  const KnotVector knots = KnotVector::clamped(2, breaks);
  const std::vector<double> abscissae = knots.greville_abscissae();
  const auto line = [](const Point2& from, const Point2& to) {
    Points<2> ends(2, 2);
    ends << from, to;
    return NurbsCurve<2>::from_points(KnotVector::bezier(1), ends);
  };
  for (const int raised : {9, 14, 22, 37}) {
    Points<2> points(2, knots.basis_count());
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      points.col(i) << abscissae[static_cast<std::size_t>(i)], i == raised ? -height : 0.0;
    const Boundary<2> region{{{"bottom", NurbsCurve<2>::from_points(knots, points), 1},
                              {"right", line({1.0, 0.0}, {1.0, 1.0}), 1},
                              {"top", line({1.0, 1.0}, {0.0, 1.0}), 1},
                              {"left", line({0.0, 1.0}, {0.0, 0.0}), 1}}};
    // x is the parameter, so the bump's area is that under its basis function.
    const Boundary<3> bar = extrude(region, {0.0, 0.0, 0.1});
    expect_mesh(bar, 0.1 * (1.0 + height / spans), 2.4, 1e-4);
    const TriangleMesh mesh = mesh_of(bar, 1e-4);
    const auto is_end = [&](int patch) { return bar.patches[static_cast<std::size_t>(patch)].name.starts_with("end"); };
    EXPECT_LT(std::ranges::count_if(mesh.patches, is_end), 500);
  }
}

TEST(Tessellation, OfTrimmedSolids) {
  Boundary<3> holed =
      clip(orient(sphere(1.0)).boundary, CylinderTool{{0.3, 0.0, 0.0}, Vector3::UnitZ(), 0.4, KeptSide::outside});
  EXPECT_TRUE(is_watertight(mesh_of(holed, 1e-3)));
  Boundary<3> crossed = orient(box({2.0, 2.0, 2.0}, {-1.0, -1.0, -1.0})).boundary;
  crossed = clip(crossed, CylinderTool{Point3::Zero(), Vector3::UnitZ(), 0.5, KeptSide::outside});
  crossed = clip(crossed, CylinderTool{Point3::Zero(), Vector3::UnitX(), 0.5, KeptSide::outside});
  const TriangleMesh mesh = mesh_of(crossed, 1e-3);
  EXPECT_TRUE(is_watertight(mesh));
  // Two cylinders of length 2 less their common part, 16 r^3 / 3.
  EXPECT_NEAR(volume(mesh), 8.0 - (2.0 * pi * 0.25 * 2.0 - 16.0 / 3.0 * 0.125), 0.02);
  const Boundary<3> eight = clip(orient(torus(2.0, 0.5)).boundary, PlaneTool{{1.5, 0.0, 0.0}, Vector3::UnitX()});
  EXPECT_TRUE(is_watertight(mesh_of(eight, 1e-3)));
}

TEST(Tessellation, OfTSplinesByTheirElements) {
  Boundary<3> solid = sphere(1.0);
  for (Patch<3>& patch : solid.patches) patch.shape = extracted_surface(Boundary<3>{{patch}});
  const TriangleMesh mesh = mesh_of(solid, 1e-3);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume(mesh), 4.0 * pi / 3.0, 4.0 * pi * 1e-3);
}

TEST(Tessellation, OfPropellersWithTheirHubs) {
  for (const BladeSeries series : {BladeSeries::kaplan, BladeSeries::wageningen_b}) {
    SeriesBlade blade;
    blade.series = series;
    blade.diameter = 500.0;
    blade.blades = series == BladeSeries::kaplan ? 4 : 5;
    blade.area_ratio = 0.6;
    blade.pitch_ratio = RadialLaw(0.9);
    Propeller screw;
    screw.sections = series_sections(blade);
    screw.blades = blade.blades;
    screw.hub = Hub{50.0};
    const TriangleMesh mesh = mesh_of(propeller(screw), 0.2);
    EXPECT_TRUE(is_watertight(mesh));
    EXPECT_GT(volume(mesh), 1e6);
    // The volume that the exact boundary has (kaplan.toml's without its longer hub) to what the tolerance makes.
    const TriangleMesh finer = mesh_of(propeller(screw), 0.02);
    EXPECT_TRUE(is_watertight(finer));
    EXPECT_NEAR(volume(mesh), volume(finer), 0.2 * area(finer));
    EXPECT_LT(mesh.triangles.size(), finer.triangles.size());
  }
}

TEST(Tessellation, RefusesOpenBoundariesAndNegativeTolerances) {
  Boundary<3> open = box({1.0, 1.0, 1.0});
  open.patches.pop_back();
  EXPECT_THAT(refusal([&] { tessellate(orient(open)); }), HasSubstr("the boundary is not closed"));
  EXPECT_THAT(refusal([&] { tessellate(orient(sphere(1.0)), {.chord_tolerance = -1.0}); }),
              HasSubstr("tolerance is -1"));
}

}  // namespace
}  // namespace isorim::geometry
