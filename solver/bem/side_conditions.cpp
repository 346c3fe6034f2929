#include "solver/bem/side_conditions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/errors.h"
#include "quadrature/rim.h"
#include "solver/bem/basis_moments.h"
#include "solver/bem/boundary_data.h"

namespace isorim::solver {

namespace {

using geometry::ElementTable;
using quadrature::Integrand;
using quadrature::IntegrandFactory;

/// Imbalances below this part of the absolute sum are taken for rounding of the data.
constexpr double balance_tolerance = 1e-6;
/// Of the rules for functions times motions: as for targets so many radii of the element's sphere away from it.
constexpr double rule_distance = 0.5;

template <int Dim>
quadrature::NodeView<Dim> smooth_rule(const quadrature::TargetRules<Dim>& rules, int element) {
  return rules.far_nodes(element, rule_distance * rules.sphere(element).radius);
}

template <int Dim>
using PointColumns = Eigen::Ref<const geometry::Points<Dim>>;

/// The elements of what a motion moves: all, or those under one condition.
template <int Dim>
ElementTable<Dim> moved_part(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const RigidMotion<Dim>& motion,
                             std::optional<std::size_t> condition = {}) {
  const ElementTable<Dim>& table = space.table;
  ElementTable<Dim> part{{}, table.nets, table.regions};
  for (std::size_t e = 0; e < table.elements.size(); ++e) {
    if (condition && static_cast<std::size_t>(problem.condition_of[e]) != *condition) continue;
    if (motion.moves(space.body_of(static_cast<int>(e)))) part.elements.push_back(table.elements[e]);
  }
  return part;
}

/// f(given value) (axis . motion) at points, `absolute` or not.
template <int Dim>
IntegrandFactory<Dim> work_of(const IntegrandFactory<Dim>& given, const geometry::Vector<Dim>& axis,
                              const RigidMotion<Dim>& motion, double (*shape)(double)) {
  return [=]() -> Integrand<Dim> {
    const Integrand<Dim> inner = given();
    return [=](const PointColumns<Dim>& points, const PointColumns<Dim>& normals, std::span<double> values) {
      inner(points, normals, values);
      for (Eigen::Index q = 0; q < points.cols(); ++q)
        values[static_cast<std::size_t>(q)] =
            shape(values[static_cast<std::size_t>(q)] * axis.dot(motion(points.col(q))));
    };
  };
}

double itself(double x) {
  return x;
}
double magnitude(double x) {
  return std::abs(x);
}

quadrature::Options sum_options(double tolerance, int threads) {
  quadrature::Options options;
  options.tolerance = tolerance;
  options.threads = threads;
  return options;
}

/// The given fluxes' work on a motion.
template <int Dim>
double boundary_work(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const RigidMotion<Dim>& motion,
                     double (*shape)(double), const quadrature::Options& options) {
  double sum = 0.0;
  for (std::size_t k = 0; k < problem.conditions.size(); ++k) {
    const Condition<Dim>& condition = problem.conditions[k];
    const ElementTable<Dim> part = moved_part(problem, space, motion, k);
    if (part.elements.empty()) continue;
    for (std::size_t c = 0; c < condition.components.size(); ++c) {
      const ComponentCondition<Dim>& component = condition.components[c];
      if (component.kind != ConditionKind::flux || !component.value) continue;
      const auto axis = component_axis(condition, static_cast<int>(c));
      sum += quadrature::integrate_over_boundary<Dim>(part, work_of<Dim>(component.value, axis, motion, shape), options)
                 .integral.value;
    }
  }
  return sum;
}

template <int Dim>
double domain_work(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const RigidMotion<Dim>& motion,
                   double (*shape)(double), const quadrature::Options& options) {
  double sum = 0.0;
  const ElementTable<Dim> table = moved_part(problem, space, motion);
  for (const auto& load : problem.loads) {
    if (load->is_thermal()) continue;
    // One component at a time: their sum may vanish at every point (a radial load and a rotation), and then nothing
    // but rounding would be left to integrate.
    const std::vector<IntegrandFactory<Dim>> density = load->density();
    for (std::size_t c = 0; c < density.size(); ++c) {
      const auto axis = geometry::Vector<Dim>::Unit(static_cast<Eigen::Index>(c));
      const auto integrand = work_of<Dim>(density[c], axis, motion, shape);
      sum += quadrature::integrate_over_domain<Dim>(table, integrand, std::nullopt, options).integral.value;
    }
  }
  return sum;
}

/// "the body", or "the body of patch 'x'" where there are several.
template <int Dim>
std::string body_name(const FieldSpace<Dim>& space, std::int32_t body) {
  if (body < 0) return "the body";
  return fmt::format("the body of patch '{}'", space.bodies[static_cast<std::size_t>(body)]);
}

template <int Dim>
std::string on_body(const FieldSpace<Dim>& space, std::int32_t body) {
  return body < 0 ? "" : " on " + body_name(space, body);
}

template <int Dim>
void require_balance(const Problem<Dim>& problem, const FieldSpace<Dim>& space, const RigidMotion<Dim>& motion,
                     int threads) {
  const quadrature::Options fine = sum_options(1e-10, threads);
  const quadrature::Options coarse = sum_options(1e-3, threads);
  const double sum =
      boundary_work(problem, space, motion, itself, fine) + domain_work(problem, space, motion, itself, fine);
  const double gross =
      boundary_work(problem, space, motion, magnitude, coarse) + domain_work(problem, space, motion, magnitude, coarse);
  if (std::abs(sum) <= balance_tolerance * gross) return;
  const int components = component_count(problem.equation);
  if (components == 1) {
    throw InputError(
        fmt::format("only fluxes are prescribed{}, and with the sources they sum to {:.6g} ({:.6g} in absolute value) "
                    "where a solution "
                    "needs 0; balance them, or prescribe a value (or robin) on a part of {} boundary",
                    on_body(space, motion.body), sum, gross, motion.body < 0 ? "the" : "its"));
  }
  throw InputError(fmt::format(
      "nothing holds {} against {}, and the loads along it sum to {:.6g} ({:.6g} in absolute value) where a "
      "solution needs 0; balance them, or prescribe a displacement (or robin) that holds the body",
      body_name(space, motion.body), describe(motion, components), sum, gross));
}

/// What a row of side conditions takes of one element: values of a scalar function at its nodes, for each component.
template <int Dim>
struct RowSource {
  const FieldSpace<Dim>& space;
  const quadrature::TargetRules<Dim>& rules;
  MomentScratch scratch;
  NodeBasis<Dim> basis;
  std::vector<double> integrand;
  std::vector<double> sums;
};

/// row[a C + c] += factor int density phi_a (axis . motion) dS; density empty: 1.
template <int Dim>
void add_element_row(RowSource<Dim>& source, int element, int component, int components,
                     const geometry::Vector<Dim>& axis, const RigidMotion<Dim>& motion,
                     const std::vector<double>& density, double factor, Eigen::Ref<Eigen::RowVectorXd> row) {
  const quadrature::NodeView<Dim> nodes = smooth_rule(source.rules, element);
  const std::size_t n = nodes.size();
  source.integrand.resize(n);
  for (std::size_t q = 0; q < n; ++q) {
    geometry::Point<Dim> y;
    for (std::size_t d = 0; d < Dim; ++d) y[static_cast<Eigen::Index>(d)] = nodes.position[d][q];
    source.integrand[q] = factor * nodes.weight[q] * axis.dot(motion(y)) * (density.empty() ? 1.0 : density[q]);
  }
  const std::span<const std::int32_t> functions = source.space.functions_of(element);
  source.sums.assign(functions.size(), 0.0);
  fill_node_basis(source.space, element, nodes, source.basis, source.scratch);
  add_moments<Dim>(source.space, element, source.basis, source.integrand, 1, source.scratch, source.sums);
  for (std::size_t a = 0; a < functions.size(); ++a) row[functions[a] * components + component] += source.sums[a];
}

/// int u . motion dS of the unknown components of u, divided by the measure of what moves.
template <int Dim>
void fill_mean_row(const Problem<Dim>& problem, RowSource<Dim>& source, const RigidMotion<Dim>& motion, double measure,
                   Eigen::Ref<Eigen::RowVectorXd> row) {
  const int components = component_count(problem.equation);
  for (std::size_t e = 0; e < problem.condition_of.size(); ++e) {
    if (!motion.moves(source.space.body_of(static_cast<int>(e)))) continue;
    const Condition<Dim>& condition = problem.conditions[static_cast<std::size_t>(problem.condition_of[e])];
    for (int c = 0; c < components; ++c) {
      if (condition.components[static_cast<std::size_t>(c)].kind == ConditionKind::value) continue;
      add_element_row(source, static_cast<int>(e), c, components, component_axis(condition, c), motion, {},
                      1.0 / measure, row);
    }
  }
}

/// int t . direction dS of an exterior problem, of which the known part goes to the right; divided by flux_scale and
/// the measure.
template <int Dim>
void fill_flux_row(const Problem<Dim>& problem, RowSource<Dim>& source, const RigidMotion<Dim>& motion, double measure,
                   double flux_scale, Eigen::Ref<Eigen::RowVectorXd> row, double& right) {
  const int components = component_count(problem.equation);
  BoundaryData<Dim> data(problem);
  ConditionValues<Dim> values;
  for (std::size_t e = 0; e < problem.condition_of.size(); ++e) {
    const Condition<Dim>& condition = problem.conditions[static_cast<std::size_t>(problem.condition_of[e])];
    const quadrature::NodeView<Dim> nodes = smooth_rule(source.rules, static_cast<int>(e));
    data.evaluate(problem.condition_of[e], nodes, values);
    for (int c = 0; c < components; ++c) {
      const auto index = static_cast<std::size_t>(c);
      const geometry::Vector<Dim> axis = component_axis(condition, c);
      const ConditionKind kind = condition.components[index].kind;
      const double scale = 1.0 / (flux_scale * measure);
      if (kind == ConditionKind::value)
        add_element_row(source, static_cast<int>(e), c, components, axis, motion, {}, 1.0 / measure, row);
      if (kind == ConditionKind::robin) {
        add_element_row(source, static_cast<int>(e), c, components, axis, motion, values.coefficient[index], scale,
                        row);
      }
      if (kind == ConditionKind::value || values.value[index].empty()) continue;
      for (std::size_t q = 0; q < nodes.size(); ++q) {
        const double factor = kind == ConditionKind::robin ? -values.coefficient[index][q] : 1.0;
        right -= scale * nodes.weight[q] * factor * values.value[index][q] * axis.dot(motion.translation);
      }
    }
  }
}

template <int Dim>
double measure_of(const FieldSpace<Dim>& space, const quadrature::TargetRules<Dim>& rules, std::int32_t body = -1) {
  double sum = 0.0;
  for (std::size_t e = 0; e < space.table.elements.size(); ++e) {
    if (body >= 0 && space.body_of(static_cast<int>(e)) != body) continue;
    for (const double weight : smooth_rule(rules, static_cast<int>(e)).weight) sum += weight;
  }
  return sum;
}

/// Directions orthogonal to the free translations.
template <int Dim>
std::vector<geometry::Vector<Dim>> held_directions(const std::vector<RigidMotion<Dim>>& free, int components) {
  using Directions = std::vector<geometry::Vector<Dim>>;
  if (static_cast<int>(free.size()) == components) return {};
  if (free.empty()) {
    Directions all;
    for (int c = 0; c < components; ++c) all.push_back(geometry::Vector<Dim>::Unit(c));
    return all;
  }
  const geometry::Vector<Dim> open = free.front().translation.normalized();
  geometry::Vector<Dim> held = geometry::Vector<Dim>::Zero();
  held[0] = -open[1];
  held[1] = open[0];
  return {held};
}

template <int Dim>
std::string fixed_message(const FieldSpace<Dim>& space, std::int32_t body, const std::vector<std::string>& names,
                          int components) {
  const std::string boundary = body < 0 ? "the boundary" : "its boundary";
  if (components == 1) {
    return fmt::format(
        "only fluxes are prescribed{}: the potential is determined up to a constant; its mean over {} "
        "was set to 0",
        on_body(space, body), boundary);
  }
  return fmt::format(
      "the conditions leave {} free ({}); the mean displacement along these motions over {} was set to 0",
      body_name(space, body), fmt::join(names, ", "), boundary);
}

/// One for each body that is free; the motions of a body stand together.
template <int Dim>
void append_messages(const FieldSpace<Dim>& space, const std::vector<RigidMotion<Dim>>& motions, int components,
                     std::vector<std::string>& messages) {
  for (std::size_t k = 0; k < motions.size();) {
    const std::int32_t body = motions[k].body;
    std::vector<std::string> names;
    for (; k < motions.size() && motions[k].body == body; ++k) names.push_back(describe(motions[k], components));
    messages.push_back(fixed_message(space, body, names, components));
  }
}

template <int Dim>
SideConditions<Dim> fix_motions(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                const quadrature::TargetRules<Dim>& rules, std::vector<RigidMotion<Dim>> motions,
                                int threads) {
  const int components = component_count(problem.equation);
  SideConditions<Dim> result;
  const auto count = static_cast<Eigen::Index>(motions.size());
  result.rows.setZero(count, components * space.function_count());
  result.right.setZero(count, 1);
  RowSource<Dim> source{space, rules, {}, {}, {}, {}};
  for (Eigen::Index k = 0; k < count; ++k) {
    const RigidMotion<Dim>& motion = motions[static_cast<std::size_t>(k)];
    require_balance(problem, space, motion, threads);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(result.rows.cols());
    fill_mean_row(problem, source, motion, measure_of(space, rules, motion.body), row);
    result.rows.row(k) = row;
  }
  append_messages(space, motions, components, result.messages);
  result.flux_modes = std::move(motions);
  return result;
}

SideConditions<2> fix_constants(const Problem<2>& problem, const FieldSpace<2>& space,
                                const quadrature::TargetRules<2>& rules, const std::vector<RigidMotion<2>>& free,
                                double flux_scale, int threads) {
  const int components = component_count(problem.equation);
  for (const RigidMotion<2>& motion : free) require_balance(problem, space, motion, threads);
  SideConditions<2> result;
  result.constants = held_directions(free, components);
  const auto count = static_cast<Eigen::Index>(result.constants.size());
  result.rows.setZero(count, components * space.function_count());
  result.right.setZero(count, 1);
  RowSource<2> source{space, rules, {}, {}, {}, {}};
  const double measure = measure_of(space, rules);
  for (Eigen::Index k = 0; k < count; ++k) {
    RigidMotion<2> motion;
    motion.translation = result.constants[static_cast<std::size_t>(k)];
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(result.rows.cols());
    fill_flux_row(problem, source, motion, measure, flux_scale, row, result.right(k, 0));
    result.rows.row(k) = row;
  }
  return result;
}

}  // namespace

template <int Dim>
SideConditions<Dim> side_conditions(const Problem<Dim>& problem, const FieldSpace<Dim>& space,
                                    const quadrature::TargetRules<Dim>& rules, double flux_scale, int threads) {
  if (problem.exterior) {
    if constexpr (Dim == 2)
      return fix_constants(problem, space, rules, free_motions(problem, space), flux_scale, threads);
    SideConditions<Dim> none;
    none.rows.resize(0, component_count(problem.equation) * space.function_count());
    none.right.resize(0, 1);
    return none;
  }
  return fix_motions(problem, space, rules, free_motions(problem, space), threads);
}

template SideConditions<2> side_conditions<2>(const Problem<2>&, const FieldSpace<2>&,
                                              const quadrature::TargetRules<2>&, double, int);
template SideConditions<3> side_conditions<3>(const Problem<3>&, const FieldSpace<3>&,
                                              const quadrature::TargetRules<3>&, double, int);

}  // namespace isorim::solver
