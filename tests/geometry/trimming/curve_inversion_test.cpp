#include "geometry/trimming/curve_inversion.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/shapes/transforms.h"
#include "geometry/trimming/curve_cuts.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using std::numbers::pi;
using testing::Random;

InversionOptions options(double size, double largest_deviation = 1e-3) {
  return {size, 1e-12 * size, largest_deviation};
}

/// The graph of a wavy function over [0, 1]^2, degree p x q, with inner knots of all multiplicities below the degree.
NurbsSurface<3> wavy_surface(Random& random, int p, int q) {
  const auto knots = [&](int degree) {
    std::vector<double> breaks{0.0};
    for (int i = 1; i < 4; ++i)
      breaks.insert(breaks.end(), static_cast<std::size_t>(random.integer(1, degree - 1)), i / 4.0 + 0.03 * i);
    breaks.push_back(1.0);
    return KnotVector::clamped(degree, breaks);
  };
  const KnotVector u = knots(p);
  const KnotVector v = knots(q);
  const std::vector<double> gu = u.greville_abscissae();
  const std::vector<double> gv = v.greville_abscissae();
  Points<3> points(3, u.basis_count() * v.basis_count());
  std::vector<double> weights;
  for (int j = 0; j < v.basis_count(); ++j)
    for (int i = 0; i < u.basis_count(); ++i) {
      points.col(i + j * u.basis_count()) << gu[static_cast<std::size_t>(i)] + random.real(-0.02, 0.02),
          gv[static_cast<std::size_t>(j)] + random.real(-0.02, 0.02), random.real(-0.15, 0.15);
      weights.push_back(random.real(0.8, 1.25));
    }
  return NurbsSurface<3>::from_points(u, v, points, weights);
}

/// A cubic through points of the surface, near it everywhere.
NurbsCurve<3> curve_near(Random& random, const NurbsSurface<3>& surface, double lift) {
  const KnotVector knots = KnotVector::clamped_uniform(3, 12);
  const Point2 from(random.real(0.1, 0.3), random.real(0.1, 0.9));
  const Point2 to(random.real(0.7, 0.9), random.real(0.1, 0.9));
  Points<3> points(3, knots.basis_count());
  const std::vector<double> greville = knots.greville_abscissae();
  for (int i = 0; i < points.cols(); ++i) {
    const Point2 uv = from + greville[static_cast<std::size_t>(i)] * (to - from);
    points.col(i) = evaluate(surface, uv) + Vector3(0, 0, random.real(-lift, lift));
  }
  return NurbsCurve<3>::from_points(knots, points);
}

TEST(CurveInversion, ImagesAreTheNearestPointsOfTheSurface) {
  Random random(1);
  for (int round = 0; round < 24; ++round) {
    const NurbsSurface<3> surface = wavy_surface(random, 2 + round % 3, 2 + round / 3 % 3);
    const NurbsCurve<3> curve = curve_near(random, surface, 1e-3);
    const ParameterRectangle rectangle(surface);
    const CurveInverter inverter(rectangle, options(1.0, 1.0));
    const InvertedCurve inverted = inverter.invert(curve);
    ASSERT_EQ(inverted.curves.size(), 1u);
    double deviation = 0.0;
    for (int k = 0; k <= 60; ++k) {
      // The parameter is the curve's own.
      const double t = k / 60.0;
      const Point3 target = evaluate(curve, t);
      const Point3 image = evaluate(surface, evaluate(inverted.curves[0], t));
      const ClosestSurfacePoint<3> nearest = closest_point(surface, target);
      deviation = std::max(deviation, nearest.distance);
      EXPECT_LT((image - nearest.point).norm(), 4e-12) << "round " << round << ", t = " << t;
    }
    EXPECT_GE(inverted.deviation, 0.95 * deviation);
    EXPECT_LE(inverted.deviation, 1.05 * deviation);
    EXPECT_EQ(inverted.misfit, 0.0);
  }
}

TEST(CurveInversion, ParameterLinesGiveStraightLines) {
  Random random(2);
  const NurbsSurface<3> surface = wavy_surface(random, 3, 3);
  const ParameterRectangle rectangle(surface);
  const CurveInverter inverter(rectangle, options(1.0));
  for (const double value : {0.0, 0.3, 0.56, 0.77, 1.0})
    for (const Direction direction : {Direction::u, Direction::v}) {
      const InvertedCurve inverted = inverter.invert(isoparametric_curve(surface, direction, value));
      ASSERT_EQ(inverted.curves.size(), 1u);
      ASSERT_EQ(inverted.curves[0].degree(), 1);
      const Point2 from = direction == Direction::u ? Point2(0, value) : Point2(value, 0);
      const Point2 to = direction == Direction::u ? Point2(1, value) : Point2(value, 1);
      EXPECT_LT((start_of(inverted.curves[0]) - from).norm(), 1e-14);
      EXPECT_LT((end_of(inverted.curves[0]) - to).norm(), 1e-14);
    }
}

TEST(CurveInversion, CurvesMayStartAnywhereOnAClosedSurface) {
  const NurbsSurface<3> tube = surface_of(cylinder(1.0, 3.0).patches[1].shape);
  const ParameterRectangle rectangle(tube);
  const CurveInverter inverter(rectangle, options(3.0));
  AffineMap<3> shear;
  shear.linear(2, 0) = 0.5;
  shear.linear(2, 1) = -0.3;
  shear.translation.z() = 1.5;
  for (int k = 0; k < 16; ++k) {
    const double start = k * pi / 8;
    const NurbsCurve<3> rim =
        transform(embed(circular_arc(1.0, Point2::Zero(), start, start + (k % 2 == 0 ? 2 : -2) * pi)), shear);
    const InvertedCurve inverted = inverter.invert(rim);
    ASSERT_EQ(inverted.curves.size(), 1u);
    const Point2 advance = end_of(inverted.curves[0]) - start_of(inverted.curves[0]);
    EXPECT_NEAR(advance.x(), k % 2 == 0 ? 1.0 : -1.0, 1e-14);
    EXPECT_NEAR(advance.y(), 0.0, 1e-14);
    for (int i = 0; i <= 100; ++i)
      EXPECT_LT((rectangle.point(evaluate(inverted.curves[0], i / 100.0)) - evaluate(rim, i / 100.0)).norm(), 6e-12);
  }
}

TEST(CurveInversion, ACurveOffTheSurfaceIsGivenUp) {
  const NurbsSurface<3> tube = surface_of(cylinder(1.0, 3.0).patches[1].shape);
  const ParameterRectangle rectangle(tube);
  const CurveInverter inverter(rectangle, options(3.0, 1e-2));
  const InvertedCurve inverted = inverter.invert(line_segment<3>(Point3(1, 0, 1), Point3(0, 1, 2)));
  EXPECT_TRUE(inverted.curves.empty());
  EXPECT_NEAR(inverted.deviation, 1 - std::sqrt(0.5), 1e-2);
}

TEST(ParameterRectangle, FindsSeamsAndPolesFromTheGeometry) {
  const auto kinds = [](const NurbsSurface<3>& surface) {
    const ParameterRectangle rectangle(surface);
    return std::vector<SideKind>{rectangle.side(0), rectangle.side(1), rectangle.side(2), rectangle.side(3)};
  };
  constexpr SideKind open = SideKind::open;
  constexpr SideKind seam = SideKind::seam;
  constexpr SideKind pole = SideKind::pole;
  using Kinds = std::vector<SideKind>;
  EXPECT_EQ(kinds(surface_of(sphere(1.0).patches[0].shape)), (Kinds{pole, seam, pole, seam}));
  EXPECT_EQ(kinds(surface_of(torus(1.0, 0.5).patches[0].shape)), (Kinds{seam, seam, seam, seam}));
  EXPECT_EQ(kinds(surface_of(cylinder(1.0, 1.0).patches[1].shape)), (Kinds{open, seam, open, seam}));
  EXPECT_EQ(kinds(surface_of(box(Vector3(1, 2, 3)).patches[0].shape)), (Kinds{open, open, open, open}));
  const NurbsSurface<3> slit = revolve(line_segment<3>(Point3(1, 0, 0), Point3(1, 0, 1)), {}, 2 * pi * (1 - 1e-4));
  EXPECT_EQ(kinds(slit), (Kinds{open, open, open, open}));
}

}  // namespace
}  // namespace isorim::geometry
