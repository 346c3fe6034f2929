#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/bezier/element_table.h"
#include "quadrature/element_piece.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/piece_samples.h"

/// Integrals of functions with a singularity on or near an element, by bisection alone.
namespace isorim::quadrature::testing {

/// An element of which all points are taken relative to a target.
template <int Dim>
geometry::ElementTable<Dim> relative_to(const geometry::ElementTable<Dim>& table, const geometry::Point<Dim>& target) {
  geometry::ElementTable<Dim> moved = table;
  for (const geometry::BezierElement<Dim>& element : table.elements) {
    for (int k = 0; k < element.control_point_count(); ++k) {
      double* point = moved.nets.data() + element.offset + static_cast<std::size_t>(k * (Dim + 1));
      for (int c = 0; c < Dim; ++c) point[c] -= point[Dim] * target[c];
    }
  }
  return moved;
}

/// A part of an element and where it lies in its cell.
template <int Dim>
struct PlacedPiece {
  ElementPiece<Dim> piece;
  geometry::Point<Dim - 1> lower = geometry::Point<Dim - 1>::Zero();
  geometry::Point<Dim - 1> upper = geometry::Point<Dim - 1>::Ones();
};

/// The direction in which a part is longer than it is far from the origin, by its control points; -1: none.
template <int Dim>
int direction_to_bisect(const ElementPiece<Dim>& piece) {
  const Eigen::Map<const geometry::HomogeneousPoints<Dim>> net(piece.net(), Dim + 1,
                                                               piece.element->control_point_count());
  const geometry::Points<Dim> points = net.template topRows<Dim>().array().rowwise() / net.row(Dim).array();
  const geometry::Point<Dim> zero = geometry::Point<Dim>::Zero();
  const geometry::Point<Dim> nearest = zero.cwiseMax(points.rowwise().minCoeff()).cwiseMin(points.rowwise().maxCoeff());
  std::array<double, 2> length{};
  const int columns = piece.element->degree[0] + 1;
  for (int k = 0; k + 1 < points.cols(); ++k) {
    if (k % columns + 1 < columns)
      length[0] = std::max(length[0], columns * (points.col(k + 1) - points.col(k)).norm());
    if (k + columns < points.cols())
      length[1] = std::max(
          length[1], static_cast<double>(points.cols()) / columns * (points.col(k + columns) - points.col(k)).norm());
  }
  const int longest = length[1] > length[0] ? 1 : 0;
  return length[static_cast<std::size_t>(longest)] > nearest.norm() ? longest : -1;
}

/// int f(place, y - x, n) over element `index`, n the area vector of the cell (the line element's normal): f adds
/// weight times its values to sums. Parts are bisected until none is longer than its distance from the target, or until
/// it is negligible, and then integrated with 20 points in each direction.
template <int Dim, class Function>
std::vector<double> integrate_by_bisection(const geometry::ElementTable<Dim>& table, std::size_t index,
                                           const geometry::Point<Dim>& target, std::size_t count, const Function& f) {
  constexpr int negligible_depth = Dim == 2 ? 60 : 110;
  const geometry::ElementTable<Dim> moved = relative_to(table, target);
  std::vector<PlacedPiece<Dim>> stack{{whole_element(moved, moved.elements[index])}};
  std::vector<double> sums(count, 0.0);
  PieceSamples<Dim> samples;
  Orders<Dim - 1> orders;
  orders.fill(20);
  while (!stack.empty()) {
    const PlacedPiece<Dim> part = stack.back();
    stack.pop_back();
    if (part.piece.empty()) continue;
    // At least two bisections in each direction, so that the element's own shape is resolved.
    const int shape_depth = 2 * (Dim - 1);
    const int direction = part.piece.depth < shape_depth        ? part.piece.depth % (Dim - 1)
                          : part.piece.depth < negligible_depth ? direction_to_bisect(part.piece)
                                                                : -1;
    if (direction >= 0) {
      auto [first, second] = bisect(part.piece, direction);
      PlacedPiece<Dim> lower{std::move(first), part.lower, part.upper};
      PlacedPiece<Dim> upper{std::move(second), part.lower, part.upper};
      lower.upper[direction] = upper.lower[direction] = 0.5 * (part.lower[direction] + part.upper[direction]);
      stack.push_back(std::move(lower));
      stack.push_back(std::move(upper));
      continue;
    }
    sample_piece(part.piece, orders, samples);
    const Orders<Dim - 1> nodes = nodes_of_rule(part.piece, orders);
    for (std::size_t q = 0; q < samples.weights.size(); ++q) {
      geometry::Point<Dim - 1> place = part.lower;
      std::size_t rest = q;
      for (std::size_t d = 0; d < Dim - 1; ++d) {
        const auto i = static_cast<Eigen::Index>(d);
        const auto n = static_cast<std::size_t>(nodes[d]);
        place[i] += gauss_legendre(nodes[d]).nodes[rest % n] * (part.upper[i] - part.lower[i]);
        rest /= n;
      }
      const auto k = static_cast<Eigen::Index>(q);
      f(place, samples.points.col(k), samples.normals.col(k), samples.weights[q], sums);
    }
  }
  return sums;
}

}  // namespace isorim::quadrature::testing
