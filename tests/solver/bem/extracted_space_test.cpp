#include "solver/bem/extracted_space.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/topology/orientation.h"
#include "tests/geometry/tspline/extracted_surfaces.h"
#include "tests/solver/bem/field_spaces.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::Direction;
using geometry::ExtractedSurface;
using geometry::KnotVector;
using geometry::NurbsSurface;
using geometry::Point3;
using geometry::Vector3;
using geometry::testing::extracted;
using testing::collocation_matrix;
using testing::condition;
using testing::interpolation_error;

FieldSpace<3> space_on(const Boundary<3>& boundary, std::optional<int> degree, int refine) {
  DiscretisationOptions<3> options;
  options.degree = degree;
  options.refine = refine;
  return field_space<3>(orient(boundary), options);
}

/// A biquadratic bump over the unit square, 5 x 4 elements; rational if asked for.
NurbsSurface<3> bump(bool rational) {
  const KnotVector u = KnotVector::clamped_uniform(2, 5);
  const KnotVector v = KnotVector::clamped_uniform(2, 4);
  const std::vector<double> s = u.greville_abscissae();
  const std::vector<double> t = v.greville_abscissae();
  geometry::HomogeneousPoints<3> net(4, static_cast<Eigen::Index>(s.size() * t.size()));
  for (std::size_t j = 0; j < t.size(); ++j)
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double w = rational ? 1.0 + 0.3 * std::sin(3.0 * s[i] + t[j]) : 1.0;
      net.col(static_cast<Eigen::Index>(i + j * s.size())) << w * s[i], w * t[j], w * 0.3 * std::cos(2.0 * s[i] - t[j]),
          w;
    }
  return {u, v, net};
}

TEST(ExtractedSpace, IsThatOfTheSplineSurface) {
  for (const bool rational : {false, true}) {
    const Boundary<3> surface{{{"bump", bump(rational)}}};
    const FieldSpace<3> given = space_on(surface, {}, 0);
    const FieldSpace<3> found = space_on(extracted(surface), {}, 0);
    ASSERT_EQ(found.function_count(), given.function_count());
    ASSERT_EQ(found.elements.size(), given.elements.size());
    const auto f = [](const Point3& x, const Vector3&) { return std::sin(2.0 * x.x()) + x.y() * x.z(); };
    EXPECT_LT(interpolation_error<3>(found, f), 3.0 * interpolation_error<3>(given, f));
    EXPECT_LT(condition(collocation_matrix(found)), 10.0 * condition(collocation_matrix(given)));
    EXPECT_LT(interpolation_error<3>(found, [](const Point3& x, const auto&) { return x.x() + x.y() - x.z(); }), 1e-14);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(found.function_count());
    EXPECT_LT(testing::largest_error<3>(found, ones, [](const auto&, const auto&) { return 1.0; }), 2e-15);
  }
}

TEST(ExtractedSpace, TakesHangingEdges) {
  const ExtractedSurface cut = geometry::testing::cut_element(geometry::extracted_surface(bump(true)), 7, 0, 0.5);
  const FieldSpace<3> space = space_on({{{"bump", cut}}}, {}, 0);
  EXPECT_EQ(space.function_count(), 7 * 6);
  EXPECT_EQ(space.elements.size(), 21U);
  EXPECT_LT(interpolation_error<3>(space, [](const Point3& x, const auto&) { return x.x() + x.y() - x.z(); }), 1e-14);
}

TEST(ExtractedSpace, JumpsAtCreases) {
  geometry::Points<3> corners(3, 4);
  corners << 0, 1, 1, 2,  //
      0, 0, 1, 1,         //
      0, 0, 0, 0;
  const NurbsSurface<3> stairs = elevate_degree(
      elevate_degree(geometry::extrude(geometry::polyline<3>(corners), Vector3(0.0, 0.0, 1.0)), Direction::u, 1),
      Direction::v, 1);
  const FieldSpace<3> space = space_on(extracted(Boundary<3>{{{"stairs", stairs}}}), {}, 0);
  EXPECT_EQ(space.function_count(), 3 * 9);
  EXPECT_LT(interpolation_error<3>(space, [](const Point3& x, const Vector3& n) { return n.x() + x.y() * n.y(); }),
            1e-13);
}

TEST(ExtractedSpace, GroupsDoNotShareFunctions) {
  DiscretisationOptions<3> options;
  options.group = [](int, const Point3& x, const Vector3&) { return x.x() > 0.6 ? 1 : 0; };
  const FieldSpace<3> space = field_space<3>(orient(extracted(Boundary<3>{{{"bump", bump(true)}}})), options);
  // Two of the 7 functions in u reach across the line.
  EXPECT_EQ(space.function_count(), (7 + 2) * 6);
  EXPECT_LT(condition(collocation_matrix(space)), 300.0);
}

TEST(ExtractedSpace, RefinementAndOtherDegreesTakeEveryElementByItself) {
  const Boundary<3> sphere = geometry::six_patch_sphere(1.0);
  const auto f = [](const Point3& x, const Vector3&) { return std::exp(x.x()) * std::sin(x.y() + 0.5 * x.z()); };
  for (const int degree : {2, 5})
    for (const int refine : {1, 2}) {
      const FieldSpace<3> given = space_on(sphere, degree, refine);
      const FieldSpace<3> found = space_on(extracted(sphere), degree, refine);
      EXPECT_EQ(found.functions, given.functions);
      const double error = interpolation_error<3>(given, f);
      EXPECT_NEAR(interpolation_error<3>(found, f), error, 1e-9 * error);
    }
  // Nothing is shared across the edges of elements.
  const FieldSpace<3> apart = space_on(extracted(Boundary<3>{{{"bump", bump(true)}}}), 3, 0);
  EXPECT_EQ(apart.function_count(), 5 * 4 * 16);
  EXPECT_LT(interpolation_error<3>(apart, [](const Point3& x, const auto&) { return x.x() + x.y() - x.z(); }), 1e-14);
}

}  // namespace
}  // namespace isorim::solver
