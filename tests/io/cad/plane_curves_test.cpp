#include "io/cad/plane_curves.h"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/transforms.h"
#include "tests/geometry/expect_error.h"

namespace isorim::io {
namespace {

using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

NurbsCurve<3> circle(double radius = 1.0) {
  return geometry::embed(geometry::circle_curve(radius));
}

/// A circle of radius 2 about the origin, turned and moved.
NurbsCurve<3> placed_circle(const Vector3& axis, double angle, const Vector3& by) {
  const auto turn = geometry::rotation(geometry::Axis{Point3::Zero(), axis}, angle);
  return geometry::transform(circle(2.0), geometry::compose<3>(geometry::translation<3>(by), turn));
}

std::vector<NurbsCurve<3>> line(const Point3& from, const Point3& to) {
  Points<3> ends(3, 2);
  ends << from, to;
  return {NurbsCurve<3>::from_points(KnotVector::bezier(1), ends)};
}

TEST(DrawingPlane, HorizontalPlanesKeepEveryBit) {
  const NurbsCurve<3> curve = geometry::transform(circle(0.1), geometry::translation<3>(Vector3(0.3, 0.7, 5.0)));
  const DrawingPlane plane = drawing_plane(std::vector{curve}, 1e-6);
  EXPECT_EQ(plane.deviation, 0.0);
  const NurbsCurve<2> flat = project(curve, plane);
  EXPECT_EQ(flat.homogeneous().topRows<2>(), curve.homogeneous().topRows<2>());
  EXPECT_EQ(flat.homogeneous().row(2), curve.homogeneous().row(3));
  EXPECT_EQ(flat.knots(), curve.knots());
}

TEST(DrawingPlane, UprightPlanesHaveTheAxesOfAnElevation) {
  const double quarter = 0.5 * std::numbers::pi;
  const DrawingPlane front =
      drawing_plane(std::vector{placed_circle(Vector3::UnitX(), quarter, {1.0, 7.0, 2.0})}, 1e-6);
  EXPECT_TRUE(front.x_axis.isApprox(Vector3::UnitX(), 1e-15));
  EXPECT_TRUE(front.y_axis.isApprox(Vector3::UnitZ(), 1e-15));
  EXPECT_TRUE(front.origin.isApprox(Vector3(0.0, 7.0, 0.0), 1e-15));
  const DrawingPlane side =
      drawing_plane(std::vector{placed_circle(Vector3::UnitY(), quarter, {-3.0, 1.0, 2.0})}, 1e-6);
  EXPECT_TRUE(side.x_axis.isApprox(Vector3::UnitY(), 1e-15));
  EXPECT_TRUE(side.y_axis.isApprox(Vector3::UnitZ(), 1e-15));
}

TEST(DrawingPlane, ProjectionOntoAnObliquePlaneKeepsDistances) {
  const NurbsCurve<3> curve = placed_circle({1.0, 2.0, -0.5}, 1.1, {4.0, -2.0, 3.0});
  const DrawingPlane plane = drawing_plane(std::vector{curve}, 1e-6);
  EXPECT_LT(plane.deviation, 1e-14);
  EXPECT_GT(plane.y_axis.z(), 0.0);
  EXPECT_EQ(plane.x_axis.z(), 0.0);
  EXPECT_NEAR(plane.x_axis.dot(plane.y_axis), 0.0, 1e-15);
  EXPECT_NEAR(plane.origin.dot(plane.x_axis), 0.0, 1e-14);
  EXPECT_NEAR(plane.origin.dot(plane.y_axis), 0.0, 1e-14);
  const NurbsCurve<2> flat = project(curve, plane);
  for (double u = 0.0; u < 1.0; u += 0.1) {
    const Point2 q = evaluate(flat, u);
    const Point3 back = plane.origin + q.x() * plane.x_axis + q.y() * plane.y_axis;
    EXPECT_LT((back - evaluate(curve, u)).norm(), 1e-14);
  }
}

TEST(DrawingPlane, TellsHowFarTheCurvesLeaveThePlane) {
  std::vector<NurbsCurve<3>> curves{circle(), geometry::transform(circle(), geometry::translation<3>({0, 0, 1e-8}))};
  EXPECT_NEAR(drawing_plane(curves, 1e-6).deviation, 0.5e-8, 1e-16);
}

TEST(DrawingPlane, RefusesCurvesOfNoPlane) {
  std::vector<NurbsCurve<3>> curves{circle(), placed_circle(Vector3::UnitX(), 1.0, Vector3::Zero())};
  EXPECT_GEOMETRY_ERROR(drawing_plane(curves, 1e-6), "the curves lie in no plane");
}

TEST(DrawingPlane, RefusesAStraightLine) {
  EXPECT_GEOMETRY_ERROR(drawing_plane(line({0, 0, 0}, {1, 2, 3}), 1e-6), "on one straight line");
}

/// The parallelogram origin + u a + v b over [0, 2] x [0, 3], of degree 2 x 3 with inner knots.
NurbsSurface<3> parallelogram() {
  Points<3> corners(3, 4);
  corners << 1.0, 3.0, 1.0, 3.0,  //
      0.0, 2.0, 3.0, 5.0,         //
      0.5, 0.5, 3.5, 3.5;
  NurbsSurface<3> surface =
      NurbsSurface<3>::from_points(KnotVector(1, {0, 0, 2, 2}), KnotVector(1, {0, 0, 3, 3}), corners);
  surface = elevate_degree(surface, geometry::Direction::u, 1);
  surface = elevate_degree(surface, geometry::Direction::v, 2);
  return insert_knot(insert_knot(surface, geometry::Direction::u, 0.7), geometry::Direction::v, 1.9, 2);
}

TEST(FlatFaceEdges, AreTheImagesOfTheLoops) {
  const NurbsSurface<3> surface = parallelogram();
  const NurbsCurve<2> hole =
      reverse(geometry::transform(geometry::circle_curve(0.5), geometry::translation<2>(geometry::Vector2(1.0, 1.5))));
  const geometry::TrimmedSurface face(surface, {geometry::domain_loop(surface), {{hole}}});
  const std::vector<NurbsCurve<3>> edges = flat_face_edges(face);
  ASSERT_EQ(edges.size(), 5U);
  for (double t = 0.0; t < 1.0; t += 0.05) {
    EXPECT_LT((evaluate(edges[4], t) - evaluate(surface, evaluate(hole, t))).norm(), 1e-14);
  }
  EXPECT_LT((evaluate(edges[0], 0.0) - Point3(1.0, 0.0, 0.5)).norm(), 1e-15);
}

TEST(FlatFaceEdges, RefusesSurfacesThatAreNotLinearInTheirParameters) {
  geometry::HomogeneousPoints<3> bent = parallelogram().homogeneous();
  bent(0, 5) += 1e-3;
  const NurbsSurface<3> surface = parallelogram();
  EXPECT_GEOMETRY_ERROR(flat_face_edges(NurbsSurface<3>(surface.knots_u(), surface.knots_v(), bent)), "0.001 off one");
}

}  // namespace
}  // namespace isorim::io
