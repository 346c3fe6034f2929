// Logarithms on an element in the plane by two ways. The classical one (Stroud and Secrest, Gaussian Quadrature
// Formulas, 1966, table 8) takes ln r = ln eta + ln(r / eta) apart and has a Gauss rule for the weight ln(1 / eta).
// Ours puts eta = t^6 and takes nothing apart: the same nodes serve the single layer, whose kernel may be a sum of a
// logarithm and of other terms, and the double one.

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "geometry/bezier/element_table.h"
#include "geometry/shapes/regions.h"
#include "quadrature/element_jet.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/target_rules.h"

namespace isorim::quadrature {
namespace {

using geometry::ElementTable;
using geometry::Point;
using geometry::Point2;

/// int_0^1 ln(1/x) f(x) dx, exact for polynomials of degree 2 n - 1.
struct WeightedRule {
  Eigen::VectorXd nodes;
  Eigen::VectorXd weights;
};

/// From the moments of the shifted Legendre polynomials, 1 and (-1)^k / (k (k + 1)), by the modified Chebyshev
/// algorithm and the eigenvalues of Jacobi's matrix (Gautschi, Orthogonal Polynomials, 2004, sections 2.1.7 and 3.1.1).
WeightedRule logarithmic_gauss(int n) {
  const int count = 2 * n;
  // Monic: P_k divided by its leading coefficient, the k-th product of 2 (2 j - 1) / j.
  Eigen::VectorXd moments(count);
  double leading = 1.0;
  for (int k = 0; k < count; ++k) {
    if (k > 0) leading *= 2.0 * (2.0 * k - 1.0) / k;
    moments[k] = (k == 0 ? 1.0 : (k % 2 == 0 ? 1.0 : -1.0) / (k * (k + 1.0))) / leading;
  }
  const auto b = [](int k) { return k == 0 ? 1.0 : 1.0 / (4.0 * (4.0 - 1.0 / (static_cast<double>(k) * k))); };
  constexpr double a = 0.5;
  Eigen::VectorXd before = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd row = moments;
  Eigen::VectorXd alpha(n);
  Eigen::VectorXd beta(n);
  alpha[0] = a + moments[1] / moments[0];
  beta[0] = moments[0];
  for (int k = 1; k < n; ++k) {
    Eigen::VectorXd next = Eigen::VectorXd::Zero(count);
    for (int l = k; l < count - k; ++l)
      next[l] = row[l + 1] - (alpha[k - 1] - a) * row[l] - beta[k - 1] * before[l] + b(l) * row[l - 1];
    alpha[k] = a + next[k + 1] / next[k] - row[k] / row[k - 1];
    beta[k] = next[k] / row[k - 1];
    before = row;
    row = next;
  }
  Eigen::MatrixXd jacobi = Eigen::MatrixXd(alpha.asDiagonal());
  for (int k = 1; k < n; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = std::sqrt(beta[k]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(jacobi);
  return {solver.eigenvalues(), beta[0] * solver.eigenvectors().row(0).transpose().cwiseAbs2()};
}

TEST(LogarithmicRule, ClassicalRuleIsThatOfTheTables) {
  const WeightedRule two = logarithmic_gauss(2);
  EXPECT_NEAR(two.nodes[0], 0.112008806166976, 1e-14);
  EXPECT_NEAR(two.nodes[1], 0.602276908118738, 1e-14);
  EXPECT_NEAR(two.weights[0], 0.718539319030384, 1e-14);
  EXPECT_NEAR(two.weights[1], 0.281460680969615, 1e-14);
  const WeightedRule rule = logarithmic_gauss(12);
  for (int power = 0; power < 24; ++power)
    EXPECT_NEAR(rule.weights.dot(rule.nodes.array().pow(power).matrix()), 1.0 / ((power + 1.0) * (power + 1.0)), 1e-14);
}

/// Chebyshev's polynomial of degree k about the middle of the cell.
double field(int k, double place) {
  return std::cos(k * std::acos(2.0 * place - 1.0));
}

/// int ln(1/r) field ds over element 0 from one of its points, split there, with n points of either rule on each side.
double classical(const ElementTable<2>& table, double place, int k, int n) {
  const auto net = element_net(table, table.elements[0]);
  const Point<1> at = Point<1>::Constant(place);
  const Point2 target = element_jet<2>(net, at, Point2::Zero()).offset;
  const WeightedRule weighted = logarithmic_gauss(n);
  const Rule& plain = gauss_legendre(n);
  double sum = 0.0;
  for (const double end : {0.0, 1.0}) {
    const double length = end - place;
    const auto jet = [&](double eta) { return element_jet<2>(net, Point<1>::Constant(place + eta * length), target); };
    const auto density = [&](double eta) {
      return field(k, place + eta * length) * jet(eta).first[0].norm() * std::abs(length);
    };
    for (Eigen::Index i = 0; i < weighted.nodes.size(); ++i) sum += weighted.weights[i] * density(weighted.nodes[i]);
    for (std::size_t i = 0; i < plain.nodes.size(); ++i) {
      const double eta = plain.nodes[i];
      sum -= plain.weights[i] * density(eta) * std::log(jet(eta).offset.norm() / eta);
    }
  }
  return sum;
}

double ours(const ElementTable<2>& table, double place, int k) {
  const auto net = element_net(table, table.elements[0]);
  const Point<1> at = Point<1>::Constant(place);
  const TargetRules<2> rules(table, {1e-12, 6});
  NodeBuffer<2> buffer;
  const NodeView<2> nodes = rules.nodes(0, {element_jet<2>(net, at, Point2::Zero()).offset, 0, at}, buffer);
  double sum = 0.0;
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    // t^6 may vanish beside the place; the weight, of the order of t^5, is below rounding then.
    const double r = std::hypot(nodes.offset[0][q], nodes.offset[1][q]);
    if (r > 0.0) sum -= nodes.weight[q] * field(k, nodes.place[0][q]) * std::log(r);
  }
  return sum;
}

TEST(LogarithmicRule, AgreesWithTheClassicalRule) {
  const ElementTable<2> straight = bezier_elements(geometry::rectangle({2.0, 1.0}));
  const ElementTable<2> arc = bezier_elements(geometry::disc(1.5));
  const ElementTable<2> slender = bezier_elements(geometry::elliptic_disc({1.0, 0.25}));
  for (const ElementTable<2>* table : {&straight, &arc, &slender}) {
    for (const double place : {0.5, 0.25, 0.9, 1e-3}) {
      for (int k = 0; k <= 6; ++k)
        EXPECT_NEAR(ours(*table, place, k), classical(*table, place, k, 40), 1e-11) << place << " degree " << k;
    }
  }
}

TEST(LogarithmicRule, OneIsTheLengthOfTheLogarithm) {
  // int_0^2 ln(1/|x - 2 p|) dx = 2 - 2 p ln 2 p - 2 (1 - p) ln 2 (1 - p).
  const ElementTable<2> straight = bezier_elements(geometry::rectangle({2.0, 1.0}));
  for (const double place : {0.5, 0.3}) {
    const double below = 2.0 * place;
    const double above = 2.0 - below;
    EXPECT_NEAR(ours(straight, place, 0), 2.0 - below * std::log(below) - above * std::log(above), 1e-13);
  }
}

}  // namespace
}  // namespace isorim::quadrature
