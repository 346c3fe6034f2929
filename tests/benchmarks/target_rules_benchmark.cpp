#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "geometry/shapes/solids.h"
#include "quadrature/element_jet.h"
#include "quadrature/target_rules.h"
#include "solver/bem/kernels.h"

namespace isorim {
namespace {

using geometry::Point2;
using geometry::Point3;
using quadrature::NodeBuffer;
using quadrature::NodeView;
using quadrature::Target;
using quadrature::TargetRules;

/// Kernel evaluations: items are nodes.
template <class Kernel>
void evaluate_kernel(benchmark::State& state,
                     void (*layer)(const Kernel&, const Point3&, const NodeView<3>&, std::span<double>),
                     std::size_t entries) {
  const geometry::ElementTable<3> table = geometry::bezier_elements(geometry::torus(2.0, 0.5));
  const TargetRules<3> rules(table, {1e-12, 4});
  const Point3 target(0.1, 0.2, 0.3);
  const NodeView<3> nodes = rules.far_nodes(0, rules.sphere(0).radius);
  std::vector<double> values(entries * nodes.size());
  for (auto _ : state) {
    layer(Kernel{}, target, nodes, values);
    benchmark::DoNotOptimize(values.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(nodes.size()));
}
void laplace_u(benchmark::State& state) {
  evaluate_kernel<solver::Laplace<3>>(state, solver::single_layer, 1);
}
void laplace_t(benchmark::State& state) {
  evaluate_kernel<solver::Laplace<3>>(state, solver::double_layer, 1);
}
void kelvin_u(benchmark::State& state) {
  evaluate_kernel<solver::Elasticity<3>>(state, solver::single_layer, 9);
}
void kelvin_t(benchmark::State& state) {
  evaluate_kernel<solver::Elasticity<3>>(state, solver::double_layer, 9);
}
void kelvin_t_gradient(benchmark::State& state) {
  evaluate_kernel<solver::Elasticity<3>>(state, solver::double_layer_gradient, 27);
}
BENCHMARK(laplace_u);
BENCHMARK(laplace_t);
BENCHMARK(kelvin_u);
BENCHMARK(kelvin_t);
BENCHMARK(kelvin_t_gradient);

/// Nodes for a target above the middle of an element of a torus, its distance in thousandths of the element's length
/// (0: on it), at the tolerance 10^-range(1).
void make_nodes(benchmark::State& state) {
  const geometry::ElementTable<3> table = geometry::bezier_elements(geometry::torus(2.0, 0.5));
  const double distance = 1e-3 * static_cast<double>(state.range(0));
  const TargetRules<3> rules(table, {std::pow(10.0, -static_cast<double>(state.range(1))), 4});
  const Point2 place(0.45, 0.6);
  const quadrature::ElementJet<3> jet =
      quadrature::element_jet<3>(quadrature::element_net(table, table.elements[0]), place, Point3::Zero());
  Target<3> target{jet.offset};
  if (distance == 0.0) {
    target.element = 0;
    target.place = place;
  } else {
    target.position += distance * jet.first[1].norm() * jet.offset.normalized();
  }
  NodeBuffer<3> buffer;
  std::size_t count = 0;
  for (auto _ : state) {
    const NodeView<3> nodes = rules.nodes(0, target, buffer);
    count = nodes.size();
    benchmark::DoNotOptimize(nodes.weight.data());
  }
  state.counters["nodes"] = static_cast<double>(count);
}
BENCHMARK(make_nodes)->ArgsProduct({{0, 1, 10, 100, 300, 1000, 3000, 10000, 30000}, {6, 12}});

/// What assembly asks of the rules and the kernels: all elements for a target on each of them, without the field's
/// basis. A sphere of six patches is as many elements as eight octants.
void visit_all_pairs(benchmark::State& state) {
  const geometry::ElementTable<3> table = geometry::bezier_elements(geometry::torus(2.0, 0.5));
  const TargetRules<3> rules(table, {std::pow(10.0, -static_cast<double>(state.range(0))), 6});
  NodeBuffer<3> buffer;
  std::vector<double> values;
  std::size_t count = 0;
  std::size_t pairs = 0;
  for (auto _ : state) {
    for (int e = 0; e < static_cast<int>(table.elements.size()); ++e) {
      for (const Point2& place : {Point2(0.5, 0.5), Point2(0.1, 0.3), Point2(0.02, 0.96)}) {
        const auto net = quadrature::element_net(table, table.elements[static_cast<std::size_t>(e)]);
        const Target<3> target{quadrature::element_jet<3>(net, place, Point3::Zero()).offset, e, place};
        for (int f = 0; f < static_cast<int>(table.elements.size()); ++f) {
          const NodeView<3> nodes = rules.nodes(f, target, buffer);
          values.resize(nodes.size());
          solver::single_layer(solver::Laplace<3>{}, target.position, nodes, std::span(values));
          solver::double_layer(solver::Laplace<3>{}, target.position, nodes, std::span(values));
          count += nodes.size();
          ++pairs;
        }
      }
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(pairs));
  state.counters["nodes_a_pair"] = static_cast<double>(count) / static_cast<double>(pairs);
}
BENCHMARK(visit_all_pairs)->Arg(8)->Arg(12);

}  // namespace
}  // namespace isorim
