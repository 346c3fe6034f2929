#pragma once

#include <array>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"
#include "quadrature/target_rules.h"

/// Points of a Bézier element, for the rules of target_rules.h.
namespace isorim::quadrature {

/// A Bézier element and its net.
template <int Dim>
struct ElementNet {
  std::array<int, Dim - 1> degree{};
  bool polynomial = false;
  int orientation = 1;
  /// As in ElementTable::nets.
  const double* points = nullptr;
};

template <int Dim>
ElementNet<Dim> element_net(const geometry::ElementTable<Dim>& table, const geometry::BezierElement<Dim>& element);

/// A point and its derivatives with respect to the cell's coordinates.
template <int Dim>
struct ElementJet {
  /// The point minus the origin that was asked for.
  geometry::Vector<Dim> offset;
  std::array<geometry::Vector<Dim>, Dim - 1> first;
  /// uu, vv, uv.
  std::array<geometry::Vector<Dim>, Dim == 2 ? 1 : 3> second;
};

/// At a place of the unit cell. The offset is taken between net and origin before anything is summed: it is right to a
/// rounding of the net's distance from the origin.
template <int Dim>
ElementJet<Dim> element_jet(const ElementNet<Dim>& net, const geometry::Point<Dim - 1>& place,
                            const geometry::Point<Dim>& origin);

/// Fills position, offset from the origin, normal and weight of the buffer's nodes [0, size) from place and
/// cell_weight. Some 15 ns a node for biquartic elements.
template <int Dim>
void evaluate_nodes(const ElementNet<Dim>& net, const geometry::Point<Dim>& origin, NodeBuffer<Dim>& nodes);

}  // namespace isorim::quadrature
