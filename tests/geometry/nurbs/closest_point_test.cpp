#include <chrono>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/nurbs/curve.h"
#include "geometry/nurbs/surface.h"
#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using std::numbers::pi;
using testing::circle;
using testing::Random;

/// The half circle of radius 1 in the x, z plane from the south to the north pole.
NurbsCurve<2> half_circle() {
  const NurbsCurve<2> whole = circle(1.0, {0, 0});
  const NurbsCurve<2> right = restrict_to(whole, {0.0, 0.5});
  AffineMap<2> turn;
  turn.linear << 0, 1, -1, 0;
  return transform(right, turn);
}

/// The surface of revolution about the z axis of a profile (r, z), plus `slant` of the angle's parameter to z.
NurbsSurface<3> revolve(const NurbsCurve<2>& profile, double slant = 0.0) {
  const NurbsCurve<2> round = circle(1.0, {0, 0});
  const Eigen::Index nu = round.homogeneous().cols();
  const Eigen::Index nv = profile.homogeneous().cols();
  HomogeneousPoints<3> net(4, nu * nv);
  for (Eigen::Index j = 0; j < nv; ++j)
    for (Eigen::Index i = 0; i < nu; ++i) {
      const auto c = round.homogeneous().col(i);
      const auto g = profile.homogeneous().col(j);
      net.col(i + j * nu) << c[0] * g[0], c[1] * g[0], c[2] * (g[1] + slant * static_cast<double>(i) * g[2]),
          c[2] * g[2];
    }
  return {round.knots(), profile.knots(), net};
}

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(ClosestPoint, OnCurvesIsNeverBeatenBySampling) {
  Random random(100);
  for (int trial = 0; trial < 100; ++trial) {
    const NurbsCurve<2> curve = testing::random_curve<2>(random, testing::random_knots(random, random.integer(1, 8)));
    const Point2 target(random.real(-1.5, 1.5), random.real(-1.5, 1.5));
    const ClosestCurvePoint<2> found = closest_point(curve, target);
    EXPECT_NEAR((found.point - target).norm(), found.distance, 1e-14);
    double sampled = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 5000; ++i) {
      const double u = curve.domain().first + i / 5000.0 * curve.domain().length();
      sampled = std::min(sampled, (evaluate(curve, u) - target).norm());
    }
    EXPECT_LE(found.distance, sampled + 1e-14);
    EXPECT_GE(found.distance, sampled - 0.05);
    // The limit from one side where the curve jumps.
    const double left = std::nextafter(found.u, curve.domain().first);
    EXPECT_LE(std::min((evaluate(curve, found.u) - found.point).norm(), (evaluate(curve, left) - found.point).norm()),
              1e-12 * (1 + evaluate_jet(curve, found.u).du.norm()));
  }
}

TEST(ClosestPoint, OnSurfacesIsNeverBeatenBySampling) {
  Random random(101);
  for (int trial = 0; trial < 30; ++trial) {
    const KnotVector u = testing::random_knots(random, random.integer(1, 4));
    const NurbsSurface<3> surface =
        testing::random_surface<3>(random, u, testing::random_knots(random, random.integer(1, 4)));
    const Point3 target(random.real(-1.5, 1.5), random.real(-1.5, 1.5), random.real(-1.5, 1.5));
    const ClosestSurfacePoint<3> found = closest_point(surface, target);
    EXPECT_NEAR((found.point - target).norm(), found.distance, 1e-14);
    double sampled = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 150; ++i)
      for (int j = 0; j <= 150; ++j) {
        const Point2 uv(u.domain().first + i / 150.0 * u.domain().length(),
                        surface.knots_v().domain().first + j / 150.0 * surface.knots_v().domain().length());
        sampled = std::min(sampled, (evaluate(surface, uv) - target).norm());
      }
    EXPECT_LE(found.distance, sampled + 1e-14);
  }
}

TEST(ClosestPoint, PointsOfACurveAreFoundAgain) {
  Random random(102);
  for (int trial = 0; trial < 100; ++trial) {
    const NurbsCurve<3> curve = testing::random_curve<3>(random, testing::random_knots(random, random.integer(1, 8)));
    const Point3 target = evaluate(curve, random.inside(curve.domain()));
    EXPECT_LE(closest_point(curve, target).distance, 1e-14);
  }
}

TEST(ClosestPoint, PointsOfASurfaceAreFoundAgain) {
  Random random(103);
  for (int trial = 0; trial < 50; ++trial) {
    const KnotVector u = testing::random_knots(random, random.integer(1, 4));
    const KnotVector v = testing::random_knots(random, random.integer(1, 4));
    const NurbsSurface<3> surface = testing::random_surface<3>(random, u, v);
    const Point2 uv(random.inside(u.domain()), random.inside(v.domain()));
    EXPECT_LE(closest_point(surface, evaluate(surface, uv)).distance, 1e-14);
  }
}

TEST(ClosestPoint, OnTheCircleIsRadial) {
  const NurbsCurve<2> curve = circle(2.0, {1, 1});
  for (int i = 0; i < 100; ++i) {
    const double angle = 2 * pi * (i + 0.37) / 100;
    const Vector2 direction(std::cos(angle), std::sin(angle));
    for (const double r : {1e-9, 0.5, 1.999999, 2.0, 2.000001, 7.0}) {
      const ClosestCurvePoint<2> found = closest_point<2>(curve, Point2(1, 1) + r * direction);
      EXPECT_NEAR(found.distance, std::abs(r - 2.0), 4e-15 * (2 + r));
      EXPECT_LE((found.point - (Point2(1, 1) + 2 * direction)).norm(), 2e-14 + 1e-14 / r);
    }
  }
}

TEST(ClosestPoint, CentreOfACircleEndsAtOnceWithTheSmallestParameter) {
  const NurbsCurve<2> curve = elevate_degree(circle(2.0, {1, 1}), 3);
  ClosestCurvePoint<2> found;
  EXPECT_LT(seconds_of([&] { found = closest_point<2>(curve, {1, 1}); }), 0.05);
  EXPECT_EQ(found.u, 0.0);
  EXPECT_NEAR(found.distance, 2.0, 2e-15);
}

TEST(ClosestPoint, OfEquallyNearPointsHasTheSmallestParameter) {
  Points<2> points(2, 5);
  points << 2, 1, 0, -1, -2, 0, 1, 0, 1, 0;
  const NurbsCurve<2> zigzag = NurbsCurve<2>::from_points(KnotVector::clamped_uniform(1, 4), points);
  const ClosestCurvePoint<2> peaks = closest_point<2>(zigzag, {0, 3});
  EXPECT_NEAR(peaks.u, 0.25, 1e-15);
  EXPECT_NEAR(peaks.distance, std::sqrt(5.0), 1e-15);
  const ClosestCurvePoint<2> ends = closest_point<2>(circle(1.0, {0, 0}), {1, 0});
  EXPECT_EQ(ends.u, 0.0);
  AffineMap<2> flat;
  flat.linear << 2, 0, 0, 1;
  EXPECT_NEAR(closest_point<2>(transform(circle(1.0, {0, 0}), flat), {0, 0}).u, 0.25, 1e-9);
}

TEST(ClosestPoint, CountsEndsAndKinks) {
  Points<2> points(2, 3);
  points << 0, 1, 2, 0, 1, 0;
  const NurbsCurve<2> roof = NurbsCurve<2>::from_points(KnotVector::clamped_uniform(1, 2), points);
  EXPECT_EQ(closest_point<2>(roof, {1, 5}).u, 0.5);
  EXPECT_EQ(closest_point<2>(roof, {-3, -1}).u, 0.0);
  EXPECT_EQ(closest_point<2>(roof, {9, -1}).u, 1.0);
  const ClosestCurvePoint<2> foot = closest_point<2>(roof, {0, 1});
  EXPECT_NEAR(foot.u, 0.25, 1e-15);
  EXPECT_NEAR(foot.distance, std::sqrt(0.5), 1e-15);
}

TEST(ClosestPoint, SeesBothSidesOfAJump) {
  Points<2> points(2, 4);
  points << 0, 1, 5, 6, 0, 0, 1, 1;
  const NurbsCurve<2> curve = NurbsCurve<2>::from_points(KnotVector(1, {0, 0, 0.5, 0.5, 1, 1}), points);
  const ClosestCurvePoint<2> found = closest_point<2>(curve, {1.5, 0});
  EXPECT_EQ(found.u, 0.5);
  EXPECT_EQ(found.point, Point2(1, 0));
}

TEST(ClosestPoint, OnTheSphereIsRadialFromPoleToPole) {
  const NurbsSurface<3> sphere = revolve(half_circle());
  for (const double latitude : {-pi / 2, -1.2, -1e-9, 0.0, 0.7, pi / 2 - 1e-9, pi / 2}) {
    const Vector3 direction(std::cos(latitude) * std::cos(1.0), std::cos(latitude) * std::sin(1.0), std::sin(latitude));
    for (const double r : {1e-6, 0.5, 1.0 - 1e-9, 1.0, 3.0}) {
      ClosestSurfacePoint<3> found;
      EXPECT_LT(seconds_of([&] { found = closest_point<3>(sphere, r * direction); }), 1.0);
      EXPECT_NEAR(found.distance, std::abs(r - 1.0), 4e-15 * (1 + r)) << latitude << " " << r;
      // A place beside the pole is known only as well as the distance tells it apart from the pole.
      const double beside_pole = std::cos(latitude) < 1e-6 ? 2 * std::cos(latitude) : 0.0;
      EXPECT_LE((found.point - direction).norm(), 1e-13 + 1e-14 / r + beside_pole) << latitude << " " << r;
    }
  }
}

TEST(ClosestPoint, CentreOfASphereAndAxisOfATorusEndAtOnce) {
  const NurbsSurface<3> sphere = revolve(half_circle());
  const NurbsSurface<3> torus = revolve(circle(1.0, {3, 0}));
  EXPECT_LT(seconds_of([&] { EXPECT_NEAR(closest_point<3>(sphere, {0, 0, 0}).distance, 1.0, 1e-15); }), 0.05);
  EXPECT_LT(seconds_of([&] { EXPECT_NEAR(closest_point<3>(torus, {0, 0, 0}).distance, 2.0, 4e-15); }), 0.5);
  EXPECT_LT(seconds_of([&] { EXPECT_NEAR(closest_point<3>(torus, {3, 0, 0}).distance, 1.0, 4e-15); }), 0.5);
}

TEST(ClosestPoint, CurveOfEquallyNearPointsAcrossTheParametersEnds) {
  Points<2> points(2, 2);
  points << 1, 1, -4, 4;
  const NurbsCurve<2> line = NurbsCurve<2>::from_points(KnotVector::bezier(1), points);
  const NurbsSurface<3> slanting = revolve(line, 0.1);
  EXPECT_LT(seconds_of([&] { EXPECT_NEAR(closest_point<3>(slanting, {0, 0, 0.5}).distance, 1.0, 1e-13); }), 5.0);
}

TEST(ClosestPoint, RefusesATargetThatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GEOMETRY_ERROR(closest_point<2>(circle(1, {0, 0}), {0, nan}), "coordinate y of the target is nan");
}

}  // namespace
}  // namespace isorim::geometry
