#include "solver/bem/equation_rows.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "solver/bem/kernels.h"
#include "solver/linear/small_products.h"

namespace isorim::solver {

namespace {

using Eigen::Index;
using quadrature::NodeView;

/// Values of one kernel that are held at a time: within the second cache, with those of the other and the integrands.
constexpr std::size_t most_values = 8192;

/// target[q] += factor * source[q].
void add_scaled(double factor, const double* source, std::size_t count, double* target) {
  for (std::size_t q = 0; q < count; ++q) target[q] += factor * source[q];
}

template <int Dim>
geometry::Point<Dim> node_position(const NodeView<Dim>& nodes, std::size_t q) {
  geometry::Point<Dim> y;
  for (std::size_t d = 0; d < Dim; ++d) y[static_cast<Index>(d)] = nodes.position[d][q];
  return y;
}

}  // namespace

template <int Dim>
RowIntegrator<Dim>::RowIntegrator(const Assembler<Dim>& assembler)
    : assembler_(&assembler),
      room_(assembler.problems()),
      number_(static_cast<std::size_t>(assembler.space().function_count()), -1),
      is_listed_(assembler.space().elements.size(), 0) {}

template <int Dim>
void RowIntegrator<Dim>::set_functions(std::span<const std::int32_t> functions) {
  for (const std::int32_t a : numbered_) number_[static_cast<std::size_t>(a)] = -1;
  numbered_.assign(functions.begin(), functions.end());
  elements_.clear();
  std::int32_t count = 0;
  for (const std::int32_t a : functions) {
    number_[static_cast<std::size_t>(a)] = count++;
    for (const std::int32_t e : assembler_->elements_of(a)) {
      if (std::exchange(is_listed_[static_cast<std::size_t>(e)], char{1}) == 0) elements_.push_back(e);
    }
  }
  for (const int e : elements_) is_listed_[static_cast<std::size_t>(e)] = 0;
  std::sort(elements_.begin(), elements_.end());
}

template <int Dim>
void RowIntegrator<Dim>::integrate(std::span<const std::int32_t> points, EquationRows& rows) {
  const Index components = assembler_->components();
  const auto row_count = static_cast<Index>(points.size()) * components;
  rows.coefficients.setZero(row_count, static_cast<Index>(numbered_.size()) * components);
  rows.sums.setZero(row_count, sum_count(*assembler_));
  targets_.clear();
  for (const std::int32_t point : points) targets_.push_back(assembler_->target(point));
  for (const int element : elements_) add_element(element, rows);
}

template <int Dim>
void RowIntegrator<Dim>::add_element(int element, EquationRows& rows) {
  std::size_t group_count = 0;
  for (int t = 0; t < static_cast<int>(targets_.size()); ++t) {
    const View nodes = assembler_->rules().nodes(element, targets_[static_cast<std::size_t>(t)], room_.buffer);
    if (nodes.size() == 0) continue;
    if (nodes.kept < 0) {
      add_group(element, nodes, std::span(&t, 1), rows);
      continue;
    }
    const auto end = groups_.begin() + static_cast<std::ptrdiff_t>(group_count);
    auto group = std::find_if(groups_.begin(), end, [&](const Group& g) { return g.nodes.kept == nodes.kept; });
    if (group == end) {
      if (group_count == groups_.size()) groups_.emplace_back();
      group = groups_.begin() + static_cast<std::ptrdiff_t>(group_count++);
      group->nodes = nodes;
      group->targets.clear();
    }
    group->targets.push_back(t);
  }
  for (std::size_t g = 0; g < group_count; ++g) add_group(element, groups_[g].nodes, groups_[g].targets, rows);
}

template <int Dim>
void RowIntegrator<Dim>::add_group(int element, const View& nodes, std::span<const int> targets, EquationRows& rows) {
  const auto data = assembler_->node_data(element, nodes, room_);
  set_factors(element, nodes, data);
  const std::size_t n = nodes.size();
  const auto entries = static_cast<std::size_t>(assembler_->components() * assembler_->components());
  const std::size_t most = std::max<std::size_t>(1, most_values / (entries * n));
  const auto count = static_cast<std::size_t>(assembler_->space().elements[static_cast<std::size_t>(element)].count);
  for (std::size_t first = 0; first < targets.size(); first += most) {
    const std::span<const int> part = targets.subspan(first, std::min(most, targets.size() - first));
    evaluate_kernels(element, nodes, part);
    add_sums(n, part, rows);
    fill_integrands(element, n, part.size());
    moments_.assign(part.size() * entries * count, 0.0);
    add_moments(assembler_->space(), element, *data.basis, std::span(integrands_).first(part.size() * entries * n),
                static_cast<int>(part.size() * entries), room_.scratch, moments_);
    scatter(element, part, rows);
  }
}

template <int Dim>
void RowIntegrator<Dim>::set_factors(int element, const View& nodes, const typename Assembler<Dim>::NodeData& data) {
  const Condition<Dim>& condition = assembler_->condition_on(element);
  const std::size_t n = nodes.size();
  const double s = assembler_->sign();
  factors_.of_double.assign(condition.components.size() * n, 0.0);
  factors_.of_single.assign(condition.components.size() * n, 0.0);
  for (std::size_t c = 0; c < condition.components.size(); ++c) {
    double* of_double = factors_.of_double.data() + c * n;
    double* of_single = factors_.of_single.data() + c * n;
    switch (condition.components[c].kind) {
      case ConditionKind::value:
        add_scaled(-s * assembler_->flux_scale(), nodes.weight.data(), n, of_single);
        break;
      case ConditionKind::robin:
        for (std::size_t q = 0; q < n; ++q) of_single[q] = nodes.weight[q] * data.values.front().coefficient[c][q];
        [[fallthrough]];
      case ConditionKind::flux:
        add_scaled(s, nodes.weight.data(), n, of_double);
        break;
    }
  }
  set_share(element, nodes, *data.basis);
  set_sum_factors(element, nodes, data);
}

/// Functions that are not in the list leave their share of the element to others.
template <int Dim>
void RowIntegrator<Dim>::set_share(int element, const View& nodes, const NodeBasis<Dim>& basis) {
  share_.assign(nodes.weight.begin(), nodes.weight.end());
  const FieldSpace<Dim>& space = assembler_->space();
  const std::span<const std::int32_t> functions = space.functions_of(element);
  const auto is_missing = [&](std::int32_t a) { return number_[static_cast<std::size_t>(a)] < 0; };
  if (std::none_of(functions.begin(), functions.end(), is_missing)) return;
  const FieldElement<Dim>& field = space.elements[static_cast<std::size_t>(element)];
  const auto bernstein_count = static_cast<std::size_t>(field.bernstein_count());
  std::vector<double> sum(bernstein_count, 0.0);
  for (std::size_t a = 0; a < functions.size(); ++a) {
    if (is_missing(functions[a])) continue;
    add_scaled(1.0, space.rows.data() + field.row + a * bernstein_count, bernstein_count, sum.data());
  }
  multiply_by_function<Dim>(basis, field.degree, sum, share_);
}

/// What known values (column j of the double layer) and fluxes (of the single layer) stand for in the sums.
template <int Dim>
void RowIntegrator<Dim>::add_known_data(int element, std::size_t n, const ConditionValues<Dim>& values, std::size_t j,
                                        double* of_double, double* of_single) const {
  const Condition<Dim>& condition = assembler_->condition_on(element);
  const double s = assembler_->sign();
  for (std::size_t c = 0; c < condition.components.size(); ++c) {
    const std::vector<double>& given = values.value[c];
    if (given.empty()) continue;
    const double axis = component_axis(condition, static_cast<int>(c))[static_cast<Index>(j)];
    if (condition.components[c].kind == ConditionKind::value) {
      for (std::size_t q = 0; q < n; ++q) of_double[q] -= s * axis * share_[q] * given[q];
    } else if (condition.components[c].kind == ConditionKind::flux) {
      for (std::size_t q = 0; q < n; ++q) of_single[q] += s * axis * share_[q] * given[q];
    } else {
      const std::vector<double>& coefficient = values.coefficient[c];
      for (std::size_t q = 0; q < n; ++q) of_single[q] += axis * share_[q] * coefficient[q] * given[q];
    }
  }
}

template <int Dim>
void RowIntegrator<Dim>::set_sum_factors(int element, const View& nodes,
                                         const typename Assembler<Dim>::NodeData& data) {
  const std::size_t n = nodes.size();
  const auto components = static_cast<std::size_t>(assembler_->components());
  const auto right_sides = static_cast<std::size_t>(assembler_->right_sides());
  const auto& modes = assembler_->flux_modes();
  const std::size_t double_rows = 1 + right_sides;
  const std::size_t single_rows = assembler_->needs_single_layer(element) ? right_sides + modes.size() : 0;
  factors_.double_rows = static_cast<int>(double_rows);
  factors_.single_rows = static_cast<int>(single_rows);
  factors_.double_sums.assign(components * double_rows * n, 0.0);
  factors_.single_sums.assign(components * single_rows * n, 0.0);
  for (std::size_t j = 0; j < components; ++j) {
    double* of_double = factors_.double_sums.data() + j * double_rows * n;
    double* of_single = factors_.single_sums.data() + j * single_rows * n;
    std::copy(share_.begin(), share_.end(), of_double);
    for (std::size_t k = 0; k < right_sides; ++k)
      add_known_data(element, n, data.values[k], j, of_double + (1 + k) * n, of_single + k * n);
    for (std::size_t m = 0; m < modes.size(); ++m) {
      if (!modes[m].moves(assembler_->space().body_of(element))) continue;
      double* of_mode = of_single + (right_sides + m) * n;
      for (std::size_t q = 0; q < n; ++q)
        of_mode[q] = -assembler_->sign() * share_[q] * modes[m](node_position(nodes, q))[static_cast<Index>(j)];
    }
  }
}

template <int Dim>
void RowIntegrator<Dim>::evaluate_kernels(int element, const View& nodes, std::span<const int> targets) {
  const auto entries = static_cast<std::size_t>(assembler_->components() * assembler_->components());
  const std::size_t size = entries * nodes.size();
  const bool needs_single = assembler_->needs_single_layer(element);
  double_values_.resize(std::max(double_values_.size(), targets.size() * size));
  single_values_.resize(double_values_.size());
  const auto evaluate = [&](const auto& kernel) {
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const geometry::Point<Dim>& x = targets_[static_cast<std::size_t>(targets[t])].position;
      double_layer(kernel, x, nodes, std::span(double_values_).subspan(t * size, size));
      if (needs_single) single_layer(kernel, x, nodes, std::span(single_values_).subspan(t * size, size));
    }
  };
  std::visit(evaluate, assembler_->problem().equation);
}

template <int Dim>
void RowIntegrator<Dim>::add_sums(std::size_t n, std::span<const int> targets, EquationRows& rows) {
  const int components = assembler_->components();
  const auto step = static_cast<std::ptrdiff_t>(n) * components * components;
  const auto count = static_cast<int>(n);
  const auto target_count = static_cast<int>(targets.size());
  const int width = std::max(factors_.double_rows, factors_.single_rows);
  const auto add_layer = [&](const std::vector<double>& values, const std::vector<double>& factors, int i, int j,
                             int row_count) {
    partial_sums_.assign(targets.size() * static_cast<std::size_t>(width), 0.0);
    if (row_count == 0) return;
    add_product_transposed(
        target_count, row_count, count, values.data() + static_cast<std::size_t>(i * components + j) * n, step,
        factors.data() + static_cast<std::size_t>(j * row_count) * n, count, partial_sums_.data(), width);
  };
  for (int i = 0; i < components; ++i) {
    for (int j = 0; j < components; ++j) {
      add_layer(double_values_, factors_.double_sums, i, j, factors_.double_rows);
      for (int t = 0; t < target_count; ++t) {
        const double* sums = partial_sums_.data() + t * width;
        const Index row = static_cast<Index>(targets[static_cast<std::size_t>(t)]) * components + i;
        rows.sums(row, j) += sums[0];
        for (int k = 1; k < factors_.double_rows; ++k) rows.sums(row, components + k - 1) += sums[k];
      }
      add_layer(single_values_, factors_.single_sums, i, j, factors_.single_rows);
      for (int t = 0; t < target_count; ++t) {
        const double* sums = partial_sums_.data() + t * width;
        const Index row = static_cast<Index>(targets[static_cast<std::size_t>(t)]) * components + i;
        for (int k = 0; k < factors_.single_rows; ++k) rows.sums(row, components + k) += sums[k];
      }
    }
  }
}

/// Of target t, equation i and component c in integrands_[((t C + i) C + c) n + q].
template <int Dim>
void RowIntegrator<Dim>::fill_integrands(int element, std::size_t n, std::size_t target_count) {
  const Condition<Dim>& condition = assembler_->condition_on(element);
  const auto components = static_cast<std::size_t>(assembler_->components());
  integrands_.resize(std::max(integrands_.size(), target_count * components * components * n));
  const auto add_layer = [&](const std::vector<double>& values, const double* factor, std::size_t row, std::size_t c,
                             double* target) {
    const double* kernel = values.data() + row * components * n;
    if (!condition.frame) {
      for (std::size_t q = 0; q < n; ++q) target[q] += factor[q] * kernel[c * n + q];
      return;
    }
    const geometry::Vector<Dim> axis = component_axis(condition, static_cast<int>(c));
    for (std::size_t j = 0; j < components; ++j) {
      const double along = axis[static_cast<Index>(j)];
      for (std::size_t q = 0; q < n; ++q) target[q] += along * factor[q] * kernel[j * n + q];
    }
  };
  for (std::size_t row = 0; row < target_count * components; ++row) {
    for (std::size_t c = 0; c < components; ++c) {
      double* target = integrands_.data() + (row * components + c) * n;
      std::fill(target, target + n, 0.0);
      const ConditionKind kind = condition.components[c].kind;
      if (kind != ConditionKind::value) add_layer(double_values_, factors_.of_double.data() + c * n, row, c, target);
      if (kind != ConditionKind::flux) add_layer(single_values_, factors_.of_single.data() + c * n, row, c, target);
    }
  }
}

template <int Dim>
void RowIntegrator<Dim>::scatter(int element, std::span<const int> targets, EquationRows& rows) const {
  const std::span<const std::int32_t> functions = assembler_->space().functions_of(element);
  const Index components = assembler_->components();
  const double* source = moments_.data();
  for (const int target : targets) {
    for (Index i = 0; i < components; ++i) {
      double* row = rows.coefficients.data() + (target * components + i) * rows.coefficients.cols();
      for (Index c = 0; c < components; ++c) {
        for (const std::int32_t function : functions) {
          const Index number = number_[static_cast<std::size_t>(function)];
          if (number >= 0) row[number * components + c] += *source;
          ++source;
        }
      }
    }
  }
}

template class RowIntegrator<2>;
template class RowIntegrator<3>;

}  // namespace isorim::solver
