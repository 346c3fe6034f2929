#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/bezier/element_table.h"
#include "geometry/vocabulary.h"

/// Points and weights on the elements of a boundary for integrands that are singular, or nearly so, at a given target.
namespace isorim::quadrature {

/// Where the singularity is.
template <int Dim>
struct Target {
  geometry::Point<Dim> position;
  /// The element that the target lies on, and where in its unit cell; -1: on none (an interior point, possibly near).
  int element = -1;
  geometry::Point<Dim - 1> place = geometry::Point<Dim - 1>::Zero();
};

/// Nodes on one element, each array of the same length (structure of arrays, so that kernels vectorise). Sums of
/// weight f are int f dS.
template <int Dim>
struct NodeView {
  /// In the element's unit cell.
  std::array<std::span<const double>, Dim - 1> place;
  std::array<std::span<const double>, Dim> position;
  /// Unit, outward.
  std::array<std::span<const double>, Dim> normal;
  /// Times the Jacobian. Negative ones occur on cut elements only.
  std::span<const double> weight;
  /// position - target, exact to rounding relative to the element's own size, wherever that lies; empty if the nodes
  /// are not made for one target.
  std::array<std::span<const double>, Dim> offset{};
  /// Not 0: the nodes are those of the tensor Gauss-Legendre rule with so many points in each direction of the cell,
  /// the first direction fastest (bernstein_table() has the basis at them).
  std::array<int, Dim - 1> orders{};
  /// Which of the kept rules this is, so that basis values at its nodes can be kept as well: equal numbers mean equal
  /// places, on whichever element; they are small. -1: made for the target.
  int kept = -1;

  std::size_t size() const { return weight.size(); }
  bool is_tensor() const { return orders[0] > 0; }
};

/// A thread's room for nodes that are made for one target.
template <int Dim>
struct NodeBuffer {
  std::size_t size = 0;
  std::array<std::vector<double>, Dim - 1> place;
  std::array<std::vector<double>, Dim> position;
  std::array<std::vector<double>, Dim> normal;
  std::array<std::vector<double>, Dim> offset;
  std::vector<double> weight;
  /// What the vectors above were made from: weights on the unit cell.
  std::vector<double> cell_weight;
};

/// Rules for all elements of a table, which has to outlive them. Far elements are served from kept tensor rules whose
/// order goes with the distance in each direction; near ones by subdivision and sinh maps towards the closest
/// point; the target's own by polar (Duffy) maps about its place, in 2D by splitting there and logarithmic rules. Cut
/// elements: far targets by the moments of their regions, near ones and their own in polar coordinates over the
/// regions' boundaries (weights of both signs). Decisions depend on ratios of lengths alone, so the unit of length
/// plays no part.
template <int Dim>
class TargetRules {
 public:
  struct Options {
    /// Relative accuracy of int K phi dS on each element for kernels up to |x - y|^(1 - Dim) (after the value at the
    /// target has been subtracted on its own element) and phi of the field's degree. Below 1e-14 counts as 1e-14.
    double tolerance = 1e-12;
    /// Degree of the functions on every element, beside the geometry's.
    int field_degree = 2;
  };
  TargetRules(const geometry::ElementTable<Dim>& table, const Options& options);
  ~TargetRules();

  /// Nodes of an element for a target. The view holds until the next call with the same buffer. Safe to call from
  /// several threads with different buffers.
  NodeView<Dim> nodes(int element, const Target<Dim>& target, NodeBuffer<Dim>& buffer) const;

  /// The kept rule of an element that serves all targets at least `distance` away from its sphere. Throws InputError
  /// for less than a third of its radius: nearer ones need rules of their own.
  NodeView<Dim> far_nodes(int element, double distance) const;

  /// A sphere (circle) that holds the element.
  struct Sphere {
    geometry::Point<Dim> centre;
    double radius = 0.0;
  };
  Sphere sphere(int element) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace isorim::quadrature
