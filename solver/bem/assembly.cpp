#include "solver/bem/assembly.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "solver/bem/domain_load.h"
#include "solver/bem/kernels.h"

namespace isorim::solver {

namespace {

using quadrature::NodeView;
using quadrature::Target;

template <int Dim>
double stiffness(const Equation<Dim>& equation) {
  struct Visitor {
    double operator()(const Laplace<Dim>& kernel) const { return kernel.conductivity; }
    double operator()(const Elasticity<Dim>& kernel) const { return kernel.shear_modulus; }
  };
  return std::visit(Visitor{}, equation);
}

/// sum f(0), ..., f(count - 1) in four parts, so that additions need not wait for one another.
template <class Term>
double sum_of_terms(std::size_t count, const Term& term) {
  std::array<double, 4> part{};
  std::size_t q = 0;
  for (; q + 4 <= count; q += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) part[lane] += term(q + lane);
  }
  for (; q < count; ++q) part[0] += term(q);
  return (part[0] + part[1]) + (part[2] + part[3]);
}

double sum_of(const double* values, std::size_t count) {
  return sum_of_terms(count, [&](std::size_t q) { return values[q]; });
}

double dot(const double* a, const double* b, std::size_t count) {
  return sum_of_terms(count, [&](std::size_t q) { return a[q] * b[q]; });
}

void scale_rows(std::vector<double>& values, std::size_t rows, std::span<const double> weights) {
  const std::size_t n = weights.size();
  for (std::size_t r = 0; r < rows; ++r) {
    double* row = values.data() + r * n;
    for (std::size_t q = 0; q < n; ++q) row[q] *= weights[q];
  }
}

/// Row i, component c of a kernel by the axis of c: sum_j K_ij axis_j, for all nodes. Without a frame no sum is needed:
/// the answer is a row of the kernel itself.
template <int Dim>
const double* kernel_along(const Condition<Dim>& condition, const std::vector<double>& kernel, int components, int i,
                           int c, std::size_t n, std::vector<double>& room) {
  const double* row = kernel.data() + static_cast<std::size_t>(i * components) * n;
  if (!condition.frame) return row + static_cast<std::size_t>(c) * n;
  const geometry::Vector<Dim> axis = component_axis(condition, c);
  room.assign(n, 0.0);
  for (int j = 0; j < components; ++j) {
    for (std::size_t q = 0; q < n; ++q) room[q] += axis[j] * row[static_cast<std::size_t>(j) * n + q];
  }
  return room.data();
}

/// int U_ij r_j dS for a flux mode r.
template <int Dim>
geometry::Vector<Dim> mode_sum(const RigidMotion<Dim>& mode, const std::vector<double>& single, int components,
                               const NodeView<Dim>& nodes) {
  const std::size_t n = nodes.size();
  geometry::Vector<Dim> sum = geometry::Vector<Dim>::Zero();
  for (std::size_t q = 0; q < n; ++q) {
    geometry::Point<Dim> y;
    for (std::size_t d = 0; d < Dim; ++d) y[static_cast<Eigen::Index>(d)] = nodes.position[d][q];
    const geometry::Vector<Dim> r = mode(y);
    for (int i = 0; i < components; ++i) {
      for (int j = 0; j < components; ++j)
        sum[i] += single[static_cast<std::size_t>(i * components + j) * n + q] * r[j];
    }
  }
  return sum;
}

}  // namespace

template <int Dim>
Assembler<Dim>::Assembler(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                          const quadrature::TargetRules<Dim>& rules, std::vector<RigidMotion<Dim>> flux_modes)
    : problem_(&problem),
      space_(&space),
      rules_(&rules),
      flux_modes_(std::move(flux_modes)),
      components_(component_count(problem.equation)),
      flux_scale_(stiffness(problem.equation) / geometry::bounding_box(space.table).diagonal()),
      store_(space.table.elements.size()) {}

template <int Dim>
Target<Dim> Assembler<Dim>::target(int point) const {
  const CollocationPoint<Dim>& at = space_->points[static_cast<std::size_t>(point)];
  return {at.position, at.element, at.place};
}

template <int Dim>
Eigen::MatrixXd Assembler<Dim>::load_potentials(double tolerance, int threads) const {
  if (problem_->loads.empty()) return Eigen::MatrixXd::Zero(components_, space_->function_count());
  std::vector<Target<Dim>> targets;
  for (int i = 0; i < space_->function_count(); ++i) targets.push_back(target(i));
  return domain_potentials<Dim>(problem_->loads, space_->table, *rules_, targets, {tolerance, threads});
}

template <int Dim>
void Assembler<Dim>::start_target(AssemblyRoom<Dim>& room) const {
  room.double_layer.setZero();
  room.right.setZero();
  room.modes.setZero(Dim, static_cast<Eigen::Index>(flux_modes_.size()));
}

template <int Dim>
auto Assembler<Dim>::kept_nodes(int element, const NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const
    -> const KeptNodes* {
  const auto index = static_cast<std::size_t>(element);
  const auto rule = static_cast<std::size_t>(nodes.kept);
  if (room.kept.empty()) room.kept.resize(store_.size());
  std::vector<const void*>& known = room.kept[index];
  if (known.size() <= rule) known.resize(rule + 1, nullptr);
  if (known[rule] == nullptr) {
    auto made = std::make_unique<KeptNodes>();
    fill_node_basis(*space_, element, nodes, made->basis, room.scratch);
    room.data.evaluate(problem_->condition_of[index], nodes, made->values);
    const std::lock_guard lock(store_mutex_);
    known[rule] = store_[index].try_emplace(nodes.kept, std::move(made)).first->second.get();
  }
  return static_cast<const KeptNodes*>(known[rule]);
}

template <int Dim>
auto Assembler<Dim>::node_data(int element, const NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const -> NodeData {
  if (nodes.kept >= 0) {
    const KeptNodes* kept = kept_nodes(element, nodes, room);
    return {&kept->basis, &kept->values};
  }
  fill_node_basis(*space_, element, nodes, room.basis, room.scratch);
  room.data.evaluate(problem_->condition_of[static_cast<std::size_t>(element)], nodes, room.values);
  return {&room.basis, &room.values};
}

template <int Dim>
void Assembler<Dim>::weigh_kernels(const Target<Dim>& target, int element, const NodeView<Dim>& nodes,
                                   AssemblyRoom<Dim>& room) const {
  const std::size_t n = nodes.size();
  const auto entries = static_cast<std::size_t>(components_ * components_);
  const Condition<Dim>& condition = condition_on(element);
  const bool needs_single =
      !flux_modes_.empty() || std::any_of(condition.components.begin(), condition.components.end(), [](const auto& c) {
        return c.kind != ConditionKind::flux || static_cast<bool>(c.value);
      });
  room.double_values.resize(entries * n);
  if (needs_single) room.single_values.resize(entries * n);
  const auto evaluate = [&](const auto& kernel) {
    double_layer(kernel, target.position, nodes, room.double_values);
    if (needs_single) single_layer(kernel, target.position, nodes, room.single_values);
  };
  std::visit(evaluate, problem_->equation);
  scale_rows(room.double_values, entries, nodes.weight);
  if (needs_single) scale_rows(room.single_values, entries, nodes.weight);
}

template <int Dim>
void Assembler<Dim>::add_sums(int element, const NodeView<Dim>& nodes, const ConditionValues<Dim>& values,
                              AssemblyRoom<Dim>& room) const {
  const std::size_t n = nodes.size();
  const Condition<Dim>& condition = condition_on(element);
  for (int i = 0; i < components_; ++i) {
    for (int j = 0; j < components_; ++j) {
      room.double_layer(i, j) +=
          sum_of(room.double_values.data() + static_cast<std::size_t>(i * components_ + j) * n, n);
    }
    for (int c = 0; c < components_; ++c) {
      const auto index = static_cast<std::size_t>(c);
      if (values.value[index].empty()) continue;
      const bool is_value = condition.components[index].kind == ConditionKind::value;
      const double* kernel =
          kernel_along(condition, is_value ? room.double_values : room.single_values, components_, i, c, n, room.along);
      const double* given = values.value[index].data();
      double factor = is_value ? -sign() : sign();
      if (condition.components[index].kind == ConditionKind::robin) {
        factor = 1.0;
        room.product.resize(n);
        for (std::size_t q = 0; q < n; ++q) room.product[q] = values.coefficient[index][q] * given[q];
        given = room.product.data();
      }
      room.right[i] += factor * dot(kernel, given, n);
    }
  }
  for (std::size_t m = 0; m < flux_modes_.size(); ++m) {
    room.modes.col(static_cast<Eigen::Index>(m)) -=
        sign() * mode_sum(flux_modes_[m], room.single_values, components_, nodes);
  }
}

template <int Dim>
void Assembler<Dim>::fill_integrands(int element, std::size_t n, const ConditionValues<Dim>& values,
                                     AssemblyRoom<Dim>& room) const {
  const Condition<Dim>& condition = condition_on(element);
  const double s = sign();
  room.integrands.resize(static_cast<std::size_t>(components_ * components_) * n);
  for (int i = 0; i < components_; ++i) {
    for (int c = 0; c < components_; ++c) {
      const auto index = static_cast<std::size_t>(c);
      const ConditionKind kind = condition.components[index].kind;
      double* target = room.integrands.data() + static_cast<std::size_t>(i * components_ + c) * n;
      const double* kernel =
          kernel_along(condition, kind == ConditionKind::value ? room.single_values : room.double_values, components_,
                       i, c, n, room.along);
      const double factor = kind == ConditionKind::value ? -s * flux_scale_ : s;
      for (std::size_t q = 0; q < n; ++q) target[q] = factor * kernel[q];
      if (kind != ConditionKind::robin) continue;
      const double* single = kernel_along(condition, room.single_values, components_, i, c, n, room.along);
      for (std::size_t q = 0; q < n; ++q) target[q] += values.coefficient[index][q] * single[q];
    }
  }
}

template <int Dim>
void Assembler<Dim>::add_element(const Target<Dim>& target, int element, AssemblyRoom<Dim>& room) const {
  const NodeView<Dim> nodes = rules_->nodes(element, target, room.buffer);
  const int entries = components_ * components_;
  room.block.assign(static_cast<std::size_t>(entries * space_->elements[static_cast<std::size_t>(element)].count), 0.0);
  if (nodes.size() == 0) return;
  const NodeData data = node_data(element, nodes, room);
  weigh_kernels(target, element, nodes, room);
  add_sums(element, nodes, *data.values, room);
  fill_integrands(element, nodes.size(), *data.values, room);
  add_moments(*space_, element, *data.basis, room.integrands, entries, room.scratch, room.block);
}

template <int Dim>
void Assembler<Dim>::add_element_sums(const Target<Dim>& target, int element, AssemblyRoom<Dim>& room) const {
  const NodeView<Dim> nodes = rules_->nodes(element, target, room.buffer);
  if (nodes.size() == 0) return;
  const NodeData data = node_data(element, nodes, room);
  weigh_kernels(target, element, nodes, room);
  add_sums(element, nodes, *data.values, room);
}

template <int Dim>
void Assembler<Dim>::add_target_terms(int point, AssemblyRoom<Dim>& room) const {
  const CollocationPoint<Dim>& at = space_->points[static_cast<std::size_t>(point)];
  const Condition<Dim>& condition = condition_on(at.element);
  const auto count = static_cast<std::size_t>(space_->elements[static_cast<std::size_t>(at.element)].count);
  Eigen::Matrix<double, Dim, Dim> factor = -sign() * room.double_layer;
  if (problem_->exterior) factor += Eigen::Matrix<double, Dim, Dim>::Identity();
  std::vector<double> basis(count);
  basis_values(*space_, at.element, at.place, std::span<double>(basis));
  room.data.evaluate(problem_->condition_of[static_cast<std::size_t>(at.element)], at.position, at.normal, room.values);
  room.block.assign(static_cast<std::size_t>(components_ * components_) * count, 0.0);
  for (int c = 0; c < components_; ++c) {
    const auto index = static_cast<std::size_t>(c);
    const geometry::Vector<Dim> along = factor * component_axis(condition, c);
    if (condition.components[index].kind == ConditionKind::value) {
      if (!room.values.value[index].empty()) room.right -= room.values.value[index][0] * along;
      continue;
    }
    for (int i = 0; i < components_; ++i) {
      double* block = room.block.data() + static_cast<std::size_t>(i * components_ + c) * count;
      for (std::size_t a = 0; a < count; ++a) block[a] = along[i] * basis[a];
    }
  }
}

template class Assembler<2>;
template class Assembler<3>;

}  // namespace isorim::solver
