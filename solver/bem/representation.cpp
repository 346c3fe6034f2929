#include "solver/bem/representation.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <variant>

#include "solver/linear/small_products.h"

namespace isorim::solver {

using Eigen::Index;

namespace {

/// Values of one kernel that are held at a time.
constexpr std::size_t most_values = 8192;

/// Columns of a matrix as rows of numbers times weights.
void append_weighted(const Eigen::MatrixXd& columns, std::span<const double> weights, std::vector<double>& rows) {
  for (Index c = 0; c < columns.cols(); ++c)
    for (std::size_t q = 0; q < weights.size(); ++q) rows.push_back(weights[q] * columns(static_cast<Index>(q), c));
}

}  // namespace

template <int Dim>
Representation<Dim>::Representation(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const quadrature::TargetRules<Dim>& rules, int components)
    : problem_(&problem), space_(&space), rules_(&rules), components_(components), kept_(space.elements.size()) {}

template <int Dim>
auto Representation<Dim>::factors_at(int element, const View& nodes, RepresentationRoom<Dim>& room) const
    -> const Factors& {
  const auto index = static_cast<std::size_t>(element);
  const std::lock_guard lock(mutexes_[index % mutexes_.size()]);
  auto& kept = kept_[index];
  const auto known = std::find_if(kept.begin(), kept.end(), [&](const auto& f) { return f->number == nodes.kept; });
  if (known != kept.end()) return **known;
  auto made = std::make_unique<Factors>();
  made->number = nodes.kept;
  room.densities.at_nodes(element, nodes, room.own);
  append_weighted(room.own.potential, nodes.weight, made->potential);
  append_weighted(room.own.flux, nodes.weight, made->flux);
  made->linear.assign(nodes.weight.begin(), nodes.weight.end());
  for (std::size_t k = 0; k < Dim; ++k) {
    const double centre = nodes.position[k][0];
    made->centre[static_cast<Index>(k)] = centre;
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      made->linear.push_back(nodes.weight[q] * (nodes.position[k][q] - centre));
      made->normal.push_back(nodes.weight[q] * nodes.normal[k][q]);
    }
  }
  return *kept.emplace_back(std::move(made));
}

template <int Dim>
void Representation<Dim>::evaluate_kernels(const View& nodes, const geometry::Point<Dim>& target, bool is_gradient,
                                           std::span<double> of_single, std::span<double> of_double) const {
  const auto evaluate = [&](const auto& kernel) {
    if (is_gradient) {
      single_layer_gradient(kernel, target, nodes, of_single);
      double_layer_gradient(kernel, target, nodes, of_double);
    } else {
      single_layer(kernel, target, nodes, of_single);
      double_layer(kernel, target, nodes, of_double);
    }
  };
  std::visit(evaluate, problem_->equation);
}

template <int Dim>
void Representation<Dim>::add_kept(const typename RepresentationRoom<Dim>::Group& group, const Factors& factors,
                                   std::span<const Place> places, bool is_gradient, RepresentationRoom<Dim>& room,
                                   std::span<Sums> sums) const {
  const int rows = is_gradient ? Dim * components_ : components_;
  const std::size_t size = static_cast<std::size_t>(rows * components_) * group.nodes.size();
  const std::size_t most = std::max<std::size_t>(1, most_values / size);
  room.single_values.resize(std::max(room.single_values.size(), most * size));
  room.double_values.resize(room.single_values.size());
  for (std::size_t first = 0; first < group.targets.size(); first += most) {
    const auto targets = std::span(group.targets).subspan(first, std::min(most, group.targets.size() - first));
    for (std::size_t t = 0; t < targets.size(); ++t) {
      evaluate_kernels(group.nodes, places[targets[t]].target.position, is_gradient,
                       std::span(room.single_values).subspan(t * size, size),
                       std::span(room.double_values).subspan(t * size, size));
    }
    for (int o = 0; o < rows; ++o) {
      for (int j = 0; j < components_; ++j) {
        set_moments(group.nodes, factors, targets.size(), size, o * components_ + j, j, room);
        for (std::size_t t = 0; t < targets.size(); ++t) {
          Sums& all = sums[targets[t]];
          (is_gradient ? all.gradient.data() : all.value.data())[o] +=
              room.moments[t].without(places[targets[t]].simple, factors.centre, j);
        }
      }
    }
  }
}

/// Of one entry of the kernels and of component j of the fields, for targets whose values are `size` numbers apart.
template <int Dim>
void Representation<Dim>::set_moments(const View& nodes, const Factors& factors, std::size_t target_count,
                                      std::size_t size, int entry, int j, RepresentationRoom<Dim>& room) const {
  using Moments = typename RepresentationRoom<Dim>::Moments;
  const auto n = static_cast<std::ptrdiff_t>(nodes.size());
  const double* of_single = room.single_values.data() + entry * n;
  const double* of_double = room.double_values.data() + entry * n;
  room.moments.assign(target_count, Moments());
  const auto add = [&](const double* kernel, const std::vector<double>& factor, int first, int count, int place) {
    add_product_transposed(static_cast<int>(target_count), count, static_cast<int>(n), kernel,
                           static_cast<std::ptrdiff_t>(size), factor.data() + first * n, n,
                           room.moments.front().values.data() + place, Moments::count);
  };
  add(of_single, factors.flux, j, 1, Moments::flux);
  add(of_double, factors.potential, j, 1, Moments::potential);
  add(of_double, factors.linear, 0, 1 + Dim, Moments::linear);
  add(of_single, factors.normal, 0, Dim, Moments::normal);
}

/// Of U t - T u less those of U t_v - T v.
template <int Dim>
double RepresentationRoom<Dim>::Moments::without(const SimpleSolution<Dim>& v, const geometry::Point<Dim>& centre,
                                                 int component) const {
  using Row = Eigen::Map<const geometry::Vector<Dim>>;
  double sum = values[flux] - values[potential] + v.value[component] * values[linear];
  if (v.is_uniform()) return sum;
  const geometry::Vector<Dim> first = (centre - v.centre) * values[linear] + Row(values.data() + linear + 1);
  sum += v.gradient.row(component).dot(first) - v.stress.row(component).dot(Row(values.data() + normal));
  return sum;
}

template <int Dim>
void Representation<Dim>::weigh(const Place& place, const View& nodes, Densities& densities) const {
  const auto count = static_cast<Index>(nodes.size());
  const SimpleSolution<Dim>& simple = place.simple;
  const geometry::Vector<Dim> from_centre = place.target.position - simple.centre;
  const Eigen::Map<const Eigen::ArrayXd> weights(nodes.weight.data(), count);
  for (Index c = 0; c < components_; ++c) {
    auto potential = densities.potential.col(c).array();
    auto flux = densities.flux.col(c).array();
    potential -= simple.value[c];
    for (std::size_t i = 0; i < Dim && !simple.is_uniform(); ++i) {
      const auto k = static_cast<Index>(i);
      const Eigen::Map<const Eigen::ArrayXd> normal(nodes.normal[i].data(), count);
      const Eigen::Map<const Eigen::ArrayXd> offset(nodes.offset[i].data(), count);
      potential -= simple.gradient(c, k) * (offset + from_centre[k]);
      flux -= simple.stress(c, k) * normal;
    }
    potential *= weights;
    flux *= weights;
  }
}

template <int Dim>
void Representation<Dim>::add_own(const Place& place, const View& nodes, bool is_gradient,
                                  RepresentationRoom<Dim>& room, Sums& sums) const {
  const auto n = static_cast<Index>(nodes.size());
  const Index rows = is_gradient ? Dim * components_ : components_;
  const auto size = static_cast<std::size_t>(rows * components_ * n);
  room.single_values.resize(std::max(room.single_values.size(), size));
  room.double_values.resize(room.single_values.size());
  evaluate_kernels(nodes, place.target.position, is_gradient, std::span(room.single_values).first(size),
                   std::span(room.double_values).first(size));
  const Eigen::Map<const Eigen::MatrixXd> of_single(room.single_values.data(), n, rows * components_);
  const Eigen::Map<const Eigen::MatrixXd> of_double(room.double_values.data(), n, rows * components_);
  double* result = is_gradient ? sums.gradient.data() : sums.value.data();
  for (Index o = 0; o < rows; ++o) {
    for (Index j = 0; j < components_; ++j) {
      const Index column = o * components_ + j;
      result[o] +=
          of_single.col(column).dot(room.own.flux.col(j)) - of_double.col(column).dot(room.own.potential.col(j));
    }
  }
}

template <int Dim>
void Representation<Dim>::add_element(int element, std::span<const Place> places, bool with_gradient,
                                      RepresentationRoom<Dim>& room, std::span<Sums> sums) const {
  std::size_t group_count = 0;
  for (std::size_t t = 0; t < places.size(); ++t) {
    const View nodes = rules_->nodes(element, places[t].target, room.buffer);
    if (nodes.size() == 0) continue;
    if (nodes.kept < 0) {
      room.densities.at_nodes(element, nodes, room.own);
      weigh(places[t], nodes, room.own);
      add_own(places[t], nodes, false, room, sums[t]);
      if (with_gradient) add_own(places[t], nodes, true, room, sums[t]);
      continue;
    }
    const auto end = room.groups.begin() + static_cast<std::ptrdiff_t>(group_count);
    auto group = std::find_if(room.groups.begin(), end, [&](const auto& g) { return g.nodes.kept == nodes.kept; });
    if (group == end) {
      if (group_count == room.groups.size()) room.groups.emplace_back();
      group = room.groups.begin() + static_cast<std::ptrdiff_t>(group_count++);
      group->nodes = nodes;
      group->targets.clear();
    }
    group->targets.push_back(t);
  }
  for (std::size_t g = 0; g < group_count; ++g) {
    const Factors& factors = factors_at(element, room.groups[g].nodes, room);
    add_kept(room.groups[g], factors, places, false, room, sums);
    if (with_gradient) add_kept(room.groups[g], factors, places, true, room, sums);
  }
}

template <int Dim>
auto Representation<Dim>::sum(std::span<const Place> places, bool with_gradient, RepresentationRoom<Dim>& room) const
    -> std::vector<Sums> {
  const Sums zero{Eigen::VectorXd::Zero(components_), Eigen::MatrixXd::Zero(with_gradient ? components_ : 0, Dim)};
  std::vector<Sums> sums(places.size(), zero);
  for (std::size_t e = 0; e < space_->elements.size(); ++e)
    add_element(static_cast<int>(e), places, with_gradient, room, sums);
  return sums;
}

template <int Dim>
auto Representation<Dim>::at(std::span<const Place> places, RepresentationRoom<Dim>& room) const -> std::vector<Sums> {
  return sum(places, true, room);
}

template <int Dim>
auto Representation<Dim>::values(std::span<const Place> places, RepresentationRoom<Dim>& room) const
    -> std::vector<Sums> {
  return sum(places, false, room);
}

template class Representation<2>;
template class Representation<3>;

}  // namespace isorim::solver
