#pragma once

#include <span>
#include <vector>

#include "geometry/vocabulary.h"
#include "quadrature/element_piece.h"
#include "quadrature/element_sums.h"

namespace isorim::quadrature {

/// The points of a rule on a piece of an element, the first direction fastest.
template <int Dim>
struct PieceSamples {
  /// Dim x n.
  geometry::Points<Dim> points;
  /// Dim x n: outward normals, of the length of the length or area element on the unit cell.
  geometry::Points<Dim> normals;
  /// Of the rule; on a cut piece some are negative.
  std::vector<double> weights;
};

/// Evaluates a piece at the points of the rule of the given orders. `samples` is reused storage.
template <int Dim>
void sample_piece(const ElementPiece<Dim>& piece, const Orders<Dim - 1>& orders, PieceSamples<Dim>& samples);

/// Evaluates a piece of a surface at any points of its unit cell, which weigh nothing.
PieceSamples<3> sample_at(const ElementPiece<3>& piece, std::span<const geometry::Point2> places);

}  // namespace isorim::quadrature
