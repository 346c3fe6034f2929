#include "solver/bem/evaluation.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "solver/bem/simple_solution.h"
#include "solver/bem/stress.h"
#include "tests/solver/bem/interpolated.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Vector;
using geometry::Vector2;
using geometry::Vector3;
using std::numbers::pi;
using testing::exact_problem;
using testing::exact_solution;
using testing::ExactField;

template <int Dim>
FieldSpace<Dim> space_on(const geometry::Boundary<Dim>& boundary, int degree, int refine) {
  DiscretisationOptions<Dim> options;
  options.degree = degree;
  options.refine = refine;
  return field_space<Dim>(geometry::orient<Dim>(boundary), options);
}

ConditionKind all_flux(int, int) {
  return ConditionKind::flux;
}
ConditionKind mixed(int element, int component) {
  return static_cast<ConditionKind>((element + component) % 3);
}

/// Largest errors of value and gradient over points that lie so far inside of places of some elements.
struct Errors {
  double value = 0.0;
  double gradient = 0.0;
};

template <class Kernel>
Errors errors_at_distance(const Kernel& kernel, const FieldSpace<Kernel::dimension>& space,
                          const Problem<Kernel::dimension>& problem, const Solution<Kernel::dimension>& solution,
                          const ExactField<Kernel::dimension>& field, double distance) {
  constexpr int dimension = Kernel::dimension;
  geometry::Points<dimension> points(dimension, 0);
  for (std::size_t i = 0; i < space.points.size(); i += 1 + space.points.size() / 12) {
    const auto& point = space.points[i];
    points.conservativeResize(dimension, points.cols() + 1);
    points.col(points.cols() - 1) = point.position - (problem.exterior ? -distance : distance) * point.normal;
  }
  const auto found = evaluate_at<dimension>(problem, space, solution, points);
  Errors errors;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto& at = found[static_cast<std::size_t>(i)];
    EXPECT_EQ(at.location, distance > 0.0 ? Location::inside : Location::on_boundary) << points.col(i).transpose();
    if (at.location == Location::outside) continue;
    const geometry::Point<dimension> x = points.col(i);
    errors.value = std::max(errors.value, (at.field.value - field.value(x)).norm());
    errors.gradient = std::max(errors.gradient, (at.field.gradient - field.gradient(x)).norm());
    if constexpr (Kernel::components == dimension) {
      EXPECT_LT((at.field.stress - testing::stress(kernel, field.gradient(x))).norm(), 5.0 * errors.gradient + 1e-12);
    }
  }
  return errors;
}

/// A solution that lies in the space, at any distance from the boundary and on it.
template <class Kernel>
void expect_exact(const Kernel& kernel, const FieldSpace<Kernel::dimension>& space,
                  const ExactField<Kernel::dimension>& field) {
  for (const testing::KindOf& kinds : {testing::KindOf(all_flux), testing::KindOf(mixed)}) {
    const auto problem = exact_problem(kernel, space, field, kinds);
    const auto solution = exact_solution(kernel, space, field);
    for (const double distance : {0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0}) {
      const Errors errors = errors_at_distance(kernel, space, problem, solution, field, distance);
      EXPECT_LT(errors.value, 1e-10) << field.name << " at " << distance;
      EXPECT_LT(errors.gradient, 1e-10) << field.name << " at " << distance;
    }
  }
}

TEST(Evaluation, SolutionsInTheSpaceAreExactAtAnyDistance) {
  Eigen::Matrix2d q2;
  q2 << 1.0, 0.4, 0.4, -1.0;
  Eigen::Matrix3d q3;
  q3 << 1.0, 0.4, 0.2, 0.4, -2.0, 0.1, 0.2, 0.1, 1.0;
  const FieldSpace<2> square = space_on<2>(geometry::rectangle({1.0, 1.0}), 2, 1);
  const FieldSpace<3> cube = space_on<3>(geometry::cube(1.0), 2, 1);
  const Laplace<2> laplace2{1.7, 3.0};
  const Laplace<3> laplace3{0.6};
  const Elasticity<2> elastic2{1.3, 0.3, 3.0};
  const Elasticity<3> elastic3{0.8, 0.25};
  expect_exact(laplace2, square, testing::harmonic_quadratic<2>(laplace2, q2));
  expect_exact(laplace3, cube, testing::harmonic_quadratic<3>(laplace3, q3));
  expect_exact(elastic2, square, testing::harmonic_displacement<2>(elastic2));
  expect_exact(elastic3, cube, testing::harmonic_displacement<3>(elastic3));
}

/// On a curved boundary the interpolant's own error is the measure: none larger near the boundary than on it.
template <class Kernel>
void expect_uniform(const Kernel& kernel, const FieldSpace<Kernel::dimension>& space,
                    const ExactField<Kernel::dimension>& field, bool exterior) {
  const auto problem = exact_problem(kernel, space, field, mixed, exterior);
  const auto solution = exact_solution(kernel, space, field);
  const Errors on = errors_at_distance(kernel, space, problem, solution, field, 0.0);
  EXPECT_LT(on.gradient, 5e-2) << field.name;
  for (const double distance : {0.3, 0.1, 1e-2, 1e-4, 1e-6}) {
    const Errors errors = errors_at_distance(kernel, space, problem, solution, field, distance);
    EXPECT_LT(errors.value, 2.0 * on.gradient) << field.name << " at " << distance;
    EXPECT_LT(errors.gradient, 3.0 * on.gradient) << field.name << " at " << distance;
  }
}

/// 1 / |x - s| (-ln in the plane): harmonic away from s.
template <int Dim>
ExactField<Dim> point_source(const geometry::Point<Dim>& s) {
  return {"point source",
          [=](const geometry::Point<Dim>& x) -> Eigen::VectorXd {
            const double r = (x - s).norm();
            return Eigen::VectorXd::Constant(1, Dim == 3 ? 1.0 / r : -std::log(r));
          },
          [=](const geometry::Point<Dim>& x) -> Eigen::MatrixXd {
            const Vector<Dim> d = x - s;
            return -d.transpose() / std::pow(d.norm(), Dim);
          },
          [](const geometry::Point<Dim>&) -> Eigen::VectorXd { return Eigen::VectorXd::Zero(1); }};
}

TEST(Evaluation, ErrorsNearCurvedBoundariesAreThoseOnThem) {
  expect_uniform(Laplace<2>{1.0, 3.0}, space_on<2>(geometry::disc(1.0), 4, 2), point_source<2>({1.7, 0.4}), false);
  expect_uniform(Laplace<3>{1.0}, space_on<3>(geometry::sphere(1.0), 4, 1), point_source<3>({1.7, 0.4, 0.2}), false);
  expect_uniform(Laplace<3>{1.0}, space_on<3>(geometry::torus(1.0, 0.4), 3, 1), point_source<3>({0.1, 0.0, 0.9}),
                 false);
  const Elasticity<2> elastic{1.0, 0.3, 3.0};
  expect_uniform(elastic, space_on<2>(geometry::disc(1.0), 4, 2), testing::harmonic_displacement<2>(elastic), false);
}

TEST(Evaluation, ExteriorProblems) {
  expect_uniform(Laplace<3>{1.0}, space_on<3>(geometry::sphere(1.0), 4, 1), point_source<3>({0.3, 0.1, 0.2}), true);
}

TEST(Evaluation, PointsOutsideAreRecognised) {
  const Laplace<3> kernel;
  const FieldSpace<3> space = space_on<3>(geometry::torus(1.0, 0.4), 2, 0);
  const ExactField<3> field = point_source<3>({3.0, 0.0, 0.0});
  const auto problem = exact_problem(kernel, space, field, all_flux);
  const auto solution = exact_solution(kernel, space, field);
  geometry::Points<3> points(3, 5);
  points << 0.0, 1.0, 1.4 + 1e-6, 1.4 - 1e-6, 5.0, /**/ 0.0, 0.0, 0.0, 0.0, 5.0, /**/ 0.0, 0.0, 0.0, 0.0, 5.0;
  const auto found = evaluate_at<3>(problem, space, solution, points);
  const std::vector<Location> expected{Location::outside, Location::inside, Location::outside, Location::inside,
                                       Location::outside};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found[i].location, expected[i]) << i;
    EXPECT_EQ(found[i].field.value.size(), expected[i] == Location::outside ? 0 : 1) << i;
  }
}

TEST(Evaluation, SameBitsForAnyNumberOfThreads) {
  const Laplace<3> kernel;
  const FieldSpace<3> space = space_on<3>(geometry::sphere(1.0), 2, 0);
  const ExactField<3> field = point_source<3>({3.0, 0.0, 0.0});
  const auto problem = exact_problem(kernel, space, field, mixed);
  const auto solution = exact_solution(kernel, space, field);
  const geometry::Points<3> points = 0.5 * geometry::Points<3>::Random(3, 20);
  const auto one = evaluate_at<3>(problem, space, solution, points, {1e-11, 1});
  const auto three = evaluate_at<3>(problem, space, solution, points, {1e-11, 3});
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].field.value, three[i].field.value);
    EXPECT_EQ(one[i].field.gradient, three[i].field.gradient);
  }
}

/// Points are evaluated in batches: those on the boundary, near it and far from it, alone and with others.
TEST(Evaluation, SameBitsInAnyCompany) {
  const Elasticity<3> kernel{0.8, 0.25};
  const FieldSpace<3> space = space_on<3>(geometry::cube(1.0), 2, 1);
  const ExactField<3> field = testing::harmonic_displacement<3>(kernel);
  const auto problem = exact_problem(kernel, space, field, mixed);
  const auto solution = exact_solution(kernel, space, field);
  geometry::Points<3> points = geometry::Points<3>::Constant(3, 150, 0.5) + 0.45 * geometry::Points<3>::Random(3, 150);
  points.row(0).leftCols(20).setConstant(1e-4);
  points.row(2).middleCols(20, 5).setZero();
  const auto all = evaluate_at<3>(problem, space, solution, points);
  for (const Eigen::Index i : {0, 7, 19, 22, 60, 63, 64, 149}) {
    const auto alone = evaluate_at<3>(problem, space, solution, points.col(i));
    EXPECT_EQ(alone[0].location, all[static_cast<std::size_t>(i)].location) << i;
    EXPECT_EQ(alone[0].field.value, all[static_cast<std::size_t>(i)].field.value) << i;
    EXPECT_EQ(alone[0].field.gradient, all[static_cast<std::size_t>(i)].field.gradient) << i;
  }
}

TEST(BoundaryGradient, RecoversAnyGradientFromFluxAndTangentialDerivatives) {
  const Elasticity<3> kernel{1.4, 0.2};
  Eigen::Matrix<double, 3, 2> tangents;
  tangents << 1.0, 0.3, 0.2, 2.0, -0.4, 0.5;
  const Vector3 u = tangents.col(0);
  const Vector3 v = tangents.col(1);
  const Vector3 normal =
      Vector3(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]).normalized();
  Eigen::MatrixXd gradient(3, 3);
  gradient << 1.0, 2.0, -0.5, 0.3, -0.7, 0.9, 0.1, 0.4, 1.5;
  const double uniform = 0.8;
  const Eigen::VectorXd traction = stress_of(kernel, gradient, uniform) * normal;
  const Eigen::MatrixXd found =
      boundary_gradient<3>(Equation<3>(kernel), tangents, normal, gradient * tangents, traction, uniform);
  EXPECT_LT((found - gradient).norm(), 1e-14);
}

TEST(Stress, VonMisesAndPrincipalStresses) {
  Eigen::MatrixXd uniaxial = Eigen::MatrixXd::Zero(3, 3);
  uniaxial(1, 1) = -3.0;
  EXPECT_NEAR(von_mises(uniaxial), 3.0, 1e-15);
  Eigen::MatrixXd shear(2, 2);
  shear << 0.0, 2.0, 2.0, 0.0;
  EXPECT_NEAR(von_mises(shear), 2.0 * std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(von_mises(Eigen::MatrixXd::Identity(2, 2), 1.0), 0.0, 1e-15);
  EXPECT_NEAR(principal_stresses(shear)[0], -2.0, 1e-15);
  EXPECT_NEAR(principal_stresses(shear)[1], 2.0, 1e-15);
}

}  // namespace
}  // namespace isorim::solver
