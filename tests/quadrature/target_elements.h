#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "tests/quadrature/regions.h"

/// Single elements for tests of rules with singular targets.
namespace isorim::quadrature::testing {

/// A net point: position and weight.
using NetPoint = Eigen::Vector4d;

/// An element whose control point (i, j) is net(i / p, j / q).
inline geometry::ElementTable<3> surface_element(int p, int q, const std::function<NetPoint(double u, double v)>& net) {
  geometry::ElementTable<3> table;
  geometry::BezierElement<3> element;
  element.degree = {static_cast<std::int8_t>(p), static_cast<std::int8_t>(q)};
  element.polynomial = true;
  for (int j = 0; j <= q; ++j) {
    for (int i = 0; i <= p; ++i) {
      const NetPoint point = net(static_cast<double>(i) / p, static_cast<double>(j) / q);
      element.polynomial = element.polynomial && point[3] == 1.0;
      for (int c = 0; c < 3; ++c) table.nets.push_back(point[3] * point[c]);
      table.nets.push_back(point[3]);
    }
  }
  table.elements.push_back(element);
  return table;
}

inline geometry::ElementTable<2> curve_element(const std::vector<Eigen::Vector3d>& points) {
  geometry::ElementTable<2> table;
  geometry::BezierElement<2> element;
  element.degree = {static_cast<std::int8_t>(points.size() - 1)};
  element.polynomial = true;
  for (const Eigen::Vector3d& point : points) {
    element.polynomial = element.polynomial && point[2] == 1.0;
    for (int c = 0; c < 2; ++c) table.nets.push_back(point[2] * point[c]);
    table.nets.push_back(point[2]);
  }
  table.elements.push_back(element);
  return table;
}

/// The weight of the middle point of a quarter circle.
inline double quarter(double u) {
  return u == 0.5 ? std::numbers::sqrt2 / 2.0 : 1.0;
}

inline std::vector<std::pair<std::string, geometry::ElementTable<3>>> surface_elements() {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto shaken = [&](double u, double v) {
    const double x = u + 0.15 * unit(generator);
    const double y = v + 0.1 * unit(generator);
    const double z = 0.3 * unit(generator);
    return NetPoint(x, y, z, 1.0 + 0.4 * unit(generator));
  };
  const auto turned = [](double t) { return std::pair(t == 1.0 ? 0.0 : 1.0, t == 0.0 ? 0.0 : 1.0); };
  const auto sphere = [&](double u, double v) {
    const auto [x, y] = turned(u);
    const auto [radius, z] = turned(v);
    return NetPoint(radius * x, radius * y, z, quarter(u) * quarter(v));
  };
  const auto cylinder = [&](double u, double v) {
    const auto [x, y] = turned(u);
    return NetPoint(x, y, 20.0 * v, quarter(u));
  };
  return {
      {"square", surface_element(1, 1, [](double u, double v) { return NetPoint(u, v, 0, 1); })},
      {"parallelogram", surface_element(1, 1, [](double u, double v) { return NetPoint(u + v, v, 0, 1); })},
      {"strip", surface_element(1, 1, [](double u, double v) { return NetPoint(100.0 * u, v, 0, 1); })},
      {"twisted strip",
       surface_element(2, 2, [](double u, double v) { return NetPoint(10.0 * u, v, 2.0 * u * v - 0.5 * u, 1); })},
      {"bump", surface_element(
                   3, 3, [](double u, double v) { return NetPoint(u, v, 8.0 * u * (1.0 - u) * v * (1.0 - v), 1); })},
      {"uneven", surface_element(
                     2, 2, [](double u, double v) { return NetPoint(u == 0.5 ? 0.1 : u, v == 0.5 ? 0.85 : v, 0, 1); })},
      {"quarter cylinder", surface_element(2, 1, cylinder)},
      {"eighth of a sphere", surface_element(2, 2, sphere)},
      {"random rational", surface_element(2, 3, shaken)},
  };
}

/// A bent element of random degrees from 1 to 4, aspect ratio from 1 to 100 and orientation, three of four rational
/// with weights from 1/4 to 4: uneven in both directions, every point displaced.
inline geometry::ElementTable<3> random_element(std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> degree(1, 4);
  const int p = degree(generator);
  const int q = degree(generator);
  const double aspect = std::pow(100.0, std::abs(unit(generator)));
  const double bend = 0.5 * std::abs(unit(generator));
  const bool rational = unit(generator) > -0.5;
  const double skew = 0.5 * unit(generator);
  const auto shifts = [&](int points) {
    std::vector<Eigen::Vector2d> result;
    for (int i = 0; i <= points; ++i)
      result.emplace_back(0.3 / points * unit(generator), std::pow(2.0, unit(generator)));
    return result;
  };
  const std::vector<Eigen::Vector2d> along = shifts(p);
  const std::vector<Eigen::Vector2d> across = shifts(q);
  geometry::ElementTable<3> table = surface_element(p, q, [&](double u, double v) {
    const Eigen::Vector2d& i = along[static_cast<std::size_t>(std::lround(u * p))];
    const Eigen::Vector2d& j = across[static_cast<std::size_t>(std::lround(v * q))];
    const double x = aspect * (u + i[0]) + skew * v + 0.3 / q * unit(generator);
    const double y = v + j[0] + 0.3 / q * unit(generator);
    const double z = bend * unit(generator);
    return NetPoint(x, y, z, rational ? i[1] * j[1] * (1.0 + 0.3 / aspect * unit(generator)) : 1.0);
  });
  table.elements[0].orientation = unit(generator) > 0.0 ? 1 : -1;
  return table;
}

/// A rational element between (0, 0), (1, 0) and (shear, 1), (1 + shear, 1), as thin as that makes it, bent and uneven
/// by a third of how thin it is.
inline geometry::ElementTable<3> sheared_element(double shear, std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double bend = 0.3 / shear;
  return surface_element(2, 2, [&](double u, double v) {
    const double x = u + shear * v + bend * unit(generator);
    const double y = v + bend * unit(generator);
    const double z = 2.0 * bend * unit(generator);
    return NetPoint(x, y, z, 1.0 + 0.3 * unit(generator));
  });
}

}  // namespace isorim::quadrature::testing
