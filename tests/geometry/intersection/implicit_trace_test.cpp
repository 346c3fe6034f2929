#include "geometry/intersection/implicit_trace.h"

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/boundary.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "geometry/topology/point_clusters.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;

constexpr double pi = std::numbers::pi;

NurbsSurface<3> only_surface(const Boundary<3>& boundary) {
  return surface_of(boundary.patches.front().shape);
}

struct Quality {
  /// |F| at 40 points a curve.
  double largest_residual = 0.0;
  /// Curves on whose left F is not negative or on whose right it is not positive.
  int wrong_sides = 0;
  /// Places inside the domain where not as many curves end as start.
  int loose_ends = 0;
  /// Total length in space.
  double length = 0.0;
};

Quality quality(const NurbsSurface<3>& surface, const ImplicitSurface& implicit, const ImplicitTrace& trace) {
  Quality result;
  const Interval u = surface.knots_u().domain();
  const Interval v = surface.knots_v().domain();
  PointClusters<2> ends(1e-8);
  std::map<int, int> balance;
  for (const TracedCurve& traced : trace.curves()) {
    const NurbsCurve<2>& curve = traced.curve;
    Point3 last = evaluate(surface, evaluate(curve, 0.0));
    for (int k = 1; k <= 40; ++k) {
      const Point3 x = evaluate(surface, evaluate(curve, k / 40.0));
      result.largest_residual = std::max(result.largest_residual, std::abs(evaluate(implicit, x)));
      result.length += (x - last).norm();
      last = x;
    }
    const CurveJet<2> middle = evaluate_jet(curve, 0.5);
    const Vector2 left = 1e-3 * std::min(1e-2, middle.du.norm()) * Vector2(-middle.du.y(), middle.du.x()).normalized();
    if (evaluate(implicit, evaluate(surface, middle.point + left)) >= 0.0 ||
        evaluate(implicit, evaluate(surface, middle.point - left)) <= 0.0)
      ++result.wrong_sides;
    --balance[ends.add(evaluate(curve, 0.0))];
    ++balance[ends.add(evaluate(curve, 1.0))];
  }
  for (const auto& [vertex, sum] : balance) {
    const Point2& at = ends[vertex];
    const bool on_boundary =
        std::min(at.x() - u.first, u.last - at.x()) < 1e-8 || std::min(at.y() - v.first, v.last - at.y()) < 1e-8;
    if (sum != 0 && !on_boundary) ++result.loose_ends;
  }
  return result;
}

void expect_traced(const NurbsSurface<3>& surface, const ImplicitSurface& implicit, double residual = 4e-15) {
  const ImplicitTrace trace(surface, implicit);
  const Quality found = quality(surface, implicit, trace);
  EXPECT_LE(found.largest_residual, residual * bounding_box(bezier_elements(Boundary<3>{{{"s", surface}}})).diagonal());
  EXPECT_EQ(found.wrong_sides, 0);
  EXPECT_EQ(found.loose_ends, 0);
  EXPECT_FALSE(trace.curves().empty());
}

double traced_length(const NurbsSurface<3>& surface, const ImplicitSurface& implicit) {
  return quality(surface, implicit, ImplicitTrace(surface, implicit)).length;
}

TEST(ImplicitTrace, PlaneThroughASphereIsACircle) {
  const NurbsSurface<3> surface = only_surface(sphere(1.0));
  const ImplicitSurface plane = implicit_plane(Point3(0.1, 0.2, 0.3), Vector3(1, -2, 0.5));
  expect_traced(surface, plane);
  const double distance = evaluate(plane, Point3::Zero());
  EXPECT_NEAR(traced_length(surface, plane), 2.0 * pi * std::sqrt(1.0 - distance * distance), 1e-3);
}

TEST(ImplicitTrace, PlanesThroughThePolesAreMeridians) {
  const NurbsSurface<3> surface = only_surface(sphere(1.0));
  for (const Vector3& normal : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(1, 1, 0), Vector3(0.3, -0.7, 0)}) {
    const ImplicitSurface plane = implicit_plane(Point3::Zero(), normal);
    expect_traced(surface, plane);
  }
  // Off the seam, where the meridians are inside the domain.
  EXPECT_NEAR(traced_length(surface, implicit_plane(Point3::Zero(), Vector3(0.3, -0.7, 0))), 2.0 * pi, 1e-3);
}

TEST(ImplicitTrace, AlongKnotLinesAreLines) {
  const NurbsSurface<3> surface = only_surface(sphere(1.0));
  const ImplicitTrace trace(surface, implicit_plane(Point3::Zero(), Vector3(0, 0, 1)));
  ASSERT_EQ(trace.curves().size(), 4U);
  for (const TracedCurve& traced : trace.curves()) EXPECT_EQ(traced.curve.degree(), 1);
  expect_traced(surface, implicit_plane(Point3::Zero(), Vector3(0, 0, 1)));
  expect_traced(surface, implicit_plane(Point3::Zero(), Vector3(0, 0, -1)));
}

TEST(ImplicitTrace, TouchingPlanesLeaveNoTrace) {
  const NurbsSurface<3> ball = only_surface(sphere(1.0));
  for (const Vector3& normal :
       {Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(0.36, 0.48, 0.8), Vector3(0.6, 0.0, -0.8)}) {
    EXPECT_TRUE(ImplicitTrace(ball, implicit_plane(normal, normal)).curves().empty());
    EXPECT_TRUE(ImplicitTrace(ball, implicit_plane(normal, -normal)).curves().empty());
  }
  const NurbsSurface<3> ring = only_surface(torus(1.0, 0.5));
  EXPECT_TRUE(ImplicitTrace(ring, implicit_plane(Point3(0, 0, 0.5), Vector3(0, 0, 1))).curves().empty());
  // A cylinder touched along a ruling off the knot lines, and one off the axes of its parameters.
  const NurbsSurface<3> side = surface_of(cylinder(1.0, 2.0).patches[1].shape);
  const Vector3 normal = Vector3(0.6, 0.8, 0);
  EXPECT_TRUE(ImplicitTrace(side, implicit_plane(normal, normal)).curves().empty());
  EXPECT_TRUE(ImplicitTrace(ball, implicit_cylinder(Point3::Zero(), Vector3(1, 2, 3), 1.0)).curves().empty());
}

TEST(ImplicitTrace, NearlyTouchingPlanesAreSmallCircles) {
  const NurbsSurface<3> ball = only_surface(sphere(1.0));
  const Vector3 normal(0.36, 0.48, 0.8);
  for (const double depth : {1e-3, 1e-6, 1e-9}) {
    const ImplicitSurface plane = implicit_plane((1.0 - depth) * normal, normal);
    expect_traced(ball, plane);
    EXPECT_NEAR(traced_length(ball, plane) / (2.0 * pi * std::sqrt(depth * (2.0 - depth))), 1.0, 1e-3) << depth;
  }
}

TEST(ImplicitTrace, TangentPlaneOfATorusIsAFigureEight) {
  for (const double turn : {0.0, 0.3, 0.5, 0.7853981633974483}) {
    const NurbsSurface<3> ring = only_surface(torus(1.0, 0.5));
    const Vector3 normal(std::cos(turn), std::sin(turn), 0);
    expect_traced(ring, implicit_plane(0.5 * normal, normal));
    for (const double shift : {1e-3, -1e-3, 1e-7, -1e-7, 1e-11, -1e-11})
      expect_traced(ring, implicit_plane((0.5 + shift) * normal, normal));
  }
}

TEST(ImplicitTrace, BitangentPlaneOfATorusGivesVillarceauCircles) {
  const NurbsSurface<3> ring = only_surface(torus(1.0, 0.5));
  for (const double turn : {0.0, 0.3}) {
    const Vector3 normal(0.5 * std::cos(turn), 0.5 * std::sin(turn), -std::sqrt(0.75));
    const ImplicitSurface plane = implicit_plane(Point3::Zero(), normal);
    expect_traced(ring, plane);
    EXPECT_NEAR(traced_length(ring, plane), 4.0 * pi, 2e-3);
  }
}

TEST(ImplicitTrace, VivianisWindow) {
  const NurbsSurface<3> ball = only_surface(sphere(1.0));
  expect_traced(ball, implicit_cylinder(Point3(0.5, 0, 0), Vector3(0, 0, 1), 0.5));
  expect_traced(ball, complement(implicit_cylinder(Point3(0.5, 0, 0), Vector3(0, 0, 1), 0.5)));
  for (const double turn : {0.3, 1.1, 2.5}) {
    const Point3 centre(0.5 * std::cos(turn), 0.5 * std::sin(turn), 0);
    expect_traced(ball, implicit_cylinder(centre, Vector3(0, 0, 1), 0.5));
  }
  expect_traced(ball, implicit_cylinder(Point3(0.3, 0.0, 0.4), Vector3(0.8, 0, -0.6), 0.5));
}

TEST(ImplicitTrace, QuadricsOnPrimitives) {
  const NurbsSurface<3> ball = only_surface(sphere(1.0));
  expect_traced(ball, implicit_cylinder(Point3::Zero(), Vector3(0, 0, 1), 0.6));
  expect_traced(ball, implicit_cylinder(Point3(0.3, 0, 0), Vector3(0, 0, 1), 0.4));
  expect_traced(ball, implicit_sphere(Point3(0.3, 0.5, 0.2), 0.9));
  expect_traced(ball, implicit_cone(Point3(0, 0, -1.5), Vector3(0.1, 0, 1), 0.4));
  const NurbsSurface<3> ring = only_surface(torus(1.0, 0.5));
  expect_traced(ring, implicit_cylinder(Point3(0.9, 0.1, 0), Vector3(0.2, 0.3, 1), 0.3));
  expect_traced(ring, implicit_sphere(Point3(0.8, 0.1, 0.3), 0.6));
  const NurbsSurface<3> side = surface_of(cylinder(1.0, 4.0, Point3(0, 0, -2)).patches[1].shape);
  expect_traced(side, implicit_cylinder(Point3::Zero(), Vector3(1, 0, 0), 1.0));
  expect_traced(side, implicit_cylinder(Point3::Zero(), Vector3(1, 0.3, 0), 1.0));
}

TEST(ImplicitTrace, RandomSurfaces) {
  Random random(7);
  for (int round = 0; round < 15; ++round) {
    const KnotVector u = testing::random_knots(random, random.integer(1, 4), testing::Ends::clamped, 1);
    const KnotVector v = testing::random_knots(random, random.integer(1, 4), testing::Ends::clamped, 1);
    const NurbsSurface<3> surface = testing::random_surface<3>(random, u, v);
    const Point3 point = Point3(random.real(-0.2, 0.2), random.real(-0.2, 0.2), random.real(-0.2, 0.2));
    const Vector3 direction(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    SCOPED_TRACE(round);
    expect_traced(surface, implicit_plane(point, direction), 3e-13);
    expect_traced(surface, implicit_cylinder(point, direction, 0.2), 3e-13);
    expect_traced(surface, implicit_sphere(point, 0.3), 3e-13);
  }
}

}  // namespace
}  // namespace isorim::geometry
