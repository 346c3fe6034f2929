#include "quadrature/target_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "quadrature/element_jet.h"
#include "quadrature/winding_number.h"
#include "tests/quadrature/brute_force.h"
#include "tests/quadrature/target_elements.h"

namespace isorim::quadrature {
namespace {

using geometry::ElementTable;
using geometry::Point;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector;
using geometry::Vector3;

constexpr int degree = 3;

/// Chebyshev polynomials of the place up to `degree` in each direction: no function of that degree is harder.
template <int Dim>
struct Fields {
  static constexpr std::size_t count = Dim == 2 ? degree + 1 : (degree + 1) * (degree + 1);
  std::array<double, count> values;

  explicit Fields(const Point<Dim - 1>& place) {
    for (std::size_t k = 0; k < count; ++k) {
      values[k] = chebyshev(k % (degree + 1), place[0]);
      if constexpr (Dim == 3) values[k] *= chebyshev(k / (degree + 1), place[1]);
    }
  }

 private:
  static double chebyshev(std::size_t k, double x) {
    double before = 1.0;
    double value = 2.0 * x - 1.0;
    if (k == 0) return before;
    for (std::size_t i = 1; i < k; ++i) {
      const double next = 2.0 * (2.0 * x - 1.0) * value - before;
      before = value;
      value = next;
    }
    return value;
  }
};

/// Kernels times the area: of a single layer, of a double layer, and two that no symmetry tames: one of order
/// r^(1-Dim), one of r^-Dim.
template <int Dim>
std::array<double, 4> kernels(const Vector<Dim>& d, const Vector<Dim>& n) {
  const double r = d.norm();
  const double area = n.norm();
  const double power = std::pow(r, Dim);
  const double single = Dim == 2 ? -std::log(r / 100.0) : 1.0 / r;
  return {area * single, d.dot(n) / power, (d[0] * n[1] - d[1] * n[0] + 0.3 * d[1] * area) / power,
          area * (1.0 - Dim * d[0] * d[1] / (r * r)) / power};
}

/// The integrals of all kernels times all fields (less their value at an own target, but for the first kernel), and of
/// the kernels' absolute values.
template <int Dim>
struct Integrand {
  bool is_own;
  Fields<Dim> at_target;
  static constexpr std::size_t count = 4 * (Fields<Dim>::count + 1);

  void add(const Point<Dim - 1>& place, const Vector<Dim>& d, const Vector<Dim>& n, double weight,
           std::vector<double>& sums) const {
    const std::array<double, 4> kernel = kernels<Dim>(d, n);
    const Fields<Dim> fields(place);
    for (std::size_t m = 0; m < (is_own ? 2 : 4); ++m) {
      for (std::size_t k = 0; k < Fields<Dim>::count; ++k) {
        const double field = fields.values[k] - (is_own && m > 0 ? at_target.values[k] : 0.0);
        sums[4 * k + m] += weight * field * kernel[m];
      }
      sums[4 * Fields<Dim>::count + m] += std::abs(weight * kernel[is_own ? 0 : m]);
    }
  }
};

template <int Dim>
Vector<Dim> offset_of(const NodeView<Dim>& nodes, const Point<Dim>& target, std::size_t q) {
  Vector<Dim> d;
  for (std::size_t c = 0; c < Dim; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    d[i] = nodes.offset[c].empty() ? nodes.position[c][q] - target[i] : nodes.offset[c][q];
  }
  return d;
}

/// The largest error of a kernel's integrals with all fields, relative to that of its absolute value.
template <int Dim>
std::array<double, 4> errors(const ElementTable<Dim>& table, const Target<Dim>& target, double tolerance,
                             std::size_t* count = nullptr) {
  const TargetRules<Dim> rules(table, {tolerance, degree});
  NodeBuffer<Dim> buffer;
  const NodeView<Dim> nodes = rules.nodes(0, target, buffer);
  if (count != nullptr) *count = nodes.size();
  const Integrand<Dim> integrand{target.element == 0, Fields<Dim>(target.place)};
  std::vector<double> sums(Integrand<Dim>::count, 0.0);
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    Point<Dim - 1> place;
    Vector<Dim> normal;
    for (std::size_t d = 0; d < Dim - 1; ++d) place[static_cast<Eigen::Index>(d)] = nodes.place[d][q];
    for (std::size_t c = 0; c < Dim; ++c) normal[static_cast<Eigen::Index>(c)] = nodes.normal[c][q];
    integrand.add(place, offset_of(nodes, target.position, q), normal, nodes.weight[q], sums);
  }
  const std::vector<double> expected = testing::integrate_by_bisection<Dim>(
      table, 0, target.position, Integrand<Dim>::count,
      [&](const Point<Dim - 1>& place, const Vector<Dim>& d, const Vector<Dim>& n, double weight,
          std::vector<double>& into) { integrand.add(place, d, n, weight, into); });
  std::array<double, 4> largest{};
  for (std::size_t k = 0; k < 4 * Fields<Dim>::count; ++k) {
    const double scale = std::max(std::abs(expected[4 * Fields<Dim>::count + k % 4]), 1e-300);
    const double error = std::abs(sums[k] - expected[k]) / scale;
    if (!(error <= largest[k % 4])) largest[k % 4] = error;
  }
  return largest;
}

template <int Dim>
Target<Dim> own_target(const ElementTable<Dim>& table, const Point<Dim - 1>& place) {
  const auto net = element_net(table, table.elements[0]);
  return {element_jet<Dim>(net, place, Point<Dim>::Zero()).offset, 0, place};
}

/// Off the surface at a place, by a multiple of the shorter parameter line's length; at the edge u = 0 beside it.
Target<3> near_target(const ElementTable<3>& table, const Point2& place, double distance) {
  const ElementJet<3> jet = element_jet<3>(element_net(table, table.elements[0]), place, Point3::Zero());
  const double size = std::min(jet.first[0].norm(), jet.first[1].norm());
  Vector3 direction = jet.first[0].cross(jet.first[1]).normalized();
  if (place[0] == 0.0) direction = -jet.first[0].normalized();
  return {jet.offset + distance * size * direction};
}

void expect_errors(const std::array<double, 4>& found, const std::array<double, 4>& allowed, const std::string& what) {
  for (std::size_t m = 0; m < 4; ++m) EXPECT_LE(found[m], allowed[m]) << what << ", kernel " << m;
}

std::string words(const std::string& name, const Target<3>& target, double distance) {
  return name + " at " + std::to_string(target.position[0]) + ' ' + std::to_string(target.position[1]) + ' ' +
         std::to_string(target.position[2]) + ", distance " + std::to_string(distance);
}

TEST(TargetRules, OwnElementIsIntegratedByPolarCoordinates) {
  for (const auto& [name, table] : testing::surface_elements()) {
    for (const Point2& place : {Point2(0.4, 0.7), Point2(1e-3, 0.3), Point2(0.999, 0.99), Point2(0.61, 1e-6)}) {
      const Target<3> target = own_target(table, place);
      std::size_t count = 0;
      const auto found = errors(table, target, 1e-12, &count);
      expect_errors(found, {1e-11, 1e-11, 0, 0}, words(name, target, 0.0));
      EXPECT_LE(count, 6000U) << words(name, target, 0.0);
    }
  }
}

TEST(TargetRules, NearTargetsKeepTheTolerance) {
  for (const auto& [name, table] : testing::surface_elements()) {
    for (const double distance : {1e-4, 1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0}) {
      for (const Point2& place : {Point2(0.4, 0.7), Point2(1e-3, 0.3), Point2(0.0, 0.4), Point2(0.98, 0.01)}) {
        const Target<3> target = near_target(table, place, distance);
        // Of coordinates that are rounded, the kernels of higher order know fewer digits.
        const double rounding = 1e-15 / distance;
        std::size_t count = 0;
        const auto found = errors(table, target, 1e-12, &count);
        expect_errors(found, {1e-11, 1e-11 + rounding, 1e-11 + rounding, 1e-10 + 10 * rounding},
                      words(name, target, distance));
      }
    }
  }
}

// None of these was looked at when the rules' constants were chosen.
TEST(TargetRules, FreshRandomElementsKeepTheTolerance) {
  constexpr double allowed = 1e-10;
  std::mt19937 generator(20261122);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 40; ++k) {
    const ElementTable<3> table = testing::random_element(generator);
    Point2 place(unit(generator), unit(generator));
    if (k % 5 == 0) place[k % 2] = std::pow(10.0, -4.0 * unit(generator));
    const Target<3> own = own_target(table, place);
    expect_errors(errors(table, own, 1e-12), {allowed, allowed, 0, 0}, words("element " + std::to_string(k), own, 0.0));
    const double distance = std::pow(10.0, -4.0 + 5.0 * unit(generator));
    if (k % 7 == 0) place[0] = 0.0;
    const Target<3> near = near_target(table, place, distance);
    const double rounding = 1e-15 / distance;
    expect_errors(errors(table, near, 1e-12),
                  {allowed, allowed + rounding, allowed + rounding, allowed + 10 * rounding},
                  words("element " + std::to_string(k), near, distance));
  }
}

// Their speeds hardly change: it is the metric that does.
TEST(TargetRules, ShearedElementsKeepTheTolerance) {
  constexpr double allowed = 1e-10;
  std::mt19937 generator(31);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 6; ++k) {
    const double shear = 10.0 * std::pow(0.5, unit(generator));
    const ElementTable<3> table = testing::sheared_element(shear, generator);
    const Point2 place(unit(generator), unit(generator));
    const Target<3> own = own_target(table, place);
    expect_errors(errors(table, own, 1e-12), {allowed, allowed, 0, 0}, words("sheared " + std::to_string(k), own, 0.0));
    const double distance = std::pow(10.0, -4.0 + 5.0 * unit(generator));
    const Target<3> near = near_target(table, place, distance);
    const double rounding = 1e-15 / distance;
    expect_errors(errors(table, near, 1e-12),
                  {allowed, allowed + rounding, allowed + rounding, 10 * (allowed + rounding)},
                  words("sheared " + std::to_string(k), near, distance));
  }
}

/// Errors of a kept rule for a target, as errors() has them.
double far_error(const ElementTable<3>& table, const NodeView<3>& nodes, const Point3& target) {
  double sum = 0.0;
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    const Vector3 d = offset_of(nodes, target, q);
    sum += nodes.weight[q] / d.squaredNorm();
  }
  const auto expected = testing::integrate_by_bisection<3>(
      table, 0, target, 1,
      [](const Point2&, const Vector3& d, const Vector3& n, double weight, std::vector<double>& into) {
        into[0] += weight * n.norm() / d.squaredNorm();
      });
  return std::abs(sum / expected[0] - 1.0);
}

TEST(TargetRules, FarNodesServeAllTargetsBeyondTheirDistance) {
  std::mt19937 generator(7);
  for (const double tolerance : {1e-6, 1e-12}) {
    for (int k = 0; k < 8; ++k) {
      const ElementTable<3> table = testing::random_element(generator);
      const TargetRules<3> rules(table, {tolerance, degree});
      const auto sphere = rules.sphere(0);
      for (const double distance : {1.0 / 3.0, 0.36, 1.5, 10.0}) {
        const NodeView<3> nodes = rules.far_nodes(0, distance * sphere.radius);
        const double away = (1.0 + distance) * sphere.radius;
        for (const Vector3& direction : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(-0.6, 0, 0.8)}) {
          EXPECT_LE(far_error(table, nodes, sphere.centre + away * direction), 10.0 * tolerance)
              << k << ' ' << distance << ' ' << direction.transpose();
        }
      }
      EXPECT_THROW(rules.far_nodes(0, 0.3 * sphere.radius), InputError);
    }
  }
}

/// The element with only a region of its cell kept.
ElementTable<3> cut(ElementTable<3> table, geometry::TrimmedRegion region) {
  table.elements[0].region = 0;
  table.regions = {std::move(region)};
  return table;
}

/// A place at so much of a curve, and so far to its left.
Point2 beside_curve(const geometry::HomogeneousPoints<2>& curve, double at, double beside) {
  const auto point = [&](double s) {
    std::vector<Vector3> row;
    for (Eigen::Index i = 0; i < curve.cols(); ++i) row.emplace_back(curve.col(i));
    for (; row.size() > 1; row.pop_back())
      for (std::size_t i = 0; i + 1 < row.size(); ++i) row[i] += s * (row[i + 1] - row[i]);
    return Point2(row[0].head<2>() / row[0][2]);
  };
  constexpr double step = 1e-4;
  const Point2 along = (point(at + step) - point(at - step)).normalized();
  return point(at) + beside * Point2(-along[1], along[0]);
}

std::vector<std::pair<std::string, geometry::TrimmedRegion>> regions() {
  geometry::TrimmedRegion holed = testing::whole_cell();
  testing::add_circle(holed, {0.6, 0.45}, 0.3, 8, -1);
  geometry::TrimmedRegion blob;
  testing::add_blob(blob, {0.5, 0.5}, 0.35, 0.3, 3, 40, 1);
  return {{"triangle", testing::polygon({{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}})},
          {"hooked", testing::polygon({{0, 0}, {1, 0}, {1, 1}, {0.8, 1}, {0.8, 0.2}, {0.2, 0.2}, {0.2, 1}, {0, 1}})},
          {"holed", holed},
          {"blob", blob}};
}

TEST(TargetRules, CutElementsAreIntegratedOverWhatIsKept) {
  const auto elements = testing::surface_elements();
  for (const std::size_t e : {0U, 3U, 8U}) {
    for (const auto& [region_name, region] : regions()) {
      const ElementTable<3> table = cut(elements[e].second, region);
      const std::string name = elements[e].first + ", " + region_name;
      for (const Point2& place : {Point2(0.42, 0.17), Point2(0.7, 0.65), Point2(0.19999, 0.5)}) {
        const double winding = winding_number(region, place);
        if (winding > 0.5) {
          const Target<3> target = own_target(table, place);
          expect_errors(errors(table, target, 1e-12), {1e-11, 1e-11, 0, 0}, words(name, target, 0.0));
        }
        for (const double distance : {1e-4, 1e-2, 0.2, 3.0}) {
          const Target<3> target = near_target(table, place, distance);
          const double rounding = 1e-15 / distance;
          expect_errors(errors(table, target, 1e-12),
                        {1e-11, 1e-11 + rounding, 1e-11 + rounding, 1e-10 + 10 * rounding},
                        words(name, target, distance));
        }
      }
    }
  }
}

// As the points of a round hole's wall are seen from the faces that it ends in: their feet lie on the trim, to
// rounding.
TEST(TargetRules, TargetsAboveATrimKeepTheTolerance) {
  const auto elements = testing::surface_elements();
  for (const std::size_t e : {0U, 3U}) {
    for (const auto& [region_name, region] : regions()) {
      const ElementTable<3> table = cut(elements[e].second, region);
      for (const double beside : {0.0, 1e-16, -1e-16, 1e-9, -1e-9, 1e-3, -1e-3, 0.02, -0.02}) {
        for (const double distance : {1e-4, 1e-2, 0.3}) {
          for (const double at : {0.0, 0.37}) {
            const geometry::HomogeneousPoints<2>& curve = region.curves[region.curves.size() / 3];
            const Target<3> target = near_target(table, beside_curve(curve, at, beside), distance);
            const double rounding = 1e-15 / distance;
            expect_errors(
                errors(table, target, 1e-12), {1e-11, 1e-11 + rounding, 1e-11 + rounding, 1e-10 + 10 * rounding},
                words(elements[e].first + ", " + region_name + ", beside " + std::to_string(beside), target, distance));
          }
        }
      }
    }
  }
}

// In what a trim has taken away the surface goes on, and with it the singularity: rays must not run through it.
TEST(TargetRules, TargetsBesideACutLieOffTheElement) {
  const ElementTable<3> plane = testing::surface_elements()[0].second;
  for (const auto& [region_name, region] : regions()) {
    const ElementTable<3> table = cut(plane, region);
    for (const Point2& place : {Point2(0.55, 0.5), Point2(0.6, 0.6), Point2(0.500001, 0.500001), Point2(0.5, 0.21)}) {
      if (winding_number(region, place) > 0.5) continue;
      const Target<3> target = near_target(table, place, 0.0);
      const auto found = errors(table, target, 1e-12);
      expect_errors(found, {1e-11, 0, 1e-9, 1e-9}, words(region_name, target, 0.0));
    }
  }
}

std::vector<std::pair<std::string, ElementTable<2>>> curve_elements() {
  return {{"line", testing::curve_element({{0, 0, 1}, {3, 1, 1}})},
          {"quarter circle", testing::curve_element({{1, 0, 1}, {1, 1, std::sqrt(0.5)}, {0, 1, 1}})},
          {"wave", testing::curve_element({{0, 0, 1}, {1, 1.5, 1}, {2, -1.5, 1}, {3, 0.5, 1}})},
          {"uneven line", testing::curve_element({{0, 0, 1}, {0.1, 0, 1}, {1, 0, 1}})},
          {"rational", testing::curve_element({{0, 0, 1}, {0.4, 0.3, 2}, {0.8, 0.1, 0.5}, {1, 0.6, 1.5}})}};
}

TEST(TargetRules, CurvesKeepTheTolerance) {
  for (const auto& [name, table] : curve_elements()) {
    for (const double at : {1e-6, 1e-3, 0.02, 0.31, 0.55, 0.9999}) {
      const Point<1> place(at);
      const Target<2> own = own_target(table, place);
      const std::string words = name + " at " + std::to_string(at);
      expect_errors(errors(table, own, 1e-12), {1e-11, 1e-11, 0, 0}, words);
      const ElementJet<2> jet = element_jet<2>(element_net(table, table.elements[0]), place, Point2::Zero());
      for (const double distance : {1e-4, 1e-3, 1e-2, 0.1, 0.5, 2.0, 10.0}) {
        const Vector<2> across(distance * jet.first[0][1], -distance * jet.first[0][0]);
        const double rounding = 1e-15 / distance;
        expect_errors(errors(table, Target<2>{jet.offset + across}, 1e-12),
                      {1e-11, 1e-11 + rounding, 1e-11 + rounding, 1e-10 + 10 * rounding},
                      words + ", distance " + std::to_string(distance));
      }
    }
  }
}

TEST(TargetRules, TheUnitOfLengthPlaysNoPart) {
  for (const auto& [name, table] : testing::surface_elements()) {
    for (const double scale : {1e-3, 1e3}) {
      ElementTable<3> scaled = table;
      for (std::size_t k = 0; k < scaled.nets.size(); ++k) {
        if (k % 4 != 3) scaled.nets[k] *= scale;
      }
      const TargetRules<3> rules(table, {1e-10, degree});
      const TargetRules<3> scaled_rules(scaled, {1e-10, degree});
      NodeBuffer<3> buffer;
      for (const double distance : {0.0, 1e-3, 0.1, 1.0, 5.0}) {
        const Point2 place(0.3, 0.6);
        Target<3> target = distance == 0.0 ? own_target(table, place) : near_target(table, place, distance);
        const std::size_t count = rules.nodes(0, target, buffer).size();
        target.position *= scale;
        EXPECT_EQ(scaled_rules.nodes(0, target, buffer).size(), count) << words(name, target, distance);
      }
    }
  }
}

// Far below what can be checked: the rules stay of a reasonable size and finite.
// A small element on a large body: its speeds must not be known to the body's rounding only.
TEST(TargetRules, ThePlaceOfAnElementPlaysNoPart) {
  const Vector3 shift(1e4, -3e4, 2e4);
  for (const auto& [name, table] : testing::surface_elements()) {
    ElementTable<3> shifted = table;
    for (std::size_t k = 0; k < shifted.nets.size(); k += 4) {
      for (std::size_t c = 0; c < 3; ++c)
        shifted.nets[k + c] += shifted.nets[k + 3] * shift[static_cast<Eigen::Index>(c)];
    }
    const TargetRules<3> rules(table, {1e-12, degree});
    const TargetRules<3> shifted_rules(shifted, {1e-12, degree});
    NodeBuffer<3> buffer;
    for (const double distance : {0.1, 1.0, 5.0, 1e3}) {
      Target<3> target = near_target(table, {0.3, 0.6}, distance);
      const auto count = static_cast<double>(rules.nodes(0, target, buffer).size());
      target.position += shift;
      EXPECT_LE(static_cast<double>(shifted_rules.nodes(0, target, buffer).size()), 1.05 * count)
          << words(name, target, distance);
    }
  }
}

TEST(TargetRules, TinyDistancesDoNoHarm) {
  for (const auto& [name, table] : testing::surface_elements()) {
    const TargetRules<3> rules(table, {1e-12, degree});
    NodeBuffer<3> buffer;
    for (const double distance : {1e-6, 1e-9, 1e-13}) {
      for (const Point2& place : {Point2(0.3, 0.6), Point2(0.0, 0.4), Point2(1e-9, 0.2)}) {
        const Target<3> target = near_target(table, place, distance);
        const NodeView<3> nodes = rules.nodes(0, target, buffer);
        double angle = 0.0;
        for (std::size_t q = 0; q < nodes.size(); ++q) {
          const Vector3 d = offset_of(nodes, target.position, q);
          for (std::size_t c = 0; c < 3; ++c)
            angle += nodes.weight[q] * d[static_cast<Eigen::Index>(c)] * nodes.normal[c][q] / std::pow(d.norm(), 3);
        }
        EXPECT_LT(nodes.size(), 60000U) << words(name, target, distance);
        // A solid angle: no surface here is seen from both sides of a full one.
        EXPECT_LE(std::abs(angle), 4.0 * std::numbers::pi) << words(name, target, distance);
      }
    }
  }
}

// Rounding in the Jacobian is no detail of the element's shape.
TEST(TargetRules, TightTolerancesStayAffordable) {
  const ElementTable<3> table = geometry::bezier_elements(geometry::sphere(1.0));
  const TargetRules<3> rules(table, {1e-16, 16});
  NodeBuffer<3> buffer;
  const Target<3> target{{0.2, -0.3, 0.1}};
  double angle = 0.0;
  for (int e = 0; e < static_cast<int>(table.elements.size()); ++e) {
    const NodeView<3> nodes = rules.nodes(e, target, buffer);
    EXPECT_LT(nodes.size(), 2000U);
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      const Vector3 d = offset_of(nodes, target.position, q);
      for (std::size_t c = 0; c < 3; ++c)
        angle += nodes.weight[q] * d[static_cast<Eigen::Index>(c)] * nodes.normal[c][q] / std::pow(d.norm(), 3);
    }
  }
  EXPECT_NEAR(angle, 4.0 * std::numbers::pi, 1e-13);
}

}  // namespace
}  // namespace isorim::quadrature
