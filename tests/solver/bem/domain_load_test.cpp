#include "solver/bem/domain_load.h"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "quadrature/gauss_legendre.h"
#include "tests/quadrature/hollow.h"
#include "tests/solver/bem/exact_fields.h"

namespace isorim::solver {
namespace {

using geometry::bezier_elements;
using geometry::ElementTable;
using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector;
using geometry::Vector2;
using geometry::Vector3;
using quadrature::NodeView;
using quadrature::Target;
using quadrature::TargetRules;
using std::numbers::pi;
using testing::ExactField;
using testing::flux;
using ::testing::HasSubstr;
using testing::integrand;
using testing::load_density;

constexpr double tolerance = 1e-11;

template <int Dim>
Target<Dim> free_target(const Point<Dim>& position) {
  Target<Dim> target;
  target.position = position;
  return target;
}

template <int Dim>
Eigen::MatrixXd potentials(const ElementTable<Dim>& table, const Loads<Dim>& loads,
                           const std::vector<Target<Dim>>& targets) {
  const TargetRules<Dim> rules(table, {1e-12, 4});
  return domain_potentials<Dim>(loads, table, rules, targets);
}

template <int Dim>
DomainJets jets(const ElementTable<Dim>& table, const Loads<Dim>& loads, const std::vector<Target<Dim>>& targets) {
  const TargetRules<Dim> rules(table, {1e-12, 4});
  return domain_jets<Dim>(loads, table, rules, targets);
}

/// int (U t - T u) dS, and its derivatives by x, of an exact field: what the load's potential lacks to the field itself
/// (Green, Somigliana).
template <class Kernel>
struct BoundaryPart {
  static constexpr int dimension = Kernel::dimension;
  static constexpr int components = Kernel::components;

  Eigen::VectorXd value = Eigen::VectorXd::Zero(components);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(dimension * components);

  BoundaryPart(const Kernel& kernel, const ElementTable<dimension>& table, const ExactField<dimension>& field,
               const Point<dimension>& x) {
    const TargetRules<dimension> rules(table, {1e-14, 16});
    quadrature::NodeBuffer<dimension> buffer;
    for (std::size_t e = 0; e < table.elements.size(); ++e)
      add(kernel, field, x, rules.nodes(static_cast<int>(e), free_target<dimension>(x), buffer));
  }

 private:
  void add(const Kernel& kernel, const ExactField<dimension>& field, const Point<dimension>& x,
           const NodeView<dimension>& nodes) {
    const std::size_t n = nodes.size();
    std::vector<double> single(components * components * n);
    std::vector<double> twice(components * components * n);
    std::vector<double> single_gradient(dimension * components * components * n);
    std::vector<double> twice_gradient(dimension * components * components * n);
    single_layer(kernel, x, nodes, std::span<double>(single));
    double_layer(kernel, x, nodes, std::span<double>(twice));
    single_layer_gradient(kernel, x, nodes, std::span<double>(single_gradient));
    double_layer_gradient(kernel, x, nodes, std::span<double>(twice_gradient));
    for (std::size_t q = 0; q < n; ++q) {
      Point<dimension> y;
      Vector<dimension> normal;
      for (std::size_t i = 0; i < dimension; ++i) {
        y[static_cast<Eigen::Index>(i)] = nodes.position[i][q];
        normal[static_cast<Eigen::Index>(i)] = nodes.normal[i][q];
      }
      const Eigen::VectorXd u = nodes.weight[q] * field.value(y);
      const Eigen::VectorXd t = nodes.weight[q] * flux(kernel, field.gradient(y), normal);
      for (int row = 0; row < dimension * components; ++row) {
        for (int j = 0; j < components; ++j) {
          const std::size_t at = static_cast<std::size_t>(row * components + j) * n + q;
          if (row < components) value[row] += single[at] * t[j] - twice[at] * u[j];
          gradient[row] += single_gradient[at] * t[j] - twice_gradient[at] * u[j];
        }
      }
    }
  }
};

/// Row k * components + i: the derivative of component i by coordinate k.
Eigen::VectorXd stacked(const Eigen::MatrixXd& gradient) {
  return Eigen::Map<const Eigen::VectorXd>(gradient.data(), gradient.size());
}

/// The load's potential is the field less its boundary part, at points inside.
template <class Kernel>
void expect_representation(const Kernel& kernel, const ElementTable<Kernel::dimension>& table,
                           const ExactField<Kernel::dimension>& field, const Loads<Kernel::dimension>& loads,
                           const std::vector<Point<Kernel::dimension>>& points, const std::string& what) {
  constexpr int dimension = Kernel::dimension;
  std::vector<Target<dimension>> targets;
  for (const auto& x : points) targets.push_back(free_target<dimension>(x));
  const Eigen::MatrixXd potential = potentials<dimension>(table, loads, targets);
  const DomainJets jet = jets<dimension>(table, loads, targets);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const BoundaryPart<Kernel> rest(kernel, table, field, points[i]);
    const Eigen::VectorXd exact = field.value(points[i]) - rest.value;
    const Eigen::VectorXd exact_gradient = stacked(field.gradient(points[i])) - rest.gradient;
    const double scale = field.value(points[i]).norm() + rest.value.norm();
    EXPECT_LT((potential.col(column) - exact).norm(), tolerance * scale) << what << ", " << field.name << " " << i;
    EXPECT_LT((jet.value.col(column) - exact).norm(), tolerance * scale) << what << ", " << field.name << " " << i;
    EXPECT_LT((jet.gradient.col(column) - exact_gradient).norm(),
              tolerance * (exact_gradient.norm() + rest.gradient.norm()))
        << what << ", " << field.name << " " << i;
  }
}

ElementTable<2> annulus(double inner, double outer) {
  return quadrature::testing::hollow(geometry::disc(outer), geometry::disc(inner));
}

TEST(DomainLoad, SourcesInThePlane) {
  const Laplace<2> kernel{2.5, 7.0};
  const ExactField<2> field = testing::wave_potential<2>(kernel, {0.4, -0.3}, {1.1, 0.7}, 0.6);
  const auto check = [&](const ElementTable<2>& table, const std::vector<Point2>& points, const std::string& what) {
    expect_representation(kernel, table, field, {expression_load(kernel, load_density(field, 1), table)}, points, what);
  };
  check(bezier_elements(geometry::disc(1.0)), {{0.0, 0.0}, {0.5, -0.3}}, "disc");
  check(bezier_elements(geometry::elliptic_disc({2.0, 0.7}, {0.3, 0.1}, 0.4)), {{0.4, 0.1}, {1.2, 0.5}}, "ellipse");
  check(bezier_elements(geometry::rectangle({1.0, 2.0})), {{0.5, 0.5}, {0.2, 1.7}}, "rectangle");
  check(annulus(0.8, 1.5), {{1.1, 0.0}, {-0.7, 0.9}}, "annulus");
}

TEST(DomainLoad, SourcesInSpace) {
  const Laplace<3> kernel{0.7};
  const ExactField<3> field = testing::wave_potential<3>(kernel, {0.3, -0.2, 0.4}, {0.7, 1.1, -0.5}, 0.3);
  const auto check = [&](const ElementTable<3>& table, const std::vector<Point3>& points, const std::string& what) {
    expect_representation(kernel, table, field, {expression_load(kernel, load_density(field, 1), table)}, points, what);
  };
  check(bezier_elements(geometry::sphere(1.0)), {{0.0, 0.0, 0.0}, {0.3, -0.2, 0.4}}, "sphere");
  check(bezier_elements(geometry::cube(1.0)), {{0.5, 0.4, 0.6}}, "cube");
  check(bezier_elements(geometry::torus(1.0, 0.4)), {{1.1, 0.0, 0.1}}, "torus");
}

TEST(DomainLoad, ForcesInThePlane) {
  const Elasticity<2> kernel{1.7, 0.3, 5.0};
  const ExactField<2> field = testing::wave_displacement<2>(kernel, {0.8, -0.5}, {0.9, 1.3}, 0.2);
  const auto check = [&](const ElementTable<2>& table, const std::vector<Point2>& points, const std::string& what) {
    expect_representation(kernel, table, field, {expression_load(kernel, load_density(field, 2), table)}, points, what);
  };
  check(bezier_elements(geometry::disc(1.0)), {{0.1, 0.2}}, "disc");
  check(annulus(0.8, 1.5), {{1.1, 0.0}, {-0.7, 0.9}}, "annulus");
}

TEST(DomainLoad, ForcesInSpace) {
  const Elasticity<3> kernel{0.6, 0.25};
  const ExactField<3> field = testing::wave_displacement<3>(kernel, {0.8, -0.5, 0.3}, {0.9, 0.4, -0.6}, 0.2);
  const ElementTable<3> table = bezier_elements(geometry::sphere(1.0));
  expect_representation(kernel, table, field, {expression_load(kernel, load_density(field, 3), table)},
                        {{0.2, 0.1, -0.3}}, "sphere");
}

/// u_i = (z - p)_i^3 / 6: Navier's equation makes a force of it that is linear in z.
template <int Dim>
ExactField<Dim> cubes(const Elasticity<Dim>& kernel) {
  const double mu = kernel.shear_modulus;
  const double lambda = 2.0 * mu * kernel.poisson / (1.0 - 2.0 * kernel.poisson);
  return {"cubes", [](const Point<Dim>& x) -> Eigen::VectorXd { return x.array().cube() / 6.0; },
          [](const Point<Dim>& x) -> Eigen::MatrixXd {
            return Eigen::MatrixXd((0.5 * x.array().square()).matrix().asDiagonal());
          },
          [=](const Point<Dim>& x) -> Eigen::VectorXd { return -(lambda + 2.0 * mu) * x; }};
}

TEST(DomainLoad, CentrifugalLoadIsLinearInTheDistance) {
  const Elasticity<2> kernel{1.3, 0.3, 4.0};
  const double stiffness = 2.0 * kernel.shear_modulus * (1.0 - kernel.poisson) / (1.0 - 2.0 * kernel.poisson);
  Rotation rotation;
  rotation.density = 0.5;
  rotation.angular_speed = std::sqrt(stiffness / rotation.density);
  ExactField<2> field = cubes<2>(kernel);
  // The load of the rotation is the opposite of the field's.
  field.value = [value = field.value](const Point2& x) -> Eigen::VectorXd { return -value(x); };
  field.gradient = [gradient = field.gradient](const Point2& x) -> Eigen::MatrixXd { return -gradient(x); };
  expect_representation(kernel, annulus(0.8, 1.5), field, {centrifugal_load<2>(kernel, rotation)}, {{1.1, 0.3}},
                        "annulus");
}

TEST(DomainLoad, CentrifugalLoadAboutAnyAxis) {
  const Elasticity<3> kernel{1.0, 0.3};
  Rotation rotation{{1.0, 2.0, 3.0}, {0.0, 2.0, 2.0}, 3.0, 0.5};
  const auto density = centrifugal_load<3>(kernel, rotation)->density();
  const Point3 z(4.0, -1.0, 5.0);
  const Vector3 axis = Vector3(0.0, 1.0, 1.0).normalized();
  const Vector3 arm = z - rotation.point;
  const Vector3 exact = 0.5 * 9.0 * (arm - axis * axis.dot(arm));
  for (std::size_t c = 0; c < 3; ++c) {
    double value = 0.0;
    density[c]()(z, geometry::Points<3>(3, 0), {&value, 1});
    EXPECT_NEAR(value, exact[static_cast<Eigen::Index>(c)], 1e-13);
  }
}

/// Potentials of polynomials over the unit ball and disc, at points inside and on the boundary.
TEST(DomainLoad, PolynomialsOverTheBall) {
  const Laplace<3> kernel;
  const ElementTable<3> ball = bezier_elements(geometry::sphere(1.0));
  std::vector<Target<3>> targets{free_target<3>({0.0, 0.0, 0.0}), free_target<3>({0.3, -0.5, 0.2}),
                                 free_target<3>({0.0, 0.6, 0.799})};
  Quadratic<3> squared;
  squared.quadratic.setIdentity();
  Quadratic<3> saddle;
  saddle.quadratic.diagonal() << 1.0, -1.0, 0.0;
  const Eigen::MatrixXd one = potentials<3>(ball, {polynomial_load(kernel, {Quadratic<3>{1.0}})}, targets);
  const Eigen::MatrixXd radial = potentials<3>(ball, {polynomial_load(kernel, {squared})}, targets);
  const Eigen::MatrixXd tilted = potentials<3>(ball, {polynomial_load(kernel, {saddle})}, targets);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Point3 x = targets[static_cast<std::size_t>(i)].position;
    const double r2 = x.squaredNorm();
    EXPECT_NEAR(one(0, i), (3.0 - r2) / 6.0, tolerance);
    EXPECT_NEAR(radial(0, i), 0.25 - r2 * r2 / 20.0, tolerance);
    EXPECT_NEAR(tilted(0, i), (x[0] * x[0] - x[1] * x[1]) * (0.1 - r2 / 14.0), tolerance);
  }
}

TEST(DomainLoad, PolynomialsOverTheDisc) {
  const Laplace<2> kernel{1.0, 3.0};
  const ElementTable<2> disc = bezier_elements(geometry::disc(1.0));
  const std::vector<Target<2>> targets{free_target<2>({0.0, 0.0}), free_target<2>({0.3, -0.5}),
                                       free_target<2>({0.6, 0.799})};
  const Eigen::MatrixXd one = potentials<2>(disc, {polynomial_load(kernel, {Quadratic<2>{1.0}})}, targets);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double r2 = targets[static_cast<std::size_t>(i)].position.squaredNorm();
    EXPECT_NEAR(one(0, i), (1.0 - r2) / 4.0 + std::log(3.0) / 2.0, tolerance);
  }
}

/// (al / sqrt(pi))^3 exp(-al^2 r^2) over the unit ball: by two integrals over the radius (bem_problems.md, P3).
double gaussian_potential(double alpha, double r) {
  const auto density = [&](double s) { return std::pow(alpha / std::sqrt(pi), 3) * std::exp(-alpha * alpha * s * s); };
  const auto integral = [](double from, double to, const auto& f) {
    double sum = 0.0;
    constexpr int panels = 200;
    const quadrature::Rule& rule = quadrature::gauss_legendre(16);
    for (int p = 0; p < panels; ++p) {
      const double h = (to - from) / panels;
      for (std::size_t k = 0; k < rule.nodes.size(); ++k)
        sum += h * rule.weights[k] * f(from + h * (p + rule.nodes[k]));
    }
    return sum;
  };
  const double outer = integral(r, 1.0, [&](double s) { return density(s) * s; });
  return r > 0.0 ? outer + integral(0.0, r, [&](double s) { return density(s) * s * s; }) / r : outer;
}

TEST(DomainLoad, SharpGaussians) {
  const Laplace<3> kernel;
  const ElementTable<3> ball = bezier_elements(geometry::sphere(1.0));
  for (const double alpha : {1.0, 5.0, 12.0}) {
    const std::vector<quadrature::IntegrandFactory<3>> density{integrand<3>([=](const Point3& x, const Vector3&) {
      return std::pow(alpha / std::sqrt(pi), 3) * std::exp(-alpha * alpha * x.squaredNorm());
    })};
    const std::vector<Target<3>> targets{free_target<3>({0.0, 0.0, 0.05}), free_target<3>({0.0, 0.6, 0.79})};
    const Eigen::MatrixXd found = potentials<3>(ball, {expression_load(kernel, density, ball)}, targets);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const double exact = gaussian_potential(alpha, targets[i].position.norm());
      EXPECT_NEAR(found(0, static_cast<Eigen::Index>(i)), exact, tolerance * alpha) << alpha << " " << i;
    }
  }
}

/// Against the equivalent force -beta grad theta and traction beta theta n.
template <int Dim>
void expect_thermal_potential(const Elasticity<Dim>& kernel, const ElementTable<Dim>& table, const Point<Dim>& point) {
  constexpr double beta = 1.9;
  const Vector<Dim> slope = Vector<Dim>::LinSpaced(Dim, 0.4, -0.9);
  const auto temperature = [=](const Point<Dim>& x) { return 300.0 + std::exp(slope.dot(x)); };
  const auto load = thermal_load<Dim>(
      kernel, beta, integrand<Dim>([=](const Point<Dim>& x, const Vector<Dim>&) { return temperature(x); }), table);
  // The same by the force and by the single layer of the traction.
  ExactField<Dim> force;
  force.load = [=](const Point<Dim>& x) -> Eigen::VectorXd { return -beta * std::exp(slope.dot(x)) * slope; };
  const auto duhamel = expression_load(kernel, load_density(force, Dim), table);
  const std::vector<Target<Dim>> targets{free_target<Dim>(point)};
  const Eigen::MatrixXd found = potentials<Dim>(table, {load}, targets);
  Eigen::VectorXd exact = potentials<Dim>(table, {duhamel}, targets);
  const DomainJets found_jet = jets<Dim>(table, {load}, targets);
  Eigen::VectorXd exact_gradient = jets<Dim>(table, {duhamel}, targets).gradient;
  const TargetRules<Dim> rules(table, {1e-14, 16});
  quadrature::NodeBuffer<Dim> buffer;
  Eigen::VectorXd uniform_gradient = Eigen::VectorXd::Zero(Dim * Dim);
  for (std::size_t e = 0; e < table.elements.size(); ++e) {
    const NodeView<Dim> nodes = rules.nodes(static_cast<int>(e), targets.front(), buffer);
    const std::size_t n = nodes.size();
    std::vector<double> single(Dim * Dim * n);
    std::vector<double> gradient(Dim * Dim * Dim * n);
    single_layer(kernel, point, nodes, std::span<double>(single));
    single_layer_gradient(kernel, point, nodes, std::span<double>(gradient));
    for (std::size_t q = 0; q < n; ++q) {
      Point<Dim> y;
      for (std::size_t i = 0; i < Dim; ++i) y[static_cast<Eigen::Index>(i)] = nodes.position[i][q];
      for (std::size_t row = 0; row < Dim * Dim; ++row) {
        for (std::size_t j = 0; j < Dim; ++j) {
          const double weight = nodes.weight[q] * beta * nodes.normal[j][q];
          const auto at = static_cast<Eigen::Index>(row);
          if (row < Dim) exact[at] += weight * temperature(y) * single[(row * Dim + j) * n + q];
          exact_gradient[at] += weight * temperature(y) * gradient[(row * Dim + j) * n + q];
          uniform_gradient[at] += weight * temperature(point) * gradient[(row * Dim + j) * n + q];
        }
      }
    }
  }
  EXPECT_LT((found - exact).norm(), tolerance * exact.norm()) << Dim;
  EXPECT_LT((found_jet.gradient + uniform_gradient - exact_gradient).norm(), tolerance * exact_gradient.norm()) << Dim;
  EXPECT_NEAR(found_jet.uniform_stress[0], beta * temperature(point), 1e-12);
}

TEST(DomainLoad, TemperatureIsDuhamelsForceAndTraction) {
  expect_thermal_potential<2>({1.1, 0.3, 6.0}, annulus(0.8, 1.5), {1.1, 0.3});
  expect_thermal_potential<3>({0.8, 0.2}, bezier_elements(geometry::sphere(1.0)), {0.2, -0.3, 0.1});
}

TEST(DomainLoad, ResultantsOfAWeight) {
  const Elasticity<3> kernel;
  const ElementTable<3> table = bezier_elements(geometry::box({1.0, 2.0, 3.0}));
  const auto weight = polynomial_load(kernel, {Quadratic<3>{}, Quadratic<3>{}, Quadratic<3>{-2.0}});
  const LoadResultant found = load_resultant<3>({weight, weight}, table, Point3::Zero());
  EXPECT_LT((found.force - Vector3(0.0, 0.0, -24.0)).norm(), 1e-12);
  EXPECT_LT((found.moment - Vector3(-24.0, 12.0, 0.0)).norm(), 1e-12);
}

template <class Make>
std::string complaint(const Make& make) {
  try {
    make();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(DomainLoad, Refusals) {
  const Elasticity<2> kernel;
  EXPECT_THAT(complaint([&] { polynomial_load(kernel, {Quadratic<2>{}}); }), HasSubstr("1 components; expected 2"));
  EXPECT_THAT(
      complaint([&] { polynomial_load(Laplace<2>{}, {Quadratic<2>{std::numeric_limits<double>::quiet_NaN()}}); }),
      HasSubstr("not finite"));
  Rotation rotation;
  rotation.direction.setZero();
  EXPECT_THAT(complaint([&] { centrifugal_load<2>(kernel, rotation); }), HasSubstr("expected a direction"));
  rotation.direction = {1.0, 0.0, 1.0};
  EXPECT_THAT(complaint([&] { centrifugal_load<2>(kernel, rotation); }), HasSubstr("in the plane or normal to it"));
}

TEST(DomainLoad, AValueThatIsNotFiniteIsNamed) {
  const Laplace<2> kernel;
  const ElementTable<2> table = annulus(0.8, 1.5);
  const auto load = expression_load(
      kernel, {integrand<2>([](const Point2& x, const Vector2&) { return x[0] > 0.0 ? 1.0 : std::sqrt(x[0]); })},
      table);
  try {
    potentials<2>(table, {load}, {free_target<2>({1.1, 0.0})});
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the load is nan at (-"));
  }
}

}  // namespace
}  // namespace isorim::solver
