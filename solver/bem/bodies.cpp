#include "solver/bem/bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "geometry/bezier/element_jet.h"
#include "quadrature/target_rules.h"

namespace isorim::solver {

namespace {

using geometry::ElementTable;
using geometry::Point;
using geometry::Shell;

template <int Dim>
ElementTable<Dim> elements_of(const Shell<Dim>& shell, const ElementTable<Dim>& table) {
  ElementTable<Dim> part{{}, table.nets, table.regions};
  for (const auto& element : table.elements)
    if (std::ranges::find(shell.patches, element.patch) != shell.patches.end()) part.elements.push_back(element);
  return part;
}

/// Gauss's integral: 1 inside a closed boundary, 0 outside.
template <int Dim>
double turns_about(std::size_t elements, const quadrature::TargetRules<Dim>& rules, const Point<Dim>& point) {
  quadrature::NodeBuffer<Dim> buffer;
  double sum = 0.0;
  for (int e = 0; e < static_cast<int>(elements); ++e) {
    const quadrature::NodeView<Dim> nodes = rules.nodes(e, {point}, buffer);
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      double flux = 0.0;
      double squared = 0.0;
      for (std::size_t d = 0; d < Dim; ++d) {
        const double offset = nodes.position[d][q] - point[static_cast<Eigen::Index>(d)];
        flux += offset * nodes.normal[d][q];
        squared += offset * offset;
      }
      sum += nodes.weight[q] * flux / std::pow(squared, 0.5 * Dim);
    }
  }
  return sum / ((Dim == 2 ? 2.0 : 4.0) * std::numbers::pi);
}

constexpr double rule_tolerance = 1e-3;

template <int Dim>
bool contains(const ElementTable<Dim>& boundary, const Point<Dim>& point) {
  return turns_about<Dim>(boundary.elements.size(), {boundary, {rule_tolerance, 1}}, point) > 0.5;
}

template <int Dim>
Point<Dim> point_of(const ElementTable<Dim>& boundary) {
  return evaluate_jet<Dim>(boundary, boundary.elements.front(), Point<Dim - 1>::Constant(0.4)).position;
}

}  // namespace

template <int Dim>
std::vector<std::int32_t> bodies_of_patches(const geometry::Topology<Dim>& topology, const ElementTable<Dim>& table) {
  std::vector<ElementTable<Dim>> outer;
  std::size_t patches = 0;
  for (const Shell<Dim>& shell : topology.shells) {
    if (!shell.closed) return {};
    if (!shell.is_void) outer.push_back(elements_of(shell, table));
    patches += shell.patches.size();
  }
  if (outer.size() < 2) return {};
  std::vector<std::int32_t> result(patches, 0);
  std::int32_t next = 0;
  for (const Shell<Dim>& shell : topology.shells) {
    std::int32_t body = 0;
    if (!shell.is_void) {
      body = next++;
    } else {
      const Point<Dim> point = point_of(elements_of(shell, table));
      double smallest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < outer.size(); ++k) {
        const double size = geometry::bounding_box(outer[k]).diagonal();
        if (size >= smallest || !contains(outer[k], point)) continue;
        smallest = size;
        body = static_cast<std::int32_t>(k);
      }
    }
    for (const int patch : shell.patches) result[static_cast<std::size_t>(patch)] = body;
  }
  return result;
}

template <int Dim>
BodyLocator<Dim>::BodyLocator(const FieldSpace<Dim>& space) {
  if (space.body_count() == 1) return;
  bodies_.resize(static_cast<std::size_t>(space.body_count()));
  for (Body& body : bodies_) body.boundary = {{}, space.table.nets, space.table.regions};
  for (int e = 0; e < static_cast<int>(space.table.elements.size()); ++e)
    bodies_[static_cast<std::size_t>(space.body_of(e))].boundary.elements.push_back(
        space.table.elements[static_cast<std::size_t>(e)]);
  for (Body& body : bodies_)
    body.rules = std::make_unique<quadrature::TargetRules<Dim>>(
        body.boundary, typename quadrature::TargetRules<Dim>::Options{rule_tolerance, 1});
}

template <int Dim>
std::int32_t BodyLocator<Dim>::operator()(const Point<Dim>& point) const {
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    if (turns_about(bodies_[body].boundary.elements.size(), *bodies_[body].rules, point) > 0.5)
      return static_cast<std::int32_t>(body);
  return 0;
}

template class BodyLocator<2>;
template class BodyLocator<3>;
template std::vector<std::int32_t> bodies_of_patches(const geometry::Topology<2>&, const ElementTable<2>&);
template std::vector<std::int32_t> bodies_of_patches(const geometry::Topology<3>&, const ElementTable<3>&);

}  // namespace isorim::solver
