#include "solver/bem/trimmed_space.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/intersection/clip.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/sweeps.h"
#include "geometry/trimming/face_locator.h"
#include "tests/solver/bem/field_spaces.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::FaceLocator;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::TrimLoop;
using geometry::TrimmedSurface;
using geometry::Vector3;
using std::numbers::pi;
using testing::collocation_matrix;
using testing::condition;

NurbsSurface<3> unit_square() {
  geometry::Points<3> corners(3, 4);
  corners << 0, 1, 0, 1,  //
      0, 0, 1, 1,         //
      0, 0, 0, 0;
  return NurbsSurface<3>::from_points(geometry::KnotVector::bezier(1), geometry::KnotVector::bezier(1), corners);
}

/// Radius 1, height 2, four rational quadratic elements around.
NurbsSurface<3> cylinder_side() {
  return geometry::extrude(geometry::embed(geometry::unit_arc(0.0, 2.0 * pi)), Vector3(0.0, 0.0, 2.0));
}

TrimLoop polygon(const std::vector<Point2>& corners) {
  geometry::Points<2> points(2, static_cast<Eigen::Index>(corners.size()) + 1);
  for (std::size_t i = 0; i <= corners.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) = corners[i % corners.size()];
  return {{geometry::polyline<2>(points)}};
}

TrimmedSurface square_with_hole() {
  const TrimLoop hole{{geometry::circular_arc(0.3, Point2(0.5, 0.5), 0.0, -2.0 * pi)}};
  return {unit_square(), {geometry::domain_loop(unit_square()), hole}};
}

TrimmedSurface window_of_cylinder() {
  return {cylinder_side(), {polygon({{0.1, 0.1}, {0.27, 0.13}, {0.9, 0.2}, {0.8, 0.9}, {0.4, 0.77}, {0.1, 0.7}})}};
}

FieldSpace<3> space_on(const TrimmedSurface& face, int degree, int refine) {
  DiscretisationOptions<3> options;
  options.degree = degree;
  options.refine = refine;
  return field_space<3>({Boundary<3>{{{"face", face}}}, {}}, options);
}

/// The largest difference over what is kept.
template <class Function>
double error_on(const TrimmedSurface& face, const FieldSpace<3>& space, const Function& f) {
  const FaceLocator locator(face);
  const Eigen::VectorXd coefficients = testing::interpolate<3>(space, f);
  double error = 0.0;
  for (std::size_t e = 0; e < space.elements.size(); ++e)
    for (const double s : {0.02, 0.25, 0.5, 0.75, 0.98})
      for (const double t : {0.02, 0.25, 0.5, 0.75, 0.98}) {
        const geometry::BezierElement<3>& element = space.table.elements[e];
        const Point2 uv(element.domain[0].first + s * element.domain[0].length(),
                        element.domain[1].first + t * element.domain[1].length());
        if (locator.winding_number(uv) != 1) continue;
        const auto jet = geometry::evaluate_jet<3>(space.table, element, Point2(s, t));
        const double value = testing::value<3>(space, coefficients, static_cast<int>(e), Point2(s, t));
        error = std::max(error, std::abs(value - f(jet.position, jet.normal())));
      }
  return error;
}

const std::vector<double> slivers{0.1, 0.03, 1e-2, 3e-3, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};

// Without extensions the condition grows like the sliver to the power of -degree.
TEST(TrimmedSpace, ConditionStaysBoundedAsATrimSlidesAcrossKnotLines) {
  for (const int degree : {1, 2, 3}) {
    const double bound = degree == 1 ? 40.0 : degree == 2 ? 300.0 : 3000.0;
    for (const double sliver : slivers) {
      const TrimmedSurface straight(unit_square(), {polygon({{0, 0}, {0.5 + sliver, 0}, {0.5 + sliver, 1}, {0, 1}})});
      EXPECT_LT(condition(collocation_matrix(space_on(straight, degree, 3))), bound) << degree << " " << sliver;
    }
  }
}

TEST(TrimmedSpace, ConditionStaysBoundedAsACornerSlidesAcrossACrossingOfKnotLines) {
  for (const int degree : {1, 2, 3}) {
    const double bound = degree == 1 ? 60.0 : degree == 2 ? 600.0 : 3000.0;
    for (const double sliver : slivers) {
      const double end = 0.5 + sliver;
      const TrimmedSurface corner(unit_square(), {polygon({{0, 0}, {end, 0}, {end, end}, {0, end}})});
      EXPECT_LT(condition(collocation_matrix(space_on(corner, degree, 3))), bound) << degree << " " << sliver;
      const TrimmedSurface oblique(unit_square(), {polygon({{0, 0}, {1, 0}, {1, sliver}, {sliver, 1}, {0, 1}})});
      EXPECT_LT(condition(collocation_matrix(space_on(oblique, degree, 3))), 4.0 * bound) << degree << " " << sliver;
    }
  }
}

TEST(TrimmedSpace, ConditionStaysBoundedAsATrimSlidesAcrossAKnotOfTheGeometry) {
  for (const int degree : {2, 3})
    for (const double sliver : slivers) {
      const TrimmedSurface face(cylinder_side(),
                                {polygon({{0.0, 0.1}, {0.5 + sliver, 0.1}, {0.5 + sliver, 0.77}, {0.0, 0.7}})});
      EXPECT_LT(condition(collocation_matrix(space_on(face, degree, 2))), degree == 2 ? 800.0 : 1e4)
          << degree << " " << sliver;
    }
}

TEST(TrimmedSpace, HoldsConstantsAndLinearFunctions) {
  for (const TrimmedSurface& face : {square_with_hole(), window_of_cylinder()})
    for (const int degree : {2, 3, 4})
      for (const int refine : {1, 2, 3}) {
        const FieldSpace<3> space = space_on(face, degree, refine);
        const Eigen::VectorXd ones = Eigen::VectorXd::Ones(space.function_count());
        EXPECT_LT(testing::largest_error<3>(space, ones, [](const auto&, const auto&) { return 1.0; }), 1e-14);
        EXPECT_LT(error_on(face, space, [](const Point3& x, const auto&) { return x.x() - 2.0 * x.y() + x.z(); }),
                  degree < 4 ? 1e-13 : 2e-12)
            << degree << " " << refine;
      }
}

TEST(TrimmedSpace, KeepsTheOrderOfApproximation) {
  const auto f = [](const Point3& x, const Vector3&) { return std::exp(x.x()) * std::sin(2.0 * x.y() + x.z()); };
  for (const TrimmedSurface& face : {square_with_hole(), window_of_cylinder()})
    for (const int degree : {1, 2, 3}) {
      const int refine = degree == 1 ? 3 : 2;
      const double coarse = error_on(face, space_on(face, degree, refine), f);
      const double fine = error_on(face, space_on(face, degree, refine + 2), f);
      EXPECT_GT(0.5 * std::log2(coarse / fine), degree + 0.6) << degree << " " << coarse << " " << fine;
    }
}

TEST(TrimmedSpace, PointsAreKeptAndOffTheTrims) {
  for (const TrimmedSurface& face : {square_with_hole(), window_of_cylinder()}) {
    const FaceLocator locator(face);
    const FieldSpace<3> space = space_on(face, 2, 3);
    for (const CollocationPoint<3>& point : space.points) {
      const geometry::BezierElement<3>& element = space.table.elements[static_cast<std::size_t>(point.element)];
      const Point2 uv(element.domain[0].first + point.place.x() * element.domain[0].length(),
                      element.domain[1].first + point.place.y() * element.domain[1].length());
      EXPECT_EQ(locator.winding_number(uv, 1e-3), 1);
      EXPECT_GT(point.place.minCoeff(), 0.0);
      EXPECT_LT(point.place.maxCoeff(), 1.0);
    }
  }
}

TEST(TrimmedSpace, OfEverythingIsTheSpaceOfTheWhole) {
  const TrimmedSurface face(cylinder_side(), {geometry::domain_loop(cylinder_side())});
  const FieldSpace<3> trimmed = space_on(face, 3, 1);
  DiscretisationOptions<3> options;
  options.degree = 3;
  options.refine = 1;
  const FieldSpace<3> whole = field_space<3>({Boundary<3>{{{"face", cylinder_side()}}}, {}}, options);
  ASSERT_EQ(trimmed.function_count(), whole.function_count());
  EXPECT_EQ(trimmed.functions, whole.functions);
  EXPECT_EQ(trimmed.rows, whole.rows);
  for (int i = 0; i < whole.function_count(); ++i)
    EXPECT_EQ(trimmed.points[static_cast<std::size_t>(i)].position, whole.points[static_cast<std::size_t>(i)].position);
}

TrimmedSurface only(const TrimLoop& loop) {
  return {unit_square(), {loop}};
}

const auto linear = [](const Point3& x, const auto&) { return 2.0 - x.x() + 3.0 * x.y(); };

// What tells functions of a large cell from one another is small there.
TEST(TrimmedSpace, OfASmallPieceOfOneCellIsWellConditioned) {
  for (const double radius : {0.3, 0.15, 1e-2, 1e-4, 1e-6})
    for (const int degree : {1, 2, 3, 4}) {
      const TrimmedSurface disc = only({{geometry::circular_arc(radius, Point2(0.62, 0.58), 0.0, 2.0 * pi)}});
      const FieldSpace<3> space = space_on(disc, degree, 0);
      EXPECT_EQ(space.function_count(), (degree + 1) * (degree + 1));
      EXPECT_LT(condition(collocation_matrix(space)), degree < 3 ? 100.0 : 5e4) << degree << " " << radius;
      EXPECT_LT(error_on(disc, space, linear), 1e-12 / radius) << degree << " " << radius;
      const TrimmedSurface corner = only(polygon({{1.0 - radius, 1.0}, {1.0, 1.0 - radius}, {1.0, 1.0}}));
      const FieldSpace<3> small = space_on(corner, degree, 1);
      EXPECT_LT(condition(collocation_matrix(small)), degree < 3 ? 100.0 : 5e4) << degree << " " << radius;
      EXPECT_LT(error_on(corner, small, linear), 1e-12 / radius) << degree << " " << radius;
    }
}

TEST(TrimmedSpace, OfAThinPieceIsWellConditioned) {
  for (const double width : {0.1, 1e-2, 1e-3, 1e-5, 1e-8})
    for (const int degree : {1, 2, 3})
      for (const int refine : {0, 2}) {
        const TrimmedSurface strip = only(polygon({{0.1, 0.2}, {0.8, 0.7}, {0.8, 0.7 + width}, {0.1, 0.2 + width}}));
        const FieldSpace<3> space = space_on(strip, degree, refine);
        EXPECT_LT(condition(collocation_matrix(space)), degree < 3 ? 1e3 : 1e4) << degree << " " << width;
        // What varies less than can be told from a constant is a constant.
        EXPECT_LT(error_on(strip, space, linear), width > 1e-5 ? 1e-10 : 3.0 * width)
            << degree << " " << refine << " " << width;
      }
}

// A function that is seen well, but looks like a sum of others wherever points may lie, cannot have one.
TEST(TrimmedSpace, FunctionsThatPointsCannotTellApartFollowOthers) {
  const geometry::SphereTool tool{{-0.6862, -0.4706, -0.0652}, 0.2192, geometry::KeptSide::outside};
  const Boundary<3> bitten = geometry::clip(geometry::sphere(1.0), tool);
  const TrimmedSurface& cap = std::get<TrimmedSurface>(bitten.patches[1].shape);
  const FieldSpace<3> space = space_on(cap, 4, 2);
  EXPECT_LT(condition(collocation_matrix(space)), 1e6);
  EXPECT_LT(error_on(cap, space, [](const Point3& x, const auto&) { return 1.0 + x.x() - 2.0 * x.y() + x.z(); }),
            1e-11);
}

}  // namespace
}  // namespace isorim::solver
