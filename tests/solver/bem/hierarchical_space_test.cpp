#include "solver/bem/hierarchical_space.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "tests/solver/bem/field_spaces.h"

namespace isorim::solver {
namespace {

using geometry::Boundary;
using geometry::OrientedBoundary;
using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;
using testing::collocation_matrix;
using testing::condition;
using testing::interpolation_error;

/// Bisects `times` times the elements whose middles the rule marks.
template <int Dim>
struct Refined {
  OrientedBoundary<Dim> boundary;
  DiscretisationOptions<Dim> options;
  FieldSpace<Dim> space;

  Refined(const Boundary<Dim>& shape, int degree, int refine) : boundary{shape, {}} {
    options.degree = degree;
    options.refine = refine;
    space = field_space<Dim>(boundary, options);
  }
  void bisect(const std::function<bool(const Point<Dim>&)>& marks) {
    std::vector<int> marked;
    for (std::size_t e = 0; e < space.table.elements.size(); ++e)
      if (marks(geometry::evaluate_jet<Dim>(space.table, space.table.elements[e], Point<Dim - 1>::Constant(0.5))
                    .position))
        marked.push_back(static_cast<int>(e));
    options = refine_locally<Dim>(boundary, options, space, marked);
    space = field_space<Dim>(boundary, options);
  }
};

/// Elements about a point, nearer than a distance that halves each time.
template <int Dim>
Refined<Dim> refined_towards(const Boundary<Dim>& shape, int degree, int refine, const Point<Dim>& centre, int times) {
  Refined<Dim> result(shape, degree, refine);
  double distance = 0.5;
  for (int i = 0; i < times; ++i, distance *= 0.5)
    result.bisect([&](const Point<Dim>& x) { return (x - centre).norm() < distance; });
  return result;
}

TEST(HierarchicalSpace, HoldsConstantsAndLinearFunctions) {
  for (const Boundary<3>& shape : {geometry::sphere(1.0), geometry::torus(1.0, 0.4), geometry::cube(1.0)})
    for (const int degree : {2, 3}) {
      const auto refined = refined_towards<3>(shape, degree, 1, Point3(1.0, 0.3, 0.2), 2);
      EXPECT_GT(refined.options.bisected.size(), 0U);
      const FieldSpace<3>& space = refined.space;
      const Eigen::VectorXd ones = Eigen::VectorXd::Ones(space.function_count());
      EXPECT_LT(testing::largest_error<3>(space, ones, [](const auto&, const auto&) { return 1.0; }), 1e-13);
      EXPECT_LT(interpolation_error<3>(space, [](const Point3& x, const auto&) { return x.x() - x.y() + 2.0 * x.z(); }),
                1e-12);
    }
}

TEST(HierarchicalSpace, HoldsTheFunctionsOfTheSpaceBefore) {
  for (const int degree : {1, 2, 3}) {
    Refined<2> refined(geometry::disc(1.0), degree, 2);
    const FieldSpace<2> before = refined.space;
    refined.bisect([](const geometry::Point2& x) { return x.x() > 0.5; });
    ASSERT_GT(refined.space.function_count(), before.function_count());
    // A B-spline of the coarse space, as a function of the angle: found by the place among the coarse elements.
    Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(before.function_count());
    for (int i = 0; i < before.function_count(); ++i) coefficients(i) = std::sin(1.0 + 3.0 * i);
    const auto coarse = [&](int element, double s) {
      const GridCell<2>& cell = refined.space.cells[static_cast<std::size_t>(element)];
      const std::int64_t count = std::int64_t{1} << cell.level;
      const double place = (static_cast<double>(cell.index[0] % count) + s) / static_cast<double>(count);
      return testing::value<2>(before, coefficients, static_cast<int>(cell.index[0] / count), Point<1>(place));
    };
    Eigen::VectorXd values(refined.space.function_count());
    for (int i = 0; i < values.size(); ++i) {
      const CollocationPoint<2>& point = refined.space.points[static_cast<std::size_t>(i)];
      values(i) = coarse(point.element, point.place(0));
    }
    const Eigen::VectorXd found = collocation_matrix(refined.space).partialPivLu().solve(values);
    for (int e = 0; e < static_cast<int>(refined.space.elements.size()); ++e)
      for (const double s : {0.0, 0.3, 1.0})
        EXPECT_NEAR(testing::value<2>(refined.space, found, e, Point<1>(s)), coarse(e, s), 1e-12) << degree;
  }
}

TEST(HierarchicalSpace, ConditionStaysBoundedTowardsAPoint) {
  for (const int degree : {1, 2, 3}) {
    const double bound = degree == 1 ? 10.0 : degree == 2 ? 100.0 : 1000.0;
    for (const int times : {1, 2, 3, 4}) {
      const auto refined = refined_towards<3>(geometry::cube(1.0), degree, 2, Point3(1.0, 1.0, 1.0), times);
      EXPECT_LT(condition(collocation_matrix(refined.space)), bound) << degree << " " << times;
      const auto on_disc = refined_towards<2>(geometry::disc(1.0), degree, 2, geometry::Point2(0.6, 0.8), times + 3);
      EXPECT_LT(condition(collocation_matrix(on_disc.space)), bound) << degree << " " << times;
    }
  }
}

// A step that is narrow against the elements of level 0.
TEST(HierarchicalSpace, ResolvesWhatItIsRefinedFor) {
  const auto f = [](const Point3& x, const Vector3&) {
    return std::atan(20.0 * (x - Point3(1.0, 0.3, 0.6)).norm() - 4.0);
  };
  Refined<3> local(geometry::cube(1.0), 2, 2);
  for (int i = 0; i < 2; ++i)
    local.bisect([](const Point3& x) { return x.x() > 0.99 && (x - Point3(1.0, 0.3, 0.6)).norm() < 0.45; });
  const Refined<3> uniform(geometry::cube(1.0), 2, 3);
  EXPECT_LT(local.space.function_count(), uniform.space.function_count());
  EXPECT_LT(interpolation_error<3>(local.space, f), 0.5 * interpolation_error<3>(uniform.space, f));
}

TEST(HierarchicalSpace, LevelsChangeByOneWithinTheReachOfAFunction) {
  const auto refined = refined_towards<3>(geometry::cube(1.0), 2, 2, Point3(1.0, 1.0, 1.0), 4);
  const CellTree<3> tree({4, 4}, [&] {
    std::vector<GridCell<3>> cells;
    for (const auto& [patch, cell] : refined.options.bisected)
      if (patch == 1) cells.push_back(cell);
    return cells;
  }());
  EXPECT_EQ(tree.levels(), 5);
  for (const GridCell<3>& cell : tree.bisected()) {
    if (cell.level == 0) continue;
    for (const int i : {-1, 0, 1})
      for (const int j : {-1, 0, 1}) {
        const GridCell<3> near{cell.level, {cell.index[0] + i, cell.index[1] + j}};
        EXPECT_TRUE(!tree.is_inside(near) || tree.exists(near));
      }
  }
}

TEST(HierarchicalSpace, WithNothingMarkedIsTheSame) {
  Refined<3> refined(geometry::sphere(1.0), 3, 1);
  const FieldSpace<3> before = refined.space;
  refined.bisect([](const Point3&) { return false; });
  EXPECT_EQ(refined.space.functions, before.functions);
  EXPECT_EQ(refined.space.rows, before.rows);
}

TEST(HierarchicalSpace, WithEverythingMarkedIsTheUniformOne) {
  Refined<3> refined(geometry::torus(1.0, 0.3), 2, 1);
  refined.bisect([](const Point3&) { return true; });
  const Refined<3> uniform(geometry::torus(1.0, 0.3), 2, 2);
  EXPECT_EQ(refined.space.function_count(), uniform.space.function_count());
  const auto f = [](const Point3& x, const Vector3&) { return std::sin(3.0 * x.x()) * x.z(); };
  const double error = interpolation_error<3>(uniform.space, f);
  EXPECT_NEAR(interpolation_error<3>(refined.space, f), error, 0.2 * error);
}

TEST(HierarchicalSpace, RefusesCellsThatAreNotThere) {
  DiscretisationOptions<3> options;
  const auto refusal = [&] {
    try {
      field_space<3>({geometry::cube(1.0), {}}, options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  options.bisected = {{1, {1, {0, 0}}}};
  EXPECT_THAT(refusal(), ::testing::HasSubstr("no cell (0, 0) of level 1 to bisect"));
  options.bisected = {{1, {0, {1, 0}}}};
  EXPECT_THAT(refusal(), ::testing::HasSubstr("no cell (1, 0) of level 0 to bisect"));
  options.bisected = {{7, {0, {0, 0}}}};
  EXPECT_THAT(refusal(), ::testing::HasSubstr("patch 7 is no curve or whole surface"));
}

}  // namespace
}  // namespace isorim::solver
