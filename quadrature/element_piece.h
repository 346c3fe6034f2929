#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "quadrature/cut_region.h"
#include "quadrature/element_sums.h"
#include "quadrature/sector.h"

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
  /// What is kept of the piece; null if all of it is. Of surfaces only.
  std::shared_ptr<const CutRegion> region = nullptr;
  /// If set, the piece is this sector of the element's cell, and its directions are the curve and the rays.
  std::shared_ptr<const Sector> sector = nullptr;

  const double* net() const { return own_net.empty() ? element_net : own_net.data(); }
  bool is_cut() const { return region != nullptr; }
  /// Nothing of it is kept.
  bool empty() const { return is_cut() && region->extent() == CutRegion::Extent::nothing; }
};

/// The piece that is the whole element, or what is kept of it.
template <int Dim>
ElementPiece<Dim> whole_element(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element) {
  ElementPiece<Dim> piece{&element, table.nets.data() + element.offset, {}, 0};
  if (element.is_cut()) {
    CutRegion region(table.regions[static_cast<std::size_t>(element.region)]);
    if (region.extent() != CutRegion::Extent::everything) piece.region = std::make_shared<CutRegion>(std::move(region));
  }
  return piece;
}

/// The same as pieces: the element, if something of it is kept; or, if it is cut, its sectors.
enum class CutForm { region, sectors };
template <int Dim>
std::vector<ElementPiece<Dim>> pieces_of_element(const geometry::ElementTable<Dim>& table,
                                                 const geometry::BezierElement<Dim>& element, CutForm form);

/// The tensor Gauss-Legendre nodes that a rule of the given orders uses: on a cut piece twice as many, because there
/// n nodes integrate polynomials of degree n - 1 exactly, not 2 n - 1. So a rule of n points means the same accuracy on
/// whole and on cut pieces.
template <int Dim>
Orders<Dim - 1> nodes_of_rule(const ElementPiece<Dim>& piece, Orders<Dim - 1> orders) {
  if (piece.is_cut()) {
    for (int& order : orders) order *= 2;
  }
  return orders;
}

/// The number of points of that rule.
template <int Dim>
std::int64_t points_of_rule(const ElementPiece<Dim>& piece, const Orders<Dim - 1>& orders) {
  std::int64_t points = 1;
  for (const int nodes : nodes_of_rule(piece, orders)) points *= nodes;
  return points;
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

/// The element is an affine image of its unit cell, to rounding: so its normal is constant, and the area or length is a
/// polynomial as well.
template <int Dim>
bool is_affine(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element);

/// The order in each direction at which a rule of two points less is expected to integrate the sums to the relative
/// tolerance: exact_order where all weights are 1, two more (so that the lesser rule is exact) where they are constant
/// along the direction; elsewhere the rate of convergence is
/// taken from the nearest complex zero that a weight function with that ratio of weights can have.
template <int Dim>
Orders<Dim - 1> expected_orders(const ElementPiece<Dim>& piece, double tolerance);

}  // namespace isorim::quadrature
