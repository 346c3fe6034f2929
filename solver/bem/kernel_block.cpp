#include "solver/bem/kernel_block.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <variant>

#include "quadrature/element_jet.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/parallel.h"
#include "solver/bem/kernels.h"

namespace isorim::solver {

namespace {

using Eigen::Index;

template <int Dim>
quadrature::NodeView<Dim> view_of(const std::array<std::vector<double>, Dim>& positions,
                                  const std::array<std::vector<double>, Dim>& normals) {
  quadrature::NodeView<Dim> view;
  for (std::size_t d = 0; d < Dim; ++d) {
    view.position[d] = positions[d];
    view.normal[d] = normals[d];
  }
  // Kernels take the number of nodes from the weights, and nothing else.
  view.weight = positions[0];
  return view;
}

/// Points in each direction of an element.
template <int Dim>
int source_order(const FieldSpace<Dim>& space) {
  const double functions = static_cast<double>(space.function_count()) / static_cast<double>(space.elements.size());
  return std::max(2, static_cast<int>(std::ceil(std::pow(2.0 * functions, 1.0 / (Dim - 1)) - 1e-9)));
}

/// The grid on the unit cell.
template <int Dim>
quadrature::NodeBuffer<Dim> grid(int order) {
  const quadrature::Rule& rule = quadrature::gauss_legendre(order);
  const std::size_t n = rule.nodes.size();
  quadrature::NodeBuffer<Dim> nodes;
  nodes.size = Dim == 2 ? n : n * n;
  for (std::size_t q = 0; q < nodes.size; ++q) {
    nodes.place[0].push_back(rule.nodes[q % n]);
    nodes.cell_weight.push_back(rule.weights[q % n]);
    if constexpr (Dim == 3) {
      nodes.place[1].push_back(rule.nodes[q / n]);
      nodes.cell_weight.back() *= rule.weights[q / n];
    }
  }
  return nodes;
}

}  // namespace

template <int Dim>
SourcePoints<Dim>::SourcePoints(const FieldSpace<Dim>& space, int threads) {
  const quadrature::NodeBuffer<Dim> cell = grid<Dim>(source_order(space));
  per_element_ = cell.size;
  const std::size_t elements = space.elements.size();
  for (std::size_t d = 0; d < Dim; ++d) {
    positions_[d].resize(elements * per_element_);
    normals_[d].resize(elements * per_element_);
  }
  weights_.resize(elements * per_element_);
  constexpr std::size_t chunk = 64;
  quadrature::parallel_for((elements + chunk - 1) / chunk, threads, [&](std::size_t task, int) {
    quadrature::NodeBuffer<Dim> nodes = cell;
    for (std::size_t e = task * chunk; e < std::min((task + 1) * chunk, elements); ++e) {
      const auto net = quadrature::element_net(space.table, space.table.elements[e]);
      evaluate_nodes(net, geometry::Point<Dim>(geometry::Point<Dim>::Zero()), nodes);
      const auto first = static_cast<std::ptrdiff_t>(e * per_element_);
      for (std::size_t d = 0; d < Dim; ++d) {
        std::copy_n(nodes.position[d].begin(), per_element_, positions_[d].begin() + first);
        std::copy_n(nodes.normal[d].begin(), per_element_, normals_[d].begin() + first);
      }
      std::copy_n(nodes.weight.begin(), per_element_, weights_.begin() + first);
    }
  });
}

template <int Dim>
KernelBlock<Dim>::KernelBlock(const Assembler<Dim>& assembler, const SourcePoints<Dim>& sources,
                              std::span<const std::int32_t> targets, std::span<const int> elements)
    : assembler_(&assembler),
      targets_(targets.begin(), targets.end()),
      elements_(elements.begin(), elements.end()),
      per_element_(sources.per_element()) {
  for (const std::int32_t target : targets_) {
    const geometry::Point<Dim>& x = assembler.space().points[static_cast<std::size_t>(target)].position;
    for (std::size_t d = 0; d < Dim; ++d) target_positions_[d].push_back(x[static_cast<Index>(d)]);
  }
  const auto append = [&](const std::vector<double>& from, int element, std::vector<double>& to) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(element) * static_cast<std::ptrdiff_t>(per_element_);
    to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(per_element_));
  };
  for (const int element : elements_) {
    for (std::size_t d = 0; d < Dim; ++d) {
      append(sources.positions()[d], element, positions_[d]);
      append(sources.normals()[d], element, normals_[d]);
    }
    append(sources.weights(), element, weights_);
    needs_single_ = needs_single_ || assembler.needs_single_layer(element);
  }
  double_scale_ = least_distance();
  single_scale_ = assembler.stiffness();
}

/// Between the boxes of targets and sources, or half their diagonal if the boxes touch.
template <int Dim>
double KernelBlock<Dim>::least_distance() const {
  double squared = 0.0;
  double diagonal = 0.0;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto [target_low, target_high] =
        std::minmax_element(target_positions_[d].begin(), target_positions_[d].end());
    const auto [low, high] = std::minmax_element(positions_[d].begin(), positions_[d].end());
    const double gap = std::max({0.0, *target_low - *high, *low - *target_high});
    const double extent = std::max(*target_high, *high) - std::min(*target_low, *low);
    squared += gap * gap;
    diagonal += extent * extent;
  }
  return squared > 0.0 ? std::sqrt(squared) : 0.5 * std::sqrt(diagonal);
}

template <int Dim>
void KernelBlock<Dim>::evaluate(const geometry::Point<Dim>& target, const Coordinates& positions,
                                const Coordinates& normals) {
  const quadrature::NodeView<Dim> view = view_of<Dim>(positions, normals);
  const std::size_t size = static_cast<std::size_t>(assembler_->components() * assembler_->components()) * view.size();
  double_values_.resize(size);
  if (needs_single_) single_values_.resize(size);
  const auto fill = [&](const auto& kernel) {
    double_layer(kernel, target, view, std::span<double>(double_values_));
    if (needs_single_) single_layer(kernel, target, view, std::span<double>(single_values_));
  };
  std::visit(fill, assembler_->problem().equation);
}

template <int Dim>
void KernelBlock<Dim>::row(Index target, Eigen::Ref<Eigen::MatrixXd> values) {
  const auto index = static_cast<std::size_t>(targets_[static_cast<std::size_t>(target)]);
  evaluate(assembler_->space().points[index].position, positions_, normals_);
  const auto components = static_cast<std::size_t>(assembler_->components());
  const auto stride = static_cast<std::size_t>(column_components());
  const std::size_t n = weights_.size();
  const auto spread = [&](const std::vector<double>& kernel, double scale, std::size_t first) {
    for (std::size_t i = 0; i < components; ++i) {
      double* row = values.col(static_cast<Index>(i)).data();
      for (std::size_t j = 0; j < components; ++j) {
        const double* source = kernel.data() + (i * components + j) * n;
        for (std::size_t q = 0; q < n; ++q) row[q * stride + first + j] = scale * weights_[q] * source[q];
      }
    }
  };
  spread(double_values_, double_scale_, 0);
  if (needs_single_) spread(single_values_, single_scale_, components);
}

/// With the roles of target and source exchanged the single layer stays, and the double layer (with the source's
/// normal) changes its sign.
template <int Dim>
void KernelBlock<Dim>::column(Index node, Eigen::Ref<Eigen::MatrixXd> values) {
  const auto q = static_cast<std::size_t>(node);
  geometry::Point<Dim> y;
  for (std::size_t d = 0; d < Dim; ++d) {
    y[static_cast<Index>(d)] = positions_[d][q];
    repeated_normal_[d].assign(targets_.size(), normals_[d][q]);
  }
  evaluate(y, target_positions_, repeated_normal_);
  const auto components = static_cast<std::size_t>(assembler_->components());
  const std::size_t n = targets_.size();
  const auto spread = [&](const std::vector<double>& kernel, double scale, std::size_t first) {
    for (std::size_t j = 0; j < components; ++j) {
      double* column = values.col(static_cast<Index>(first + j)).data();
      for (std::size_t i = 0; i < components; ++i) {
        const double* source = kernel.data() + (i * components + j) * n;
        for (std::size_t x = 0; x < n; ++x) column[x * components + i] = scale * source[x];
      }
    }
  };
  spread(double_values_, -double_scale_ * weights_[q], 0);
  if (needs_single_) spread(single_values_, single_scale_ * weights_[q], components);
}

template <int Dim>
std::int32_t KernelBlock<Dim>::target_group(Index target) const {
  const auto index = static_cast<std::size_t>(targets_[static_cast<std::size_t>(target)]);
  const int element = assembler_->space().points[index].element;
  return assembler_->space().table.elements[static_cast<std::size_t>(element)].patch;
}

template <int Dim>
std::int32_t KernelBlock<Dim>::node_group(Index node) const {
  const int element = elements_[static_cast<std::size_t>(node) / per_element_];
  return assembler_->space().table.elements[static_cast<std::size_t>(element)].patch;
}

template <int Dim>
double KernelBlock<Dim>::double_layer_bound() const {
  constexpr double unit_sphere = Dim == 3 ? 4.0 * std::numbers::pi : 2.0 * std::numbers::pi;
  const double measure = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  return measure / (unit_sphere * std::pow(double_scale_, Dim - 1));
}

template class SourcePoints<2>;
template class SourcePoints<3>;
template class KernelBlock<2>;
template class KernelBlock<3>;

}  // namespace isorim::solver
