#include "solver/bem/boundary_locator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "geometry/bezier/element_jet.h"
#include "quadrature/parallel.h"

namespace isorim::solver {

namespace {

/// Of the solid angle: one decides by whether it exceeds a half.
constexpr double angle_tolerance = 1e-3;

/// Cells along the longest side of the box: twice as many as points, if these fill it.
template <int Dim>
int cell_count(std::size_t point_count) {
  constexpr double least = 16.0;
  constexpr double most = Dim == 2 ? 2000.0 : 160.0;
  const double along = 2.0 * std::pow(static_cast<double>(point_count), 1.0 / Dim);
  return static_cast<int>(std::clamp(along, least, most));
}

}  // namespace

template <int Dim>
BoundaryLocator<Dim>::BoundaryLocator(const geometry::ElementTable<Dim>& table)
    : table_(&table), rules_(table, {angle_tolerance, 0}) {
  shapes_.reserve(table.elements.size());
  for (const geometry::BezierElement<Dim>& element : table.elements)
    shapes_.push_back(quadrature::plain_shape(quadrature::element_net(table, element)));
}

template <int Dim>
void BoundaryLocator<Dim>::prepare(std::size_t point_count, double margin, int threads) {
  regions_ = std::make_unique<CellRegions<Dim>>(*table_, cell_count<Dim>(point_count), margin);
  is_inside_.assign(static_cast<std::size_t>(regions_->count()), std::nullopt);
  quadrature::parallel_for(is_inside_.size(), threads, [&](std::size_t region, int) {
    // They disagree where the boundary leaks.
    quadrature::NodeBuffer<Dim> buffer;
    std::size_t inside = 0;
    const auto& samples = regions_->samples(static_cast<int>(region));
    for (const geometry::Point<Dim>& sample : samples) inside += winding_number(sample, buffer) > 0.5 ? 1 : 0;
    if (inside == 0 || inside == samples.size()) is_inside_[region] = inside > 0;
  });
}

template <int Dim>
std::optional<bool> BoundaryLocator<Dim>::known_inside(const geometry::Point<Dim>& point) const {
  const int region = regions_ ? regions_->region(point) : CellRegions<Dim>::touched;
  if (region == CellRegions<Dim>::touched) return std::nullopt;
  return is_inside_[static_cast<std::size_t>(region)];
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
    const quadrature::NodeView<Dim> nodes = rules_.nodes(static_cast<int>(e), target, buffer);
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
