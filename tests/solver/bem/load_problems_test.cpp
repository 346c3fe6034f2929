#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "solver/bem/boundary_integrals.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/solve.h"
#include "tests/quadrature/hollow.h"
#include "tests/solver/bem/exact_fields.h"

/// Problems with loads in the domain and known solutions, from the solve to values, gradients and stresses inside.
namespace isorim::solver {
namespace {

using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector;
using geometry::Vector2;
using geometry::Vector3;
using std::numbers::pi;
using testing::ExactField;
using testing::integrand;

template <int Dim>
FieldSpace<Dim> space_on(const geometry::Boundary<Dim>& boundary, int degree, int refine) {
  DiscretisationOptions<Dim> options;
  options.degree = degree;
  options.refine = refine;
  return field_space<Dim>(geometry::orient<Dim>(boundary), options);
}

template <int Dim>
geometry::Boundary<Dim> hollow_boundary(const geometry::Boundary<Dim>& outer, const geometry::Boundary<Dim>& inner) {
  geometry::Boundary<Dim> both = outer;
  for (geometry::Patch<Dim> patch : inner.patches) {
    patch.name = "inner " + patch.name;
    patch.orientation = -patch.orientation;
    both.patches.push_back(patch);
  }
  return both;
}

/// One condition on all elements: prescribed by the functions, components apart.
template <int Dim>
Problem<Dim> problem_with(const Equation<Dim>& equation, const FieldSpace<Dim>& space, ConditionKind kind,
                          std::vector<quadrature::IntegrandFactory<Dim>> data, Loads<Dim> loads) {
  Problem<Dim> problem;
  problem.equation = equation;
  Condition<Dim> condition;
  condition.name = "all";
  for (auto& function : data) condition.components.push_back({kind, std::move(function), {}});
  problem.conditions = {condition};
  problem.condition_of.assign(space.elements.size(), 0);
  problem.loads = std::move(loads);
  return problem;
}

template <int Dim>
Problem<Dim> dirichlet(const Laplace<Dim>& kernel, const FieldSpace<Dim>& space, const ExactField<Dim>& field,
                       Loads<Dim> loads) {
  return problem_with<Dim>(kernel, space, ConditionKind::value,
                           {integrand<Dim>([=](const Point<Dim>& x, const Vector<Dim>&) { return field.value(x)[0]; })},
                           std::move(loads));
}

/// No traction anywhere.
template <int Dim>
Problem<Dim> free_body(const Elasticity<Dim>& kernel, const FieldSpace<Dim>& space, Loads<Dim> loads) {
  return problem_with<Dim>(kernel, space, ConditionKind::flux, std::vector<quadrature::IntegrandFactory<Dim>>(Dim),
                           std::move(loads));
}

SolveOptions solve_options() {
  SolveOptions options;
  options.tolerance = 1e-12;
  return options;
}

/// Largest errors at points inside.
template <int Dim>
struct Found {
  double value = 0.0;
  double gradient = 0.0;
  double stress = 0.0;
};

template <int Dim>
Found<Dim> errors_inside(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const Solution<Dim>& solution,
                         const ExactField<Dim>& field, const geometry::Points<Dim>& points) {
  const auto values = evaluate_at<Dim>(problem, space, solution, points);
  Found<Dim> found;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto& at = values[static_cast<std::size_t>(i)];
    EXPECT_EQ(at.location, Location::inside) << points.col(i).transpose();
    if (at.location != Location::inside) continue;
    found.value = std::max(found.value, (at.field.value - field.value(points.col(i))).norm());
    found.gradient = std::max(found.gradient, (at.field.gradient - field.gradient(points.col(i))).norm());
  }
  return found;
}

template <int Dim>
ExactData<Dim> exact_flux(const Laplace<Dim>& kernel, const ExactField<Dim>& field) {
  ExactData<Dim> exact;
  exact.flux = {integrand<Dim>(
      [=](const Point<Dim>& x, const Vector<Dim>& n) { return testing::flux(kernel, field.gradient(x), n)[0]; })};
  return exact;
}

/// Solves Dirichlet's problem; expects the flux and the inside right to the tolerance.
template <int Dim>
void expect_poisson(const Laplace<Dim>& kernel, const FieldSpace<Dim>& space, const ExactField<Dim>& field,
                    const Loads<Dim>& loads, const geometry::Points<Dim>& points, double tolerance) {
  const Problem<Dim> problem = dirichlet(kernel, space, field, loads);
  const Solution<Dim> solution = solve<Dim>(problem, space, solve_options());
  const auto errors = boundary_errors<Dim>(problem, space, solution, exact_flux(kernel, field));
  EXPECT_LT(errors.flux->l2, tolerance * errors.flux->exact_l2) << field.name;
  const Found<Dim> found = errors_inside<Dim>(problem, space, solution, field, points);
  EXPECT_LT(found.value, tolerance) << field.name;
  EXPECT_LT(found.gradient, 10.0 * tolerance) << field.name;
  const auto integrals = result_integrals<Dim>(problem, space, solution);
  EXPECT_LT(std::abs(integrals.force_imbalance[0]), tolerance * integrals.load.force.norm()) << field.name;
}

/// Constant source: u is quadratic and vanishes on the ellipsoid (P1).
template <int Dim>
ExactField<Dim> quadratic_bubble(const Vector<Dim>& radii) {
  const Vector<Dim> inverse = radii.array().square().inverse();
  const double factor = 1.0 / (2.0 * inverse.sum());
  return {"bubble",
          [=](const Point<Dim>& x) -> Eigen::VectorXd {
            return Eigen::VectorXd::Constant(1, factor * (1.0 - x.cwiseProduct(x).dot(inverse)));
          },
          [=](const Point<Dim>& x) -> Eigen::MatrixXd { return -2.0 * factor * x.cwiseProduct(inverse).transpose(); },
          {}};
}

/// In L2, relative.
template <int Dim>
double bubble_flux_error(const geometry::Boundary<Dim>& boundary, const Vector<Dim>& radii, int degree, int refine) {
  const FieldSpace<Dim> space = space_on<Dim>(boundary, degree, refine);
  const Laplace<Dim> kernel{1.0, logarithm_length(space.table)};
  const ExactField<Dim> field = quadratic_bubble<Dim>(radii);
  const Problem<Dim> problem = dirichlet(kernel, space, field, {polynomial_load(kernel, {Quadratic<Dim>{1.0}})});
  const auto errors =
      boundary_errors<Dim>(problem, space, solve<Dim>(problem, space, solve_options()), exact_flux(kernel, field));
  return errors.flux->l2 / errors.flux->exact_l2;
}

/// Of the normal derivative, which the space only approximates, since normals have roots in them: what bounds the test
/// below is the order of the discretisation, not the source.
TEST(Poisson, FluxOfAUnitSourceConvergesWithTheOrderOfTheFunctions) {
  for (const int degree : {3, 5}) {
    const Vector2 radii(2.0, 1.0);
    const double coarse = bubble_flux_error<2>(geometry::elliptic_disc(radii), radii, degree, 3);
    const double fine = bubble_flux_error<2>(geometry::elliptic_disc(radii), radii, degree, 4);
    EXPECT_GT(std::log2(coarse / fine), degree + 0.7) << degree;
  }
  const Vector3 radii(1.0, 0.8, 0.6);
  // On eight elements that meet at two poles, by degree.
  EXPECT_LT(bubble_flux_error<3>(geometry::ellipsoid(radii), radii, 4, 1), 2e-4);
  EXPECT_LT(bubble_flux_error<3>(geometry::ellipsoid(radii), radii, 6, 1), 6.5e-6);
  EXPECT_LT(bubble_flux_error<3>(geometry::ellipsoid(radii), radii, 8, 1), 1.4e-6);
}

TEST(Poisson, UnitSourceInEllipseAndEllipsoid) {
  const FieldSpace<2> ellipse = space_on<2>(geometry::elliptic_disc({2.0, 1.0}), 5, 2);
  const Laplace<2> plane{1.0, logarithm_length(ellipse.table)};
  geometry::Points<2> in_ellipse(2, 3);
  in_ellipse << 0.0, 1.3, -1.9, 0.0, 0.5, 0.1;
  expect_poisson<2>(plane, ellipse, quadratic_bubble<2>({2.0, 1.0}), {polynomial_load(plane, {Quadratic<2>{1.0}})},
                    in_ellipse, 2e-5);
  const FieldSpace<3> ellipsoid = space_on<3>(geometry::ellipsoid({1.0, 0.8, 0.6}), 4, 1);
  const Laplace<3> space;
  geometry::Points<3> in_ellipsoid(3, 2);
  in_ellipsoid << 0.0, 0.3, 0.0, -0.4, 0.0, 0.3;
  expect_poisson<3>(space, ellipsoid, quadratic_bubble<3>({1.0, 0.8, 0.6}),
                    {polynomial_load(space, {Quadratic<3>{1.0}})}, in_ellipsoid, 3e-4);
}

/// Prandtl's stress function of an elliptic bar: -lap phi = 2, its slope the shear stress.
TEST(Poisson, TorsionOfAnEllipticBar) {
  constexpr double a = 2.0;
  constexpr double b = 1.0;
  const FieldSpace<2> space = space_on<2>(geometry::elliptic_disc({a, b}), 4, 3);
  const Laplace<2> kernel{1.0, logarithm_length(space.table)};
  ExactField<2> field = quadratic_bubble<2>({a, b});
  const auto problem = dirichlet(
      kernel, space, {"zero", [](const Point2&) -> Eigen::VectorXd { return Eigen::VectorXd::Zero(1); }, {}, {}},
      {polynomial_load(kernel, {Quadratic<2>{2.0}})});
  const auto solution = solve<2>(problem, space, solve_options());
  geometry::Points<2> points(2, 2);
  points << 0.0, 1.1, 0.0, -0.4;
  const auto inside = evaluate_at<2>(problem, space, solution, points);
  for (std::size_t i = 0; i < 2; ++i) {
    const Point2 x = points.col(static_cast<Eigen::Index>(i));
    EXPECT_NEAR(inside[i].field.value[0], 2.0 * field.value(x)[0], 1e-7);
    EXPECT_LT((inside[i].field.gradient - 2.0 * field.gradient(x)).norm(), 1e-6);
  }
  // The greatest shear stress is at the ends of the short axis: 2 a^2 b / (a^2 + b^2).
  double greatest = 0.0;
  BoundaryFields<2> boundary(problem, space, solution);
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    for (const double s : {0.0, 0.5, 1.0})
      greatest = std::max(greatest, boundary(e, geometry::Point<1>(s)).field.gradient.norm());
  }
  EXPECT_NEAR(greatest, 2.0 * a * a * b / (a * a + b * b), 1e-5);
}

/// P2: on (-1, 1)^2; 0.294685413126 in the middle. The flux vanishes at the corners.
TEST(Poisson, UnitSourceInASquare) {
  const FieldSpace<2> space = space_on<2>(geometry::rectangle({2.0, 2.0}, {-1.0, -1.0}), 4, 4);
  const Laplace<2> kernel{1.0, logarithm_length(space.table)};
  auto problem =
      problem_with<2>(kernel, space, ConditionKind::value, {{}}, {polynomial_load(kernel, {Quadratic<2>{1.0}})});
  const auto solution = solve<2>(problem, space, solve_options());
  const geometry::Points<2> centre = geometry::Points<2>::Zero(2, 1);
  EXPECT_NEAR(evaluate_at<2>(problem, space, solution, centre)[0].field.value[0], 0.294685413126, 1e-7);
}

/// P3: u = erf(alpha r) / (4 pi r).
TEST(Poisson, GaussianInASphere) {
  constexpr double alpha = 4.0;
  const ExactField<3> field{"gaussian",
                            [](const Point3& x) -> Eigen::VectorXd {
                              const double r = x.norm();
                              return Eigen::VectorXd::Constant(1, std::erf(alpha * r) / (4.0 * pi * r));
                            },
                            [](const Point3& x) -> Eigen::MatrixXd {
                              const double r = x.norm();
                              const double slope = 2.0 * alpha / std::sqrt(pi) * std::exp(-alpha * alpha * r * r) / r -
                                                   std::erf(alpha * r) / (r * r);
                              return slope / (4.0 * pi * r) * x.transpose();
                            },
                            {}};
  const FieldSpace<3> space = space_on<3>(geometry::sphere(1.0), 3, 0);
  const Laplace<3> kernel;
  const auto density = integrand<3>([](const Point3& x, const Vector3&) {
    return std::pow(alpha / std::sqrt(pi), 3) * std::exp(-alpha * alpha * x.squaredNorm());
  });
  geometry::Points<3> points(3, 2);
  points << 0.2, 0.5, 0.1, -0.3, -0.1, 0.4;
  // Value and flux are constant on the sphere, hence in the space.
  expect_poisson<3>(kernel, space, field, {expression_load(kernel, {density}, space.table)}, points, 1e-9);
}

/// P4: u = sin(pi x) sin(pi y) [sin(pi z)] on the unit square and cube.
template <int Dim>
ExactField<Dim> product_of_sines() {
  const auto rest = [](const Point<Dim>& x, int without) {
    double product = 1.0;
    for (int k = 0; k < Dim; ++k) product *= k == without ? 1.0 : std::sin(pi * x[k]);
    return product;
  };
  return {"sines", [=](const Point<Dim>& x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, rest(x, -1)); },
          [=](const Point<Dim>& x) -> Eigen::MatrixXd {
            Eigen::MatrixXd gradient(1, Dim);
            for (int k = 0; k < Dim; ++k) gradient(0, k) = pi * std::cos(pi * x[k]) * rest(x, k);
            return gradient;
          },
          [=](const Point<Dim>& x) -> Eigen::VectorXd {
            return Eigen::VectorXd::Constant(1, Dim * pi * pi * rest(x, -1));
          }};
}

TEST(Poisson, SinesInSquareAndCube) {
  const FieldSpace<2> square = space_on<2>(geometry::rectangle({1.0, 1.0}), 5, 3);
  const Laplace<2> plane{1.0, logarithm_length(square.table)};
  geometry::Points<2> in_square(2, 2);
  in_square << 0.3, 0.95, 0.6, 0.97;
  expect_poisson<2>(plane, square, product_of_sines<2>(),
                    {expression_load(plane, testing::load_density(product_of_sines<2>(), 1), square.table)}, in_square,
                    1e-6);
  const FieldSpace<3> cube = space_on<3>(geometry::cube(1.0), 4, 1);
  const Laplace<3> space;
  geometry::Points<3> in_cube(3, 2);
  in_cube << 0.3, 0.9, 0.6, 0.8, 0.5, 0.95;
  expect_poisson<3>(space, cube, product_of_sines<3>(),
                    {expression_load(space, testing::load_density(product_of_sines<3>(), 1), cube.table)}, in_cube,
                    2e-3);
}

/// B1: a bar hung at z = L, its displacement prescribed there, free elsewhere.
TEST(BodyForce, BarUnderItsOwnWeight) {
  constexpr double length = 2.0;
  constexpr double weight = 1.3;
  const Elasticity<3> kernel{1.0, 0.3};
  const double young = 2.0 * kernel.shear_modulus * (1.0 + kernel.poisson);
  const double nu = kernel.poisson;
  const FieldSpace<3> space = space_on<3>(geometry::box({1.0, 1.0, length}, {-0.5, -0.5, 0.0}), 2, 1);
  const ExactField<3> field{"bar",
                            [=](const Point3& x) -> Eigen::VectorXd {
                              return weight / young *
                                     Vector3(-nu * x[0] * x[2], -nu * x[1] * x[2],
                                             0.5 * (x[2] * x[2] - length * length + nu * (x[0] * x[0] + x[1] * x[1])));
                            },
                            [=](const Point3& x) -> Eigen::MatrixXd {
                              Eigen::MatrixXd g(3, 3);
                              g << -nu * x[2], 0.0, -nu * x[0], 0.0, -nu * x[2], -nu * x[1], nu * x[0], nu * x[1], x[2];
                              return weight / young * g;
                            },
                            {}};
  Problem<3> problem =
      free_body<3>(kernel, space, {polynomial_load(kernel, {Quadratic<3>{}, Quadratic<3>{}, Quadratic<3>{-weight}})});
  Condition<3> hung;
  hung.name = "top";
  for (int c = 0; c < 3; ++c)
    hung.components.push_back(
        {ConditionKind::value, integrand<3>([=](const Point3& x, const Vector3&) { return field.value(x)[c]; }), {}});
  problem.conditions.push_back(hung);
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    if (space.table.elements[e].patch == 5) problem.condition_of[e] = 1;
  }
  const auto solution = solve<3>(problem, space, solve_options());
  geometry::Points<3> points(3, 3);
  points << 0.0, 0.3, 0.4999, 0.1, -0.2, 0.3, 1.0, 1.7, 0.4;
  const auto inside = evaluate_at<3>(problem, space, solution, points);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 x = points.col(static_cast<Eigen::Index>(i));
    Eigen::MatrixXd stress = Eigen::MatrixXd::Zero(3, 3);
    stress(2, 2) = weight * x[2];
    // The solution is quadratic, so it lies in the space.
    EXPECT_LT((inside[i].field.value - field.value(x)).norm(), 1e-9) << i;
    EXPECT_LT((inside[i].field.stress - stress).norm(), 1e-8) << i;
  }
  const auto integrals = result_integrals<3>(problem, space, solution);
  EXPECT_LT((integrals.conditions[1].flux - Vector3(0.0, 0.0, weight * length)).norm(), 1e-9);
  EXPECT_LT(integrals.force_imbalance.norm(), 1e-9);
  EXPECT_LT(integrals.moment_imbalance.norm(), 1e-9);
}

/// B2 in plane stress with a bore: no traction anywhere, so that rigid motions are free.
TEST(BodyForce, RotatingAnnulus) {
  constexpr double a = 0.5;
  constexpr double b = 1.0;
  constexpr double nu = 0.3;
  constexpr double mu = 0.8;
  const FieldSpace<2> space = space_on<2>(hollow_boundary(geometry::disc(b), geometry::disc(a)), 4, 3);
  const Elasticity<2> kernel{mu, nu / (1.0 + nu), logarithm_length(space.table)};
  Rotation rotation;
  rotation.angular_speed = 1.5;
  rotation.density = 2.0;
  Problem<2> problem = free_body<2>(kernel, space, {centrifugal_load<2>(kernel, rotation)});
  problem.plane_state = PlaneState::stress;
  const auto solution = solve<2>(problem, space, solve_options());
  geometry::Points<2> points(2, 3);
  points << 0.7, 0.0, -0.50001, 0.1, -0.9, 0.0;
  const auto inside = evaluate_at<2>(problem, space, solution, points);
  const double strength = rotation.density * rotation.angular_speed * rotation.angular_speed;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 x = points.col(static_cast<Eigen::Index>(i));
    const double r = x.norm();
    const Vector2 e = x / r;
    const Vector2 f(-e[1], e[0]);
    const double radial = (3.0 + nu) / 8.0 * strength * (a * a + b * b - a * a * b * b / (r * r) - r * r);
    const double hoop =
        (3.0 + nu) / 8.0 * strength * (a * a + b * b + a * a * b * b / (r * r) - (1.0 + 3.0 * nu) / (3.0 + nu) * r * r);
    const double young = 2.0 * mu * (1.0 + nu);
    EXPECT_NEAR(e.dot(inside[i].field.stress * e), radial, 1e-5 * strength) << i;
    EXPECT_NEAR(f.dot(inside[i].field.stress * f), hoop, 1e-5 * strength) << i;
    EXPECT_NEAR(e.dot(inside[i].field.stress * f), 0.0, 1e-5 * strength) << i;
    EXPECT_NEAR(inside[i].field.value.dot(e), r * (hoop - nu * radial) / young, 1e-5) << i;
    EXPECT_EQ(inside[i].field.stress_across, 0.0);
  }
}

/// B3: a sphere under its own gravity, no traction.
TEST(BodyForce, SelfGravitatingSphere) {
  constexpr double b = 1.0;
  constexpr double strength = 1.7;
  const Elasticity<3> kernel{1.0, 0.25};
  const double nu = kernel.poisson;
  const double mu = kernel.shear_modulus;
  const double lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
  const FieldSpace<3> space = space_on<3>(geometry::sphere(b), 4, 1);
  std::vector<Quadratic<3>> force(3);
  for (int i = 0; i < 3; ++i) force[static_cast<std::size_t>(i)].linear[i] = -strength / b;
  const Problem<3> problem = free_body<3>(kernel, space, {polynomial_load(kernel, force)});
  const auto solution = solve<3>(problem, space, solve_options());
  geometry::Points<3> points(3, 2);
  points << 0.3, 0.0, 0.2, 0.8, -0.4, 0.55;
  const auto inside = evaluate_at<3>(problem, space, solution, points);
  for (std::size_t i = 0; i < 2; ++i) {
    const Point3 x = points.col(static_cast<Eigen::Index>(i));
    const double r = x.norm();
    const double exact = -strength * r / (10.0 * b * (lambda + 2.0 * mu)) * ((3.0 - nu) / (1.0 + nu) * b * b - r * r);
    EXPECT_LT((inside[i].field.value - exact * x / r).norm(), 2e-5) << i;
  }
}

/// A hollow cylinder in plane strain, free of traction, with theta = theta_0 + c r^2 (Timoshenko & Goodier, art. 151).
TEST(Temperature, HollowCylinder) {
  constexpr double a = 0.5;
  constexpr double b = 1.0;
  const FieldSpace<2> space = space_on<2>(hollow_boundary(geometry::disc(b), geometry::disc(a)), 4, 3);
  const Elasticity<2> kernel{0.8, 0.3, logarithm_length(space.table)};
  const double nu = kernel.poisson;
  const double young = 2.0 * kernel.shear_modulus * (1.0 + nu);
  constexpr double expansion = 0.01;
  constexpr double base = 20.0;
  constexpr double slope = 30.0;
  Quadratic<2> temperature{base};
  temperature.quadratic = slope * Eigen::Matrix2d::Identity();
  Problem<2> problem =
      free_body<2>(kernel, space, {thermal_load<2>(kernel, young * expansion / (1.0 - 2.0 * nu), temperature)});
  const auto solution = solve<2>(problem, space, solve_options());
  const auto moment = [&](double r) {
    return 0.5 * base * (r * r - a * a) + 0.25 * slope * (std::pow(r, 4) - std::pow(a, 4));
  };
  geometry::Points<2> points(2, 3);
  points << 0.7, 0.0, -0.50001, 0.1, -0.9, 0.0;
  const auto inside = evaluate_at<2>(problem, space, solution, points);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 x = points.col(static_cast<Eigen::Index>(i));
    const double r = x.norm();
    const Vector2 e = x / r;
    const Vector2 f(-e[1], e[0]);
    const double factor = expansion * young / (1.0 - nu) / (r * r);
    const double share = moment(b) / (b * b - a * a);
    const double theta = base + slope * r * r;
    const double radial = factor * ((r * r - a * a) * share - moment(r));
    const double hoop = factor * ((r * r + a * a) * share + moment(r) - theta * r * r);
    const double across = nu * (radial + hoop) - expansion * young * theta;
    EXPECT_NEAR(e.dot(inside[i].field.stress * e), radial, 1e-5) << i;
    EXPECT_NEAR(f.dot(inside[i].field.stress * f), hoop, 1e-5) << i;
    EXPECT_NEAR(inside[i].field.stress_across, across, 1e-5) << i;
  }
}

/// A uniform temperature stretches any free body without stress; exact, since the stretch lies in the space.
TEST(Temperature, UniformRiseIsExact) {
  const FieldSpace<3> space = space_on<3>(geometry::sphere(1.0), 2, 0);
  const Elasticity<3> kernel{1.0, 0.3};
  const double young = 2.0 * kernel.shear_modulus * (1.0 + kernel.poisson);
  constexpr double expansion = 0.02;
  const Problem<3> problem = free_body<3>(
      kernel, space, {thermal_load<3>(kernel, young * expansion / (1.0 - 2.0 * kernel.poisson), Quadratic<3>{10.0})});
  const auto solution = solve<3>(problem, space, solve_options());
  geometry::Points<3> points(3, 2);
  points << 0.3, 0.0, 0.2, 0.8, -0.4, 0.55;
  const auto inside = evaluate_at<3>(problem, space, solution, points);
  for (std::size_t i = 0; i < 2; ++i) {
    const Point3 x = points.col(static_cast<Eigen::Index>(i));
    EXPECT_LT((inside[i].field.value - 10.0 * expansion * x).norm(), 1e-12) << i;
    EXPECT_LT(inside[i].field.stress.norm(), 1e-11) << i;
  }
}

}  // namespace
}  // namespace isorim::solver
