#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/orientation.h"
#include "geometry/topology/shape_loops.h"
#include "geometry/trimming/lifted_curve.h"
#include "tests/geometry/refusals.h"
#include "tests/geometry/tspline/extracted_surfaces.h"

namespace isorim::geometry {
namespace {

using ::testing::AllOf;
using testing::cut_element;
using testing::extracted;
using ::testing::HasSubstr;
using testing::refusal;

const ExtractedSurface& surface_at(const Boundary<3>& boundary, std::size_t patch = 0) {
  return std::get<ExtractedSurface>(boundary.patches[patch].shape);
}

/// Random elements cut in two, some several times.
ExtractedSurface with_hanging_edges(ExtractedSurface surface, std::mt19937& random, int cuts) {
  std::uniform_real_distribution<double> fraction(0.2, 0.8);
  for (int i = 0; i < cuts; ++i)
    surface =
        cut_element(surface, random() % surface.elements().size(), static_cast<int>(random() % 2), fraction(random));
  return surface;
}

Boundary<3> torus_with_hanging_edges(std::mt19937& random) {
  Boundary<3> boundary = extracted(torus(3.0, 1.0));
  boundary.patches[0].shape = with_hanging_edges(surface_at(boundary), random, 30);
  return boundary;
}

/// The stretches of all sides of all elements, as fractions of the unit square's side.
double total_domain(const Topology<3>& topology) {
  double sum = 0.0;
  for (const BoundaryEdge& edge : topology.edges) sum += edge.first.domain.length() + edge.second.domain.length();
  for (const FreeEdge<3>& edge : topology.free_edges) sum += edge.domain.length();
  return sum;
}

TEST(ExtractedShells, SolidsByTheirElementsAreClosed) {
  for (const Boundary<3>& solid :
       {sphere(2.0), torus(3.0, 1.0), box(Vector3(1, 2, 3)), cylinder(1.0, 4.0), cone(2.0, 1.0, 3.0)}) {
    const OrientedBoundary<3> nurbs = orient(solid);
    const OrientedBoundary<3> oriented = orient(extracted(solid));
    EXPECT_TRUE(oriented.topology.closed);
    ASSERT_EQ(oriented.boundary.patches.size(), nurbs.boundary.patches.size());
    for (std::size_t i = 0; i < nurbs.boundary.patches.size(); ++i)
      EXPECT_EQ(oriented.boundary.patches[i].orientation, nurbs.boundary.patches[i].orientation);
  }
}

TEST(ExtractedShells, EverySideOfEveryElementIsMatchedOnce) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 10; ++trial) {
    const Boundary<3> boundary = torus_with_hanging_edges(random);
    const OrientedBoundary<3> oriented = orient(boundary);
    EXPECT_TRUE(oriented.topology.closed) << "trial " << trial;
    EXPECT_EQ(oriented.topology.shells.size(), 1u);
    EXPECT_NEAR(total_domain(oriented.topology), 4.0 * static_cast<double>(surface_at(boundary).elements().size()),
                1e-9);
    EXPECT_LE(oriented.topology.largest_gap, 1e-13);
  }
}

TEST(ExtractedShells, UsesOfAnEdgeCoincide) {
  std::mt19937 random(4);
  const OrientedBoundary<3> oriented = orient(torus_with_hanging_edges(random));
  const ShapeLoops loops(oriented.boundary.patches[0].shape);
  for (const BoundaryEdge& edge : oriented.topology.edges) {
    const auto end = [&](const EdgeUse& use, bool last) {
      return lifted_point(loops.surface(use.loop), loops.curve(use.loop, use.curve),
                          last == use.forward ? use.domain.last : use.domain.first);
    };
    for (const bool last : {false, true}) EXPECT_LE((end(edge.first, last) - end(edge.second, last)).norm(), 1e-12);
    EXPECT_NE(edge.first.forward, edge.second.forward);
  }
}

TEST(ExtractedShells, NormalsThatPointInwardsAreTurned) {
  std::mt19937 random(5);
  Boundary<3> boundary = torus_with_hanging_edges(random);
  EXPECT_EQ(orient(boundary).boundary.patches[0].orientation, 1);
  AffineMap<3> mirror;
  mirror.linear(0, 0) = -1.0;
  boundary.patches[0].shape = transform(surface_at(boundary), mirror);
  EXPECT_EQ(orient(boundary).boundary.patches[0].orientation, -1);
}

TEST(ExtractedShells, InnerShellsAreVoids) {
  const Boundary<3> outer = extracted(sphere(2.0));
  Boundary<3> both = outer;
  both.patches.push_back({"void", extracted(sphere(1.0)).patches[0].shape, 1});
  const OrientedBoundary<3> oriented = orient(both);
  EXPECT_TRUE(oriented.topology.closed);
  ASSERT_EQ(oriented.topology.shells.size(), 2u);
  EXPECT_TRUE(oriented.topology.shells[1].is_void);
  EXPECT_EQ(oriented.boundary.patches[1].orientation, -oriented.boundary.patches[0].orientation);
}

TEST(ExtractedShells, MeetNurbsPatchesAndFinerElements) {
  std::mt19937 random(6);
  Boundary<3> mixed = box(Vector3(1, 2, 3));
  for (std::size_t i = 0; i < mixed.patches.size(); i += 2)
    mixed.patches[i].shape =
        with_hanging_edges(extracted_surface(std::get<NurbsSurface<3>>(mixed.patches[i].shape)), random, 12);
  const OrientedBoundary<3> oriented = orient(mixed);
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_EQ(oriented.topology.shells.size(), 1u);
  for (const Patch<3>& patch : oriented.boundary.patches)
    EXPECT_EQ(patch.orientation, orient(box(Vector3(1, 2, 3))).boundary.patches[0].orientation);
}

TEST(ExtractedShells, AMissingElementLeavesTheEdgesOfItsNeighboursFree) {
  std::mt19937 random(7);
  Boundary<3> boundary = torus_with_hanging_edges(random);
  const ExtractedSurface whole = surface_at(boundary);
  std::vector<ExtractionElement> elements = whole.elements();
  elements.erase(elements.begin() + 5);
  boundary.patches[0].shape = ExtractedSurface(whole.homogeneous(), elements);
  const OrientedBoundary<3> oriented = orient(boundary);
  EXPECT_FALSE(oriented.topology.closed);
  double free = 0.0;
  for (const FreeEdge<3>& edge : oriented.topology.free_edges) free += edge.length;
  double around = 0.0;
  const ShapeLoops loops{SurfaceShape(whole)};
  const NurbsSurface<3> hole = bezier_surface(whole, 5);
  for (const NurbsCurve<3>& side : boundary_curves(hole)) {
    for (int i = 0; i < 2000; ++i) around += (evaluate(side, (i + 1) / 2000.0) - evaluate(side, i / 2000.0)).norm();
  }
  EXPECT_NEAR(free, around, 1e-4 * around);
  EXPECT_THAT(refusal([&] { require_closed(oriented); }),
              AllOf(HasSubstr("has a free edge (at "), HasSubstr(" of element ")));
}

TEST(ExtractedShells, AGapAtAHangingEdgeIsClosedWithinTheToleranceOfFilesAndReported) {
  Boundary<3> boundary = extracted(box(Vector3(1, 1, 1)));
  ExtractedSurface side = cut_element(surface_at(boundary), 0, 0, 0.5);
  // The middle of the cut edge leaves the edge of the neighbour.
  HomogeneousPoints<3> net = side.homogeneous();
  std::vector<ExtractionElement> elements = side.elements();
  const Eigen::Index n = net.cols();
  net.conservativeResize(4, n + 1);
  const Point3 middle = bezier_net(side, 0).col(1).head<3>();
  net.col(n) << middle + 3e-5 * Vector3::Ones(), 1.0;
  const auto move_corner = [&](ExtractionElement& element, Eigen::Index corner) {
    element.functions.push_back(static_cast<std::int32_t>(n));
    element.rows.col(corner).setZero();
    element.rows.conservativeResize(element.rows.rows() + 1, Eigen::NoChange);
    element.rows.row(element.rows.rows() - 1).setZero();
    element.rows(element.rows.rows() - 1, corner) = 1.0;
  };
  move_corner(elements[0], 1);
  move_corner(elements[1], 0);
  boundary.patches[0].shape = ExtractedSurface(net, elements);
  EXPECT_FALSE(orient(boundary).topology.closed);
  const OrientedBoundary<3> tolerant = orient(boundary, {.largest_relative_gap = OrientationOptions::file_gap});
  EXPECT_TRUE(tolerant.topology.closed);
  EXPECT_NEAR(tolerant.topology.largest_gap, std::sqrt(2.0) * 3e-5, 1e-6);
}

TEST(ExtractedShells, ElementsThatLookToDifferentSidesAreRefused) {
  Boundary<3> boundary = extracted(torus(3.0, 1.0));
  std::vector<ExtractionElement> elements = surface_at(boundary).elements();
  elements[6] = reversed(surface_at(boundary)).elements()[6];
  boundary.patches[0].shape = ExtractedSurface(surface_at(boundary).homogeneous(), elements);
  EXPECT_THAT(refusal([&] { orient(boundary); }),
              AllOf(HasSubstr("look to different sides"), HasSubstr(" 6"), HasSubstr("of patch 'torus'")));
}

TEST(ExtractedShells, TheSameSurfaceTwiceIsRefused) {
  Boundary<3> boundary = extracted(box(Vector3(1, 2, 3)));
  boundary.patches.push_back({"again", cut_element(surface_at(boundary), 0, 0, 0.3), 1});
  boundary.patches[0].shape = cut_element(surface_at(boundary), 0, 0, 0.3);
  EXPECT_THAT(refusal([&] { orient(boundary); }), HasSubstr("are the same face, given twice"));
}

TEST(ExtractedShells, TheSameElementTwiceIsRefused) {
  Boundary<3> boundary = extracted(torus(3.0, 1.0));
  std::vector<ExtractionElement> elements = surface_at(boundary).elements();
  elements.push_back(elements[3]);
  boundary.patches[0].shape = ExtractedSurface(surface_at(boundary).homogeneous(), elements);
  EXPECT_THAT(refusal([&] { orient(boundary); }),
              HasSubstr("patches 'torus' (element 3) and 'torus' (element 16) are the same face, given twice"));
}

}  // namespace
}  // namespace isorim::geometry
