#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/boundary.h"

namespace isorim::geometry {

/// One rational Bézier element of a boundary in Dim dimensions: a curve segment (Dim = 2) or a tensor-product patch
/// (Dim = 3) over the unit cell [0, 1]^(Dim - 1). Quadrature, solver and writers see boundaries as these alone.
template <int Dim>
struct BezierElement {
  /// Where the net starts in ElementTable::nets, in doubles.
  std::size_t offset = 0;
  /// The element's cell in the parameter space of its patch, a knot span or (if cut) a part of one; unit cell
  /// coordinate s maps to first + s length. Of an extracted surface the cell of its T-mesh, or the unit square for
  /// every element where none is known.
  std::array<Interval, Dim - 1> domain;
  /// Index of the patch in the boundary.
  std::int32_t patch = 0;
  std::array<std::int8_t, Dim - 1> degree{};
  /// All weights of the net are 1: the coordinates are polynomials. (Equal weights are divided out.)
  bool polynomial = false;
  /// +1 or -1: the outward normal is this times (y', -x') or S_u x S_v.
  std::int8_t orientation = 1;
  /// Index into ElementTable::regions if only a part of the unit cell belongs to the boundary; -1: all of it does.
  std::int32_t region = -1;

  bool is_cut() const { return region >= 0; }

  /// Number of control points: the product of the degrees plus one.
  int control_point_count() const {
    int count = 1;
    for (const std::int8_t p : degree) count *= p + 1;
    return count;
  }
};

/// The part of a cut element that is kept, by its own boundary in the element's unit cell.
struct TrimmedRegion {
  /// Rational Bézier curves, 3 x (p + 1) homogeneous points (w s, w t, w) with positive weights: closed chains with the
  /// kept part on their left, the cell's own edges among them where they bound it. They do not cross; they may touch.
  /// The sum over all curves of a line integral is therefore one around the region, whatever their order.
  std::vector<HomogeneousPoints<2>> curves;
};

/// Every element of a boundary, patch by patch, with their control nets in one array.
template <int Dim>
struct ElementTable {
  std::vector<BezierElement<Dim>> elements;
  /// The nets one after the other; each (Dim + 1) x (p + 1)[(q + 1)] homogeneous points, column-major, the first
  /// parameter fastest: (w x, w y, [w z,] w), (w x, ...
  std::vector<double> nets;
  /// Of the cut elements (Dim = 3).
  std::vector<TrimmedRegion> regions;

  std::span<const double> net(const BezierElement<Dim>& element) const {
    return {nets.data() + element.offset, static_cast<std::size_t>(element.control_point_count() * (Dim + 1))};
  }
  /// The net as a (Dim + 1) x count matrix.
  Eigen::Map<const HomogeneousPoints<Dim>> net_matrix(const BezierElement<Dim>& element) const {
    return {nets.data() + element.offset, Dim + 1, element.control_point_count()};
  }
};

/// The rational Bézier elements of each patch, in the order of the patches, a surface's elements with u fastest, those
/// of an extracted surface in their own order.
/// Exact: knots are inserted to full multiplicity.
///
/// Of a trimmed surface only the elements are there that hold some of what is kept. Its cut elements are narrowed to
/// the bounding rectangle of their region (`domain` tells which), so that their nets bound what is kept.
template <int Dim>
ElementTable<Dim> bezier_elements(const Boundary<Dim>& boundary);

/// Corners of the smallest axis-parallel box that holds all control points, hence the boundary.
template <int Dim>
struct BoundingBox {
  Point<Dim> lower;
  Point<Dim> upper;

  Point<Dim> middle() const { return 0.5 * (lower + upper); }
  double diagonal() const { return (upper - lower).norm(); }
};
template <int Dim>
BoundingBox<Dim> bounding_box(const ElementTable<Dim>& table);

}  // namespace isorim::geometry
