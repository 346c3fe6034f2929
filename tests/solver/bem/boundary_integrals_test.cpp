#include "solver/bem/boundary_integrals.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "tests/solver/bem/interpolated.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;
using std::numbers::pi;
using testing::exact_problem;
using testing::exact_solution;
using testing::ExactField;
using ::testing::HasSubstr;
using testing::integrand;

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
ConditionKind all_value(int, int) {
  return ConditionKind::value;
}

/// u = -x / 2 outside of the unit sphere's potential x / (2 r^3): the added mass is half the displaced mass (Lamb,
/// art. 92).
TEST(ResultIntegrals, AddedMassOfASphere) {
  const Laplace<3> kernel;
  const FieldSpace<3> space = space_on<3>(geometry::sphere(1.0), 4, 0);
  const ExactField<3> field{"dipole",
                            [](const Point3& x) -> Eigen::VectorXd {
                              return Eigen::VectorXd::Constant(1, -0.5 * x[0] / std::pow(x.norm(), 3));
                            },
                            [](const Point3& x) -> Eigen::MatrixXd {
                              const double r = x.norm();
                              const Vector3 gradient =
                                  -0.5 * (Vector3::UnitX() / std::pow(r, 3) - 3.0 * x[0] * x / std::pow(r, 5));
                              return gradient.transpose();
                            },
                            {}};
  const auto problem = exact_problem(kernel, space, field, all_flux, true);
  const auto result = result_integrals<3>(problem, space, exact_solution(kernel, space, field));
  const double volume = 4.0 / 3.0 * pi;
  EXPECT_NEAR(-result.total.potential_normal(0, 0), 0.5 * volume, 1e-11);
  EXPECT_NEAR(result.total.potential_normal(0, 1), 0.0, 1e-11);
  // The flux on the sphere is the normal's x.
  EXPECT_NEAR(-result.total.work, 0.5 * volume, 1e-11);
  EXPECT_NEAR(result.total.measure, 4.0 * pi, 1e-11);
  EXPECT_EQ(result.force_imbalance.size(), 0);
}

TEST(ResultIntegrals, ForcesAndMomentsOfACubeByPatchAndCondition) {
  const Elasticity<3> kernel{1.0, 0.25};
  const FieldSpace<3> space = space_on<3>(geometry::cube(2.0), 2, 0);
  // A shear: stress yz and zy of 3.
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(3, 3);
  gradient(1, 2) = 3.0;
  const ExactField<3> field{"shear",
                            [=](const Point3& x) -> Eigen::VectorXd { return gradient * x; },
                            [=](const Point3&) -> Eigen::MatrixXd { return gradient; },
                            {}};
  const auto kinds = [](int element, int) { return element < 2 ? ConditionKind::value : ConditionKind::flux; };
  const auto problem = exact_problem(kernel, space, field, kinds);
  const Point3 centre(1.0, 1.0, 1.0);
  const auto result = result_integrals<3>(problem, space, exact_solution(kernel, space, field), centre);
  // Patches: x_min, x_max, y_min, y_max, z_min, z_max.
  ASSERT_EQ(result.patches.size(), 6U);
  EXPECT_LT((result.patches[3].flux - Vector3(0.0, 0.0, 12.0)).norm(), 1e-12);
  EXPECT_LT((result.patches[3].moment - Vector3(12.0, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((result.patches[5].flux - Vector3(0.0, 12.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((result.patches[5].moment - Vector3(-12.0, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT(result.force_imbalance.norm(), 1e-12);
  EXPECT_LT(result.moment_imbalance.norm(), 1e-12);
  // Half the work is the energy mu gamma^2 V / 2.
  EXPECT_NEAR(result.total.work, 9.0 * 8.0, 1e-11);
  ASSERT_EQ(result.conditions.size(), 2U);
  EXPECT_LT((result.conditions[0].flux + result.conditions[1].flux - result.total.flux).norm(), 1e-12);
  EXPECT_NEAR(result.conditions[0].measure, 8.0, 1e-12);
}

TEST(ResultIntegrals, FluxBalancesTheSource) {
  const Laplace<2> kernel{2.0, 5.0};
  const FieldSpace<2> space = space_on<2>(geometry::disc(1.5), 3, 1);
  // -k lap u = 3.
  const ExactField<2> field{
      "paraboloid",
      [](const Point2& x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, -0.375 * x.squaredNorm()); },
      [](const Point2& x) -> Eigen::MatrixXd { return -0.75 * x.transpose(); },
      {}};
  auto problem = exact_problem(kernel, space, field, all_value);
  problem.loads = {polynomial_load(kernel, {Quadratic<2>{3.0}})};
  const auto result = result_integrals<2>(problem, space, exact_solution(kernel, space, field));
  EXPECT_NEAR(result.load.force[0], 3.0 * pi * 2.25, 1e-11);
  EXPECT_NEAR(result.force_imbalance[0], 0.0, 1e-11);
  EXPECT_NEAR(result.total.potential[0], -0.375 * 2.25 * 2.0 * pi * 1.5, 1e-11);
}

TEST(BoundaryErrors, NormsOfAKnownError) {
  const Laplace<3> kernel;
  const FieldSpace<3> space = space_on<3>(geometry::sphere(1.0), 2, 0);
  const ExactField<3> field{"linear",
                            [](const Point3& x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, x[0]); },
                            [](const Point3&) -> Eigen::MatrixXd { return Vector3::UnitX().transpose(); },
                            {}};
  const auto problem = exact_problem(kernel, space, field, all_flux);
  ExactData<3> exact;
  exact.potential = {integrand<3>([](const Point3& x, const Vector3&) { return x[0] + 0.5; })};
  const auto errors = boundary_errors<3>(problem, space, exact_solution(kernel, space, field), exact);
  ASSERT_TRUE(errors.potential);
  EXPECT_FALSE(errors.flux);
  EXPECT_NEAR(errors.potential->l2, 0.5 * std::sqrt(4.0 * pi), 1e-11);
  EXPECT_NEAR(errors.potential->max, 0.5, 1e-12);
  EXPECT_NEAR(errors.potential->exact_l2, std::sqrt(4.0 * pi * (1.0 / 3.0 + 0.25)), 1e-11);
  EXPECT_NEAR(errors.potential->exact_max, 1.5, 0.02);
  exact.flux = {exact.potential[0], exact.potential[0]};
  try {
    boundary_errors<3>(problem, space, exact_solution(kernel, space, field), exact);
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("found 2 exact functions; expected one for each of 1"));
  }
}

}  // namespace
}  // namespace isorim::solver
