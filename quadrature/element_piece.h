#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "quadrature/element_sums.h"

namespace isorim::quadrature {

/// A Bézier element or a part of one that bisections have made.
template <int Dim>
struct ElementPiece {
  const geometry::BezierElement<Dim>* element = nullptr;
  /// The element's net in the table, and, once the piece is not the whole element, a net of its own.
  const double* element_net = nullptr;
  std::vector<double> own_net;
  /// Bisections that led to the piece.
  int depth = 0;

  const double* net() const { return own_net.empty() ? element_net : own_net.data(); }
};

template <int Dim>
ElementPiece<Dim> whole_element(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element) {
  return {&element, table.nets.data() + element.offset, {}, 0};
}

/// The halves of a piece in one of the element's directions.
template <int Dim>
std::pair<ElementPiece<Dim>, ElementPiece<Dim>> bisect(const ElementPiece<Dim>& piece, int direction);

/// The number of Gauss points that integrates all of ElementSums but the measure exactly on a polynomial element of
/// degree p: the second moments have degree 4 p - 2 (Dim = 2) or 5 p - 2 (Dim = 3) in each direction, since the
/// leading terms of d.n cancel.
template <int Dim>
constexpr int exact_order(int degree) {
  return Dim == 2 ? 2 * degree : 5 * degree / 2;
}

/// The order in each direction at which a rule of two points less is expected to integrate the sums to the relative
/// tolerance: exact_order where all weights are 1, two more (so that the lesser rule is exact) where they are constant
/// along the direction; elsewhere the rate of convergence is
/// taken from the nearest complex zero that a weight function with that ratio of weights can have.
template <int Dim>
Orders<Dim - 1> expected_orders(const ElementPiece<Dim>& piece, double tolerance);

}  // namespace isorim::quadrature
