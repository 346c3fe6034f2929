#include "solver/bem/extracted_space.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/bezier/subdivision.h"
#include "quadrature/gauss_legendre.h"
#include "solver/bem/point_selection.h"
#include "solver/bem/smoothness.h"

namespace isorim::solver {

using geometry::BezierElement;
using geometry::BoundaryEdge;
using geometry::EdgeUse;
using geometry::ElementTable;
using geometry::ExtractedSurface;
using geometry::ExtractionElement;
using geometry::Interval;
using geometry::Point2;

namespace {

ExtractionElement part_of(ExtractionElement element, const std::array<Interval, 2>& part) {
  const std::array<int, 2> degrees{element.degree[0], element.degree[1]};
  const std::span<double> rows(element.rows.data(), static_cast<std::size_t>(element.rows.size()));
  for (std::size_t d = 0; d < 2; ++d) {
    geometry::restrict_net(rows, static_cast<int>(element.rows.rows()), degrees, static_cast<int>(d), part[d]);
    const Interval whole = element.domain[d];
    element.domain[d] = {whole.first + part[d].first * whole.length(), whole.first + part[d].last * whole.length()};
  }
  return element;
}

/// Numbers that sets of elements have in common.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& parent = parent_[static_cast<std::size_t>(i)];
      parent = parent_[static_cast<std::size_t>(parent)];
      i = parent;
    }
    return i;
  }
  void join(int i, int j) {
    const int a = root(i);
    const int b = root(j);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// Where a side of an element, as ShapeLoops counts them, is at its parameter.
Point2 place_on_side(int side, double t) {
  const std::array<Point2, 4> places{Point2(t, 0.0), Point2(1.0, t), Point2(1.0 - t, 1.0), Point2(0.0, 1.0 - t)};
  return places[static_cast<std::size_t>(side)];
}

/// The place at a share of the edge, from its first vertex.
Point2 place_on_edge(const EdgeUse& use, double share) {
  const double along = use.forward ? share : 1.0 - share;
  return place_on_side(use.curve, use.domain.first + along * use.domain.length());
}

}  // namespace

ExtractedSurface bisected(const ExtractedSurface& surface, int levels) {
  if (levels == 0) return surface;
  const int count = 1 << levels;
  std::vector<ExtractionElement> elements;
  for (const ExtractionElement& element : surface.elements())
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < count; ++i) {
        const auto part = [count](int k) {
          return Interval{static_cast<double>(k) / count, static_cast<double>(k + 1) / count};
        };
        elements.push_back(part_of(element, {part(i), part(j)}));
      }
  return {surface.homogeneous(), std::move(elements)};
}

std::vector<int> smooth_regions(const ExtractedSurface& surface, int patch, std::span<const BoundaryEdge> edges,
                                const ElementTable<3>& table, std::size_t first_element, std::span<const int> groups) {
  DisjointSets sets(groups.size());
  const auto same_group = [&](int a, int b) {
    return groups[static_cast<std::size_t>(a)] == groups[static_cast<std::size_t>(b)];
  };
  const auto element = [&](int e) -> const BezierElement<3>& {
    return table.elements[first_element + static_cast<std::size_t>(e)];
  };
  bool has_edges = false;
  for (const BoundaryEdge& edge : edges) {
    if (edge.first.patch != patch || edge.second.patch != patch) continue;
    has_edges = true;
    const int a = edge.first.loop;
    const int b = edge.second.loop;
    if (!same_group(a, b)) continue;
    const bool is_smooth = std::ranges::none_of(std::array{0.1, 0.4, 0.7}, [&](double share) {
      return has_crease<3>(table, element(a), place_on_edge(edge.first, share), element(b),
                           place_on_edge(edge.second, share));
    });
    if (is_smooth) sets.join(a, b);
  }
  if (!has_edges) {
    std::map<std::pair<std::int32_t, int>, int> seen;
    for (int e = 0; e < static_cast<int>(groups.size()); ++e)
      for (const std::int32_t f : surface.elements()[static_cast<std::size_t>(e)].functions)
        sets.join(seen.try_emplace({f, groups[static_cast<std::size_t>(e)]}, e).first->second, e);
  }
  std::vector<int> regions(groups.size());
  for (std::size_t e = 0; e < regions.size(); ++e) regions[e] = sets.root(static_cast<int>(e));
  return regions;
}

PatchSpace<3> extracted_space(const ExtractedSurface& surface, std::span<const int> regions,
                              std::span<const BezierElement<3>> elements) {
  PatchSpace<3> space;
  std::map<std::pair<int, std::int32_t>, std::int32_t> numbers;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const ExtractionElement& from = surface.elements()[e];
    Eigen::MatrixXd rows = from.rows;
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
      rows.row(k) *= surface.homogeneous()(3, from.functions[static_cast<std::size_t>(k)]);
    // The table has divided out the weight there.
    if (elements[e].polynomial) rows /= rows.col(0).sum();
    FieldElement<3>& field = space.elements.emplace_back();
    field.degree = from.degree;
    field.rational = !elements[e].polynomial;
    field.first = space.functions.size();
    field.count = static_cast<int>(rows.rows());
    field.row = space.rows.size();
    for (const std::int32_t f : from.functions)
      space.functions.push_back(
          numbers.try_emplace({regions[e], f}, static_cast<std::int32_t>(numbers.size())).first->second);
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
      for (Eigen::Index j = 0; j < rows.cols(); ++j) space.rows.push_back(rows(k, j));
  }
  space.points.resize(numbers.size());
  require_points<3>(space, std::vector<char>(numbers.size(), 0), [&](int e) {
    const auto& degree = space.elements[static_cast<std::size_t>(e)].degree;
    std::vector<Point2> places;
    for (const double t : quadrature::gauss_legendre(degree[1] + 2).nodes)
      for (const double s : quadrature::gauss_legendre(degree[0] + 2).nodes) places.emplace_back(s, t);
    return places;
  });
  return space;
}

}  // namespace isorim::solver
