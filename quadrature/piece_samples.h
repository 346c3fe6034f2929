#pragma once

#include "geometry/vocabulary.h"
#include "quadrature/element_piece.h"
#include "quadrature/element_sums.h"

namespace isorim::quadrature {

/// The points of a rule on a piece of an element, the first direction fastest.
template <int Dim>
struct PieceSamples {
  /// Dim x n.
  geometry::Points<Dim> points;
  /// Dim x n: outward normals n dS, of the length of the length or area element times the rule's weight.
  geometry::Points<Dim> normals;
};

/// Evaluates a piece at the tensor Gauss-Legendre points of the given orders. `samples` is reused storage.
template <int Dim>
void sample_piece(const ElementPiece<Dim>& piece, const Orders<Dim - 1>& orders, PieceSamples<Dim>& samples);

}  // namespace isorim::quadrature
