#pragma once

#include <cstddef>
#include <vector>

#include "quadrature/element_shape.h"
#include "quadrature/target_rules.h"

namespace isorim::quadrature {

/// A target on an element or close to it, and what is asked for it.
template <int Dim>
struct NearRequest {
  const ElementShape<Dim>* shape = nullptr;
  geometry::Point<Dim> target;
  /// The target is the element's point at `place`.
  bool is_own = false;
  geometry::Point<Dim - 1> place;
  double tolerance = 1e-12;
  /// What is kept of a cut element.
  const geometry::TrimmedRegion* region = nullptr;
};

/// Room for more places and their weights.
template <int Dim>
void reserve_more(NodeBuffer<Dim>& nodes, std::size_t count) {
  const std::size_t size = nodes.size + count;
  if (nodes.cell_weight.size() >= size) return;
  nodes.cell_weight.resize(size);
  for (std::vector<double>& values : nodes.place) values.resize(size);
}

inline void append_node(NodeBuffer<3>& nodes, const geometry::Point2& place, double weight) {
  nodes.place[0][nodes.size] = place[0];
  nodes.place[1][nodes.size] = place[1];
  nodes.cell_weight[nodes.size++] = weight;
}

}  // namespace isorim::quadrature
