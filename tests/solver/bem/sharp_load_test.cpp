#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "quadrature/element_jet.h"
#include "solver/bem/domain_load.h"
#include "tests/quadrature/hollow.h"
#include "tests/solver/bem/exact_fields.h"

/// Loads that are singular or peak sharply inside the domain, or in a hole of it that rays cross.
namespace isorim::solver {
namespace {

using geometry::bezier_elements;
using geometry::ElementTable;
using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using quadrature::Target;
using std::numbers::pi;
using testing::integrand;

/// On some elements, at a place that no symmetry prefers, and at the given points.
template <int Dim>
std::vector<Target<Dim>> targets_on(const ElementTable<Dim>& table, const std::vector<Point<Dim>>& inside) {
  std::vector<Target<Dim>> targets;
  for (const int element : {0, static_cast<int>(table.elements.size()) / 2}) {
    Target<Dim> target;
    target.element = element;
    target.place.setConstant(0.31);
    target.position =
        quadrature::element_jet<Dim>(quadrature::element_net(table, table.elements[static_cast<std::size_t>(element)]),
                                     target.place, Point<Dim>::Zero())
            .offset;
    targets.push_back(target);
  }
  for (const Point<Dim>& point : inside) {
    Target<Dim> target;
    target.position = point;
    targets.push_back(target);
  }
  return targets;
}

template <int Dim>
void expect_potential(const ElementTable<Dim>& table, const std::function<double(const Point<Dim>&)>& source,
                      const std::function<double(const Point<Dim>&)>& potential,
                      const std::vector<Target<Dim>>& targets, double tolerance) {
  const auto load = expression_load(
      Laplace<Dim>{},
      {integrand<Dim>([source](const Point<Dim>& z, const geometry::Vector<Dim>&) { return source(z); })}, table);
  EXPECT_EQ(load->peaks().size(), 1U);
  const quadrature::TargetRules<Dim> rules(table, {tolerance, 3});
  const Eigen::MatrixXd found = domain_potentials<Dim>({load}, table, rules, targets, {tolerance, 0});
  double largest = 0.0;
  for (const Target<Dim>& target : targets) largest = std::max(largest, std::abs(potential(target.position)));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    EXPECT_NEAR(found(0, static_cast<Eigen::Index>(i)), potential(targets[i].position), 10.0 * tolerance * largest)
        << "at " << targets[i].position.transpose();
  }
}

// u = erf(alpha r) / (4 pi r), since nothing of the source reaches the boundary.
TEST(SharpLoad, GaussianOfAFiftiethOfTheRadius) {
  constexpr double alpha = 50.0;
  const Point3 centre(0.1, 0.05, -0.02);
  const ElementTable<3> ball = bezier_elements(geometry::sphere(1.0));
  const double height = std::pow(alpha / std::sqrt(pi), 3);
  expect_potential<3>(
      ball, [&](const Point3& z) { return height * std::exp(-alpha * alpha * (z - centre).squaredNorm()); },
      [&](const Point3& x) {
        const double r = (x - centre).norm();
        return std::erf(alpha * r) / (4.0 * pi * r);
      },
      targets_on<3>(ball, {{0.0, 0.0, 0.5}, {0.5, -0.3, 0.4}, {0.13, 0.05, -0.02}}), 1e-8);
}

// In a ring rays cross the bore, where ln r is singular: u = -ln(x) int_a^x s ln s ds - int_x^b s ln^2 s ds.
TEST(SharpLoad, LogarithmAboutABore) {
  constexpr double inner = 0.8;
  constexpr double outer = 1.5;
  const ElementTable<2> ring = quadrature::testing::hollow(geometry::disc(outer), geometry::disc(inner));
  const auto first = [](double s) { return 0.5 * s * s * (std::log(s) - 0.5); };
  const auto second = [](double s) { return 0.5 * s * s * (std::log(s) * (std::log(s) - 1.0) + 0.5); };
  expect_potential<2>(
      ring, [](const Point2& z) { return std::log(z.norm()); },
      [&](const Point2& x) {
        const double r = std::clamp(x.norm(), inner, outer);
        return -std::log(r) * (first(r) - first(inner)) - (second(outer) - second(r));
      },
      targets_on<2>(ring, {{1.1, 0.0}, {-0.7, 0.81}, {0.3, -1.3}}), 1e-9);
}

TEST(SharpLoad, RefusalsNameTheLoad) {
  const ElementTable<2> disc = bezier_elements(geometry::disc(1.0));
  const auto load =
      expression_load(Laplace<2>{}, {integrand<2>([](const Point2& z, const Vector2&) { return std::sqrt(z[0]); })},
                      disc, 1e-12, "[source] value");
  const quadrature::TargetRules<2> rules(disc, {1e-6, 2});
  try {
    domain_potentials<2>({load}, disc, rules, targets_on<2>(disc, {}));
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("[source] value is nan at ("));
  }
}

}  // namespace
}  // namespace isorim::solver
