#include "solver/bem/kernels.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"

namespace isorim::solver {
namespace {

using geometry::Point;
using geometry::Vector;
using quadrature::NodeView;
using std::numbers::pi;

/// Nodes at random places with random unit normals.
template <int Dim>
struct Cloud {
  std::array<std::vector<double>, Dim> position;
  std::array<std::vector<double>, Dim> normal;
  std::vector<double> weight;

  Cloud(std::size_t count, double size, unsigned seed) : weight(count, 1.0) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (std::size_t q = 0; q < count; ++q) {
      Vector<Dim> n;
      for (int k = 0; k < Dim; ++k) n[k] = unit(generator);
      n.normalize();
      for (std::size_t k = 0; k < Dim; ++k) {
        position[k].push_back(size * unit(generator));
        normal[k].push_back(n[static_cast<Eigen::Index>(k)]);
      }
    }
  }
  NodeView<Dim> view() const {
    NodeView<Dim> nodes;
    for (std::size_t k = 0; k < Dim; ++k) {
      nodes.position[k] = position[k];
      nodes.normal[k] = normal[k];
    }
    nodes.weight = weight;
    return nodes;
  }
  std::size_t size() const { return weight.size(); }
};

template <class Kernel>
using Layer = void (*)(const Kernel&, const Point<Kernel::dimension>&, const NodeView<Kernel::dimension>&,
                       std::span<double>);

template <class Kernel>
std::vector<double> values_of(Layer<Kernel> layer, int entries, const Kernel& kernel,
                              const Point<Kernel::dimension>& target, const NodeView<Kernel::dimension>& nodes) {
  std::vector<double> values(static_cast<std::size_t>(entries) * nodes.size());
  layer(kernel, target, nodes, values);
  return values;
}

/// The gradient against central differences of the layer, of fourth order.
template <class Kernel>
void expect_gradient(Layer<Kernel> layer, Layer<Kernel> gradient, const Kernel& kernel) {
  constexpr int dim = Kernel::dimension;
  constexpr int entries = Kernel::components * Kernel::components;
  const Cloud<dim> cloud(37, 1.0, 11);
  const Point<dim> target = Point<dim>::LinSpaced(1.7, 2.3);
  const std::vector<double> found = values_of(gradient, dim * entries, kernel, target, cloud.view());
  constexpr double step = 1e-3;
  for (int k = 0; k < dim; ++k) {
    const auto at = [&](int steps) {
      Point<dim> moved = target;
      moved[k] += steps * step;
      return values_of(layer, entries, kernel, moved, cloud.view());
    };
    const auto [a, b, c, d] = std::array{at(-2), at(-1), at(1), at(2)};
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double expected = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step);
      EXPECT_NEAR(found[static_cast<std::size_t>(k) * a.size() + i], expected, 1e-11) << k << ' ' << i;
    }
  }
}

TEST(Kernels, GradientsMatchFiniteDifferences) {
  expect_gradient<Laplace<2>>(single_layer, single_layer_gradient, {1.7, 3.0});
  expect_gradient<Laplace<2>>(double_layer, double_layer_gradient, {1.7, 3.0});
  expect_gradient<Laplace<3>>(single_layer, single_layer_gradient, {1.7});
  expect_gradient<Laplace<3>>(double_layer, double_layer_gradient, {1.7});
  expect_gradient<Elasticity<2>>(single_layer, single_layer_gradient, {1.3, 0.27, 5.0});
  expect_gradient<Elasticity<2>>(double_layer, double_layer_gradient, {1.3, 0.27, 5.0});
  expect_gradient<Elasticity<3>>(single_layer, single_layer_gradient, {1.3, 0.27});
  expect_gradient<Elasticity<3>>(double_layer, double_layer_gradient, {1.3, 0.27});
}

/// T is the traction of U: with the derivatives by the node (the target's with the other sign),
/// T_ij = sigma_jk(U_i) n_k by Hooke's law.
template <int Dim>
void expect_traction() {
  const Elasticity<Dim> kernel{1.3, 0.27, 2.0};
  const double lame = 2.0 * kernel.shear_modulus * kernel.poisson / (1.0 - 2.0 * kernel.poisson);
  const Cloud<Dim> cloud(29, 1.0, 5);
  const Point<Dim> target = Point<Dim>::LinSpaced(-1.9, -1.2);
  const std::vector<double> traction =
      values_of<Elasticity<Dim>>(double_layer, Dim * Dim, kernel, target, cloud.view());
  const std::vector<double> gradient =
      values_of<Elasticity<Dim>>(single_layer_gradient, Dim * Dim * Dim, kernel, target, cloud.view());
  for (std::size_t q = 0; q < cloud.size(); ++q) {
    for (int i = 0; i < Dim; ++i) {
      const auto slope = [&](int j, int k) {
        return -gradient[static_cast<std::size_t>((k * Dim + i) * Dim + j) * cloud.size() + q];
      };
      double divergence = 0.0;
      for (int k = 0; k < Dim; ++k) divergence += slope(k, k);
      for (int j = 0; j < Dim; ++j) {
        double expected = lame * divergence * cloud.normal[static_cast<std::size_t>(j)][q];
        for (int k = 0; k < Dim; ++k)
          expected += kernel.shear_modulus * (slope(j, k) + slope(k, j)) * cloud.normal[static_cast<std::size_t>(k)][q];
        EXPECT_NEAR(traction[static_cast<std::size_t>(i * Dim + j) * cloud.size() + q], expected, 2e-15);
      }
    }
  }
}

TEST(Kernels, TractionIsHookesLawOfTheDisplacement) {
  expect_traction<2>();
  expect_traction<3>();
}

template <int Dim>
void expect_flux() {
  const Laplace<Dim> kernel{1.7, 2.0};
  const Cloud<Dim> cloud(29, 1.0, 6);
  const Point<Dim> target = Point<Dim>::LinSpaced(-1.9, -1.2);
  const std::vector<double> flux = values_of<Laplace<Dim>>(double_layer, 1, kernel, target, cloud.view());
  const std::vector<double> gradient =
      values_of<Laplace<Dim>>(single_layer_gradient, Dim, kernel, target, cloud.view());
  for (std::size_t q = 0; q < cloud.size(); ++q) {
    double expected = 0.0;
    for (std::size_t k = 0; k < Dim; ++k)
      expected -= kernel.conductivity * gradient[k * cloud.size() + q] * cloud.normal[k][q];
    EXPECT_NEAR(flux[q], expected, 1e-15);
  }
}

TEST(Kernels, FluxIsTheNormalDerivative) {
  expect_flux<2>();
  expect_flux<3>();
}

// Written as in the books, term by term.
TEST(Kernels, MatchTheLiterature) {
  const Cloud<3> space(1, 1.0, 3);
  const Cloud<2> plane(1, 1.0, 4);
  const Point<3> x(2.0, 0.5, -1.0);
  const Point<2> y(2.0, 0.5);
  const double mu = 1.3;
  const double nu = 0.27;
  const Vector<3> d(space.position[0][0] - x[0], space.position[1][0] - x[1], space.position[2][0] - x[2]);
  const Vector<2> e(plane.position[0][0] - y[0], plane.position[1][0] - y[1]);
  const auto u3 = values_of<Elasticity<3>>(single_layer, 9, {mu, nu}, x, space.view());
  const auto u2 = values_of<Elasticity<2>>(single_layer, 4, {mu, nu, 1.0}, y, plane.view());
  const auto t3 = values_of<Elasticity<3>>(double_layer, 9, {mu, nu}, x, space.view());
  const double r = d.norm();
  double normal_derivative = 0.0;
  for (std::size_t k = 0; k < 3; ++k) normal_derivative += d[static_cast<Eigen::Index>(k)] / r * space.normal[k][0];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double same = i == j ? 1.0 : 0.0;
      const double product = d[i] / r * d[j] / r;
      // Kelvin; as in Brebbia & Dominguez 1992, chapter 3.
      EXPECT_NEAR(u3[static_cast<std::size_t>(3 * i + j)],
                  ((3.0 - 4.0 * nu) * same + product) / (16.0 * pi * mu * (1.0 - nu) * r), 1e-16);
      const double turn = space.normal[static_cast<std::size_t>(i)][0] * d[j] / r -
                          space.normal[static_cast<std::size_t>(j)][0] * d[i] / r;
      EXPECT_NEAR(t3[static_cast<std::size_t>(3 * i + j)],
                  -(normal_derivative * ((1.0 - 2.0 * nu) * same + 3.0 * product) + (1.0 - 2.0 * nu) * turn) /
                      (8.0 * pi * (1.0 - nu) * r * r),
                  1e-16);
      if (i == 2 || j == 2) continue;
      const double plane_product = e[i] * e[j] / e.squaredNorm();
      EXPECT_NEAR(u2[static_cast<std::size_t>(2 * i + j)],
                  ((3.0 - 4.0 * nu) * -std::log(e.norm()) * same + plane_product) / (8.0 * pi * mu * (1.0 - nu)),
                  1e-16);
    }
  }
  EXPECT_NEAR(values_of<Laplace<3>>(single_layer, 1, {2.0}, x, space.view())[0], 1.0 / (8.0 * pi * r), 1e-17);
  EXPECT_NEAR(values_of<Laplace<2>>(single_layer, 1, {2.0, 7.0}, y, plane.view())[0],
              -std::log(e.norm() / 7.0) / (4.0 * pi), 1e-16);
}

// From where distances stop to count.
TEST(Kernels, LogarithmIsRightForAnySize) {
  const Laplace<2> kernel{1.0 / (2.0 * pi), 1.0};
  for (double r = 1.01e-40; r < 1e140; r *= 1.37) {
    const std::vector<double> zero{0.0};
    const std::vector<double> at{r};
    NodeView<2> nodes;
    nodes.position = {at, zero};
    nodes.normal = {at, zero};
    nodes.weight = at;
    const double value = values_of<Laplace<2>>(single_layer, 1, kernel, {0.0, 0.0}, nodes)[0];
    EXPECT_NEAR(value, -std::log(r), 4e-16 * std::abs(std::log(r)) + 2e-16) << r;
  }
}

/// int T dS over all elements for a target that lies on none, with entry (i, j) expected to be `expected` delta_ij.
template <class Kernel>
void expect_flux_balance(const geometry::Boundary<Kernel::dimension>& boundary, const Kernel& kernel,
                         const Point<Kernel::dimension>& target, double expected) {
  constexpr int dim = Kernel::dimension;
  constexpr auto count = static_cast<std::size_t>(Kernel::components);
  const geometry::ElementTable<dim> table = geometry::bezier_elements(boundary);
  const quadrature::TargetRules<dim> rules(table, {1e-13, 2});
  quadrature::NodeBuffer<dim> buffer;
  std::array<double, count * count> sums{};
  std::vector<double> values;
  for (int e = 0; e < static_cast<int>(table.elements.size()); ++e) {
    const NodeView<dim> nodes = rules.nodes(e, {target}, buffer);
    values.resize(count * count * nodes.size());
    double_layer(kernel, target, nodes, values);
    for (std::size_t k = 0; k < sums.size(); ++k) {
      for (std::size_t q = 0; q < nodes.size(); ++q) sums[k] += values[k * nodes.size() + q] * nodes.weight[q];
    }
  }
  for (std::size_t k = 0; k < sums.size(); ++k)
    EXPECT_NEAR(sums[k], k % (count + 1) == 0 ? expected : 0.0, 2e-12) << k << " at " << target.transpose();
}

// The constants of kernels.h: int T dS = -I for a target inside, 0 outside.
TEST(Kernels, TractionsBalanceOverClosedSurfaces) {
  const geometry::Boundary<3> torus = geometry::torus(2.0, 0.5);
  expect_flux_balance(torus, Laplace<3>{3.0}, {2.1, 0.3, -0.1}, -1.0);
  expect_flux_balance(torus, Laplace<3>{3.0}, {0.4, 0.3, -0.1}, 0.0);
  expect_flux_balance(torus, Elasticity<3>{2.0, 0.3}, {2.1, 0.3, -0.1}, -1.0);
  expect_flux_balance(torus, Elasticity<3>{2.0, 0.3}, {0.4, 0.3, -0.1}, 0.0);
  const geometry::Boundary<2> circle = geometry::disc(1.0);
  expect_flux_balance(circle, Laplace<2>{3.0, 5.0}, {0.4, 0.8}, -1.0);
  expect_flux_balance(circle, Laplace<2>{3.0, 5.0}, {0.7, 0.8}, 0.0);
  expect_flux_balance(circle, Elasticity<2>{2.0, 0.3, 5.0}, {0.4, 0.8}, -1.0);
  expect_flux_balance(circle, Elasticity<2>{2.0, 0.3, 5.0}, {0.7, 0.8}, 0.0);
}

}  // namespace
}  // namespace isorim::solver
