#include "solver/properties.h"

#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "tests/geometry/tspline/extracted_surfaces.h"

namespace isorim::solver {
namespace {

using geometry::bezier_elements;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using quadrature::Status;
using std::numbers::pi;

TEST(Properties, BoxHasItsTextbookInertia) {
  const auto result = geometric_properties(bezier_elements(geometry::box({1.0, 2.0, 3.0}, {4.0, 5.0, 6.0})));
  ASSERT_TRUE(result.domain);
  EXPECT_NEAR(result.boundary_measure.value, 22.0, 1e-13);
  EXPECT_NEAR(result.domain->measure.value, 6.0, 2e-14);
  EXPECT_LT((result.domain->centroid - Point3(4.5, 6.0, 7.5)).norm(), 1e-14);
  const Vector3 expected(6.0 * (4 + 9) / 12.0, 6.0 * (1 + 9) / 12.0, 6.0 * (1 + 4) / 12.0);
  EXPECT_LT((result.domain->inertia - Eigen::Matrix3d(expected.asDiagonal())).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((result.domain->principal_moments - Vector3(2.5, 5.0, 6.5)).norm(), 1e-13);
  EXPECT_EQ(result.domain_status, Status::exact);
}

TEST(Properties, RectangleHasItsAreaMoments) {
  const auto result = geometric_properties(bezier_elements(geometry::rectangle(Vector2(4.0, 3.0), Point2(1.0, 1.0))));
  EXPECT_NEAR(result.boundary_measure.value, 14.0, 1e-14);
  EXPECT_NEAR(result.domain->measure.value, 12.0, 1e-14);
  EXPECT_NEAR(result.domain->inertia(0, 0), 4.0 * 27.0 / 12.0, 2e-14);
  EXPECT_NEAR(result.domain->inertia(1, 1), 3.0 * 64.0 / 12.0, 2e-14);
  EXPECT_NEAR(result.domain->inertia(0, 1), 0.0, 2e-14);
}

TEST(Properties, InertiaTurnsWithTheBody) {
  const geometry::Boundary<3> box = geometry::box({1.0, 2.0, 3.0});
  const geometry::AffineMap<3> turn = geometry::rotation(geometry::Axis{Point3(1, 1, 0), Vector3(1, 2, 3)}, 0.7);
  const auto still = geometric_properties(bezier_elements(box));
  const auto turned = geometric_properties(bezier_elements(geometry::transform(box, turn)));
  const Eigen::Matrix3d expected = turn.linear * still.domain->inertia * turn.linear.transpose();
  EXPECT_LT((turned.domain->inertia - expected).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((turned.domain->centroid - turn(still.domain->centroid)).norm(), 1e-14);
  const auto& axes = turned.domain->principal_axes;
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-14);
  const Eigen::Matrix3d rebuilt = axes * turned.domain->principal_moments.asDiagonal() * axes.transpose();
  EXPECT_LT((rebuilt - expected).cwiseAbs().maxCoeff(), 1e-13);
}

// M. A. Correia, 2016, chapter 6, reproduced with its own effort of 6 x 6 points a knot span.
TEST(Properties, ThesisSphereAtItsOwnEffort) {
  PropertyOptions<3> options;
  options.integration.fixed_points = 6;
  const auto result = geometric_properties(bezier_elements(geometry::sphere(1.0, Point3(0.5, 0.5, 0.5))), options);
  EXPECT_NEAR(result.domain->measure.value, 4.18878985069, 5e-12);
  EXPECT_NEAR(result.boundary_measure.value, 12.5663695521, 5e-11);
  EXPECT_EQ(result.domain_status, Status::fixed_rule);
}

TEST(Properties, FarAwayBodyKeepsItsInertia) {
  const auto result = geometric_properties(bezier_elements(geometry::sphere(1.0, Point3(1000.0, -2000.0, 500.0))));
  const double expected = 8.0 * pi / 15.0;
  EXPECT_NEAR(result.domain->inertia(0, 0), expected, 1e-11);
  EXPECT_LE(std::abs(result.domain->inertia(0, 0) - expected), 2.0 * result.domain->inertia_error);
  EXPECT_LT((result.domain->centroid - Point3(1000.0, -2000.0, 500.0)).norm(), 1e-12);
}

TEST(Properties, SizeDoesNotMatter) {
  for (const double radius : {1e-9, 1e-3, 1.0, 1e3, 1e9}) {
    const auto result = geometric_properties(bezier_elements(geometry::torus(2.0 * radius, 0.5 * radius)));
    EXPECT_NEAR(result.domain->measure.value / std::pow(radius, 3), pi * pi, 1e-13);
    EXPECT_NEAR(result.boundary_measure.value / std::pow(radius, 2), 4.0 * pi * pi, 1e-13);
    EXPECT_EQ(result.boundary_status, Status::converged);
    EXPECT_EQ(result.domain_status, Status::converged);
  }
}

TEST(Properties, OpenBoundaryHasAnAreaAndADefect) {
  geometry::Boundary<3> half = geometry::box({1.0, 1.0, 1.0});
  half.patches.pop_back();
  PropertyOptions<3> options;
  options.scope = PropertyOptions<3>::Scope::boundary_only;
  const auto result = geometric_properties(bezier_elements(half), options);
  EXPECT_NEAR(result.boundary_measure.value, 5.0, 1e-14);
  EXPECT_NEAR(result.closure_defect, 0.2, 1e-14);
  EXPECT_FALSE(result.domain);
}

// The volume changes with the pole as the pole shift says, and no more than that for any pole in the bounding box.
TEST(Properties, PoleShiftIsWhatTheGapsCost) {
  geometry::Boundary<3> open = geometry::box({1.0, 2.0, 3.0});
  open.patches.pop_back();
  const auto table = bezier_elements(open);
  const auto volume = [&](const Point3& pole) {
    PropertyOptions<3> options;
    options.pole = pole;
    return geometric_properties(table, options);
  };
  const auto middle = volume(Point3(0.5, 1.0, 1.5));
  const Vector3 total_normal = [&] {
    Vector3 normal;
    for (int i = 0; i < 3; ++i) {
      Point3 pole(0.5, 1.0, 1.5);
      pole[i] -= 1e-2;
      normal[i] = 3e2 * (volume(pole).domain->measure.value - middle.domain->measure.value);
    }
    return normal;
  }();
  EXPECT_NEAR(middle.pole_shift, total_normal.norm() * std::sqrt(14.0) / 3.0, 1e-11);
  EXPECT_NEAR(middle.closure_defect, total_normal.norm() / middle.boundary_measure.value, 1e-12);
  const Vector3 diagonal = std::sqrt(14.0) * total_normal.normalized();
  const Point3 moved = Point3(0.5, 1.0, 1.5) - diagonal;
  EXPECT_NEAR(volume(moved).domain->measure.value - middle.domain->measure.value, middle.pole_shift, 1e-12);
}

TEST(Properties, PoleShiftInThePlane) {
  geometry::Boundary<2> open = geometry::rectangle(Vector2(3.0, 4.0));
  open.patches.pop_back();
  PropertyOptions<2> options;
  options.scope = PropertyOptions<2>::Scope::boundary_only;
  const auto result = geometric_properties(bezier_elements(open), options);
  EXPECT_NEAR(result.pole_shift, 4.0 * 5.0 / 2.0, 1e-13);
  const auto closed = geometric_properties(bezier_elements(geometry::rectangle(Vector2(3.0, 4.0))));
  EXPECT_LT(closed.pole_shift, 1e-14);
}

TEST(Properties, InvertedBoundaryIsRefused) {
  geometry::Boundary<3> box = geometry::box({1.0, 1.0, 1.0});
  for (auto& patch : box.patches) patch.orientation = -patch.orientation;
  try {
    geometric_properties(bezier_elements(box));
    FAIL();
  } catch (const GeometryError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("expected a positive volume"));
  }
}

// The middle of the control net is one radius away from the centre of this circle of a single Bézier curve (J. J. Chou,
// Computer-Aided Design 27, 1995), and the low rule of the first pass misjudges its size.
TEST(Properties, ToleranceIsMetWithThePoleFarFromTheCentroid) {
  geometry::HomogeneousPoints<2> net(3, 6);
  net << 5, 1, -3, -3, 1, 5,  //
      0, 4, 2, -2, -4, 0,     //
      5, 1, 1, 1, 1, 5;
  const geometry::NurbsCurve<2> circle(geometry::KnotVector::bezier(5), net);
  const auto table = bezier_elements(geometry::Boundary<2>{{{"circle", circle, 1}}});
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
    PropertyOptions<2> options;
    options.integration.tolerance = tolerance;
    const auto result = geometric_properties(table, options);
    EXPECT_EQ(result.domain_status, Status::converged) << tolerance;
    EXPECT_LE(result.domain->inertia_error, tolerance * pi / 2.0) << tolerance;
    EXPECT_NEAR(result.domain->inertia(0, 0), pi / 4.0, 2.0 * result.domain->inertia_error) << tolerance;
  }
}

TEST(Properties, UnreachableToleranceIsReported) {
  PropertyOptions<3> options;
  options.integration.tolerance = 1e-17;
  const auto result = geometric_properties(bezier_elements(geometry::sphere(1.0)), options);
  EXPECT_EQ(result.boundary_status, Status::limited_by_rounding);
  EXPECT_EQ(result.domain_status, Status::limited_by_rounding);
  EXPECT_NEAR(result.domain->measure.value, 4.0 * pi / 3.0, 1e-14);
}

TEST(Properties, UnresolvedElementIsReported) {
  PropertyOptions<3> options;
  options.integration.max_depth = 0;
  // A hundred to one: one rule of 24 points cannot resolve this rational sphere.
  const auto sphere = bezier_elements(geometry::ellipsoid({1.0, 100.0, 1.0}));
  EXPECT_EQ(geometric_properties(sphere, options).boundary_status, Status::tolerance_not_reached);
}

TEST(Properties, ExtractedSurfacesHaveThoseOfTheNurbsThatTheyWere) {
  namespace test = geometry::testing;
  geometry::Boundary<3> torus = test::extracted(geometry::torus(3.0, 1.0, Point3(1.0, 2.0, 3.0)));
  const auto& whole = std::get<geometry::ExtractedSurface>(torus.patches[0].shape);
  torus.patches[0].shape = test::cut_element(test::cut_element(whole, 3, 0, 0.3), 7, 1, 0.6);
  const auto result = geometric_properties(bezier_elements(torus));
  EXPECT_NEAR(result.boundary_measure.value, 12.0 * pi * pi, 1e-13 * 12.0 * pi * pi);
  EXPECT_NEAR(result.domain->measure.value, 6.0 * pi * pi, 1e-13 * 6.0 * pi * pi);
  EXPECT_LT((result.domain->centroid - Point3(1.0, 2.0, 3.0)).norm(), 1e-13);
  EXPECT_LT(result.closure_defect, 1e-15);
}

}  // namespace
}  // namespace isorim::solver
