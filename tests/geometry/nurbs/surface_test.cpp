#include "geometry/nurbs/surface.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/geometry/expect_error.h"
#include "tests/geometry/random_splines.h"

namespace isorim::geometry {
namespace {

using testing::Random;
using testing::random_knots;
using testing::random_surface;

constexpr int trials = 100;

NurbsSurface<3> some_surface(Random& random) {
  const KnotVector u = random_knots(random, random.integer(1, 6));
  return random_surface<3>(random, u, random_knots(random, random.integer(1, 6)));
}

Point2 inside(Random& random, const NurbsSurface<3>& surface) {
  const double u = random.inside(surface.knots_u().domain());
  return {u, random.inside(surface.knots_v().domain())};
}

Point3 reference_point(const NurbsSurface<3>& surface, const Point2& uv) {
  const std::vector<long double> u = testing::reference_basis(surface.knots_u(), uv[0], 0);
  const std::vector<long double> v = testing::reference_basis(surface.knots_v(), uv[1], 0);
  Eigen::Matrix<long double, 4, 1> sum = Eigen::Matrix<long double, 4, 1>::Zero();
  for (std::size_t j = 0; j < v.size(); ++j)
    for (std::size_t i = 0; i < u.size(); ++i)
      sum += u[i] * v[j] * surface.homogeneous().col(i + j * u.size()).cast<long double>();
  return (sum.head<3>() / sum[3]).cast<double>();
}

void expect_same(const NurbsSurface<3>& expected, const NurbsSurface<3>& actual, Random& random,
                 double tolerance = 1e-13) {
  for (int i = 0; i < 10; ++i) {
    const Point2 uv = inside(random, actual);
    EXPECT_LE((evaluate(actual, uv) - reference_point(expected, uv)).norm(), tolerance);
  }
}

TEST(NurbsSurface, EvaluationMatchesTheReference) {
  Random random(50);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsSurface<3> surface = some_surface(random);
    expect_same(surface, surface, random, 1e-14);
  }
}

TEST(NurbsSurface, DerivativesAreThoseOfItsIsoparametricCurves) {
  Random random(51);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsSurface<3> surface = some_surface(random);
    const Point2 uv = inside(random, surface);
    const SurfaceJet<3> jet = evaluate_jet(surface, uv);
    const CurveJet<3> along_u = evaluate_jet(isoparametric_curve(surface, Direction::u, uv[1]), uv[0]);
    const CurveJet<3> along_v = evaluate_jet(isoparametric_curve(surface, Direction::v, uv[0]), uv[1]);
    EXPECT_LE((jet.point - along_u.point).norm(), 1e-13);
    EXPECT_LE((jet.du - along_u.du).norm(), 1e-12 * (1 + jet.du.norm()));
    EXPECT_LE((jet.dv - along_v.du).norm(), 1e-12 * (1 + jet.dv.norm()));
    EXPECT_LE((jet.duu - along_u.duu).norm(), 1e-11 * (1 + jet.du.norm() + jet.duu.norm()));
    EXPECT_LE((jet.dvv - along_v.duu).norm(), 1e-11 * (1 + jet.dv.norm() + jet.dvv.norm()));
  }
}

TEST(NurbsSurface, MixedDerivativeMatchesFiniteDifferences) {
  Random random(52);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsSurface<3> surface = some_surface(random);
    const int span = surface.knots_v().find_span(inside(random, surface)[1]);
    const double width = surface.knots_v()[span + 1] - surface.knots_v()[span];
    const Point2 uv(inside(random, surface)[0], surface.knots_v()[span] + width * random.real(0.3, 0.7));
    const double h = 1e-3 * width;
    const auto du = [&](double step) -> Vector<3> { return evaluate_jet(surface, uv + Point2(0, step)).du; };
    const Vector<3> difference = (8.0 * (du(h) - du(-h)) - (du(2 * h) - du(-2 * h))) / (12.0 * h);
    const SurfaceJet<3> jet = evaluate_jet(surface, uv);
    EXPECT_LE((jet.duv - difference).norm(), 1e-5 * (1 + jet.du.norm() / width + jet.duv.norm()));
  }
}

TEST(NurbsSurface, RefinementElevationSplittingClampingChangeNothing) {
  Random random(53);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsSurface<3> surface = some_surface(random);
    const Direction direction = random.integer(0, 1) == 0 ? Direction::u : Direction::v;
    const double u = random.inside(surface.knots(direction).domain());
    const NurbsSurface<3> refined = insert_knot(surface, direction, u, 2);
    expect_same(surface, refined, random);
    expect_same(surface, elevate_degree(surface, direction, random.integer(0, 3)), random);
    expect_same(surface, clamp(surface), random);
    EXPECT_TRUE(clamp(surface).knots_u().is_clamped() && clamp(surface).knots_v().is_clamped());
    const auto [low, high] = split(surface, direction, u);
    expect_same(surface, low, random);
    expect_same(surface, high, random);
    const SurfaceKnotRemoval<3> removal = remove_knot(refined, direction, u, 2, 1e-9);
    EXPECT_EQ(removal.removed, 2);
    EXPECT_EQ(removal.surface.knots(direction), surface.knots(direction));
    expect_same(surface, removal.surface, random, 1e-14 + removal.error_bound);
  }
}

TEST(NurbsSurface, ReversalAndSwapMapTheParametersAndTurnTheNormal) {
  Random random(54);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsSurface<3> surface = some_surface(random);
    const Point2 uv = inside(random, surface);
    const Interval domain = surface.knots_u().domain();
    const SurfaceJet<3> jet = evaluate_jet(surface, uv);
    const double tolerance = 1e-13 + 1e-14 * jet.du.norm();
    const Point2 mirrored(domain.first + (domain.last - uv[0]), uv[1]);
    const SurfaceJet<3> reversed = evaluate_jet(reverse(surface, Direction::u), mirrored);
    const SurfaceJet<3> swapped = evaluate_jet(swap_directions(surface), {uv[1], uv[0]});
    EXPECT_LE((reversed.point - jet.point).norm(), tolerance);
    EXPECT_LE((swapped.point - jet.point).norm(), 1e-14);
    EXPECT_LT(reversed.du.cross(reversed.dv).dot(jet.du.cross(jet.dv)), 0.0);
    EXPECT_LT(swapped.du.cross(swapped.dv).dot(jet.du.cross(jet.dv)), 0.0);
  }
}

TEST(NurbsSurface, IsAffineInvariant) {
  Random random(55);
  for (int trial = 0; trial < trials; ++trial) {
    const NurbsSurface<3> surface = some_surface(random);
    AffineMap<3> map;
    for (double& entry : map.linear.reshaped()) entry = random.real(-1, 1);
    for (double& entry : map.translation) entry = random.real(-1, 1);
    const Point2 uv = inside(random, surface);
    EXPECT_LE((evaluate(transform(surface, map), uv) - map(evaluate(surface, uv))).norm(), 1e-14);
  }
}

TEST(NurbsSurface, BoundaryCurvesOfAClampedSurfaceAreItsOuterRowsBitForBit) {
  Random random(56);
  const KnotVector u = KnotVector::clamped_uniform(3, 4);
  const KnotVector v = KnotVector::clamped_uniform(2, 3);
  const NurbsSurface<3> surface = random_surface<3>(random, u, v);
  const std::array<NurbsCurve<3>, 4> curves = boundary_curves(surface);
  const int nu = surface.count_u();
  const int nv = surface.count_v();
  EXPECT_EQ(curves[0].homogeneous(), surface.homogeneous().leftCols(nu));
  EXPECT_EQ(curves[2].homogeneous(), surface.homogeneous().rightCols(nu));
  for (int j = 0; j < nv; ++j) {
    EXPECT_EQ(curves[1].homogeneous().col(j), surface.homogeneous().col(nu - 1 + j * nu));
    EXPECT_EQ(curves[3].homogeneous().col(j), surface.homogeneous().col(j * nu));
  }
}

TEST(NurbsSurface, RefusesBadInput) {
  const KnotVector knots = KnotVector::bezier(1);
  HomogeneousPoints<3> net = HomogeneousPoints<3>::Ones(4, 4);
  using Surface = NurbsSurface<3>;
  EXPECT_GEOMETRY_ERROR(Surface(knots, KnotVector::bezier(2), net), "4 control points given; the knots need 2 x 3 = 6");
  net(3, 3) = 0.0;
  EXPECT_GEOMETRY_ERROR(Surface(knots, knots, net), "weight (1, 1) is 0");
  net(3, 3) = 1.0;
  net(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_GEOMETRY_ERROR(Surface(knots, knots, net), "coordinate z of control point (0, 1)");
  EXPECT_GEOMETRY_ERROR(Surface::from_points(knots, knots, Points<3>::Ones(3, 4), std::vector<double>{1.0}),
                        "1 weights given for 4 control points");
  const Surface surface = Surface::from_points(knots, knots, Points<3>::Ones(3, 4));
  EXPECT_GEOMETRY_ERROR(split(surface, Direction::v, 1.0), "split parameter 1 is not strictly inside");
  EXPECT_GEOMETRY_ERROR(insert_knot(surface, Direction::u, 0.5, -1), "-1 times asked for");
}

}  // namespace
}  // namespace isorim::geometry
