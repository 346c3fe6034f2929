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

/// u = a x / |x|^Dim + b x: Lame's fields.
template <int Dim>
ExactField<Dim> radial_field(double a, double b) {
  return {[=](const geometry::Point<Dim>& x) -> Eigen::VectorXd { return (a * std::pow(x.norm(), -Dim) + b) * x; },
          [=](const geometry::Point<Dim>& x) -> Eigen::MatrixXd {
            const double r = x.norm();
            const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(Dim, Dim);
            return a * std::pow(r, -Dim) * (identity - Dim * x * x.transpose() / (r * r)) + b * identity;
          }};
}

geometry::Boundary<3> hollow_sphere(double inner, double outer) {
  geometry::Boundary<3> shell = geometry::sphere(outer);
  geometry::Boundary<3> hole = geometry::sphere(inner);
  hole.patches[0].name = "hole";
  shell.patches.push_back(hole.patches[0]);
  return shell;
}

geometry::Boundary<2> annulus(double inner, double outer) {
  const std::vector<std::vector<geometry::NurbsCurve<2>>> loops{{geometry::circle_curve(outer)},
                                                                {geometry::circle_curve(inner)}};
  return geometry::region(loops);
}

template <int Dim>
void expect_solution(const ExactField<Dim>& field, const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                     double bound) {
  SolveOptions options;
  options.tolerance = 1e-14;
  const Solution<Dim> solution = solve(problem, space, options);
  const bool is_free = !solution.messages.empty();
  const test::Errors errors =
      test::errors_of(solution, is_free ? test::without_motions(field, problem, space) : field, problem, space);
  EXPECT_LT(errors.potential, bound);
  EXPECT_LT(errors.flux, bound);
}

/// Pressure inside and outside: K1 = (p_i a^2 - p_e b^2) / (b^2 - a^2), K2 = (p_i - p_e) a^2 b^2 / (b^2 - a^2),
/// u_r = K1 (1 - 2 nu) r / (2 mu) + K2 / (2 mu r). The field lies in the space.
TEST(Elasticity, LamesHollowCylinder) {
  const double mu = 80.0, nu = 0.3, a = 1.0, b = 2.0, p_i = 3.0, p_e = 1.0;
  const double k1 = (p_i * a * a - p_e * b * b) / (b * b - a * a);
  const double k2 = (p_i - p_e) * a * a * b * b / (b * b - a * a);
  const ExactField<2> field = radial_field<2>(k2 / (2.0 * mu), k1 * (1.0 - 2.0 * nu) / (2.0 * mu));
  const FieldSpace<2> space = test::space_on(annulus(a, b), 2, 0);
  const Equation<2> equation = test::elasticity_on(space, mu, nu);
  for (const auto& kinds : {std::vector{flux}, std::vector{value}, std::vector{flux, value}, std::vector{robin, flux}})
    expect_solution(field, test::problem_from(field, equation, space, kinds), space, 1e-11);
  // The field is that of the pressures.
  const Eigen::VectorXd traction = test::flux_of<2>(equation, field.gradient({0.0, a}), {0.0, -1.0});
  EXPECT_NEAR(traction[1], p_i, 1e-12);
  EXPECT_NEAR(test::flux_of<2>(equation, field.gradient({b, 0.0}), {1.0, 0.0})[0], -p_e, 1e-12);
}

TEST(Elasticity, LamesHollowSphere) {
  const double mu = 80.0, nu = 0.3, a = 1.0, b = 2.0, p_i = 3.0, p_e = 1.0;
  const double k1 = (p_i * a * a * a - p_e * b * b * b) / (b * b * b - a * a * a);
  const double k2 = (p_i - p_e) * a * a * a * b * b * b / (b * b * b - a * a * a);
  const ExactField<3> field = radial_field<3>(k2 / (4.0 * mu), k1 * (1.0 - 2.0 * nu) / (2.0 * mu * (1.0 + nu)));
  const FieldSpace<3> space = test::space_on(hollow_sphere(a, b), 2, 0);
  const Equation<3> equation = test::elasticity_on(space, mu, nu);
  for (const auto& kinds : {std::vector{flux}, std::vector{flux, value}})
    expect_solution(field, test::problem_from(field, equation, space, kinds), space, 1e-11);
  EXPECT_NEAR(test::flux_of<3>(equation, field.gradient({0.0, 0.0, a}), {0.0, 0.0, -1.0})[2], p_i, 1e-12);
}

/// Condition: normal displacement and tangential tractions zero on the plane with normal (-sin, cos).
Condition<2> symmetry_line(double angle) {
  Eigen::Matrix2d frame;
  frame << -std::sin(angle), std::cos(angle), std::cos(angle), std::sin(angle);
  return {"symmetry", {{value, {}, {}}, {flux, {}, {}}}, frame};
}

/// A piece of the hollow cylinder between two radii that are planes of symmetry, neither of them along an axis. Along
/// the radii the field is 1 / r, which the space only approximates: smooth splines of degree 8 on 4 elements are 12
/// functions. The bounds are what more of them leave; the tolerance of the quadrature changes no digit.
TEST(Elasticity, SymmetryPlanesNeedNotBeParallelToAxes) {
  const double mu = 80.0, nu = 0.3, first = 0.3, last = 1.1;
  const ExactField<2> field = radial_field<2>(0.02, 0.01);
  const auto on_circle = [](double r, double angle) { return Point2(r * std::cos(angle), r * std::sin(angle)); };
  const std::vector<std::vector<geometry::NurbsCurve<2>>> loop{
      {geometry::circular_arc(2.0, {0, 0}, first, last),
       geometry::line_segment<2>(on_circle(2.0, last), on_circle(1.0, last)),
       geometry::circular_arc(1.0, {0, 0}, last, first),
       geometry::line_segment<2>(on_circle(1.0, first), on_circle(2.0, first))}};
  struct Case {
    int degree;
    int refine;
    double bound;
  };
  for (const auto& [degree, refine, bound] : {Case{8, 2, 2e-8}, Case{8, 3, 2.5e-10}, Case{10, 3, 5e-12}}) {
    const FieldSpace<2> space = test::space_on(geometry::region(loop), degree, refine);
    const Equation<2> equation = test::elasticity_on(space, mu, nu);
    Problem<2> problem{equation, {}, false, {}, {}, {}};
    problem.conditions = {test::condition_from(field, equation, flux), symmetry_line(last), symmetry_line(first)};
    const std::vector<std::int32_t> of_patch{0, 1, 0, 2};
    for (const auto& element : space.table.elements)
      problem.condition_of.push_back(of_patch[static_cast<std::size_t>(element.patch)]);
    expect_solution(field, problem, space, bound);
  }
}

/// A cavity under pressure p in an unbounded medium: u_r = p a^3 / (4 mu r^2), in the plane p a^2 / (2 mu r).
TEST(Elasticity, CavityUnderPressure) {
  const double mu = 80.0;
  const FieldSpace<3> sphere = test::space_on(geometry::sphere(1.5), 2, 0);
  const ExactField<3> field = radial_field<3>(3.0 * std::pow(1.5, 3) / (4.0 * mu), 0.0);
  for (const auto kind : {flux, value, robin}) {
    expect_solution(field, test::problem_from(field, test::elasticity_on(sphere, mu, 0.3), sphere, {kind}, true),
                    sphere, 1e-11);
  }
  const FieldSpace<2> circle = test::space_on(geometry::disc(1.5), 2, 0);
  const ExactField<2> plane_field = radial_field<2>(3.0 * 1.5 * 1.5 / (2.0 * mu), 0.0);
  for (const auto kind : {flux, value, robin}) {
    expect_solution(plane_field,
                    test::problem_from(plane_field, test::elasticity_on(circle, mu, 0.3), circle, {kind}, true), circle,
                    1e-11);
  }
}

/// A bonded rigid sphere moved by U: F = 24 pi mu a U (1 - nu) / (5 - 6 nu), evenly spread; n points into the medium.
TEST(Elasticity, RigidSphereInUnboundedMedium) {
  const double mu = 2.0, nu = 0.3, a = 1.5, moved = 0.1;
  const FieldSpace<3> space = test::space_on(geometry::sphere(a), 2, 0);
  Problem<3> problem{test::elasticity_on(space, mu, nu), {}, true, {}, {}, {}};
  const auto along_x = test::data<3>([=](const Point3&, const Vector3&) { return moved; });
  problem.conditions.push_back({"bond", {{value, along_x, {}}, {value, {}, {}}, {value, {}, {}}}, {}});
  problem.condition_of.assign(space.elements.size(), 0);
  SolveOptions options;
  options.tolerance = 1e-14;
  const Solution<3> solution = solve(problem, space, options);
  const double force = 24.0 * pi * mu * a * moved * (1.0 - nu) / (5.0 - 6.0 * nu);
  const double traction = -force / (4.0 * pi * a * a);
  EXPECT_LT((solution.flux.col(0).array() - traction).abs().maxCoeff(), 1e-11 * std::abs(traction));
  EXPECT_LT(solution.flux.rightCols(2).cwiseAbs().maxCoeff(), 1e-11 * std::abs(traction));
}

/// In the plane a bounded field with a rigid body moved by U is U everywhere: no force.
TEST(Elasticity, RigidDiscInThePlaneTakesItsSurroundingsAlong) {
  const FieldSpace<2> space = test::space_on(geometry::disc(1.0), 2, 0);
  Problem<2> problem{test::elasticity_on(space, 2.0, 0.3), {}, true, {}, {}, {}};
  const auto moved = test::data<2>([](const Point2&, const Vector2&) { return 0.1; });
  problem.conditions.push_back({"bond", {{value, moved, {}}, {value, {}, {}}}, {}});
  problem.condition_of.assign(space.elements.size(), 0);
  const Solution<2> solution = solve(problem, space, {});
  EXPECT_NEAR(solution.at_infinity[0], 0.1, 1e-10);
  EXPECT_NEAR(solution.at_infinity[1], 0.0, 1e-10);
  EXPECT_LT(solution.flux.cwiseAbs().maxCoeff(), 1e-9);
}

/// Order of the displacements under tractions and of the tractions under displacements.
TEST(Elasticity, ManufacturedFieldsConvergeWithFullOrder) {
  const double mu = 1.3, nu = 0.25;
  // Papkovich and Neuber: u = x grad(phi) - (3 - 4 nu) phi e_x for a harmonic phi = exp(x) cos(y).
  const double kappa = 3.0 - 4.0 * nu;
  const ExactField<2> field{[=](const Point2& x) -> Eigen::VectorXd {
                              const double e = std::exp(x[0]), c = std::cos(x[1]), s = std::sin(x[1]);
                              return Vector2(x[0] * e * c - kappa * e * c, -x[0] * e * s);
                            },
                            [=](const Point2& x) -> Eigen::MatrixXd {
                              const double e = std::exp(x[0]), c = std::cos(x[1]), s = std::sin(x[1]);
                              Eigen::Matrix2d gradient;
                              gradient << e * c * (1.0 + x[0] - kappa), -e * s * (x[0] - kappa), -e * s * (1.0 + x[0]),
                                  -x[0] * e * c;
                              return gradient;
                            }};
  for (int degree = 1; degree <= 5; ++degree) {
    std::vector<double> sizes;
    std::vector<double> errors;
    for (const int refine : {3, 4, 5}) {
      const FieldSpace<2> space = test::space_on(geometry::rectangle({1.0, 0.8}), degree, refine);
      const auto problem = test::problem_from<2>(field, test::elasticity_on(space, mu, nu), space, {value, flux});
      SolveOptions options;
      options.tolerance = 1e-13;
      const test::Errors found = test::errors_of(solve(problem, space, options), field, problem, space);
      sizes.push_back(1.0 / space.function_count());
      errors.push_back(std::max(found.potential, found.flux));
    }
    EXPECT_GT(test::observed_order(sizes, errors), degree + 1 - 0.2) << "degree " << degree;
  }
}

}  // namespace
}  // namespace isorim::solver
