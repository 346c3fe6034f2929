#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "solver/bem/solve.h"
#include "tests/solver/bem/exact_problem.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using std::numbers::pi;
using test::ExactField;
constexpr auto value = ConditionKind::value;
constexpr auto flux = ConditionKind::flux;
constexpr auto robin = ConditionKind::robin;

Eigen::VectorXd number(double x) {
  return Eigen::VectorXd::Constant(1, x);
}

ExactField<2> wave_2d() {
  return {[](const Point2& x) { return number(std::exp(x[0]) * std::cos(x[1])); },
          [](const Point2& x) {
            return Eigen::MatrixXd(std::exp(x[0]) * Eigen::RowVector2d(std::cos(x[1]), -std::sin(x[1])));
          }};
}

ExactField<3> wave_3d() {
  return {[](const Point3& x) { return number(std::exp(0.5 * x[0]) * std::cos(0.3 * x[1]) * std::cos(0.4 * x[2])); },
          [](const Point3& x) {
            const double e = std::exp(0.5 * x[0]);
            return Eigen::MatrixXd(e * Eigen::RowVector3d(0.5 * std::cos(0.3 * x[1]) * std::cos(0.4 * x[2]),
                                                          -0.3 * std::sin(0.3 * x[1]) * std::cos(0.4 * x[2]),
                                                          -0.4 * std::cos(0.3 * x[1]) * std::sin(0.4 * x[2])));
          }};
}

/// c + d . x / |x|^2: decays to c.
ExactField<2> dipole(double constant) {
  const Vector2 d(0.6, -0.8);
  return {[=](const Point2& x) { return number(constant + d.dot(x) / x.squaredNorm()); },
          [=](const Point2& x) {
            const Vector2 gradient = d / x.squaredNorm() - 2.0 * d.dot(x) * x / (x.squaredNorm() * x.squaredNorm());
            return Eigen::MatrixXd(gradient.transpose());
          }};
}

ExactField<3> source_at(const Point3& s) {
  return {[=](const Point3& x) { return number(1.0 / (x - s).norm()); },
          [=](const Point3& x) {
            const Vector3 d = x - s;
            return Eigen::MatrixXd(-d.transpose() / std::pow(d.norm(), 3));
          }};
}

template <int Dim>
test::Errors solve_errors(const ExactField<Dim>& field, const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                          double tolerance = 1e-12) {
  SolveOptions options;
  options.tolerance = tolerance;
  return test::errors_of(solve(problem, space, options), field, problem, space);
}

/// Least-squares order in unknowns^(-1 / (Dim - 1)), which is the elements' size but for small spaces, over refinements
/// of the larger of both fields' errors (each is unknown on a part).
template <int Dim>
double order_of(const geometry::Boundary<Dim>& boundary, const ExactField<Dim>& field, int degree,
                const std::vector<int>& refinements) {
  std::vector<double> sizes;
  std::vector<double> errors;
  for (const int refine : refinements) {
    const FieldSpace<Dim> space = test::space_on(boundary, degree, refine);
    const auto problem = test::problem_from<Dim>(field, test::laplace_on(space), space, {value, flux});
    const test::Errors found = solve_errors(field, problem, space);
    sizes.push_back(std::pow(space.function_count(), -1.0 / (Dim - 1)));
    errors.push_back(std::max(found.potential, found.flux));
  }
  return test::observed_order(sizes, errors);
}

TEST(Potential, MixedProblemsConvergeWithFullOrderInThePlane) {
  const geometry::Boundary<2> boundary = geometry::ellipse_sector({{1.5, 1.0}, {0.2, 0.1}, 0.3, 0.0, 2.0});
  for (int degree = 1; degree <= 5; ++degree) {
    const double order = order_of(boundary, wave_2d(), degree, {3, 4, 5});
    EXPECT_GT(order, degree + 1 - 0.2) << "degree " << degree;
  }
}

TEST(Potential, MixedProblemsConvergeWithFullOrderInSpace) {
  const geometry::Boundary<3> boundary = geometry::box({1.0, 0.8, 0.6}, {0.1, 0.2, 0.3});
  for (int degree = 1; degree <= 5; ++degree) {
    const std::vector<int> refinements = degree < 2 ? std::vector{1, 2, 3} : std::vector{0, 1, 2};
    const double order = order_of(boundary, wave_3d(), degree, refinements);
    EXPECT_GT(order, degree + 1 - 0.25) << "degree " << degree;
  }
}

TEST(Potential, ExteriorFieldOfASourceInsideABody) {
  const FieldSpace<3> space = test::space_on(geometry::ellipsoid({1.0, 0.8, 0.7}), 6, 0);
  const ExactField<3> field = source_at({0.1, 0.05, 0.0});
  for (const auto kind : {value, flux, robin}) {
    const auto problem = test::problem_from<3>(field, test::laplace_on(space, 2.0), space, {kind}, true);
    const test::Errors errors = solve_errors(field, problem, space, 1e-9);
    EXPECT_LT(errors.potential, 1e-4) << static_cast<int>(kind);
    EXPECT_LT(errors.flux, 4e-4) << static_cast<int>(kind);
  }
}

TEST(Potential, PlaneExteriorFieldsTendToTheirConstant) {
  const FieldSpace<2> space = test::space_on(geometry::elliptic_disc({1.3, 0.9}), 6, 4);
  for (const auto kind : {value, robin}) {
    const double constant = 2.5;
    const ExactField<2> field = dipole(constant);
    const auto problem = test::problem_from<2>(field, test::laplace_on(space, 2.0), space, {kind}, true);
    const Solution<2> solution = solve(problem, space, {});
    EXPECT_NEAR(solution.at_infinity[0], constant, 1e-8);
    EXPECT_LT(test::errors_of(solution, field, problem, space).flux, 1e-6);
  }
}

TEST(Potential, PlaneExteriorFluxProblemsVanishAtInfinity) {
  const FieldSpace<2> space = test::space_on(geometry::elliptic_disc({1.3, 0.9}), 6, 4);
  const ExactField<2> field = dipole(0.0);
  const auto problem = test::problem_from<2>(field, test::laplace_on(space, 2.0), space, {flux}, true);
  const Solution<2> solution = solve(problem, space, {});
  EXPECT_EQ(solution.at_infinity[0], 0.0);
  EXPECT_LT(test::errors_of(solution, field, problem, space).potential, 1e-6);
}

TEST(Potential, NoScaleOfThePlaneIsDegenerate) {
  // The single layer of -ln r vanishes on constants for an ellipse with a + b = 2.
  const ExactField<2> field = test::linear_field<2>(Eigen::RowVector2d(1.0, 0.5), number(3.0));
  for (const Vector2& radii : {Vector2(1.0, 1.0), Vector2(1.4, 0.6)}) {
    std::vector<double> errors;
    for (const double scale : {0.01, 0.999999, 1.0, 1.000001, 100.0}) {
      const FieldSpace<2> space = test::space_on(geometry::elliptic_disc(scale * radii), 4, 2);
      const auto problem = test::problem_from<2>(field, test::laplace_on(space), space, {value});
      errors.push_back(solve_errors(field, problem, space).flux);
    }
    for (const double error : errors) EXPECT_NEAR(error, errors.front(), 1e-6 * errors.front() + 1e-11);
    EXPECT_LT(errors.front(), 1e-3);
  }
}

TEST(Potential, UnitsOfLengthAndConductivityChangeNothing) {
  std::vector<test::Errors> errors;
  for (const double unit : {1.0, 1000.0}) {
    const FieldSpace<3> space = test::space_on(geometry::ellipsoid(unit * Vector3(1.0, 0.8, 0.7)), 3, 0);
    const ExactField<3> field{[=](const Point3& x) { return wave_3d().value(x / unit); },
                              [=](const Point3& x) { return Eigen::MatrixXd(wave_3d().gradient(x / unit) / unit); }};
    const auto problem = test::problem_from<3>(field, test::laplace_on(space, 17.0 / unit), space, {value});
    errors.push_back(solve_errors(field, problem, space));
  }
  EXPECT_NEAR(errors[0].flux, errors[1].flux, 1e-9 * errors[0].flux);
}

TEST(Potential, AnyNumberOfThreadsGivesTheSameBits) {
  const FieldSpace<3> space = test::space_on(geometry::box({1.0, 0.8, 0.6}), 2, 1);
  const auto problem = test::problem_from<3>(wave_3d(), test::laplace_on(space), space, {value, flux, robin});
  SolveOptions options;
  options.threads = 1;
  const Solution<3> one = solve(problem, space, options);
  options.threads = 3;
  const Solution<3> three = solve(problem, space, options);
  EXPECT_TRUE(one.potential == three.potential);
  EXPECT_TRUE(one.flux == three.flux);
}

/// Lamb: on an ellipsoid the potential of dphi/dn = n_i is -k_i x_i.
TEST(Potential, EllipsoidsHaveLambsAddedMass) {
  struct Body {
    Vector3 axes;
    Vector3 k;
  };
  const std::vector<Body> bodies{{{1.0, 1.0, 1.0}, {0.5, 0.5, 0.5}},
                                 {{2.0, 1.0, 1.0}, {0.210015048977, 0.704210425850, 0.704210425850}},
                                 {{3.0, 2.0, 1.0}, {0.185256404281, 0.364543239561, 1.36152747315}}};
  for (const Body& body : bodies) {
    const FieldSpace<3> space = test::space_on(geometry::ellipsoid(body.axes), 2, 0);
    for (int i = 0; i < 3; ++i) {
      Problem<3> problem{test::laplace_on(space), {}, true, {}, {}, {}};
      problem.conditions.push_back(
          {"wall", {{flux, test::data<3>([i](const Point3&, const Vector3& n) { return n[i]; }), {}}}, {}});
      problem.condition_of.assign(space.elements.size(), 0);
      SolveOptions options;
      options.tolerance = 1e-12;
      const Solution<3> solution = solve(problem, space, options);
      // The exact potential is linear, so it lies in the space.
      Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(1, 3);
      slope(0, i) = -body.k[i];
      const test::Errors errors = test::errors_of(solution, test::linear_field<3>(slope, number(0.0)), problem, space);
      EXPECT_LT(errors.potential, 1e-10) << body.axes.transpose() << ", axis " << i;
    }
  }
}

/// u = ln(r / a) / ln(b / a).
TEST(Potential, AnnulusBetweenTwoValues) {
  const std::vector<std::vector<geometry::NurbsCurve<2>>> loops{{geometry::circle_curve(2.0)},
                                                                {geometry::circle_curve(1.0)}};
  const FieldSpace<2> space = test::space_on(geometry::region(loops), 4, 1);
  const ExactField<2> field{
      [](const Point2& x) { return number(std::log(x.norm()) / std::log(2.0)); },
      [](const Point2& x) { return Eigen::MatrixXd(x.transpose() / (x.squaredNorm() * std::log(2.0))); }};
  for (const auto& kinds : {std::vector{value}, std::vector{value, robin}, std::vector{flux, value}}) {
    const auto problem = test::problem_from<2>(field, test::laplace_on(space), space, kinds);
    const test::Errors errors = solve_errors(field, problem, space);
    EXPECT_LT(errors.flux, 1e-11);
    EXPECT_LT(errors.potential, 1e-11);
  }
}

}  // namespace
}  // namespace isorim::solver
