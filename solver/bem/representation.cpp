#include "solver/bem/representation.h"

#include <cstddef>
#include <span>
#include <utility>
#include <variant>

namespace isorim::solver {

template <int Dim>
Representation<Dim>::Representation(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const quadrature::TargetRules<Dim>& rules, int components)
    : problem_(&problem), space_(&space), rules_(&rules), components_(components), kept_(space.elements.size()) {}

template <int Dim>
const Densities& Representation<Dim>::densities_at(int element, const quadrature::NodeView<Dim>& nodes,
                                                   RepresentationRoom<Dim>& room) const {
  if (nodes.kept < 0) {
    room.densities.at_nodes(element, nodes, room.own);
    return room.own;
  }
  auto& kept = kept_[static_cast<std::size_t>(element)];
  {
    const std::lock_guard lock(mutex_);
    const auto found = kept.find(nodes.kept);
    if (found != kept.end()) return *found->second;
  }
  // Two threads may make the same; the first one's stay.
  auto made = std::make_unique<Densities>();
  room.densities.at_nodes(element, nodes, *made);
  const std::lock_guard lock(mutex_);
  return *kept.try_emplace(nodes.kept, std::move(made)).first->second;
}

template <int Dim>
void Representation<Dim>::weigh(const quadrature::Target<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                                const Densities& densities, const SimpleSolution<Dim>& simple,
                                RepresentationRoom<Dim>& room) const {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const geometry::Vector<Dim> from_centre = target.position - simple.centre;
  const Eigen::Map<const Eigen::VectorXd> weights(nodes.weight.data(), count);
  Eigen::MatrixXd& potential = room.weighted.potential;
  Eigen::MatrixXd& flux = room.weighted.flux;
  potential = densities.potential.rowwise() - simple.value.transpose();
  flux = densities.flux;
  for (std::size_t i = 0; i < Dim; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Map<const Eigen::ArrayXd> normal(nodes.normal[i].data(), count);
    const bool exact = !nodes.offset[i].empty();
    const Eigen::Map<const Eigen::ArrayXd> place(exact ? nodes.offset[i].data() : nodes.position[i].data(), count);
    const double origin = exact ? -from_centre[k] : simple.centre[k];
    for (Eigen::Index c = 0; c < components_; ++c) {
      potential.col(c).array() -= simple.gradient(c, k) * (place - origin);
      flux.col(c).array() -= simple.stress(c, k) * normal;
    }
  }
  potential.array().colwise() *= weights.array();
  flux.array().colwise() *= weights.array();
}

template <int Dim>
void Representation<Dim>::add_value(const quadrature::Target<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                                    RepresentationRoom<Dim>& room, Sums& sums) const {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const std::size_t size = static_cast<std::size_t>(components_) * static_cast<std::size_t>(components_) * nodes.size();
  room.single_values.resize(size);
  room.double_values.resize(size);
  std::visit(
      [&](const auto& kernel) {
        single_layer(kernel, target.position, nodes, std::span<double>(room.single_values));
        double_layer(kernel, target.position, nodes, std::span<double>(room.double_values));
      },
      problem_->equation);
  const Eigen::Map<const Eigen::MatrixXd> single(room.single_values.data(), count, components_ * components_);
  const Eigen::Map<const Eigen::MatrixXd> twice(room.double_values.data(), count, components_ * components_);
  for (Eigen::Index i = 0; i < components_; ++i) {
    for (Eigen::Index j = 0; j < components_; ++j) {
      sums.value[i] += single.col(i * components_ + j).dot(room.weighted.flux.col(j)) -
                       twice.col(i * components_ + j).dot(room.weighted.potential.col(j));
    }
  }
}

template <int Dim>
void Representation<Dim>::add_gradient(const quadrature::Target<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                                       RepresentationRoom<Dim>& room, Sums& sums) const {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const Eigen::Index square = components_ * components_;
  const std::size_t size = Dim * static_cast<std::size_t>(square) * nodes.size();
  room.single_values.resize(size);
  room.double_values.resize(size);
  std::visit(
      [&](const auto& kernel) {
        single_layer_gradient(kernel, target.position, nodes, std::span<double>(room.single_values));
        double_layer_gradient(kernel, target.position, nodes, std::span<double>(room.double_values));
      },
      problem_->equation);
  const Eigen::Map<const Eigen::MatrixXd> single(room.single_values.data(), count, Dim * square);
  const Eigen::Map<const Eigen::MatrixXd> twice(room.double_values.data(), count, Dim * square);
  for (Eigen::Index k = 0; k < Dim; ++k) {
    for (Eigen::Index i = 0; i < components_; ++i) {
      for (Eigen::Index j = 0; j < components_; ++j) {
        const Eigen::Index column = k * square + i * components_ + j;
        sums.gradient(i, k) +=
            single.col(column).dot(room.weighted.flux.col(j)) - twice.col(column).dot(room.weighted.potential.col(j));
      }
    }
  }
}

template <int Dim>
typename Representation<Dim>::Sums Representation<Dim>::at(const quadrature::Target<Dim>& target,
                                                           const SimpleSolution<Dim>& simple,
                                                           RepresentationRoom<Dim>& room) const {
  Sums sums{Eigen::VectorXd::Zero(components_), Eigen::MatrixXd::Zero(components_, Dim)};
  for (std::size_t e = 0; e < space_->elements.size(); ++e) {
    const quadrature::NodeView<Dim> nodes = rules_->nodes(static_cast<int>(e), target, room.buffer);
    weigh(target, nodes, densities_at(static_cast<int>(e), nodes, room), simple, room);
    add_value(target, nodes, room, sums);
    add_gradient(target, nodes, room, sums);
  }
  return sums;
}

template <int Dim>
Eigen::VectorXd Representation<Dim>::value_at(const quadrature::Target<Dim>& target, const SimpleSolution<Dim>& simple,
                                              RepresentationRoom<Dim>& room) const {
  Sums sums{Eigen::VectorXd::Zero(components_), {}};
  for (std::size_t e = 0; e < space_->elements.size(); ++e) {
    const quadrature::NodeView<Dim> nodes = rules_->nodes(static_cast<int>(e), target, room.buffer);
    weigh(target, nodes, densities_at(static_cast<int>(e), nodes, room), simple, room);
    add_value(target, nodes, room, sums);
  }
  return sums.value;
}

template class Representation<2>;
template class Representation<3>;

}  // namespace isorim::solver
