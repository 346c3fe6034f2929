#include "quadrature/element_sums.h"

#include <cstddef>
#include <vector>

#include "quadrature/bernstein.h"
#include "quadrature/gauss_legendre.h"
#include "quadrature/lanes.h"
#include "quadrature/region_weights.h"

namespace isorim::quadrature {

namespace {

/// A rule in one direction and the Bernstein polynomials of one degree at its points: see BernsteinTable.
struct DirectionTable {
  int degree;
  int points;
  const double* weights;
  const double* values;
  const double* derivatives;
};

DirectionTable direction_table(int degree, int points) {
  const BernsteinTable& basis = bernstein_table(degree, points);
  return {degree, points, gauss_legendre(points).weights.data(), basis.values.data(), basis.derivatives.data()};
}

struct KernelInput {
  /// Control points of the batch relative to the pole, lane by lane: packet (point * components + component).
  const Packet* net;
  DirectionTable u;
  DirectionTable v;
  /// Of cut elements: a weight for each point, v fastest, lane by lane.
  const Packet* weights;
};

/// input, room for the rows' values (surfaces only), sums to be added to.
using Kernel = void (*)(const KernelInput&, Packet*, Lanes*);
struct KernelSet {
  Kernel rational_surface;
  Kernel polynomial_surface;
  Kernel cut_rational_surface;
  Kernel cut_polynomial_surface;
  Kernel rational_curve;
  Kernel polynomial_curve;
};

namespace baseline {
#include "quadrature/element_sums_kernels.inc"
}  // namespace baseline

#ifdef ISORIM_DISPATCH
#pragma GCC push_options
#pragma GCC target("arch=haswell")
namespace haswell {
#include "quadrature/element_sums_kernels.inc"
}  // namespace haswell
#pragma GCC pop_options

const KernelSet& kernels() {
  return has_wide_registers() ? haswell::kernels : baseline::kernels;
}
#else
const KernelSet& kernels() {
  return baseline::kernels;
}
#endif

/// Scratch memory of one thread.
struct Workspace {
  std::vector<Packet> net;
  std::vector<Packet> row_values;
};

/// Interleaves the nets of the batch, positions taken relative to the pole: (w x - w x0, ..[, w]). Empty lanes repeat
/// the first element, so no lane divides by zero.
template <int Dim>
void interleave(const ElementBatch<Dim>& batch, const geometry::Point<Dim>& pole, std::vector<Packet>& net) {
  const int components = batch.polynomial ? Dim : Dim + 1;
  int count = 1;
  for (const int degree : batch.degree) count *= degree + 1;
  net.resize(static_cast<std::size_t>(count * components));
  for (int lane = 0; lane < kernel_lanes; ++lane) {
    const double* source = batch.nets[static_cast<std::size_t>(lane < batch.size ? lane : 0)];
    Packet* target = net.data();
    for (int point = 0; point < count; ++point, source += Dim + 1) {
      const double weight = source[Dim];
      for (int c = 0; c < Dim; ++c) (target++)->value[lane] = source[c] - weight * pole[c];
      if (!batch.polynomial) (target++)->value[lane] = weight;
    }
  }
}

Kernel surface_kernel(const ElementBatch<3>& batch) {
  const KernelSet& set = kernels();
  if (batch.regions[0] != nullptr) return batch.polynomial ? set.cut_polynomial_surface : set.cut_rational_surface;
  return batch.polynomial ? set.polynomial_surface : set.rational_surface;
}

}  // namespace

template <int Dim>
void sum_over_elements(const ElementBatch<Dim>& batch, const geometry::Point<Dim>& pole, const Orders<Dim - 1>& orders,
                       std::span<ElementSums<Dim>> sums) {
  static thread_local Workspace workspace;
  interleave(batch, pole, workspace.net);
  KernelInput input{workspace.net.data(), direction_table(batch.degree[0], orders[0]), {}, nullptr};
  Lanes lane_sums[SumLayout<Dim>::count] = {};
  if constexpr (Dim == 3) {
    input.v = direction_table(batch.degree[1], orders[1]);
    workspace.row_values.resize(static_cast<std::size_t>(batch.degree[1] + 1) * 2 * (Dim + 1));
    if (batch.regions[0] != nullptr)
      input.weights = weights_of_regions({batch.regions.data(), static_cast<std::size_t>(batch.size)}, orders).data();
    surface_kernel(batch)(input, workspace.row_values.data(), lane_sums);
  } else {
    const Kernel kernel = batch.polynomial ? kernels().polynomial_curve : kernels().rational_curve;
    kernel(input, nullptr, lane_sums);
  }
  for (int lane = 0; lane < batch.size; ++lane) {
    for (int k = 0; k < SumLayout<Dim>::count; ++k) sums[static_cast<std::size_t>(lane)][k] = lane_sums[k][lane];
  }
}

template void sum_over_elements<2>(const ElementBatch<2>&, const geometry::Point<2>&, const Orders<1>&,
                                   std::span<ElementSums<2>>);
template void sum_over_elements<3>(const ElementBatch<3>&, const geometry::Point<3>&, const Orders<2>&,
                                   std::span<ElementSums<3>>);

}  // namespace isorim::quadrature
