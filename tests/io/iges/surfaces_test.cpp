#include "io/iges/surfaces.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "io/iges/analytic_surfaces.h"
#include "tests/geometry/expect_error.h"

namespace isorim::io::iges {
namespace {

using geometry::Axis;
using geometry::Interval;
using geometry::Point2;
using geometry::Point3;
using geometry::Points;
using geometry::SurfaceJet;
using geometry::Vector3;

constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180.0;

Point3 at(const ParametrisedSurface& surface, double u, double v) {
  return evaluate(surface.surface, {surface.parameters.u(u), surface.parameters.v(v)});
}

Vector3 normal_at(const ParametrisedSurface& surface, double u, double v) {
  const SurfaceJet<3> jet = evaluate_jet(surface.surface, {surface.parameters.u(u), surface.parameters.v(v)});
  return jet.du.cross(jet.dv).normalized();
}

/// Calls check(u, v, point) on a grid over a rectangle of IGES parameters.
template <class Check>
void sample(const ParametrisedSurface& surface, const Interval& u, const Interval& v, const Check& check) {
  constexpr int count = 12;
  for (int i = 0; i <= count; ++i)
    for (int j = 0; j <= count; ++j) {
      const double a = i == count ? u.last : u.first + u.length() * i / count;
      const double b = j == count ? v.last : v.first + v.length() * j / count;
      check(a, b, at(surface, a, b));
    }
}

TEST(IgesSurfaces, RevolutionHasGeneratrixAndAngleAsParameters) {
  // A half circle in the x, z plane as made by a matrix, about z: a sphere.
  geometry::AffineMap<3> upright;
  upright.linear << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0;
  const ParametrisedCurve half = transform(arc(0.0, {0.0, 0.0}, {0.0, -1.0}, {0.0, 1.0}), upright);
  for (const Interval angles : {Interval{0.0, 2.0 * pi}, Interval{0.5, 2.5}, Interval{-1.0, 1.0}, Interval{0.0, 0.1}}) {
    const ParametrisedSurface sphere = surface_of_revolution(half, Axis{}, angles.first, angles.last);
    sample(sphere, {1.5 * pi, 2.5 * pi}, angles, [&](double u, double v, const Point3& p) {
      const Point3 expected(std::cos(u) * std::cos(v), std::cos(u) * std::sin(v), std::sin(u));
      EXPECT_LE((p - expected).norm(), 3e-15) << u << " " << v;
    });
  }
  const ParametrisedSurface whole = surface_of_revolution(half, Axis{}, 0.0, 2.0 * pi);
  EXPECT_EQ(whole.parameters.turn_u, 2.0 * pi);
  EXPECT_EQ(whole.parameters.turn_v, 2.0 * pi);
  // S_u x S_v for u along the generatrix (upwards) and v the angle points inwards.
  EXPECT_LT(normal_at(whole, 2.0 * pi + 0.3, 0.4).dot(at(whole, 2.0 * pi + 0.3, 0.4)), -0.99);
}

TEST(IgesSurfaces, RevolutionTouchesTheAxisInOnePoint) {
  const ParametrisedCurve slant = line({0.0, 0.0, 1.0}, {1.0, 0.0, 0.0});
  const ParametrisedSurface cone = surface_of_revolution(slant, Axis{}, 0.0, 2.0 * pi);
  for (const double v : {0.0, 1.0, 3.0, 6.0}) EXPECT_EQ(at(cone, 0.0, v), Point3(0.0, 0.0, 1.0));
}

TEST(IgesSurfaces, RevolutionAboutAnyAxisTurnsRightHanded) {
  const Axis axis{{1.0, 2.0, 3.0}, {0.0, 0.0, -2.0}};
  const ParametrisedSurface surface = surface_of_revolution(line({2.0, 2.0, 0.0}, {2.0, 2.0, 5.0}), axis, 0.0, pi);
  EXPECT_LE((at(surface, 0.2, 0.5 * pi) - Point3(1.0, 1.0, 1.0)).norm(), 2e-15);
}

TEST(IgesSurfaces, AnglesOfRevolutionBeyondAFullTurnAreRefusedButForRounding) {
  const ParametrisedCurve wall = line({1.0, 0.0, 0.0}, {1.0, 0.0, 1.0});
  EXPECT_TRUE(surface_of_revolution(wall, Axis{}, 0.0, 6.283185308).parameters.v.period());
  // As stored: not quite a full turn, and nothing is closed that the file leaves open.
  EXPECT_FALSE(surface_of_revolution(wall, Axis{}, 0.0, 6.283185307).parameters.v.period());
  EXPECT_GEOMETRY_ERROR(surface_of_revolution(wall, Axis{}, 0.0, 7.0), "expected a sweep");
  EXPECT_GEOMETRY_ERROR(surface_of_revolution(wall, Axis{}, 1.0, 1.0), "expected a sweep");
}

TEST(IgesSurfaces, TabulatedCylindersHaveRelativeParameters) {
  const ParametrisedCurve bow = arc(0.5, {0.0, 0.0}, {2.0, 0.0}, {0.0, 2.0});
  const ParametrisedSurface surface = tabulated_cylinder(bow, {3.0, 0.0, 2.5});
  sample(surface, {0.0, 1.0}, {0.0, 1.0}, [](double u, double v, const Point3& p) {
    const double angle = 0.5 * pi * u;
    EXPECT_LE((p - Point3(2.0 * std::cos(angle) + v, 2.0 * std::sin(angle), 0.5 + 2.0 * v)).norm(), 3e-15);
  });
  ASSERT_EQ(surface.alternatives.size(), 1U);
  // Others take the directrix's own angle.
  EXPECT_NEAR(surface.alternatives[0].u(0.3), surface.parameters.u(0.3 / (0.5 * pi)), 1e-15);
  EXPECT_GEOMETRY_ERROR(tabulated_cylinder(bow, {2.0, 0.0, 0.5}), "no length");
}

TEST(IgesSurfaces, RuledSurfacesBetweenLikeCurvesAreExact) {
  const ParametrisedCurve lower = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {-1.0, 0.0});
  const ParametrisedCurve upper = arc(2.0, {0.5, 0.0}, {2.5, 0.0}, {-1.5, 0.0});
  const auto expected = [](double u, double v) {
    const Point3 a(std::cos(pi * u), std::sin(pi * u), 0.0);
    const Point3 b(0.5 + 2.0 * std::cos(pi * u), 2.0 * std::sin(pi * u), 2.0);
    return Point3((1.0 - v) * a + v * b);
  };
  const ParametrisedSurface ruled = ruled_surface(lower, upper, 1e-12);
  EXPECT_EQ(ruled.tolerance, 0.0);
  EXPECT_EQ(ruled.surface.knots_u().degree(), 2);
  const ParametrisedSurface by_length = ruled_by_length(lower, upper, 1e-12);
  EXPECT_EQ(by_length.tolerance, 0.0);
  for (const ParametrisedSurface* surface : {&ruled, &by_length})
    sample(*surface, {0.0, 1.0}, {0.0, 1.0},
           [&](double u, double v, const Point3& p) { EXPECT_LE((p - expected(u, v)).norm(), 3e-15); });
}

TEST(IgesSurfaces, RuledSurfacesBetweenUnlikeCurvesAreFitted) {
  const ParametrisedCurve bow = arc(0.0, {0.0, 0.0}, {1.0, 0.0}, {-1.0, 0.0});
  const ParametrisedCurve edge = line({1.0, 0.0, 1.0}, {-1.0, 0.0, 1.0});
  const ParametrisedSurface surface = ruled_surface(bow, edge, 1e-12);
  EXPECT_EQ(surface.tolerance, 1e-12);
  EXPECT_LE(surface.deviation, 1e-12);
  sample(surface, {0.0, 1.0}, {0.0, 1.0}, [](double u, double v, const Point3& p) {
    const Point3 a(std::cos(pi * u), std::sin(pi * u), 0.0);
    const Point3 b(1.0 - 2.0 * u, 0.0, 1.0);
    EXPECT_LE((p - ((1.0 - v) * a + v * b)).norm(), 2e-12);
  });
}

TEST(IgesSurfaces, RuledByLengthJoinsEqualPartsOfTheLengths) {
  // A parabola, whose parameter is not its length.
  const ParametrisedCurve bent = conic_arc({.a = 1.0, .e = -1.0}, 0.0, {0.0, 0.0}, {1.0, 1.0});
  const ParametrisedCurve edge = line({0.0, 0.0, 1.0}, {4.0, 0.0, 1.0});
  const ParametrisedSurface surface = ruled_by_length(bent, edge, 1e-11);
  EXPECT_LE(surface.deviation, 1e-11);
  EXPECT_GT(surface.tolerance, 0.0);
  const double total = arc_length(bent.curve, bent.curve.domain()).value;
  for (const double u : {0.2, 0.5, 0.9}) {
    const double t = parameter_at_length(bent.curve, u * total);
    EXPECT_LE((at(surface, u, 0.0) - Point3(t, t * t, 0.0)).norm(), 1e-10);
    EXPECT_LE((at(surface, u, 1.0) - Point3(4.0 * u, 0.0, 1.0)).norm(), 1e-10);
  }
}

TEST(IgesSurfaces, ParametricSplineSurfacesAreTheirPolynomials) {
  for (const int degree_u : {1, 2, 3})
    for (const int degree_v : {1, 3}) {
      const std::vector<double> us{0.0, 2.0, 3.0};
      const std::vector<double> vs{-1.0, 1.0};
      Eigen::Matrix<double, 3, 16> patch = Eigen::Matrix<double, 3, 16>::Zero();
      for (int l = 0; l <= degree_v; ++l)
        for (int k = 0; k <= degree_u; ++k)
          patch.col(k + 4 * l) << 1.0 / (1.0 + k + 2 * l), 0.1 * k - 0.3 * l, (k + 1.0) * (l - 0.5);
      const auto value = [&](const Eigen::Matrix<double, 3, 16>& c, double s, double t) {
        Point3 sum = Point3::Zero();
        for (int k = 0; k < 16; ++k) sum += c.col(k) * std::pow(s, k % 4) * std::pow(t, k / 4);
        return sum;
      };
      // The second patch continues the first with its u linear.
      Eigen::Matrix<double, 3, 16> second = Eigen::Matrix<double, 3, 16>::Zero();
      for (int l = 0; l < 4; ++l) {
        for (int k = 0; k < 4; ++k) second.col(4 * l) += patch.col(k + 4 * l) * std::pow(2.0, k);
        if (l <= degree_v) second.col(4 * l + 1) << 1.0, 0.5, 0.25;
      }
      const ParametrisedSurface surface = parametric_spline_surface(us, vs, std::vector{patch, second});
      EXPECT_EQ(surface.surface.knots_u().degree(), degree_u);
      EXPECT_EQ(surface.surface.knots_v().degree(), degree_v);
      sample(surface, {0.0, 3.0}, {-1.0, 1.0}, [&](double u, double v, const Point3& p) {
        const Point3 expected = u < 2.0 ? value(patch, u, v + 1.0) : value(second, u - 2.0, v + 1.0);
        EXPECT_LE((p - expected).norm(), 1e-13 * (1.0 + expected.norm()));
      });
      second.col(0).x() += 0.5;
      EXPECT_GEOMETRY_ERROR(parametric_spline_surface(us, vs, std::vector{patch, second}), "patches are 0.5 apart");
    }
}

TEST(IgesSurfaces, BSplineSurfacesArriveBitForBit) {
  BSplineSurfaceData data;
  data.degree_u = 2;
  data.degree_v = 1;
  data.knots_u = {-1.0, 0.0, 0.0, 0.4, 1.0, 1.0, 2.0};
  data.knots_v = {0.0, 0.0, 1.0, 1.0};
  data.weights.assign(8, 1.0);
  data.weights[3] = 0.3;
  data.points.resize(3, 8);
  for (int i = 0; i < 8; ++i) data.points.col(i) << i % 4, i / 4, 1.0 / (i + 3.0);
  data.range_u = {0.0, 1.0};
  data.range_v = {0.0, 1.0};
  Remark remark;
  const ParametrisedSurface whole = b_spline_surface(data, remark);
  EXPECT_FALSE(remark);
  EXPECT_TRUE(std::ranges::equal(whole.surface.knots_u().knots(), data.knots_u));
  EXPECT_EQ(whole.surface.weights()(3), 0.3);
  for (int i = 0; i < 8; ++i)
    EXPECT_LE((whole.surface.control_points().col(i) - data.points.col(i)).norm(), i == 3 ? 5e-16 : 0.0);
  data.range_u = {0.1, 0.5};
  const ParametrisedSurface part = b_spline_surface(data, remark);
  EXPECT_EQ(part.surface.knots_u().domain().first, 0.1);
  EXPECT_LE((at(part, 0.45, 0.3) - at(whole, 0.45, 0.3)).norm(), 1e-15);
}

AnalyticSurface analytic(AnalyticKind kind) {
  AnalyticSurface surface;
  surface.kind = kind;
  surface.frame = frame_of({1.0, -2.0, 0.5}, {0.0, 3.0, 4.0}, Vector3(1.0, 0.2, -0.1));
  surface.radius = 2.0;
  surface.minor_radius = 0.75;
  if (kind == AnalyticKind::cone) surface.slope = std::tan(30.0 * degree);
  return surface;
}

TEST(IgesSurfaces, FramesAreOrthonormal) {
  for (const Frame& frame : {analytic(AnalyticKind::plane).frame, frame_of({0.0, 0.0, 0.0}, {1.0, 1e-9, 0.0}, {})}) {
    Eigen::Matrix3d axes;
    axes << frame.x, frame.y, frame.z;
    EXPECT_LE((axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 4e-16);
    EXPECT_GT(frame.x.cross(frame.y).dot(frame.z), 0.99);
  }
  EXPECT_GEOMETRY_ERROR(frame_of({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {}), "axis is no direction");
  EXPECT_GEOMETRY_ERROR(frame_of({0.0, 0.0, 0.0}, {0.0, 0.0, 2.0}, Vector3(0.0, 0.0, -1.0)), "parallel");
}

TEST(IgesSurfaces, AnalyticSurfacesHaveTheParametersOfTheStandard) {
  const AnalyticSurface plane = analytic(AnalyticKind::plane);
  const Frame& f = plane.frame;
  sample(finite_part(plane, {{-1.0, 2.0}, {0.5, 4.0}}), {-1.0, 2.0}, {0.5, 4.0},
         [&](double u, double v, const Point3& p) { EXPECT_LE((p - (f.origin + u * f.x + v * f.y)).norm(), 2e-15); });
  const auto radial = [&](double u) { return Vector3(std::cos(u * degree) * f.x + std::sin(u * degree) * f.y); };
  for (const AnalyticKind kind : {AnalyticKind::cylinder, AnalyticKind::cone}) {
    const AnalyticSurface surface = analytic(kind);
    sample(finite_part(surface, {{10.0, 200.0}, {-1.0, 3.0}}), {0.0, 360.0}, {-1.0, 3.0},
           [&](double u, double v, const Point3& p) {
             EXPECT_LE((p - (f.origin + (2.0 + v * surface.slope) * radial(u) + v * f.z)).norm(), 4e-15);
           });
  }
  sample(finite_part(analytic(AnalyticKind::sphere), {{0.0, 360.0}, {-90.0, 90.0}}), {0.0, 360.0}, {-90.0, 90.0},
         [&](double u, double v, const Point3& p) {
           const double w = v * degree;
           EXPECT_LE((p - (f.origin + 2.0 * (std::cos(w) * radial(u) + std::sin(w) * f.z))).norm(), 4e-15);
         });
  sample(finite_part(analytic(AnalyticKind::torus), {{0.0, 360.0}, {0.0, 360.0}}), {0.0, 360.0}, {0.0, 360.0},
         [&](double u, double v, const Point3& p) {
           const double w = u * degree;
           const Point3 expected = f.origin + (2.0 + 0.75 * std::cos(w)) * radial(-v) + 0.75 * std::sin(w) * f.z;
           EXPECT_LE((p - expected).norm(), 5e-15);
         });
}

TEST(IgesSurfaces, NormalsOfAnalyticSurfacesPointOutwards) {
  for (const AnalyticKind kind :
       {AnalyticKind::cylinder, AnalyticKind::cone, AnalyticKind::sphere, AnalyticKind::torus}) {
    const AnalyticSurface surface = analytic(kind);
    const ParametrisedSurface part = finite_part(surface, {{0.0, 360.0}, {0.0, 1.0}});
    const Point3 here = at(part, 20.0, 0.5);
    const Point3 further = at(finite_part(offset(surface, 0.1), {{0.0, 360.0}, {0.0, 1.0}}), 20.0, 0.5);
    EXPECT_GT(normal_at(part, 20.0, 0.5).dot(further - here), 0.09);
  }
}

TEST(IgesSurfaces, ParametersOfPointsComeBack) {
  for (const AnalyticKind kind :
       {AnalyticKind::plane, AnalyticKind::cylinder, AnalyticKind::cone, AnalyticKind::sphere, AnalyticKind::torus}) {
    const AnalyticSurface surface = analytic(kind);
    const ParametrisedSurface part = finite_part(surface, {{0.0, 360.0}, {0.0, 50.0}});
    for (const Point2& uv : {Point2(20.0, 10.0), Point2(200.0, 40.0), Point2(300.0, 5.0)})
      EXPECT_LE((parameters_of(surface, at(part, uv.x(), uv.y())) - uv).norm(), 2e-12);
  }
}

TEST(IgesSurfaces, SeamsLieWhereTheLoopsAreNot) {
  const AnalyticSurface cylinder = analytic(AnalyticKind::cylinder);
  const ParametrisedSurface part = finite_part(cylinder, {{-50.0, 120.0}, {0.0, 1.0}});
  EXPECT_EQ(part.parameters.u.domain().first, -90.0);
  EXPECT_EQ(part.parameters.u(-90.0), 0.0);
  EXPECT_EQ(finite_part(cylinder, {{-1e-13, 360.0}, {0.0, 1.0}}).parameters.u.domain().first, 0.0);
}

TEST(IgesSurfaces, ConesEndAtTheirApex) {
  const AnalyticSurface cone = analytic(AnalyticKind::cone);
  const double apex = -cone.radius / cone.slope;
  const ParametrisedSurface part = finite_part(cone, {{0.0, 360.0}, {apex - 1.0, 1.0}});
  EXPECT_EQ(part.surface.knots_v().domain().first, apex);
  EXPECT_LE((at(part, 0.0, apex) - at(part, 100.0, apex)).norm(), 1e-15);
  EXPECT_GEOMETRY_ERROR(finite_part(cone, {{0.0, 360.0}, {apex - 2.0, apex - 1.0}}), "how far it reaches");
}

TEST(IgesSurfaces, MirroringTurnsTheNormalRound) {
  geometry::AffineMap<3> mirror;
  mirror.linear(0, 0) = -1.0;
  const AnalyticSurface sphere = analytic(AnalyticKind::sphere);
  const ParametrisedSurface image = finite_part(transform(sphere, mirror), {{0.0, 360.0}, {-90.0, 90.0}});
  const ParametrisedSurface original = finite_part(sphere, {{0.0, 360.0}, {-90.0, 90.0}});
  EXPECT_LE((at(image, 30.0, 20.0) - mirror(at(original, 30.0, 20.0))).norm(), 2e-15);
  EXPECT_LT(normal_at(image, 30.0, 20.0).dot(at(image, 30.0, 20.0) - mirror(sphere.frame.origin)), -1.9);
  geometry::AffineMap<3> stretch;
  stretch.linear(0, 0) = 2.0;
  EXPECT_GEOMETRY_ERROR(transform(sphere, stretch), "no rotation");
}

TEST(IgesSurfaces, OffsetsKeepTheirDistance) {
  // A torus by revolution, and a sphere with its poles: offsets are again such.
  geometry::AffineMap<3> upright;
  upright.linear << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0;
  const ParametrisedCurve circle = transform(arc(0.0, {2.0, 0.0}, {2.5, 0.0}, {2.5, 0.0}), upright);
  const ParametrisedSurface torus = surface_of_revolution(circle, Axis{}, 0.0, 2.0 * pi);
  const ParametrisedSurface wider = offset_surface(torus, -0.25, 1e-10);
  EXPECT_LE(wider.deviation, 1e-10);
  sample(wider, {0.0, 2.0 * pi}, {0.0, 2.0 * pi}, [](double u, double v, const Point3& p) {
    const double r = 2.0 + 0.75 * std::cos(u);
    EXPECT_LE((p - Point3(r * std::cos(v), r * std::sin(v), 0.75 * std::sin(u))).norm(), 2e-10);
  });
  const ParametrisedCurve half = transform(arc(0.0, {0.0, 0.0}, {0.0, -1.0}, {0.0, 1.0}), upright);
  const ParametrisedSurface sphere = surface_of_revolution(half, Axis{}, 0.0, 2.0 * pi);
  sample(offset_surface(sphere, -0.5, 1e-10), {1.5 * pi, 2.5 * pi}, {0.0, 2.0 * pi},
         [](double u, double v, const Point3& p) {
           const Point3 expected(std::cos(u) * std::cos(v), std::cos(u) * std::sin(v), std::sin(u));
           EXPECT_LE((p - 1.5 * expected).norm(), 2e-10) << u << " " << v;
         });
}

TEST(IgesSurfaces, OffsetsOfEdgesAreRefused) {
  Points<3> points(3, 3);
  points << 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0;
  const ParametrisedSurface bent = tabulated_cylinder(linear_path(points), {0.0, 0.0, 1.0});
  EXPECT_GEOMETRY_ERROR(offset_surface(bent, 0.1, 1e-9), "has an edge along u = 1");
}

}  // namespace
}  // namespace isorim::io::iges
