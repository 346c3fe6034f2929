#include "solver/bem/assembly.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "solver/bem/domain_load.h"

namespace isorim::solver {

namespace {

using quadrature::NodeView;
using quadrature::Target;

template <int Dim>
double stiffness_of(const Equation<Dim>& equation) {
  struct Visitor {
    double operator()(const Laplace<Dim>& kernel) const { return kernel.conductivity; }
    double operator()(const Elasticity<Dim>& kernel) const { return kernel.shear_modulus; }
  };
  return std::visit(Visitor{}, equation);
}

}  // namespace

template <int Dim>
Assembler<Dim>::Assembler(std::span<const Problem<Dim>> problems, const FieldSpace<Dim>& space,
                          const quadrature::TargetRules<Dim>& rules, std::vector<RigidMotion<Dim>> flux_modes)
    : problems_(problems),
      space_(&space),
      rules_(&rules),
      flux_modes_(std::move(flux_modes)),
      components_(component_count(problem().equation)),
      stiffness_(stiffness_of(problem().equation)),
      flux_scale_(stiffness_ / geometry::bounding_box(space.table).diagonal()),
      store_(space.table.elements.size()) {
  list_elements();
}

template <int Dim>
void Assembler<Dim>::list_elements() {
  const auto element_count = static_cast<int>(space_->elements.size());
  first_element_.assign(static_cast<std::size_t>(space_->function_count()) + 1, 0);
  for (int e = 0; e < element_count; ++e) {
    for (const std::int32_t a : space_->functions_of(e)) ++first_element_[static_cast<std::size_t>(a) + 1];
  }
  for (std::size_t a = 1; a < first_element_.size(); ++a) first_element_[a] += first_element_[a - 1];
  elements_.resize(first_element_.back());
  std::vector<std::size_t> next(first_element_.begin(), first_element_.end() - 1);
  for (int e = 0; e < element_count; ++e) {
    for (const std::int32_t a : space_->functions_of(e)) elements_[next[static_cast<std::size_t>(a)]++] = e;
  }
}

template <int Dim>
bool Assembler<Dim>::needs_single_layer(int element) const {
  if (!flux_modes_.empty()) return true;
  const auto number = static_cast<std::size_t>(problem().condition_of[static_cast<std::size_t>(element)]);
  return std::any_of(problems_.begin(), problems_.end(), [&](const Problem<Dim>& problem) {
    const auto& components = problem.conditions[number].components;
    return std::any_of(components.begin(), components.end(),
                       [](const auto& c) { return c.kind != ConditionKind::flux || static_cast<bool>(c.value); });
  });
}

template <int Dim>
Target<Dim> Assembler<Dim>::target(int point) const {
  const CollocationPoint<Dim>& at = space_->points[static_cast<std::size_t>(point)];
  return {at.position, at.element, at.place};
}

template <int Dim>
Eigen::MatrixXd Assembler<Dim>::load_potentials(double tolerance, int threads) const {
  Eigen::MatrixXd potentials = Eigen::MatrixXd::Zero(size(), right_sides());
  std::vector<Target<Dim>> targets;
  for (int i = 0; i < space_->function_count(); ++i) targets.push_back(target(i));
  for (Eigen::Index k = 0; k < potentials.cols(); ++k) {
    const Loads<Dim>& loads = problems_[static_cast<std::size_t>(k)].loads;
    if (!loads.empty())
      potentials.col(k) =
          domain_potentials<Dim>(loads, space_->table, *rules_, targets, {tolerance, threads}, space_->coarse.get())
              .reshaped();
  }
  return potentials;
}

template <int Dim>
void Assembler<Dim>::evaluate_data(int element, const NodeView<Dim>& nodes, AssemblyRoom<Dim>& room,
                                   std::vector<ConditionValues<Dim>>& values) const {
  values.resize(problems_.size());
  for (std::size_t k = 0; k < problems_.size(); ++k)
    room.data[k].evaluate(problem().condition_of[static_cast<std::size_t>(element)], nodes, values[k]);
}

template <int Dim>
auto Assembler<Dim>::kept_nodes(int element, const NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const
    -> const KeptNodes& {
  const auto index = static_cast<std::size_t>(element);
  const std::lock_guard lock(store_mutexes_[index % store_mutexes_.size()]);
  std::vector<KeptRule>& kept = store_[index];
  const auto known = std::find_if(kept.begin(), kept.end(), [&](const KeptRule& r) { return r.number == nodes.kept; });
  if (known != kept.end()) return *known->nodes;
  auto made = std::make_unique<KeptNodes>();
  fill_node_basis(*space_, element, nodes, made->basis, room.scratch);
  evaluate_data(element, nodes, room, made->values);
  return *kept.emplace_back(KeptRule{nodes.kept, std::move(made)}).nodes;
}

template <int Dim>
auto Assembler<Dim>::node_data(int element, const NodeView<Dim>& nodes, AssemblyRoom<Dim>& room) const -> NodeData {
  if (nodes.kept >= 0) {
    const KeptNodes& kept = kept_nodes(element, nodes, room);
    return {&kept.basis, kept.values};
  }
  fill_node_basis(*space_, element, nodes, room.basis, room.scratch);
  evaluate_data(element, nodes, room, room.values);
  return {&room.basis, room.values};
}

template <int Dim>
auto Assembler<Dim>::target_terms(int point, const Eigen::Matrix<double, Dim, Dim>& double_layer,
                                  AssemblyRoom<Dim>& room) const -> TargetTerms {
  const CollocationPoint<Dim>& at = space_->points[static_cast<std::size_t>(point)];
  const Condition<Dim>& condition = condition_on(at.element);
  const auto count = static_cast<std::size_t>(space_->elements[static_cast<std::size_t>(at.element)].count);
  Eigen::Matrix<double, Dim, Dim> factor = -sign() * double_layer;
  if (problem().exterior) factor += Eigen::Matrix<double, Dim, Dim>::Identity();
  std::vector<double> basis(count);
  basis_values(*space_, at.element, at.place, std::span<double>(basis));
  for (std::size_t k = 0; k < problems_.size(); ++k)
    room.data[k].evaluate(problem().condition_of[static_cast<std::size_t>(at.element)], at.position, at.normal,
                          room.values[k]);
  TargetTerms terms{Eigen::Matrix<double, Dim, Eigen::Dynamic>::Zero(Dim, right_sides()),
                    Eigen::MatrixXd::Zero(components_, components_ * static_cast<Eigen::Index>(count))};
  for (int c = 0; c < components_; ++c) {
    const auto index = static_cast<std::size_t>(c);
    const geometry::Vector<Dim> along = factor * component_axis(condition, c);
    if (condition.components[index].kind == ConditionKind::value) {
      for (std::size_t k = 0; k < problems_.size(); ++k) {
        const std::vector<double>& given = room.values[k].value[index];
        if (!given.empty()) terms.right.col(static_cast<Eigen::Index>(k)) -= given[0] * along;
      }
      continue;
    }
    for (std::size_t a = 0; a < count; ++a)
      terms.coefficients.col(static_cast<Eigen::Index>(a) * components_ + c) = basis[a] * along.head(components_);
  }
  return terms;
}

template class Assembler<2>;
template class Assembler<3>;

}  // namespace isorim::solver
