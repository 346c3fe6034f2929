#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/topology/orientation.h"
#include "geometry/trimming/lifted_curve.h"
#include "tests/geometry/refusals.h"
#include "tests/geometry/topology/trimmed_solids.h"

namespace isorim::geometry {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace testing;
constexpr double pi = std::numbers::pi;
constexpr double holed_box_volume = 4.0 - pi / 4.0;

OrientationOptions for_files() {
  OrientationOptions options;
  options.largest_relative_gap = OrientationOptions::file_gap;
  return options;
}

Boundary<3> together(Boundary<3> a, const Boundary<3>& b, const std::string& suffix) {
  for (Patch<3> patch : b.patches) {
    patch.name += suffix;
    a.patches.push_back(std::move(patch));
  }
  return a;
}

/// Every loop is covered by edges and free edges, each stretch once, but for what is degenerate or lost in a gap; the
/// uses run from vertex to vertex.
void expect_sound(const OrientedBoundary<3>& oriented) {
  const Topology<3>& topology = oriented.topology;
  std::map<std::tuple<int, int, int>, std::vector<Interval>> covered;
  const auto place = [&](const EdgeUse& use, double t) {
    const SurfaceShape& shape = oriented.boundary.patches[static_cast<std::size_t>(use.patch)].shape;
    const TrimLoop loop = trim_loops(shape)[static_cast<std::size_t>(use.loop)];
    return lifted_point(surface_of(shape), loop.curves[static_cast<std::size_t>(use.curve)], t);
  };
  const double reach = 3.0 * std::max(topology.largest_tolerance, topology.largest_gap);
  for (const BoundaryEdge& edge : topology.edges) {
    EXPECT_LE(edge.gap, topology.largest_gap);
    for (const EdgeUse& use : {edge.first, edge.second}) {
      covered[{use.patch, use.loop, use.curve}].push_back(use.domain);
      const Point3 from = topology.vertices[static_cast<std::size_t>(use.forward ? edge.from : edge.to)];
      const Point3 to = topology.vertices[static_cast<std::size_t>(use.forward ? edge.to : edge.from)];
      EXPECT_LE((place(use, use.domain.first) - from).norm(), reach);
      EXPECT_LE((place(use, use.domain.last) - to).norm(), reach);
    }
    // Consistent neighbours run through their edge in opposite directions.
    const int first = oriented.boundary.patches[static_cast<std::size_t>(edge.first.patch)].orientation;
    const int second = oriented.boundary.patches[static_cast<std::size_t>(edge.second.patch)].orientation;
    EXPECT_EQ(first * second, edge.first.forward == edge.second.forward ? -1 : 1);
  }
  for (const FreeEdge<3>& edge : topology.free_edges)
    covered[{edge.patch, edge.loop, edge.curve}].push_back(edge.domain);
  for (auto& [curve, intervals] : covered) {
    std::ranges::sort(intervals, {}, &Interval::first);
    for (std::size_t i = 0; i + 1 < intervals.size(); ++i) EXPECT_LE(intervals[i].last, intervals[i + 1].first);
  }
}

OrientedBoundary<3> expect_solid(const Boundary<3>& boundary, double volume, double accuracy = 1e-9,
                                 const OrientationOptions& options = {}) {
  const OrientedBoundary<3> oriented = orient(boundary, options);
  EXPECT_NO_THROW(require_closed(oriented));
  EXPECT_NEAR(trimmed_measures(oriented.boundary).content, volume, accuracy * std::abs(volume));
  expect_sound(oriented);
  return oriented;
}

/// The unit sphere without its part inside x^2 + y^2 < 0.36: a band between two parallels, trimmed by lines, and a
/// cylinder. Volume 4 pi / 3 0.8^3.
Boundary<3> napkin_ring() {
  const NurbsSurface<3> ball = surface_of(sphere(1.0).patches[0].shape);
  const Interval u = ball.knots_u().domain();
  const Interval v = ball.knots_v().domain();
  const auto parallel = [&](double z) {
    double low = v.first;
    double high = v.last;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (evaluate(ball, Point2(0.3, middle)).z() < z ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  const double below = parallel(-0.8);
  const double above = parallel(0.8);
  const TrimLoop band =
      polygon({Point2(u.first, below), Point2(u.last, below), Point2(u.last, above), Point2(u.first, above)});
  Boundary<3> ring{{{"band", TrimmedSurface(ball, {band})}}};
  for (const Patch<3>& patch : transform(cylinder(0.6, 1.6), translation<3>(Vector3(0, 0, -0.8))).patches) {
    const SurfaceJet<3> jet = evaluate_jet(surface_of(patch.shape), Point2(0.4, 0.4));
    if (std::abs(jet.du.cross(jet.dv).normalized().z()) < 0.5) ring.patches.push_back(patch);
  }
  return ring;
}

TEST(OrientTrimmedShells, TurnsABoxWithAHoleRight) {
  std::mt19937 random(21);
  for (int trial = 0; trial < 30; ++trial) {
    const double angle = std::uniform_real_distribution<double>(0.0, 2.0 * pi)(random);
    const Boundary<3> solid = as_from_a_file(holed_box(angle), random);
    const OrientedBoundary<3> oriented = expect_solid(solid, holed_box_volume);
    EXPECT_EQ(oriented.topology.shells.size(), 1U);
    EXPECT_LE(oriented.topology.largest_gap, 1e-14);
    const AffineMap<3> move = rotation(Axis{Point3(1, 2, 3), Vector3(1, -1, 0.3)}, 1.1);
    expect_solid(transform(solid, move), holed_box_volume);
  }
}

TEST(OrientTrimmedShells, LargestGapIsTheOneThatIsThere) {
  // A pin of a little less radius than the hole's rims, which a file would call closed.
  for (const double gap : {1e-5, 1e-4, 1e-3}) {
    Boundary<3> solid = holed_box(0.3);
    AffineMap<3> shrink;
    shrink.linear.diagonal() << 1.0 - 2.0 * gap, 1.0 - 2.0 * gap, 1.0;
    solid.patches.back().shape = transform(solid.patches.back().shape, shrink);
    const OrientedBoundary<3> strict = orient(solid);
    EXPECT_FALSE(strict.topology.closed);
    EXPECT_EQ(strict.topology.shells.size(), 2U);
    ASSERT_EQ(strict.topology.free_edges.size(), 4U);
    for (const FreeEdge<3>& edge : strict.topology.free_edges) {
      EXPECT_NEAR(edge.gap, gap, 1e-3 * gap);
      EXPECT_NEAR(edge.length, pi, 1e-2);
    }
    const OrientedBoundary<3> oriented = expect_solid(solid, holed_box_volume, 2.0 * gap, for_files());
    EXPECT_NEAR(oriented.topology.largest_gap, gap, 1e-6 * gap);
    EXPECT_NEAR(oriented.topology.largest_gap_place.head<2>().norm(), 0.5, 2.0 * gap);
    EXPECT_GE(oriented.topology.largest_tolerance, gap);
    EXPECT_LE(oriented.topology.largest_tolerance, 2.0 * gap);
  }
}

TEST(OrientTrimmedShells, ClosesGapsLocally) {
  std::mt19937 random(4);
  for (const double relative : {1e-5, 1e-4, 3e-4}) {
    for (int trial = 0; trial < 10; ++trial) {
      const Boundary<3> exact = as_from_a_file(holed_box(0.1 * trial), random);
      const double distance = 0.5 * relative * std::sqrt(9.0);
      const OrientedBoundary<3> oriented =
          expect_solid(shaken(exact, distance, random), holed_box_volume, 10.0 * relative, for_files());
      EXPECT_LE(oriented.topology.largest_gap, 2.0 * distance);
      EXPECT_GE(oriented.topology.largest_gap, 0.2 * distance);
    }
  }
}

TEST(OrientTrimmedShells, GapsNearTheToleranceLeaveSliversThatMeet) {
  std::mt19937 random(44);
  const double volume = 4.0 / 3.0 * pi * 0.512;
  for (int trial = 0; trial < 40; ++trial) {
    const double distance = std::pow(10.0, -6.5 + 0.05 * trial);
    expect_solid(shaken(as_from_a_file(napkin_ring(), random), distance, random), volume, 20.0 * distance, for_files());
  }
}

TEST(OrientTrimmedShells, AGapBesideFineDetailLeavesTheDetailAlone) {
  // A thin plate whose faces are farther apart than their edges are from each other, far less than a gap elsewhere.
  Boundary<3> solid = box(Vector3(1, 1, 1e-4));
  Boundary<3> loose = holed_box();
  AffineMap<3> shrink;
  shrink.linear.diagonal() << 1.0 - 1e-3, 1.0 - 1e-3, 1.0;
  loose.patches.back().shape = transform(loose.patches.back().shape, shrink);
  const Boundary<3> both = together(transform(solid, translation<3>(Vector3(3, 0, 0))), loose, "_loose");
  const OrientedBoundary<3> oriented = expect_solid(both, 1e-4 + holed_box_volume, 2e-3, for_files());
  EXPECT_EQ(oriented.topology.shells.size(), 2U);
}

TEST(OrientTrimmedShells, ThinSolidsStayThick) {
  std::mt19937 random(8);
  for (const double thickness : {1e-3, 1e-6, 1e-7}) {
    expect_solid(as_from_a_file(box(Vector3(1, 2, thickness)), random), 2.0 * thickness);
    expect_solid(as_from_a_file(cylinder(1.0, thickness), random), pi * thickness, 1e-7);
    expect_solid(as_from_a_file(box(Vector3(1, 2, thickness)), random), 2.0 * thickness, 1e-9, for_files());
  }
}

TEST(OrientTrimmedShells, CurvesAreSplitDifferently) {
  // One pcurve with corners around a face against four edges; many short edges against a long one.
  Boundary<3> solid = holed_box();
  for (Patch<3>& patch : solid.patches) {
    const auto* face = std::get_if<TrimmedSurface>(&patch.shape);
    if (face == nullptr) continue;
    std::vector<TrimLoop> loops = face->loops();
    Points<2> corners(2, 5);
    corners << 0, 1, 1, 0, 0, 0, 0, 1, 1, 0;
    loops[0] = {{NurbsCurve<2>::from_points(KnotVector::clamped_uniform(1, 4), corners)}};
    TrimLoop rim;
    NurbsCurve<2> rest = loops[1].curves[0];
    for (int k = 1; k < 37; ++k) {
      const Interval domain = loops[1].curves[0].domain();
      const auto [first, second] = split(rest, domain.first + domain.length() * k / 37.0);
      rim.curves.push_back(first);
      rest = second;
    }
    rim.curves.push_back(rest);
    loops[1] = rim;
    patch.shape = TrimmedSurface(face->surface(), loops);
  }
  const OrientedBoundary<3> oriented = expect_solid(solid, holed_box_volume);
  // The seam of the hole ends where the curves of one rim start, and within one of the other rim's.
  EXPECT_EQ(oriented.topology.edges.size(), 12U + 37U + 38U + 1U);
}

TEST(OrientTrimmedShells, TJunctionsOnTrimmedEdges) {
  std::mt19937 random(2);
  Boundary<3> pieces;
  for (const Patch<3>& patch : holed_box().patches) {
    if (std::holds_alternative<TrimmedSurface>(patch.shape) || patch.name == "hole") {
      pieces.patches.push_back(patch);
      continue;
    }
    const auto [a, b] = split(surface_of(patch.shape), Direction::u, 0.37);
    const auto [c, d] = split(b, Direction::v, 0.61);
    for (const auto& [suffix, part] : {std::pair{"a", a}, std::pair{"c", c}, std::pair{"d", d}})
      pieces.patches.push_back({patch.name + suffix, part, patch.orientation});
  }
  for (int trial = 0; trial < 5; ++trial) expect_solid(as_from_a_file(pieces, random), holed_box_volume);
  expect_solid(shaken(as_from_a_file(pieces, random), 3e-4, random), holed_box_volume, 1e-3, for_files());
}

TEST(OrientTrimmedShells, SeamsMeetThemselves) {
  std::mt19937 random(17);
  const double volume = 4.0 / 3.0 * pi * 0.512;
  for (int trial = 0; trial < 10; ++trial) {
    const OrientedBoundary<3> oriented = expect_solid(as_from_a_file(napkin_ring(), random), volume);
    EXPECT_LE(oriented.topology.largest_gap, 1e-13);
    EXPECT_LE(oriented.topology.largest_tolerance, 4e-6);
  }
}

TEST(OrientTrimmedShells, HalvesOfASphereMeetAtThePole) {
  // Two faces on one closed surface, each with two degenerate curves.
  const NurbsSurface<3> ball = surface_of(sphere(1.0).patches[0].shape);
  Boundary<3> solid;
  for (const auto& [name, from, to] : {std::tuple{"west", 0.0, 0.3}, std::tuple{"east", 0.3, 1.0}}) {
    const TrimLoop loop = polygon({Point2(from, 0), Point2(to, 0), Point2(to, 1), Point2(from, 1)});
    solid.patches.push_back({name, TrimmedSurface(ball, {loop})});
  }
  std::mt19937 random(6);
  const OrientedBoundary<3> oriented = expect_solid(as_from_a_file(solid, random), 4.0 / 3.0 * pi);
  EXPECT_GE(oriented.topology.edges.size(), 2U);
}

/// The cylinder r = 1 about z from z = 0, cut by z = 2 + x / 2, the cut on the cylinder a polygon of `legs` legs in the
/// parameters. Volume 2 pi.
Boundary<3> oblique_cylinder(int legs) {
  Boundary<3> solid;
  for (const Patch<3>& patch : cylinder(1.0, 3.0).patches) {
    const NurbsSurface<3>& surface = surface_of(patch.shape);
    const Vector3 across = evaluate(surface, Point2(0, 1)) - evaluate(surface, Point2(0, 0));
    if (std::abs(across.z()) < 0.5) {
      if (std::abs(evaluate(surface, Point2(0.5, 0.5)).z()) < 0.1) solid.patches.push_back(patch);
      continue;
    }
    const Points<2> zeros = Points<2>::Zero(2, legs + 3);
    Points<2> corners = zeros;
    corners.col(0) << 0, 0;
    corners.col(1) << 1, 0;
    for (int k = 0; k <= legs; ++k) {
      const double u = 1.0 - static_cast<double>(k) / legs;
      corners.col(k + 2) << u, (2.0 + 0.5 * evaluate(surface, Point2(u, 0.0)).x()) / 3.0;
    }
    TrimLoop loop = polygon({corners.col(0), corners.col(1), corners.col(2)});
    loop.curves.pop_back();
    loop.curves.push_back(
        NurbsCurve<2>::from_points(KnotVector::clamped_uniform(1, legs), corners.rightCols(legs + 1)));
    loop.curves.push_back(polygon({corners.col(legs + 2), corners.col(0)}).curves[0]);
    solid.patches.push_back({"side", TrimmedSurface(surface, {loop}), patch.orientation});
  }
  const NurbsSurface<3> lid = plane_through(Point3(-2, -2, 1), Vector3(4, 0, 2), Vector3(0, 4, 0));
  solid.patches.push_back({"lid", TrimmedSurface(lid, {circle_loop(0.25, Point2(0.5, 0.5))})});
  return solid;
}

TEST(OrientTrimmedShells, AFittedCurveMeetsAnExactOne) {
  std::mt19937 random(31);
  for (const int legs : {64, 200}) {
    // The sagitta of a leg, in u, seen along the cylinder.
    const double sagitta = 0.5 * std::pow(2.0 * pi / legs, 2) / 8.0;
    const Boundary<3> solid = as_from_a_file(oblique_cylinder(legs), random);
    const OrientedBoundary<3> oriented = orient(solid, for_files());
    EXPECT_NO_THROW(require_closed(oriented));
    expect_sound(oriented);
    EXPECT_LE(oriented.topology.largest_gap, 2.0 * sagitta);
    EXPECT_GE(oriented.topology.largest_gap, 0.2 * sagitta);
    EXPECT_NEAR(trimmed_measures(oriented.boundary, 8).content, 2.0 * pi, 10.0 * sagitta);
  }
}

TEST(OrientTrimmedShells, BridgesOfGapsInLoopsDisappear) {
  // Loops that a file left open by 1e-5: straight lines across the gaps, which no other face has.
  Boundary<3> solid = holed_box(0.7);
  for (Patch<3>& patch : solid.patches) {
    const auto* face = std::get_if<TrimmedSurface>(&patch.shape);
    if (face == nullptr) continue;
    std::vector<TrimLoop> loops = face->loops();
    const double d = 1e-5;
    loops[0] = polygon({Point2(0, 0), Point2(1, 0), Point2(1, 1), Point2(d, 1), Point2(0, 1 - d)});
    const NurbsCurve<2> rim = loops[1].curves[0];
    const Interval domain = rim.domain();
    const NurbsCurve<2> open = restrict_to(rim, {domain.first, domain.last - 1e-5 * domain.length()});
    Points<2> ends(2, 2);
    ends << evaluate(open, open.domain().last), evaluate(open, open.domain().first);
    loops[1] = {{open, NurbsCurve<2>::from_points(KnotVector::bezier(1), ends)}};
    patch.shape = TrimmedSurface(face->surface(), loops);
  }
  const OrientedBoundary<3> oriented = expect_solid(solid, holed_box_volume, 1e-4, for_files());
  EXPECT_GE(oriented.topology.largest_gap, 1e-5);
  EXPECT_LE(oriented.topology.largest_gap, 1e-4);
}

TEST(OrientTrimmedShells, VoidsAndSeparateSolids) {
  std::mt19937 random(12);
  AffineMap<3> small;
  small.linear *= 0.1;
  small.translation << 0.75, 0.75, 0.5;
  const Boundary<3> cavity = together(holed_box(), transform(holed_box(), small), "_void");
  const Boundary<3> all = together(cavity, transform(napkin_ring(), translation<3>(Vector3(5, 0, 0))), "_ring");
  // In the hole of the box, but not in the box.
  small.translation << 0.0, 0.0, 0.5;
  const Boundary<3> more = together(all, transform(holed_box(), small), "_pin");
  const double volume = holed_box_volume + 4.0 / 3.0 * pi * 0.512;
  for (int trial = 0; trial < 3; ++trial) {
    const OrientedBoundary<3> oriented = expect_solid(as_from_a_file(more, random), volume);
    EXPECT_EQ(oriented.topology.shells.size(), 4U);
    EXPECT_EQ(std::ranges::count_if(oriented.topology.shells, &Shell<3>::is_void), 1);
  }
}

TEST(OrientTrimmedShells, AMissingFaceLeavesItsEdgesFree) {
  std::mt19937 random(9);
  Boundary<3> open = holed_box();
  open.patches.pop_back();
  for (int trial = 0; trial < 5; ++trial) {
    const OrientedBoundary<3> oriented = orient(as_from_a_file(open, random));
    EXPECT_FALSE(oriented.topology.closed);
    EXPECT_EQ(oriented.topology.shells.size(), 1U);
    expect_sound(oriented);
    double length = 0.0;
    for (const FreeEdge<3>& edge : oriented.topology.free_edges) {
      length += edge.length;
      EXPECT_NEAR(edge.from.head<2>().norm(), 0.5, 1e-12);
      EXPECT_GE(edge.nearest, 0);
    }
    EXPECT_NEAR(length, 2.0 * pi, 1e-5);
    EXPECT_THAT(refusal([&] { require_closed(oriented); }), HasSubstr("has a free edge (in curve"));
  }
  // A loose face beside a closed solid.
  Boundary<3> loose = holed_box();
  loose.patches.push_back({"loose", plane_through(Point3(3, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 1))});
  const OrientedBoundary<3> oriented = orient(as_from_a_file(loose, random));
  EXPECT_FALSE(oriented.topology.closed);
  ASSERT_EQ(oriented.topology.shells.size(), 2U);
  EXPECT_NE(oriented.topology.shells[0].closed, oriented.topology.shells[1].closed);
}

TEST(OrientTrimmedShells, SolidsMayTouchAlongAnEdgeOrAFace) {
  std::mt19937 random(14);
  const Boundary<3> one = cube(1.0);
  for (int trial = 0; trial < 5; ++trial) {
    const Boundary<3> edge = together(one, cube(1.0, Point3(1, 1, 0)), "_b");
    const OrientedBoundary<3> along_edge = expect_solid(as_from_a_file(edge, random), 2.0);
    EXPECT_EQ(along_edge.topology.shells.size(), 2U);
    const Boundary<3> face = together(one, cube(1.0, Point3(1, 0, 0)), "_b");
    EXPECT_EQ(expect_solid(as_from_a_file(face, random), 2.0).topology.shells.size(), 2U);
    // Along a part of a face.
    const Boundary<3> part = together(one, cube(0.5, Point3(1, 0.25, 0.5)), "_b");
    EXPECT_EQ(expect_solid(as_from_a_file(part, random), 1.125).topology.shells.size(), 2U);
    const Boundary<3> eight =
        together(edge, together(cube(1.0, Point3(0, 1, 1)), cube(1.0, Point3(1, 0, 1)), "_d"), "_c");
    EXPECT_EQ(expect_solid(as_from_a_file(eight, random), 4.0).topology.shells.size(), 4U);
  }
}

TEST(OrientTrimmedShells, ASolidMayTouchItselfAlongAnEdge) {
  // Two cubes that share an edge, joined by a bridge of two more.
  Boundary<2> outline;
  const std::vector<Point2> corners{Point2(0, 0),   Point2(1, 0),  Point2(1, 1), Point2(2, 1), Point2(2, -1),
                                    Point2(-1, -1), Point2(-1, 2), Point2(1, 2), Point2(1, 1), Point2(0, 1)};
  Boundary<3> solid;
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 a = corners[i];
    const Point2 b = corners[(i + 1) % corners.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    solid.patches.push_back(
        {fmt::format("wall{}", i),
         plane_through(Point3(a.x(), a.y(), 0), Vector3(b.x() - a.x(), b.y() - a.y(), 0), Vector3(0, 0, 1))});
  }
  std::vector<Point2> inside;
  for (const Point2& corner : corners) inside.push_back((corner + Vector2(2, 2)) / 5.0);
  std::ranges::reverse(inside);
  for (const double z : {0.0, 1.0}) {
    const NurbsSurface<3> plane = plane_through(Point3(-2, -2, z), Vector3(5, 0, 0), Vector3(0, 5, 0));
    solid.patches.push_back({fmt::format("end{}", z), TrimmedSurface(plane, {polygon(inside)})});
  }
  std::mt19937 random(15);
  for (int trial = 0; trial < 5; ++trial) {
    const OrientedBoundary<3> oriented = expect_solid(as_from_a_file(solid, random), std::abs(area));
    EXPECT_EQ(oriented.topology.shells.size(), 1U);
  }
}

TEST(OrientTrimmedShells, NamesAFaceThatIsThereTwice) {
  Boundary<3> solid = holed_box();
  Patch<3> again = solid.patches[5];
  again.name = "again";
  again.shape = swapped_face(again.shape);
  solid.patches.push_back(again);
  EXPECT_THAT(refusal([&] { orient(solid); }), AllOf(HasSubstr("'" + solid.patches[5].name + "'"), HasSubstr("'again'"),
                                                     HasSubstr("are the same face, given twice")));
  // All of them.
  const Boundary<3> twice = together(holed_box(), holed_box(), "_again");
  EXPECT_THAT(refusal([&] { orient(twice); }), HasSubstr("are the same face, given twice"));
  // A lens over a face is none.
  Boundary<3> fin = holed_box();
  fin.patches.push_back({"fin", plane_through(Point3(1, 1, 0), Vector3(1, 1, 0), Vector3(0, 0, 1))});
  EXPECT_THAT(refusal([&] { orient(fin); }), HasSubstr("an edge joins two patches at most"));
}

TEST(OrientTrimmedShells, BelievesSharedEdgesOfTheFile) {
  // A hole farther from its rims than any tolerance allows.
  Boundary<3> solid = holed_box(0.25 * pi);
  AffineMap<3> shrink = rotation(Axis{}, 0.25 * pi);
  shrink.linear *= Vector3(0.98, 0.98, 1.0).asDiagonal();
  solid.patches.back().shape = transform(solid.patches.back().shape, shrink);
  EXPECT_FALSE(orient(solid, for_files()).topology.closed);
  OrientationOptions options;
  options.shared_edges.resize(solid.patches.size());
  const auto& hole = std::get<NurbsSurface<3>>(solid.patches.back().shape);
  options.shared_edges.back() = {{-1, -1, -1, -1}};
  for (std::size_t i = 0; i < solid.patches.size(); ++i) {
    const auto* face = std::get_if<TrimmedSurface>(&solid.patches[i].shape);
    if (face == nullptr) continue;
    const double z = evaluate(face->surface(), Point2(0.5, 0.5)).z();
    options.shared_edges[i] = {{-1, -1, -1, -1}, {z > 0.5 ? 7 : 3}};
    for (std::size_t side = 0; side < 4; ++side) {
      const NurbsCurve<3> curve = boundary_curves(hole)[side];
      const Point3 middle = evaluate(curve, curve.domain().middle());
      if (std::abs(middle.z() - z) < 1e-9) options.shared_edges.back()[0][side] = z > 0.5 ? 7 : 3;
    }
  }
  const OrientedBoundary<3> oriented = orient(solid, options);
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_NEAR(oriented.topology.largest_gap, 0.01, 1e-9);
}

TEST(OrientTrimmedShells, BelievesWhichSolidAPatchBelongsTo) {
  // Two cubes that touch along a face, and two that are the same but for their place in the file.
  const Boundary<3> stacked = together(cube(1.0), cube(1.0, Point3(1, 0, 0)), "_b");
  OrientationOptions options;
  options.solids = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};
  EXPECT_EQ(expect_solid(stacked, 2.0, 1e-9, options).topology.shells.size(), 2U);
  const Boundary<3> twice = together(cube(1.0), cube(1.0), "_b");
  EXPECT_THAT(refusal([&] { orient(twice, options); }), HasSubstr("two shells coincide"));
  // A solid with a face of another is open.
  options.solids[0] = 1;
  EXPECT_FALSE(orient(stacked, options).topology.closed);
}

TEST(OrientTrimmedShells, ThreeThousandFacesTakeLessThanTwoSeconds) {
  std::mt19937 random(1);
  Boundary<3> pattern;
  for (int i = 0; i < 430; ++i) {
    const Vector3 place(3.0 * (i % 20), 3.0 * (i / 20 % 20), 3.0 * (i / 400));
    const Boundary<3> copy = as_from_a_file(transform(holed_box(0.01 * i), translation<3>(place)), random);
    pattern = together(std::move(pattern), copy, fmt::format("_{}", i));
  }
  // Of this process: other work on the machine does not count.
  const std::clock_t start = std::clock();
  const OrientedBoundary<3> oriented = orient(pattern, for_files());
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_TRUE(oriented.topology.closed);
  EXPECT_EQ(oriented.topology.shells.size(), 430U);
  EXPECT_LT(seconds, 2.0);
}

}  // namespace
}  // namespace isorim::geometry
