#pragma once

#include <random>
#include <vector>

#include "geometry/bezier/element_table.h"

namespace isorim::quadrature::testing {

/// Elements with random nets: grid points displaced by up to 0.3 of their distance, weights between 1 and
/// `largest_weight` (all 1 and flagged polynomial if that is 1).
template <int Dim>
geometry::ElementTable<Dim> random_elements(int count, std::array<int, Dim - 1> degree, double largest_weight,
                                            unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  geometry::ElementTable<Dim> table;
  for (int e = 0; e < count; ++e) {
    geometry::BezierElement<Dim> element;
    element.offset = table.nets.size();
    for (std::size_t d = 0; d < Dim - 1; ++d) element.degree[d] = static_cast<std::int8_t>(degree[d]);
    element.polynomial = largest_weight == 1.0;
    element.orientation = e % 2 == 0 ? 1 : -1;
    for (int k = 0; k < element.control_point_count(); ++k) {
      const double weight = 1.0 + (largest_weight - 1.0) * unit(generator);
      for (int c = 0; c < Dim; ++c) {
        const int columns = degree[0] + 1;
        const double grid = c == 0   ? static_cast<double>(k % columns) / degree[0]
                            : c == 1 ? static_cast<double>(k / columns) / degree[Dim - 2]
                                     : 0.5;
        table.nets.push_back(weight * (grid + 0.3 * (unit(generator) - 0.5)));
      }
      table.nets.push_back(weight);
    }
    table.elements.push_back(element);
  }
  return table;
}

}  // namespace isorim::quadrature::testing
