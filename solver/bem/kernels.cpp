#include "solver/bem/kernels.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "quadrature/lanes.h"

namespace isorim::solver {

namespace {

/// What a loop over nodes reads and writes: d = y[k][q] - x[k]. Plain arrays, since the accessors of std::array are
/// not inlined into functions for another instruction set.
template <int Dim>
struct LoopInput {
  std::size_t count;
  const double* y[Dim];
  double x[Dim];
  const double* normal[Dim];
  double* values;
};

/// Constants of a material. U = scale (elasticity: times what Kelvin's formula has in brackets).
struct LaplaceConstants {
  double single;
  double double_layer;
  double log_length;
};
struct ElasticityConstants {
  double single;
  double double_layer;
  /// 3 - 4 nu and 1 - 2 nu.
  double three;
  double one;
  double log_length;
};

template <int Dim>
struct LoopSet {
  void (*laplace_single)(const LoopInput<Dim>&, const LaplaceConstants&);
  void (*laplace_double)(const LoopInput<Dim>&, const LaplaceConstants&);
  void (*laplace_single_gradient)(const LoopInput<Dim>&, const LaplaceConstants&);
  void (*laplace_double_gradient)(const LoopInput<Dim>&, const LaplaceConstants&);
  void (*elastic_single)(const LoopInput<Dim>&, const ElasticityConstants&);
  void (*elastic_double)(const LoopInput<Dim>&, const ElasticityConstants&);
  void (*elastic_single_gradient)(const LoopInput<Dim>&, const ElasticityConstants&);
  void (*elastic_double_gradient)(const LoopInput<Dim>&, const ElasticityConstants&);
};

namespace baseline {
#include "solver/bem/kernels_loops.inc"
}  // namespace baseline

#ifdef ISORIM_DISPATCH
#pragma GCC push_options
#pragma GCC target("arch=haswell")
namespace haswell {
#include "solver/bem/kernels_loops.inc"
}  // namespace haswell
#pragma GCC pop_options
namespace widest = haswell;
#else
namespace widest = baseline;
#endif

template <int Dim>
const LoopSet<Dim>& loops() {
  if constexpr (Dim == 2) {
    return quadrature::has_wide_registers() ? widest::loop_set_2 : baseline::loop_set_2;
  } else {
    return quadrature::has_wide_registers() ? widest::loop_set_3 : baseline::loop_set_3;
  }
}

template <int Dim>
LoopInput<Dim> loop_input(const geometry::Point<Dim>& target, const quadrature::NodeView<Dim>& nodes,
                          std::span<double> values, [[maybe_unused]] std::size_t entries) {
  assert(values.size() >= entries * nodes.size());
  const bool has_offsets = nodes.offset[0].size() == nodes.size();
  LoopInput<Dim> input{nodes.size(), {}, {}, {}, values.data()};
  for (std::size_t k = 0; k < Dim; ++k) {
    input.y[k] = has_offsets ? nodes.offset[k].data() : nodes.position[k].data();
    input.x[k] = has_offsets ? 0.0 : target[static_cast<Eigen::Index>(k)];
    input.normal[k] = nodes.normal[k].data();
  }
  return input;
}

/// Surface of the unit sphere, length of the unit circle.
template <int Dim>
constexpr double unit_sphere = Dim == 3 ? 4.0 * std::numbers::pi : 2.0 * std::numbers::pi;

template <int Dim>
LaplaceConstants constants(const Laplace<Dim>& kernel) {
  return {1.0 / (unit_sphere<Dim> * kernel.conductivity), 1.0 / unit_sphere<Dim>, std::log(kernel.length)};
}

template <int Dim>
ElasticityConstants constants(const Elasticity<Dim>& kernel) {
  const double across = 1.0 - kernel.poisson;
  return {1.0 / (4.0 * unit_sphere<Dim> * kernel.shear_modulus * across), 1.0 / (2.0 * unit_sphere<Dim> * across),
          3.0 - 4.0 * kernel.poisson, 1.0 - 2.0 * kernel.poisson, std::log(kernel.length)};
}

template <class Kernel>
constexpr bool is_elastic = Kernel::components > 1;

}  // namespace

template <class Kernel>
void single_layer(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                  const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values) {
  constexpr int dim = Kernel::dimension;
  const auto input = loop_input(target, nodes, values, Kernel::components * Kernel::components);
  if constexpr (is_elastic<Kernel>) {
    loops<dim>().elastic_single(input, constants(kernel));
  } else {
    loops<dim>().laplace_single(input, constants(kernel));
  }
}

template <class Kernel>
void double_layer(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                  const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values) {
  constexpr int dim = Kernel::dimension;
  const auto input = loop_input(target, nodes, values, Kernel::components * Kernel::components);
  if constexpr (is_elastic<Kernel>) {
    loops<dim>().elastic_double(input, constants(kernel));
  } else {
    loops<dim>().laplace_double(input, constants(kernel));
  }
}

template <class Kernel>
void single_layer_gradient(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                           const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values) {
  constexpr int dim = Kernel::dimension;
  const auto input = loop_input(target, nodes, values, dim * Kernel::components * Kernel::components);
  if constexpr (is_elastic<Kernel>) {
    loops<dim>().elastic_single_gradient(input, constants(kernel));
  } else {
    loops<dim>().laplace_single_gradient(input, constants(kernel));
  }
}

template <class Kernel>
void double_layer_gradient(const Kernel& kernel, const geometry::Point<Kernel::dimension>& target,
                           const quadrature::NodeView<Kernel::dimension>& nodes, std::span<double> values) {
  constexpr int dim = Kernel::dimension;
  const auto input = loop_input(target, nodes, values, dim * Kernel::components * Kernel::components);
  if constexpr (is_elastic<Kernel>) {
    loops<dim>().elastic_double_gradient(input, constants(kernel));
  } else {
    loops<dim>().laplace_double_gradient(input, constants(kernel));
  }
}

#define ISORIM_INSTANTIATE(Kernel)                                                                        \
  template void single_layer(const Kernel&, const geometry::Point<Kernel::dimension>&,                    \
                             const quadrature::NodeView<Kernel::dimension>&, std::span<double>);          \
  template void double_layer(const Kernel&, const geometry::Point<Kernel::dimension>&,                    \
                             const quadrature::NodeView<Kernel::dimension>&, std::span<double>);          \
  template void single_layer_gradient(const Kernel&, const geometry::Point<Kernel::dimension>&,           \
                                      const quadrature::NodeView<Kernel::dimension>&, std::span<double>); \
  template void double_layer_gradient(const Kernel&, const geometry::Point<Kernel::dimension>&,           \
                                      const quadrature::NodeView<Kernel::dimension>&, std::span<double>);
ISORIM_INSTANTIATE(Laplace<2>)
ISORIM_INSTANTIATE(Laplace<3>)
ISORIM_INSTANTIATE(Elasticity<2>)
ISORIM_INSTANTIATE(Elasticity<3>)
#undef ISORIM_INSTANTIATE

}  // namespace isorim::solver
