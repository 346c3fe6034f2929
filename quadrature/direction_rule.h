#pragma once

#include <array>

#include "quadrature/gauss_legendre.h"
#include "quadrature/sinh_map.h"

namespace isorim::quadrature {

/// A Gauss-Legendre rule along one direction of a cell, mapped.
struct DirectionRule {
  SinhMap map;
  int points = 0;
};

/// Its places in [lower, lower + width] and their weights.
struct MappedRule {
  std::array<double, max_gauss_points> places;
  std::array<double, max_gauss_points> weights;

  explicit MappedRule(const DirectionRule& direction, double lower = 0.0, double width = 1.0) {
    const Rule& gauss = gauss_legendre(direction.points);
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const SinhMap::Value at = direction.map.at(gauss.nodes[k]);
      places[k] = lower + width * at.place;
      weights[k] = width * gauss.weights[k] * at.derivative;
    }
  }
};

}  // namespace isorim::quadrature
