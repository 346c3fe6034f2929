#include "solver/bem/coarse_table.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

namespace isorim::solver {

namespace {

using geometry::BezierElement;
using geometry::ElementTable;
using geometry::Point;

bool keeps_its_parameters(const geometry::NurbsCurve<2>&) {
  return true;
}
bool keeps_its_parameters(const geometry::SurfaceShape& shape) {
  return !std::holds_alternative<geometry::ExtractedSurface>(shape);
}

template <int Dim>
bool contains(const BezierElement<Dim>& coarse, const BezierElement<Dim>& fine) {
  for (std::size_t d = 0; d + 1 < Dim; ++d) {
    if (!coarse.domain[d].contains(fine.domain[d].middle())) return false;
  }
  return coarse.patch == fine.patch;
}

/// The whole element of the same patch that each fine one is a part of; -1: none.
template <int Dim>
std::vector<int> parents(const geometry::Boundary<Dim>& boundary, const ElementTable<Dim>& whole,
                         const ElementTable<Dim>& fine) {
  std::vector<int> result(fine.elements.size(), -1);
  std::size_t first = 0;
  for (std::size_t e = 0; e < fine.elements.size(); ++e) {
    const std::int32_t patch = fine.elements[e].patch;
    while (first < whole.elements.size() && whole.elements[first].patch < patch) ++first;
    if (!keeps_its_parameters(boundary.patches[static_cast<std::size_t>(patch)].shape)) continue;
    for (std::size_t k = first; k < whole.elements.size() && whole.elements[k].patch == patch; ++k) {
      if (contains(whole.elements[k], fine.elements[e])) result[e] = static_cast<int>(k);
    }
  }
  return result;
}

}  // namespace

template <int Dim>
CoarseTable<Dim>::CoarseTable(const geometry::Boundary<Dim>& boundary, const ElementTable<Dim>& fine) {
  table_.regions = fine.regions;
  const ElementTable<Dim> whole = bezier_elements(boundary);
  const std::vector<int> parent = parents(boundary, whole, fine);
  std::vector<double> share(whole.elements.size(), 0.0);
  for (std::size_t e = 0; e < parent.size(); ++e) {
    cells_.push_back({});
    if (parent[e] < 0) continue;
    const auto k = static_cast<std::size_t>(parent[e]);
    Cell& cell = cells_.back();
    for (std::size_t d = 0; d + 1 < Dim; ++d) {
      const auto row = static_cast<Eigen::Index>(d);
      const geometry::Interval& domain = whole.elements[k].domain[d];
      const geometry::Interval& part = fine.elements[e].domain[d];
      cell.first[row] = (part.first - domain.first) / domain.length();
      cell.length[row] = part.length() / domain.length();
    }
    if (!fine.elements[e].is_cut()) share[k] += cell.length.prod();
  }
  // Elements that are cut, in the coarse table or in the fine one, stay in their fine parts.
  constexpr double rounding = 1e-9;
  std::vector<int> number_of(whole.elements.size(), -1);
  for (std::size_t e = 0; e < parent.size(); ++e) {
    const std::size_t k = parent[e] < 0 ? whole.elements.size() : static_cast<std::size_t>(parent[e]);
    if (k == whole.elements.size() || whole.elements[k].is_cut() || std::abs(share[k] - 1.0) > rounding) {
      cells_[e] = {append(fine, fine.elements[e])};
      continue;
    }
    if (number_of[k] < 0) number_of[k] = append(whole, whole.elements[k]);
    cells_[e].element = number_of[k];
  }
}

template <int Dim>
int CoarseTable<Dim>::append(const ElementTable<Dim>& from, BezierElement<Dim> element) {
  const std::span<const double> net = from.net(element);
  element.offset = table_.nets.size();
  table_.nets.insert(table_.nets.end(), net.begin(), net.end());
  table_.elements.push_back(element);
  return static_cast<int>(table_.elements.size()) - 1;
}

template <int Dim>
quadrature::Target<Dim> CoarseTable<Dim>::target(quadrature::Target<Dim> target) const {
  if (target.element < 0) return target;
  const Cell& cell = cells_[static_cast<std::size_t>(target.element)];
  target.element = cell.element;
  target.place = cell.first + cell.length.cwiseProduct(target.place);
  return target;
}

template <int Dim>
std::shared_ptr<const CoarseTable<Dim>> coarse_table(const geometry::Boundary<Dim>& boundary,
                                                     const ElementTable<Dim>& fine) {
  auto coarse = std::make_shared<const CoarseTable<Dim>>(boundary, fine);
  if (coarse->table().elements.size() == fine.elements.size()) return nullptr;
  return coarse;
}

template class CoarseTable<2>;
template class CoarseTable<3>;
template std::shared_ptr<const CoarseTable<2>> coarse_table(const geometry::Boundary<2>&, const ElementTable<2>&);
template std::shared_ptr<const CoarseTable<3>> coarse_table(const geometry::Boundary<3>&, const ElementTable<3>&);

}  // namespace isorim::solver
