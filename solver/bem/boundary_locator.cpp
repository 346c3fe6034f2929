#include "solver/bem/boundary_locator.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "geometry/bezier/element_jet.h"

namespace isorim::solver {

template <int Dim>
BoundaryLocator<Dim>::BoundaryLocator(const geometry::ElementTable<Dim>& table,
                                      const quadrature::TargetRules<Dim>& rules)
    : table_(&table), rules_(&rules) {
  // Only places are asked of the shapes, not rules.
  constexpr double rough = 1e-2;
  shapes_.reserve(table.elements.size());
  for (const geometry::BezierElement<Dim>& element : table.elements)
    shapes_.push_back(quadrature::element_shape(quadrature::element_net(table, element), 1.0, rough));
}

template <int Dim>
BoundaryPlace<Dim> BoundaryLocator<Dim>::nearest(const geometry::Point<Dim>& point) const {
  const auto lower_bound = [&](std::size_t e) { return (point - shapes_[e].centre).norm() - shapes_[e].radius; };
  BoundaryPlace<Dim> best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto look = [&](std::size_t e) {
    const quadrature::NearestPlace<Dim> found = quadrature::nearest_place(shapes_[e], {}, point);
    if (found.distance < best.distance) best = {static_cast<int>(e), found.place, found.distance, shapes_[e].radius};
  };
  std::size_t first = 0;
  for (std::size_t e = 1; e < shapes_.size(); ++e) {
    if (lower_bound(e) < lower_bound(first)) first = e;
  }
  look(first);
  for (std::size_t e = 0; e < shapes_.size(); ++e) {
    if (e != first && lower_bound(e) < best.distance) look(e);
  }
  return best;
}

template <int Dim>
double BoundaryLocator<Dim>::winding_number(const geometry::Point<Dim>& point,
                                            quadrature::NodeBuffer<Dim>& buffer) const {
  quadrature::Target<Dim> target;
  target.position = point;
  double angle = 0.0;
  for (std::size_t e = 0; e < shapes_.size(); ++e) {
    const quadrature::NodeView<Dim> nodes = rules_->nodes(static_cast<int>(e), target, buffer);
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      double squared = 0.0;
      double flux = 0.0;
      for (std::size_t i = 0; i < Dim; ++i) {
        const double d = nodes.position[i][q] - point[static_cast<Eigen::Index>(i)];
        squared += d * d;
        flux += d * nodes.normal[i][q];
      }
      if (squared > 0.0) angle += nodes.weight[q] * flux / (Dim == 2 ? squared : squared * std::sqrt(squared));
    }
  }
  return angle / (2.0 * (Dim - 1) * std::numbers::pi);
}

template <int Dim>
bool BoundaryLocator<Dim>::is_kept(const BoundaryPlace<Dim>& place, quadrature::NodeBuffer<Dim>& buffer) const {
  const geometry::BezierElement<Dim>& element = table_->elements[static_cast<std::size_t>(place.element)];
  if (!element.is_cut()) return true;
  const geometry::ElementJet<Dim> jet = geometry::evaluate_jet(*table_, element, place.place);
  const geometry::Vector<Dim> step = 1e-4 * place.element_size * jet.normal();
  const double inside = winding_number(jet.position - step, buffer);
  const double outside = winding_number(jet.position + step, buffer);
  return inside - outside > 0.5;
}

template class BoundaryLocator<2>;
template class BoundaryLocator<3>;

}  // namespace isorim::solver
