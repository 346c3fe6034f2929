#include "solver/bem/field_space.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/sweeps.h"
#include "tests/solver/bem/field_spaces.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::NurbsCurve;
using geometry::OrientedBoundary;
using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector;
using geometry::Vector3;
using testing::collocation_matrix;
using testing::condition;
using testing::interpolate;
using testing::interpolation_error;
using testing::largest_error;
using testing::values_at;

template <int Dim>
FieldSpace<Dim> space_on(const Boundary<Dim>& boundary, std::optional<int> degree, int refine) {
  DiscretisationOptions<Dim> options;
  options.degree = degree;
  options.refine = refine;
  return field_space<Dim>(OrientedBoundary<Dim>{boundary, {}}, options);
}

std::vector<Boundary<3>> solids() {
  return {geometry::sphere(1.5, Point3(1.0, 2.0, 3.0)), geometry::torus(2.0, 0.5), geometry::cylinder(1.0, 2.0),
          geometry::cone(1.0, 0.0, 2.0), geometry::cube(2.0)};
}

template <int Dim>
void expect_constants_and_linear_functions(const FieldSpace<Dim>& space) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(space.function_count());
  EXPECT_LT(largest_error<Dim>(space, ones, [](const auto&, const auto&) { return 1.0; }), 2e-15);
  for (int d = 0; d < Dim; ++d)
    EXPECT_LT(interpolation_error<Dim>(space, [d](const Point<Dim>& x, const auto&) { return x(d); }), 1e-14);
}

TEST(FieldSpace, HoldsConstantsAndLinearFunctionsInSpace) {
  for (const Boundary<3>& solid : solids())
    for (const std::optional<int> degree : {std::optional<int>{}, std::optional<int>{3}, std::optional<int>{5}})
      expect_constants_and_linear_functions(space_on(solid, degree, 1));
}

TEST(FieldSpace, HoldsConstantsAndLinearFunctionsInThePlane) {
  for (const Boundary<2>& region : {geometry::disc(2.0, Point2(1.0, -1.0)), geometry::regular_polygon(5, 1.0)})
    for (const std::optional<int> degree : {std::optional<int>{}, std::optional<int>{2}, std::optional<int>{4}})
      expect_constants_and_linear_functions(space_on(region, degree, 2));
}

TEST(FieldSpace, BelowTheDegreeOfTheGeometryHoldsConstants) {
  for (const Boundary<3>& solid : solids()) {
    const FieldSpace<3> space = space_on(solid, 1, 2);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(space.function_count());
    EXPECT_LT(largest_error<3>(space, ones, [](const auto&, const auto&) { return 1.0; }), 1e-15);
  }
}

TEST(FieldSpace, DefaultDegreeIsThatOfTheGeometryAtLeastTwo) {
  EXPECT_EQ(space_on<3>(geometry::cube(1.0), {}, 0).elements[0].degree, (std::array<std::int8_t, 2>{2, 2}));
  const FieldSpace<3> elevated = space_on<3>(
      {{{"patch",
         elevate_degree(geometry::surface_of(geometry::sphere(1.0).patches[0].shape), geometry::Direction::v, 2)}}},
      {}, 0);
  EXPECT_EQ(elevated.elements[0].degree, (std::array<std::int8_t, 2>{2, 4}));
}

TEST(FieldSpace, JetsAreThoseOfDifferences) {
  const FieldSpace<3> space = space_on(geometry::sphere(1.0), 3, 1);
  const double h = 1e-6;
  for (int e = 0; e < 32; e += 5) {
    const Point2 place(0.3, 0.6);
    const Eigen::MatrixXd jets = basis_jets<3>(space, e, place);
    const std::vector<double> values = values_at<3>(space, e, place);
    for (int d = 0; d < 2; ++d) {
      const Point2 step = h * Point2::Unit(d);
      const std::vector<double> after = values_at<3>(space, e, place + step);
      const std::vector<double> before = values_at<3>(space, e, place - step);
      for (std::size_t k = 0; k < values.size(); ++k) {
        EXPECT_NEAR(jets(static_cast<Eigen::Index>(k), 0), values[k], 1e-16);
        EXPECT_NEAR(jets(static_cast<Eigen::Index>(k), d + 1), (after[k] - before[k]) / (2.0 * h), 1e-8);
      }
    }
  }
}

/// All functions at a place, jumps among elements of the grid by which element is asked.
Eigen::VectorXd all_values(const FieldSpace<3>& space, int element, const Point2& place) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(space.function_count());
  const std::vector<double> values = values_at<3>(space, element, place);
  for (std::size_t k = 0; k < values.size(); ++k) result(space.functions_of(element)[k]) = values[k];
  return result;
}

TEST(FieldSpace, IsContinuousInsidePatchesAndAcrossSmoothSeams) {
  const FieldSpace<3> space = space_on(geometry::torus(2.0, 0.5), 3, 1);
  const int n = 8;  // elements in each direction
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Eigen::VectorXd right = all_values(space, i + n * j, Point2(1.0, 0.4));
      EXPECT_LT((right - all_values(space, (i + 1) % n + n * j, Point2(0.0, 0.4))).cwiseAbs().maxCoeff(), 1e-15);
      const Eigen::VectorXd top = all_values(space, i + n * j, Point2(0.4, 1.0));
      EXPECT_LT((top - all_values(space, i + n * ((j + 1) % n), Point2(0.4, 0.0))).cwiseAbs().maxCoeff(), 1e-15);
    }
}

TEST(FieldSpace, IsSmoothAtTheKnotsOfTheRefinement) {
  const FieldSpace<3> space = space_on(geometry::cube(1.0), 3, 1);
  // The slopes by u of the first two elements of a patch, both of the same length.
  const Eigen::MatrixXd left = basis_jets<3>(space, 0, Point2(1.0, 0.3));
  const Eigen::MatrixXd right = basis_jets<3>(space, 1, Point2(0.0, 0.3));
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(space.function_count());
  for (Eigen::Index k = 0; k < left.rows(); ++k)
    difference(space.functions_of(0)[static_cast<std::size_t>(k)]) += left(k, 1);
  for (Eigen::Index k = 0; k < right.rows(); ++k)
    difference(space.functions_of(1)[static_cast<std::size_t>(k)]) -= right(k, 1);
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-14);
}

TEST(FieldSpace, HasOneValueAtAPoleWithATangentPlane) {
  const FieldSpace<3> space = space_on(geometry::sphere(1.0), 2, 1);
  const Eigen::VectorXd here = all_values(space, 0, Point2(0.2, 0.0));
  for (int e = 0; e < 8; ++e) EXPECT_LT((here - all_values(space, e, Point2(0.9, 0.0))).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ((here.array() > 0.5).count(), 1);
}

TEST(FieldSpace, FreesTheFluxAtTheTipOfACone) {
  const FieldSpace<3> space = space_on(geometry::cone(1.0, 0.0, 2.0), 2, 1);
  EXPECT_LT(interpolation_error<3>(space, [](const Point3&, const Vector3& n) { return n.z(); }), 1e-13);
  // The normal turns once around the tip: the rational space of the rim holds it exactly, as it holds the rim.
  EXPECT_LT(interpolation_error<3>(space, [](const Point3&, const Vector3& n) { return n.z() < 0.0 ? 0.0 : n.x(); }),
            1e-13);
}

/// An L-shaped prism as one closed patch around, without its lids.
Boundary<3> creased_ring() {
  geometry::Points<3> corners(3, 7);
  corners << 0, 2, 2, 1, 1, 0, 0,  //
      0, 0, 1, 1, 2, 2, 0,         //
      0, 0, 0, 0, 0, 0, 0;
  return {{{"ring", geometry::extrude(geometry::polyline<3>(corners), Vector3(0.0, 0.0, 1.0))}}};
}

TEST(FieldSpace, JumpsAtCreases) {
  const FieldSpace<3> space = space_on(creased_ring(), 2, 0);
  EXPECT_EQ(space.function_count(), 6 * 9);
  EXPECT_LT(interpolation_error<3>(space, [](const Point3& x, const Vector3& n) { return n.x() + x.y() * n.y(); }),
            1e-13);
}

TEST(FieldSpace, JumpsAtTheCornersOfACurve) {
  geometry::Points<2> corners(2, 5);
  corners << 0, 1, 1, 0, 0,  //
      0, 0, 1, 1, 0;
  const FieldSpace<2> space = space_on<2>({{{"square", geometry::polyline<2>(corners)}}}, 2, 1);
  EXPECT_EQ(space.function_count(), 4 * 4);
}

// A quadratic curve of nominally continuous tangent whose control points coincide: a corner all the same.
TEST(FieldSpace, SeesCreasesThatKnotsDoNotShow) {
  geometry::Points<2> points(2, 5);
  points << 0, 1, 1, 1, 2,  //
      0, 1, 1, 1, 0;
  const NurbsCurve<2> curve = NurbsCurve<2>::from_points(geometry::KnotVector::clamped_uniform(2, 3), points);
  const FieldSpace<2> space = space_on<2>({{{"tent", curve}}}, 2, 0);
  EXPECT_GT(space.function_count(), 5);
}

TEST(FieldSpace, GroupsDoNotShareFunctions) {
  DiscretisationOptions<3> options;
  options.refine = 2;
  options.group = [](int, const Point3& x, const Vector3&) { return x.z() > 0.0 ? 1 : 0; };
  const FieldSpace<3> space = field_space<3>({geometry::sphere(1.0), {}}, options);
  const FieldSpace<3> whole = space_on<3>(geometry::sphere(1.0), {}, 2);
  std::vector<int> group(static_cast<std::size_t>(space.function_count()), -1);
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const auto jet = geometry::evaluate_jet<3>(space.table, space.table.elements[e], Point2(0.5, 0.5));
    const int here = jet.position.z() > 0.0 ? 1 : 0;
    for (const std::int32_t f : space.functions_of(static_cast<int>(e))) {
      int& known = group[static_cast<std::size_t>(f)];
      if (known < 0) known = here;
      EXPECT_EQ(known, here);
    }
  }
  // One more row of functions around the equator.
  EXPECT_EQ(space.function_count(), whole.function_count() + 20);
}

TEST(FieldSpace, PatchesHaveTheirOwnDegreeAndRefinement) {
  DiscretisationOptions<3> options;
  options.degree = 2;
  options.patches = {{"z_min", {.degree = 4, .refine = {}}}, {"x_max", {.degree = {}, .refine = 2}}};
  const FieldSpace<3> space = field_space<3>({geometry::cube(1.0), {}}, options);
  EXPECT_EQ(space.function_count(), 4 * 9 + 25 + 36);
}

TEST(FieldSpace, PointsLieWhereTheySayAndOffEdges) {
  for (const Boundary<3>& solid : solids())
    for (const int degree : {1, 2, 3, 4}) {
      const FieldSpace<3> space = space_on(solid, degree, 2);
      for (const CollocationPoint<3>& point : space.points) {
        const auto jet = geometry::evaluate_jet<3>(
            space.table, space.table.elements[static_cast<std::size_t>(point.element)], point.place);
        EXPECT_EQ(point.position, jet.position);
        EXPECT_NEAR(point.normal.norm(), 1.0, 1e-15);
        EXPECT_GT(point.place.minCoeff(), 0.03);
        EXPECT_LT(point.place.maxCoeff(), 0.97);
      }
    }
}

TEST(FieldSpace, ConditionStaysBoundedUnderRefinement) {
  for (const Boundary<3>& solid : {geometry::sphere(1.0), geometry::cylinder(1.0, 2.0)})
    for (const int degree : {1, 2, 3}) {
      const double bound = degree == 1 ? 3.0 : degree == 2 ? 9.0 : 70.0;
      for (const int refine : {1, 2, 3})
        EXPECT_LT(condition(collocation_matrix(space_on(solid, degree, refine))), bound) << degree << " " << refine;
    }
}

TEST(FieldSpace, InterpolationConvergesWithOrderOneMoreThanTheDegree) {
  const auto f = [](const Point3& x, const Vector3&) { return std::exp(0.5 * x.x()) * std::sin(x.y() + 0.5 * x.z()); };
  for (const Boundary<3>& solid : {geometry::sphere(1.0), geometry::cube(2.0)})
    for (const int degree : {1, 2, 3, 4}) {
      const double coarse = interpolation_error<3>(space_on(solid, degree, 2), f);
      const double fine = interpolation_error<3>(space_on(solid, degree, 3), f);
      EXPECT_GT(std::log2(coarse / fine), degree + 0.6) << degree;
    }
}

template <int Dim>
std::string refusal(const DiscretisationOptions<Dim>& options, const Boundary<Dim>& boundary) {
  try {
    field_space<Dim>({boundary, {}}, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FieldSpace, RefusesWhatCannotBeMeant) {
  using ::testing::HasSubstr;
  DiscretisationOptions<3> options;
  options.degree = 0;
  EXPECT_THAT(refusal(options, geometry::cube(1.0)), HasSubstr("degree of the functions is 0; expected 1 to 15"));
  options.degree = 2;
  options.refine = 13;
  EXPECT_THAT(refusal(options, geometry::cube(1.0)), HasSubstr("refine is 13; expected 0 to 12 bisections"));
  options.refine = 0;
  options.patches = {{"z_mim", {}}};
  EXPECT_THAT(refusal(options, geometry::cube(1.0)), HasSubstr("no patch \"z_mim\"; the patches are \"x_min\""));
  options.patches = {{"z_min", {.degree = 77, .refine = {}}}};
  EXPECT_THAT(refusal(options, geometry::cube(1.0)), HasSubstr("patch \"z_min\": the degree of the functions is 77"));
}

}  // namespace
}  // namespace isorim::solver
