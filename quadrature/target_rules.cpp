#include "quadrature/target_rules.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <deque>
#include <mutex>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "quadrature/cut_region.h"
#include "quadrature/element_jet.h"
#include "quadrature/element_shape.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/near_rule.h"
#include "quadrature/parallel.h"
#include "quadrature/region_moments.h"

namespace isorim::quadrature {

namespace {

/// Rules of a higher order in a direction are made for the target.
constexpr int most_kept_order = 24;
/// On a cut element n nodes are exact for polynomials of degree n - 1 instead of 2 n - 1.
constexpr int nodes_per_order_when_cut = 2;
/// Far targets are sorted by distance from the centre of the element's sphere, in units of its radius.
constexpr std::array<double, 9> far_levels{1.35, 1.6, 2.0, 2.6, 3.5, 5.0, 8.0, 14.0, 30.0};

/// Few different ones, so that few rules are kept.
int rounded_order(int order) {
  return order <= 8 ? order : order + order % 2;
}

/// Of the plain tensor rule; 0 where a direction is mapped or has too many points to be kept.
template <int Dim>
std::array<int, Dim - 1> plain_orders(const std::array<DirectionRule, Dim - 1>& rules) {
  std::array<int, Dim - 1> orders{};
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    if (rules[d].map.is_identity() && rules[d].points <= most_kept_order) orders[d] = rounded_order(rules[d].points);
  }
  return orders;
}

template <int Dim>
NodeView<Dim> view_of(const NodeBuffer<Dim>& nodes) {
  NodeView<Dim> view;
  const std::size_t size = nodes.size;
  for (std::size_t d = 0; d < Dim - 1; ++d) view.place[d] = std::span(nodes.place[d]).first(size);
  for (std::size_t c = 0; c < Dim; ++c) {
    view.position[c] = std::span(nodes.position[c]).first(size);
    view.normal[c] = std::span(nodes.normal[c]).first(size);
  }
  view.weight = std::span(nodes.weight).first(size);
  return view;
}

/// A rule that has been made once for an element.
template <int Dim>
struct KeptRule {
  NodeBuffer<Dim> nodes;
  NodeView<Dim> view;
  const KeptRule* next = nullptr;
};

template <int Dim>
void set_tensor(const std::array<int, Dim - 1>& orders, NodeBuffer<Dim>& nodes) {
  std::size_t size = 1;
  for (const int order : orders) size *= static_cast<std::size_t>(order);
  nodes.size = size;
  nodes.cell_weight.assign(size, 1.0);
  std::size_t stride = 1;
  for (std::size_t d = 0; d < Dim - 1; ++d) {
    const Rule& rule = gauss_legendre(orders[d]);
    nodes.place[d].resize(size);
    for (std::size_t q = 0; q < size; ++q) {
      const std::size_t k = q / stride % rule.nodes.size();
      nodes.place[d][q] = rule.nodes[k];
      nodes.cell_weight[q] *= rule.weights[k];
    }
    stride *= rule.nodes.size();
  }
}

/// A small number for each pair of orders.
template <int Dim>
int number_of(const std::array<int, Dim - 1>& orders) {
  int number = orders[0] - 1;
  if constexpr (Dim == 3) number += max_gauss_points * (orders[1] - 1);
  return number;
}

/// What is kept of a cut element.
struct CutElement {
  const geometry::TrimmedRegion* boundary;
  CutRegion region;
  /// The region's moments serve one thread at a time.
  std::mutex moments;

  explicit CutElement(const geometry::TrimmedRegion& curves) : boundary(&curves), region(curves) {}
};

/// What is known of an element, and its kept rules: a list to which rules are added in front, never taken away.
template <int Dim>
struct ElementState {
  ElementShape<Dim> shape;
  /// Null if all of it is kept.
  std::unique_ptr<CutElement> cut;
  std::array<std::array<int, Dim - 1>, far_levels.size()> far_orders{};
  std::atomic<const KeptRule<Dim>*> rules{nullptr};
  std::array<std::atomic<const KeptRule<Dim>*>, far_levels.size()> far_rules{};

  ~ElementState() {
    const KeptRule<Dim>* rule = rules.load();
    while (rule != nullptr) {
      const KeptRule<Dim>* next = rule->next;
      delete rule;
      rule = next;
    }
  }
};

}  // namespace

template <int Dim>
struct TargetRules<Dim>::State {
  using Orders = std::array<int, Dim - 1>;

  Options options;
  std::vector<ElementState<Dim>> elements;

  State(const geometry::ElementTable<Dim>& table, const Options& chosen)
      : options(chosen), elements(table.elements.size()) {
    constexpr std::size_t chunk = 16;
    constexpr double least_tolerance = 1e-14;
    options.tolerance = std::max(options.tolerance, least_tolerance);
    parallel_for((elements.size() + chunk - 1) / chunk, 0, [&](std::size_t task, int) {
      for (std::size_t e = task * chunk; e < std::min((task + 1) * chunk, elements.size()); ++e) {
        const geometry::BezierElement<Dim>& element = table.elements[e];
        elements[e].shape = element_shape(element_net(table, element), options.field_degree, options.tolerance);
        if constexpr (Dim == 3) {
          if (element.is_cut()) set_region(table.regions[static_cast<std::size_t>(element.region)], elements[e]);
        }
        set_far_orders(elements[e]);
      }
    });
  }

  /// Of a target so far from the element's sphere, beyond the end of a parameter line: nowhere else can the
  /// singularity's ellipse be smaller.
  Orders orders_at(const ElementShape<Dim>& shape, double gap) const {
    Orders orders{};
    for (std::size_t d = 0; d < Dim - 1; ++d) {
      const double half = std::max(shape.half_length[d], 1e-12 * shape.radius);
      const double log_rho = std::acosh(1.0 + gap / half);
      const int points = gauss_points(SinhMap(), log_rho, options.tolerance,
                                      [&](std::complex<double> u) { return shape.growth[d](log_ellipse(u)); });
      orders[d] = rounded_order(points);
    }
    return orders;
  }

  void set_far_orders(ElementState<Dim>& element) const {
    for (std::size_t level = 0; level < far_levels.size(); ++level)
      element.far_orders[level] = orders_at(element.shape, (far_levels[level] - 1.0) * element.shape.radius);
  }

  static void set_region(const geometry::TrimmedRegion& curves, ElementState<Dim>& element) {
    auto cut = std::make_unique<CutElement>(curves);
    if (cut->region.extent() != CutRegion::Extent::everything) element.cut = std::move(cut);
  }

  bool can_keep(const Orders& orders) const {
    return std::all_of(orders.begin(), orders.end(), [](int n) { return 0 < n && n <= most_kept_order; });
  }

  /// Weights on the cell.
  static void set_weights(ElementState<Dim>& element, const Orders& points, NodeBuffer<Dim>& nodes) {
    set_tensor<Dim>(points, nodes);
    if constexpr (Dim == 3) {
      if (!element.cut) return;
      const std::lock_guard lock(element.cut->moments);
      region_weights(element.cut->region.moments(points), points, nodes.cell_weight);
    }
  }

  const KeptRule<Dim>& kept(ElementState<Dim>& element, Orders orders) const {
    for (int& order : orders) order *= element.cut ? nodes_per_order_when_cut : 1;
    const KeptRule<Dim>* known = element.rules.load(std::memory_order_acquire);
    if (const KeptRule<Dim>* found = find(known, nullptr, orders)) return *found;
    auto rule = std::make_unique<KeptRule<Dim>>();
    set_weights(element, orders, rule->nodes);
    evaluate_nodes(element.shape.net, element.shape.centre, rule->nodes);
    rule->nodes.cell_weight = {};
    for (std::vector<double>& values : rule->nodes.offset) values = {};
    rule->view = view_of(rule->nodes);
    rule->view.orders = orders;
    rule->view.kept = number_of<Dim>(orders);
    // Another thread may have added the same meanwhile: all must see one.
    const KeptRule<Dim>* searched = known;
    rule->next = known;
    while (!element.rules.compare_exchange_weak(rule->next, rule.get(), std::memory_order_acq_rel)) {
      if (const KeptRule<Dim>* found = find(rule->next, searched, orders)) return *found;
      searched = rule->next;
    }
    return *rule.release();
  }

  /// Searches the list up to `end`.
  static const KeptRule<Dim>* find(const KeptRule<Dim>* rule, const KeptRule<Dim>* end, const Orders& orders) {
    for (; rule != end; rule = rule->next) {
      if (rule->view.orders == orders) return rule;
    }
    return nullptr;
  }

  /// The rule of a far level, or none if it is too large to keep.
  const KeptRule<Dim>* far_rule(ElementState<Dim>& element, std::size_t level) const {
    const KeptRule<Dim>* rule = element.far_rules[level].load(std::memory_order_acquire);
    if (rule != nullptr) return rule;
    if (!can_keep(element.far_orders[level])) return nullptr;
    rule = &kept(element, element.far_orders[level]);
    element.far_rules[level].store(rule, std::memory_order_release);
    return rule;
  }
};

template <int Dim>
TargetRules<Dim>::TargetRules(const geometry::ElementTable<Dim>& table, const Options& options)
    : state_(std::make_unique<State>(table, options)) {}

template <int Dim>
TargetRules<Dim>::~TargetRules() = default;

template <int Dim>
NodeView<Dim> TargetRules<Dim>::nodes(int element, const Target<Dim>& target, NodeBuffer<Dim>& buffer) const {
  ElementState<Dim>& state = state_->elements[static_cast<std::size_t>(element)];
  const ElementShape<Dim>& shape = state.shape;
  const bool is_own = target.element == element;
  const double squared = (target.position - shape.centre).squaredNorm();
  const double radius_squared = shape.radius * shape.radius;
  if (!is_own && squared >= far_levels[0] * far_levels[0] * radius_squared) {
    std::size_t level = far_levels.size() - 1;
    while (squared < far_levels[level] * far_levels[level] * radius_squared) --level;
    if (const KeptRule<Dim>* rule = state_->far_rule(state, level)) return rule->view;
  }
  const NearRequest<Dim> request{&shape,       target.position,           is_own,
                                 target.place, state_->options.tolerance, state.cut ? state.cut->boundary : nullptr};
  NearestPlace<Dim> nearest;
  std::array<DirectionRule, Dim - 1> rules;
  if (is_own) {
    nearest = {target.place, element_jet(shape.net, target.place, target.position), 0.0};
  } else {
    nearest = nearest_place(shape, Cell<Dim - 1>(), target.position);
    rules = direction_rules(request, nearest);
    const auto orders = plain_orders<Dim>(rules);
    if (state_->can_keep(orders)) return state_->kept(state, orders).view;
  }
  near_rule(request, nearest, is_own ? nullptr : &rules, buffer);
  evaluate_nodes(shape.net, target.position, buffer);
  NodeView<Dim> view = view_of(buffer);
  for (std::size_t c = 0; c < Dim; ++c) view.offset[c] = std::span(buffer.offset[c]).first(buffer.size);
  return view;
}

template <int Dim>
NodeView<Dim> TargetRules<Dim>::far_nodes(int element, double distance) const {
  ElementState<Dim>& state = state_->elements[static_cast<std::size_t>(element)];
  const double radius = state.shape.radius;
  constexpr double least_distance = (1.0 - 1e-9) / 3.0;
  if (!(distance >= least_distance * radius))
    throw InputError(
        fmt::format("a rule of element {} was asked for targets {:.3g} away from its sphere of radius "
                    "{:.3g}; expected a third of the radius at least",
                    element, distance, radius));
  std::size_t level = far_levels.size();
  while (level > 0 && radius + distance < far_levels[level - 1] * radius) --level;
  typename State::Orders orders = level > 0 ? state.far_orders[level - 1] : state_->orders_at(state.shape, distance);
  const int most = max_gauss_points / (state.cut ? nodes_per_order_when_cut : 1);
  for (int& order : orders) order = std::min(order, most);
  return state_->kept(state, orders).view;
}

template <int Dim>
typename TargetRules<Dim>::Sphere TargetRules<Dim>::sphere(int element) const {
  const ElementShape<Dim>& shape = state_->elements[static_cast<std::size_t>(element)].shape;
  return {shape.centre, shape.radius};
}

template class TargetRules<2>;
template class TargetRules<3>;

}  // namespace isorim::quadrature
