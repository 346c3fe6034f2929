#include "geometry/trimming/lifted_curve.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/shapes/solids.h"
#include "tests/geometry/refusals.h"
#include "tests/geometry/topology/trimmed_solids.h"

namespace isorim::geometry {
namespace {

using ::testing::HasSubstr;
using namespace testing;

NurbsSurface<3> smooth_surface(Random& random) {
  const KnotVector u = KnotVector::clamped_uniform(random.integer(2, 4), random.integer(1, 4));
  const KnotVector v = KnotVector::clamped_uniform(random.integer(2, 4), random.integer(1, 4));
  return random_surface<3>(random, u, v);
}

NurbsCurve<2> wandering_curve(Random& random) {
  return blob(random, Point2(0.5, 0.5), 0.45, random.integer(2, 4)).curves[0];
}

double largest_distance(const NurbsSurface<3>& surface, const NurbsCurve<2>& pcurve, const NurbsCurve<3>& curve) {
  double distance = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const double t = pcurve.domain().first + pcurve.domain().length() * i / 400.0;
    distance = std::max(distance, (evaluate(curve, t) - lifted_point(surface, pcurve, t)).norm());
  }
  return distance;
}

TEST(LiftedCurve, TangentsAndNormalsMatchFiniteDifferences) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const NurbsSurface<3> surface = smooth_surface(random);
    const NurbsCurve<2> pcurve = wandering_curve(random);
    const double t = random.inside({pcurve.domain().first + 0.01, pcurve.domain().last - 0.01});
    const double h = 1e-6;
    const LiftedJet jet = lifted_jet(surface, pcurve, t);
    const Vector3 difference =
        (lifted_point(surface, pcurve, t + h) - lifted_point(surface, pcurve, t - h)) / (2.0 * h);
    EXPECT_LE((jet.tangent - difference).norm(), 1e-6 * (1.0 + 100.0 * jet.tangent.norm()));
    EXPECT_EQ(jet.point, lifted_point(surface, pcurve, t));
    const SurfaceJet<3> expected = evaluate_jet(surface, jet.uv);
    const Vector3 normal = expected.du.cross(expected.dv);
    EXPECT_LE((jet.normal - normal).norm(), 1e-11 * (1.0 + normal.norm()));
  }
}

TEST(LiftedCurve, IsExactOnPlanes) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3 a(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    const Vector3 b(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    NurbsSurface<3> plane = plane_through(Point3(random.real(-9, 9), 2, 3), a, b);
    if (trial % 2 == 1) plane = insert_knot(elevate_degree(plane, Direction::u, 2), Direction::u, 0.3);
    if (trial % 3 == 1) plane = elevate_degree(plane, Direction::v, 1);
    const NurbsCurve<2> pcurve = wandering_curve(random);
    const std::optional<NurbsCurve<3>> curve = exact_lift(plane, pcurve);
    ASSERT_TRUE(curve);
    EXPECT_EQ(curve->knots(), pcurve.knots());
    EXPECT_LE(largest_distance(plane, pcurve, *curve), 1e-13);
  }
  // Bent a little, it is none.
  NurbsSurface<3> plane = elevate_degree(plane_through(Point3(0, 0, 0), {1, 0, 0}, {0, 1, 0}), Direction::u, 1);
  HomogeneousPoints<3> net = plane.homogeneous();
  net(2, 1) += 1e-9;
  EXPECT_FALSE(exact_lift(NurbsSurface<3>(plane.knots_u(), plane.knots_v(), net), wandering_curve(random)));
}

TEST(LiftedCurve, IsExactAlongIsoparametricLines) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const NurbsSurface<3> surface = smooth_surface(random);
    const double fixed = random.real(0, 1);
    const double from = trial % 5 == 0 ? 0.0 : random.real(0, 1);
    const double to = trial % 5 == 0 ? 1.0 : random.real(0, 1);
    Points<2> ends(2, 2);
    if (trial % 2 == 0)
      ends << from, to, fixed, fixed;
    else
      ends << fixed, fixed, from, to;
    const KnotVector knots = KnotVector::clamped(1, std::vector<double>{-3.0, 5.0});
    const NurbsCurve<2> pcurve = NurbsCurve<2>::from_points(knots, ends);
    const std::optional<NurbsCurve<3>> curve = exact_lift(surface, pcurve);
    ASSERT_TRUE(curve);
    EXPECT_EQ(curve->degree(), surface.knots(trial % 2 == 0 ? Direction::u : Direction::v).degree());
    EXPECT_LE(largest_distance(surface, pcurve, *curve), 1e-13);
  }
}

TEST(LiftedCurve, StaysWithinTheTolerance) {
  Random random(8);
  for (int trial = 0; trial < 20; ++trial) {
    const NurbsSurface<3> surface = smooth_surface(random);
    const NurbsCurve<2> pcurve = wandering_curve(random);
    EXPECT_FALSE(exact_lift(surface, pcurve));
    double previous = 0.0;
    for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9}) {
      const NurbsCurve<3> curve = lift(surface, pcurve, tolerance);
      EXPECT_LE(largest_distance(surface, pcurve, curve), tolerance);
      EXPECT_EQ(curve.domain().first, pcurve.domain().first);
      EXPECT_EQ(curve.domain().last, pcurve.domain().last);
      // A hundredth of the error for the square root of ten times as many segments, in the limit.
      const double segments = static_cast<double>(curve.knots().breakpoints().size()) - 1.0;
      if (previous > 100.0) {
        EXPECT_LE(segments, 6.0 * previous);
      }
      previous = segments;
    }
  }
  const NurbsSurface<3> plane = plane_through(Point3(0, 0, 0), {1, 0, 0}, {0, 1, 0});
  EXPECT_THAT(refusal([&] { lift(plane, wandering_curve(random), 0.0); }), HasSubstr("the tolerance is 0"));
}

}  // namespace
}  // namespace isorim::geometry
