#include "solver/bem/kernel_block.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

#include "solver/bem/kernels.h"

namespace isorim::solver {

namespace {

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

}  // namespace

template <int Dim>
KernelBlock<Dim>::KernelBlock(const Assembler<Dim>& assembler, std::span<const std::int32_t> targets,
                              std::span<const int> elements, AssemblyRoom<Dim>& room)
    : assembler_(&assembler), targets_(targets.begin(), targets.end()) {
  for (const std::int32_t target : targets_) {
    const geometry::Point<Dim>& x = assembler.space().points[static_cast<std::size_t>(target)].position;
    for (std::size_t d = 0; d < Dim; ++d) target_positions_[d].push_back(x[static_cast<Eigen::Index>(d)]);
  }
  for (const int element : elements) {
    const auto sphere = assembler.rules().sphere(element);
    double squared = std::numeric_limits<double>::infinity();
    for (const std::int32_t target : targets_) {
      const geometry::Point<Dim>& x = assembler.space().points[static_cast<std::size_t>(target)].position;
      squared = std::min(squared, (x - sphere.centre).squaredNorm());
    }
    append(element, std::max(0.0, std::sqrt(squared) - sphere.radius), room);
  }
}

template <int Dim>
void KernelBlock<Dim>::append(int element, double distance, AssemblyRoom<Dim>& room) {
  const quadrature::NodeView<Dim> nodes = assembler_->rules().far_nodes(element, distance);
  const auto data = assembler_->node_data(element, nodes, room);
  const Condition<Dim>& condition = assembler_->condition_on(element);
  parts_.push_back({element, node_count_, nodes.size(), data.basis});
  for (std::size_t d = 0; d < Dim; ++d) {
    positions_[d].insert(positions_[d].end(), nodes.position[d].begin(), nodes.position[d].end());
    normals_[d].insert(normals_[d].end(), nodes.normal[d].begin(), nodes.normal[d].end());
  }
  const double s = assembler_->sign();
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    part_of_node_.push_back(static_cast<int>(parts_.size()) - 1);
    for (std::size_t c = 0; c < condition.components.size(); ++c) {
      const ConditionKind kind = condition.components[c].kind;
      const bool is_value = kind == ConditionKind::value;
      const double robin = kind == ConditionKind::robin ? data.values->coefficient[c][q] : 0.0;
      double_factor_.push_back(is_value ? 0.0 : s * nodes.weight[q]);
      single_factor_.push_back((is_value ? -s * assembler_->flux_scale() : robin) * nodes.weight[q]);
      needs_double_ = needs_double_ || !is_value;
      needs_single_ = needs_single_ || kind != ConditionKind::flux;
    }
  }
  node_count_ += nodes.size();
}

template <int Dim>
void KernelBlock<Dim>::evaluate(const geometry::Point<Dim>& target, const Coordinates& positions,
                                const Coordinates& normals) {
  const quadrature::NodeView<Dim> view = view_of<Dim>(positions, normals);
  const auto entries = static_cast<std::size_t>(assembler_->components() * assembler_->components());
  if (needs_double_) double_values_.resize(entries * view.size());
  if (needs_single_) single_values_.resize(entries * view.size());
  const auto run = [&](const auto& kernel) {
    if (needs_double_) double_layer(kernel, target, view, double_values_);
    if (needs_single_) single_layer(kernel, target, view, single_values_);
  };
  std::visit(run, assembler_->problem().equation);
}

/// The kernels' values `at` of `count`, as the unknown component c of a node meets them.
template <int Dim>
double KernelBlock<Dim>::entry(std::size_t at, std::size_t count, std::size_t node, int i, int c,
                               double double_sign) const {
  const int components = assembler_->components();
  const auto factor = node * static_cast<std::size_t>(components) + static_cast<std::size_t>(c);
  const double of_double = double_sign * double_factor_[factor];
  const double of_single = single_factor_[factor];
  const auto kernel = [&](int j) {
    const std::size_t place = static_cast<std::size_t>(i * components + j) * count + at;
    return (of_double != 0.0 ? of_double * double_values_[place] : 0.0) +
           (of_single != 0.0 ? of_single * single_values_[place] : 0.0);
  };
  const Condition<Dim>& condition =
      assembler_->condition_on(parts_[static_cast<std::size_t>(part_of_node_[node])].element);
  if (!condition.frame) return kernel(c);
  double sum = 0.0;
  for (int j = 0; j < components; ++j) sum += kernel(j) * (*condition.frame)(c, j);
  return sum;
}

template <int Dim>
void KernelBlock<Dim>::row(Eigen::Index target, Eigen::Ref<Eigen::MatrixXd> values) {
  const auto index = static_cast<std::size_t>(targets_[static_cast<std::size_t>(target)]);
  evaluate(assembler_->space().points[index].position, positions_, normals_);
  const int components = assembler_->components();
  for (std::size_t q = 0; q < node_count_; ++q) {
    for (int c = 0; c < components; ++c) {
      for (int i = 0; i < components; ++i)
        values(static_cast<Eigen::Index>(q) * components + c, i) = entry(q, node_count_, q, i, c, 1.0);
    }
  }
}

/// With the roles of target and node exchanged the single layer stays, and the double layer (with the node's normal)
/// changes its sign.
template <int Dim>
void KernelBlock<Dim>::column(Eigen::Index node, Eigen::Ref<Eigen::MatrixXd> values) {
  const auto q = static_cast<std::size_t>(node);
  geometry::Point<Dim> y;
  for (std::size_t d = 0; d < Dim; ++d) {
    y[static_cast<Eigen::Index>(d)] = positions_[d][q];
    repeated_normal_[d].assign(targets_.size(), normals_[d][q]);
  }
  evaluate(y, target_positions_, repeated_normal_);
  const int components = assembler_->components();
  for (std::size_t x = 0; x < targets_.size(); ++x) {
    for (int i = 0; i < components; ++i) {
      for (int c = 0; c < components; ++c)
        values(static_cast<Eigen::Index>(x) * components + i, c) = entry(x, targets_.size(), q, i, c, -1.0);
    }
  }
}

template <int Dim>
std::int32_t KernelBlock<Dim>::target_group(Eigen::Index target) const {
  const auto index = static_cast<std::size_t>(targets_[static_cast<std::size_t>(target)]);
  const int element = assembler_->space().points[index].element;
  return assembler_->space().table.elements[static_cast<std::size_t>(element)].patch;
}

template <int Dim>
std::int32_t KernelBlock<Dim>::node_group(Eigen::Index node) const {
  const int part = part_of_node_[static_cast<std::size_t>(node)];
  const int element = parts_[static_cast<std::size_t>(part)].element;
  return assembler_->space().table.elements[static_cast<std::size_t>(element)].patch;
}

template class KernelBlock<2>;
template class KernelBlock<3>;

}  // namespace isorim::solver
