#include "solver/hydrostatics/stability.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "tests/solver/hydrostatics/wigley.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using std::numbers::pi;

/// Length, beam and height; the keel at z = 0.
Boundary<3> barge(double length, double beam, double height) {
  return geometry::box({length, beam, height}, {-0.5 * length, -0.5 * beam, 0.0});
}

TEST(Flotation, BoxSinksToItsVolume) {
  const FloatingBody body(barge(4.0, 2.0, 1.0));
  const FloatingState state = float_at(body, {3.2, {0.0, 0.0, 0.3}}, Vector3::UnitZ());
  EXPECT_EQ(state.status, FlotationStatus::converged);
  EXPECT_NEAR(state.plane.offset, 0.4, 1e-14);
  EXPECT_LE(state.evaluations, 3);
  // GM = KB + BM - KG.
  EXPECT_NEAR(state.transverse_metacentric_height(), 0.2 + 4.0 / (12.0 * 0.4) - 0.3, 1e-13);
  EXPECT_NEAR(state.metacentric_heights(0, 0), 0.2 + 16.0 / (12.0 * 0.4) - 0.3, 1e-13);
}

TEST(Flotation, TooHeavySinksAndNothingIsRefused) {
  const FloatingBody body(barge(4.0, 2.0, 1.0));
  EXPECT_EQ(float_at(body, {8.1, Point3::Zero()}, Vector3::UnitZ()).status, FlotationStatus::sinks);
  EXPECT_EQ(find_equilibria(body, {8.1, Point3::Zero()}, Vector3::UnitZ()).front().state.status,
            FlotationStatus::sinks);
  EXPECT_THROW(float_at(body, {0.0, Point3::Zero()}, Vector3::UnitZ()), InputError);
  // Barely afloat: the whole body is under water but for rounding.
  EXPECT_EQ(float_at(body, {8.0, Point3::Zero()}, Vector3::UnitZ()).status, FlotationStatus::converged);
}

TEST(Flotation, MetacentricHeightsAreSecondDerivativesOfTheEnergy) {
  const FloatingBody body(solver::testing::wigley_hull());
  const Loading loading{1.3, {0.2, 0.03, -0.1}};
  const Vector3 up = up_direction(0.02, 0.25);
  const FloatingState here = float_at(body, loading, up);
  const WaterAxes axes = water_axes(up);
  const double step = 1e-3;
  const auto energy = [&](double forward, double port) {
    const double angle = std::hypot(forward, port);
    const Vector3 towards = (forward * axes.forward + port * axes.port) / angle;
    return float_at(body, loading, std::cos(angle) * up + std::sin(angle) * towards).energy;
  };
  EXPECT_NEAR((energy(step, 0.0) - energy(-step, 0.0)) / (2.0 * step), -here.arms.x(), 1e-5);
  EXPECT_NEAR((energy(0.0, step) - energy(0.0, -step)) / (2.0 * step), -here.arms.y(), 1e-6);
  EXPECT_NEAR((energy(step, 0.0) - 2.0 * here.energy + energy(-step, 0.0)) / (step * step),
              here.metacentric_heights(0, 0), 1e-4 * here.metacentric_heights(0, 0));
  EXPECT_NEAR((energy(0.0, step) - 2.0 * here.energy + energy(0.0, -step)) / (step * step),
              here.metacentric_heights(1, 1), 1e-4);
  const double mixed =
      (energy(step, step) - energy(step, -step) - energy(-step, step) + energy(-step, -step)) / (4.0 * step * step);
  EXPECT_NEAR(mixed, here.metacentric_heights(0, 1), 1e-4);
}

TEST(Flotation, FreeBodyRestsWithItsCentresInOneVertical) {
  const FloatingBody body(solver::testing::wigley_hull());
  const Loading loading{1.5, {0.15, -0.01, -0.35}};
  const std::vector<Equilibrium> found = find_equilibria(body, loading, Vector3::UnitZ());
  ASSERT_EQ(found.size(), 1U);
  const FloatingState& state = found.front().state;
  EXPECT_EQ(state.status, FlotationStatus::converged);
  EXPECT_TRUE(found.front().is_stable);
  EXPECT_NEAR(state.immersed.volume.value, 1.5, 1e-11);
  const Vector3 lever = state.immersed.centre_of_buoyancy - loading.centre_of_gravity;
  EXPECT_LT(lever.cross(state.plane.up).norm(), 1e-10);
  // Bow down (G ahead of amidships), starboard down.
  const Attitude attitude = attitude_of({-0.625, {0.0, 0.0}}, state.plane);
  EXPECT_LT(attitude.trim, -1e-3);
  EXPECT_GT(attitude.heel, 1e-3);
}

// A square log of density 1/2 with G in its middle rests on its edge, not on its side; of density 0.1 on its side.
TEST(Flotation, SquareLogHasUnstableAndStableEquilibria) {
  const FloatingBody log(geometry::box({8.0, 1.0, 1.0}, {-4.0, -0.5, -0.5}));
  const Loading half{4.0, Point3::Zero()};
  const std::vector<Equilibrium> found = find_equilibria(log, half, Vector3::UnitZ());
  ASSERT_EQ(found.size(), 3U);
  EXPECT_FALSE(found[0].is_stable);
  EXPECT_NEAR(found[0].state.smallest_metacentric_height(), 1.0 / 6.0 - 0.25, 1e-13);
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_TRUE(found[i].is_stable);
    const Attitude attitude = attitude_of({0.0, {0.0, 0.0}}, found[i].state.plane);
    EXPECT_NEAR(std::abs(attitude.heel), pi / 4.0, 1e-9);
  }
  const std::vector<Equilibrium> light = find_equilibria(log, {0.8, Point3::Zero()}, Vector3::UnitZ());
  ASSERT_EQ(light.size(), 1U);
  EXPECT_TRUE(light[0].is_stable);
}

// Tilted by wall-sided formulas the log of density 0.25 lolls to tan^2 phi = -2 GM / BM.
TEST(Flotation, AngleOfLollIsTheWallSidedOne) {
  const FloatingBody log(geometry::box({8.0, 1.0, 1.0}, {-4.0, -0.5, -0.5}));
  const double draught = 0.25;
  const double bm = 1.0 / (12.0 * draught);
  const double gm = 0.5 * draught + bm - 0.5;
  ASSERT_LT(gm, 0.0);
  const std::vector<Equilibrium> found = find_equilibria(log, {8.0 * draught, Point3::Zero()}, Vector3::UnitZ());
  ASSERT_EQ(found.size(), 3U);
  const double loll = std::atan(std::sqrt(-2.0 * gm / bm));
  for (const std::size_t i : {1U, 2U})
    EXPECT_NEAR(std::abs(attitude_of({0.0, {0.0, 0.0}}, found[i].state.plane).heel), loll, 1e-10);
}

TEST(Flotation, ComesToRestFromUpsideDown) {
  const FloatingBody body(barge(4.0, 2.0, 1.0));
  for (const Vector3& up : {Vector3(0.3, 0.1, -1.0), Vector3(1.0, 0.2, 0.1), Vector3(0.0, 1.0, -0.2)}) {
    const std::vector<Equilibrium> found = find_equilibria(body, {2.4, {0.0, 0.0, 0.1}}, up);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].state.status, FlotationStatus::converged);
    EXPECT_TRUE(found[0].is_stable);
    EXPECT_NEAR(std::abs(found[0].state.plane.up.z()), 1.0, 1e-12);
  }
}

// --- Righting arms --------------------------------------------------------------------------------------------

std::vector<double> degrees(double from, double to, double step) {
  std::vector<double> result;
  for (double d = from; d <= to + 1e-9; d += step) result.push_back(d * pi / 180.0);
  return result;
}

TEST(RightingCurves, BoxFollowsTheWallSidedFormula) {
  const double beam = 2.0;
  const double draught = 0.5;
  const double kg = 0.6;
  const FloatingBody body(barge(6.0, beam, 1.0));
  const double bm = beam * beam / (12.0 * draught);
  const double gm = 0.5 * draught + bm - kg;
  // Up to where deck and bottom reach the water: tan = 0.5.
  const std::vector<double> heels = degrees(0.0, 26.0, 2.0);
  for (const TrimMode mode : {TrimMode::fixed, TrimMode::free}) {
    RightingOptions options;
    options.mode = mode;
    const RightingCurve curve = righting_curve(body, {6.0 * beam * draught, {0.0, 0.0, kg}}, heels, options);
    for (const RightingPoint& point : curve.points) {
      const double t = std::tan(point.heel);
      EXPECT_NEAR(point.arm, std::sin(point.heel) * (gm + 0.5 * bm * t * t), 1e-13);
      // Moseley: the integral of the wall-sided formula.
      const double c = std::cos(point.heel);
      EXPECT_NEAR(point.area, (gm * (1.0 - c)) + 0.5 * bm * (1.0 / c + c - 2.0), 1e-13);
    }
    ASSERT_EQ(curve.zeros.size(), 1U);
    EXPECT_EQ(curve.zeros[0].heel, 0.0);
    EXPECT_TRUE(curve.zeros[0].is_stable);
    EXPECT_FALSE(curve.vanishing_heel);
  }
}

/// Area, first moments of a polygon.
struct PolygonTruth {
  double area = 0.0;
  Vector2 centroid = Vector2::Zero();
};
PolygonTruth polygon(const std::vector<Vector2>& points) {
  PolygonTruth truth;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2& a = points[i];
    const Vector2& b = points[(i + 1) % points.size()];
    const double cross = a.x() * b.y() - a.y() * b.x();
    truth.area += 0.5 * cross;
    truth.centroid += cross / 6.0 * (a + b);
  }
  truth.centroid /= truth.area;
  return truth;
}

/// GZ of a rectangle at a heel, by polygons and bisection.
double rectangle_arm(double beam, double height, double area, double kg, double heel) {
  // Up turns from z towards +y (port).
  const Vector2 up(std::sin(heel), std::cos(heel));
  const std::vector<Vector2> corners{
      {-0.5 * beam, 0.0}, {0.5 * beam, 0.0}, {0.5 * beam, height}, {-0.5 * beam, height}};
  const auto under = [&](double offset) {
    std::vector<Vector2> kept;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2& a = corners[i];
      const Vector2& b = corners[(i + 1) % 4];
      const double at_a = up.dot(a) - offset;
      const double at_b = up.dot(b) - offset;
      if (at_a <= 0.0) kept.push_back(a);
      if ((at_a < 0.0) != (at_b < 0.0)) kept.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    return kept;
  };
  double low = -3.0 * (beam + height);
  double high = 3.0 * (beam + height);
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    const std::vector<Vector2> kept = under(middle);
    (kept.size() < 3 || polygon(kept).area < area ? low : high) = middle;
  }
  const Vector2 port(std::cos(heel), -std::sin(heel));
  return -(polygon(under(high)).centroid - Vector2(0.0, kg)).dot(port);
}

TEST(RightingCurves, BoxFollowsItsPolygonsOverTheWholeCircle) {
  const double beam = 2.0;
  const double height = 1.0;
  const double draught = 0.4;
  const double kg = 0.75;
  const FloatingBody body(barge(6.0, beam, height));
  RightingOptions options;
  options.mode = TrimMode::fixed;
  const RightingCurve curve =
      righting_curve(body, {6.0 * beam * draught, {0.0, 0.0, kg}}, degrees(0.0, 180.0, 7.5), options);
  for (const RightingPoint& point : curve.points)
    EXPECT_NEAR(point.arm, rectangle_arm(beam, height, beam * draught, kg, point.heel), 1e-12);
  ASSERT_TRUE(curve.vanishing_heel);
  EXPECT_NEAR(rectangle_arm(beam, height, beam * draught, kg, *curve.vanishing_heel), 0.0, 1e-12);
  const double best = curve.heel_of_largest_arm;
  EXPECT_NEAR(curve.largest_arm, rectangle_arm(beam, height, beam * draught, kg, best), 1e-12);
  for (const double beside : {best - 1e-3, best + 1e-3})
    EXPECT_LT(rectangle_arm(beam, height, beam * draught, kg, beside), curve.largest_arm);
}

TEST(RightingCurves, RoundCylinderHasASineForAnArm) {
  const geometry::AffineMap<3> lay = geometry::rotation(geometry::Axis{Point3::Zero(), Vector3::UnitY()}, pi / 2.0);
  const FloatingBody body(geometry::transform(geometry::cylinder(1.0, 6.0, {0.0, 0.0, -3.0}), lay));
  const double depth = 0.3;
  RightingOptions options;
  options.mode = TrimMode::fixed;
  const RightingCurve curve = righting_curve(body, {7.0, {0.0, 0.0, -depth}}, degrees(-30.0, 210.0, 15.0), options);
  for (const RightingPoint& point : curve.points) EXPECT_NEAR(point.arm, depth * std::sin(point.heel), 1e-10);
  EXPECT_NEAR(curve.largest_arm, depth, 1e-10);
  EXPECT_NEAR(curve.heel_of_largest_arm, pi / 2.0, 1e-4);
  ASSERT_TRUE(curve.vanishing_heel);
  EXPECT_NEAR(*curve.vanishing_heel, pi, 1e-9);
}

TEST(RightingCurves, AreaIsTheIntegralOfTheArm) {
  const FloatingBody body(solver::testing::wigley_hull());
  RightingOptions options;
  options.mode = TrimMode::fixed;
  const RightingCurve curve = righting_curve(body, {1.5, {0.0, 0.0, -0.3}}, degrees(0.0, 40.0, 1.0), options);
  double simpson = 0.0;
  const double step = pi / 180.0;
  for (std::size_t i = 0; i + 2 < curve.points.size(); i += 2)
    simpson += step / 3.0 * (curve.points[i].arm + 4.0 * curve.points[i + 1].arm + curve.points[i + 2].arm);
  EXPECT_NEAR(curve.points.back().area, simpson, 1e-7);
}

// With G ahead of B the fixed and the free curve differ; the free one has no trimming moment.
TEST(RightingCurves, FreeTrimTakesTheTrimmingMomentAway) {
  const FloatingBody body(solver::testing::wigley_hull());
  const Loading loading{1.5, {0.1, 0.0, -0.3}};
  const RightingCurve curve = righting_curve(body, loading, degrees(0.0, 60.0, 20.0));
  for (const RightingPoint& point : curve.points) {
    EXPECT_EQ(point.state.status, FlotationStatus::converged);
    EXPECT_LT(std::abs(point.state.arms.x()), 1e-10);
    EXPECT_LT(attitude_of({0.0, {0.0, 0.0}}, point.state.plane).trim, -1e-3);
  }
}

TEST(RightingCurves, RefuseHeelsThatDoNotRise) {
  const FloatingBody body(barge(4.0, 2.0, 1.0));
  EXPECT_THROW(righting_curve(body, {1.0, Point3::Zero()}, {0.1, 0.1}), InputError);
  EXPECT_THROW(righting_curve(body, {1.0, Point3::Zero()}, {}), InputError);
}

TEST(CrossCurves, GiveTheArmForAnyHeightOfTheCentreOfGravity) {
  const FloatingBody body(barge(6.0, 2.0, 1.0));
  const ShipFrame frame = default_frame(body);
  const std::vector<double> heels = degrees(0.0, 60.0, 20.0);
  const CrossCurves curves = cross_curves(body, frame, {3.0, 6.0, 13.0}, heels);
  const double kg = 0.45;
  RightingOptions options;
  options.mode = TrimMode::fixed;
  const RightingCurve curve = righting_curve(body, {6.0, {0.0, 0.0, kg}}, heels, options);
  for (std::size_t i = 0; i < heels.size(); ++i) {
    EXPECT_NEAR(curves.arms(1, static_cast<Eigen::Index>(i)) - kg * std::sin(heels[i]), curve.points[i].arm, 1e-13);
    EXPECT_TRUE(std::isnan(curves.arms(2, static_cast<Eigen::Index>(i))));
  }
}

TEST(BonjeanCurves, AreThoseOfWigleysParabolas) {
  const Boundary<3> hull = solver::testing::wigley_hull();
  const FloatingBody body(hull);
  const geometry::PlaneCutter cutter(hull);
  const std::vector<double> stations{-5.0, -3.1, 0.0, 4.0};
  const std::vector<double> draughts{0.0, 0.2, 0.4, 0.625};
  const BonjeanCurves curves = bonjean_curves(cutter, default_frame(body), stations, draughts);
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index k = 0; k < 4; ++k) {
      const double xi = stations[static_cast<std::size_t>(i)] / 5.0;
      // int_0^d (1 - (z / T - 1)^2) dz = d^2 / T - d^3 / (3 T^2)
      const double d = draughts[static_cast<std::size_t>(k)];
      const double area = (1.0 - xi * xi) * (d * d / 0.625 - d * d * d / (3.0 * 0.625 * 0.625));
      EXPECT_NEAR(curves.areas(i, k), area, 1e-14);
      EXPECT_LE(std::abs(curves.areas(i, k) - area), curves.errors(i, k) + 1e-16);
    }
}

}  // namespace
}  // namespace isorim::solver
