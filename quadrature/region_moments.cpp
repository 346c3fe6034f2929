#include "quadrature/region_moments.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <mutex>

#include "quadrature/gauss_legendre.h"
#include "quadrature/lanes.h"
#include "quadrature/region_weights.h"

namespace isorim::quadrature {

namespace {

/// Points, in packets, whose polynomials stand in the cache at a time.
constexpr int chunk_packets = 16;
/// Moments that the innermost loop keeps in registers.
constexpr int row_block = 4;
constexpr int column_block = 3;

/// A chunk of a line rule. Rows and columns are multiples of their blocks.
struct MomentInput {
  const Packet* x;
  const Packet* y;
  const Packet* dy;
  int packets;
  int rows;
  int columns;
};

struct WeightInput {
  const double* table_u;
  const double* table_v;
  /// nodes[0] x nodes[1], the second index fastest.
  const Packet* moments;
  Orders<2> nodes;
};

struct KernelSet {
  void (*accumulate_moments)(const MomentInput&, Packet*, Packet*, Packet*);
  void (*weights_from_moments)(const WeightInput&, Packet*, Packet*);
};

namespace baseline {
#include "quadrature/region_moments_kernels.inc"
}  // namespace baseline

#ifdef ISORIM_DISPATCH
#pragma GCC push_options
#pragma GCC target("arch=haswell")
namespace haswell {
#include "quadrature/region_moments_kernels.inc"
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

int rounded_up(int count, int block) {
  return (count + block - 1) / block * block;
}

/// sqrt(2 i + 1): q_i is this times P_i(2 x - 1).
double normalisation(int i) {
  return std::sqrt(2.0 * i + 1.0);
}

/// P_0 .. P_(count - 1) at 2 x - 1.
void legendre_polynomials(double x, int count, std::vector<double>& values) {
  values.resize(static_cast<std::size_t>(count));
  const double z = 2.0 * x - 1.0;
  double previous = 0.0;
  double current = 1.0;
  for (int k = 0; k < count; ++k) {
    values[static_cast<std::size_t>(k)] = current;
    const double next = ((2 * k + 1) * z * current - k * previous) / (k + 1);
    previous = current;
    current = next;
  }
}

std::vector<double> make_table(int nodes) {
  const Rule& rule = gauss_legendre(nodes);
  std::vector<double> table;
  std::vector<double> polynomials;
  for (std::size_t a = 0; a < rule.nodes.size(); ++a) {
    legendre_polynomials(rule.nodes[a], nodes, polynomials);
    for (int i = 0; i < nodes; ++i)
      table.push_back(rule.weights[a] * normalisation(i) * polynomials[static_cast<std::size_t>(i)]);
  }
  return table;
}

/// Scratch memory of one thread.
struct Workspace {
  std::array<std::array<Packet, chunk_packets>, 3> points;
  std::vector<Packet> primitives;
  std::vector<Packet> polynomials;
  std::vector<Packet> sums;
};

/// Copies points [begin, ..) into packets; those that are missing in the last packet weigh nothing.
int fill_packets(const LineRule& rule, std::size_t begin, std::array<std::array<Packet, chunk_packets>, 3>& packets) {
  const std::array<const std::vector<double>*, 3> sources{&rule.x, &rule.y, &rule.dy};
  const std::size_t count =
      std::min<std::size_t>(rule.x.size() - begin, static_cast<std::size_t>(chunk_packets * kernel_lanes));
  const std::size_t filled = (count + kernel_lanes - 1) / kernel_lanes;
  for (std::size_t s = 0; s < 3; ++s) {
    for (std::size_t k = 0; k < filled * kernel_lanes; ++k)
      packets[s][k / kernel_lanes].value[k % kernel_lanes] = k < count ? (*sources[s])[begin + k] : 0.0;
  }
  return static_cast<int>(filled);
}

double sum_of(Lanes lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

}  // namespace

double RegionMoments::amplification() const {
  return std::max(1.0, absolute / std::max(std::abs(area()), std::numeric_limits<double>::epsilon() * absolute));
}

const std::vector<double>& legendre_at_nodes(int nodes) {
  assert(1 <= nodes && nodes <= max_gauss_points);
  struct Slot {
    std::once_flag once;
    std::vector<double> table;
  };
  static std::array<Slot, max_gauss_points + 1> slots;
  Slot& slot = slots[static_cast<std::size_t>(nodes)];
  std::call_once(slot.once, [&] { slot.table = make_table(nodes); });
  return slot.table;
}

void add_moments(const LineRule& rule, RegionMoments& moments) {
  static thread_local Workspace workspace;
  const int rows = rounded_up(moments.counts[0], row_block);
  const int columns = rounded_up(moments.counts[1], column_block);
  workspace.primitives.resize(static_cast<std::size_t>(rows * chunk_packets));
  workspace.polynomials.resize(static_cast<std::size_t>(columns * chunk_packets));
  workspace.sums.assign(static_cast<std::size_t>(rows * columns), Packet{});
  for (std::size_t begin = 0; begin < rule.x.size(); begin += chunk_packets * kernel_lanes) {
    const int packets = fill_packets(rule, begin, workspace.points);
    const MomentInput input{
        workspace.points[0].data(), workspace.points[1].data(), workspace.points[2].data(), packets, rows, columns};
    kernels().accumulate_moments(input, workspace.primitives.data(), workspace.polynomials.data(),
                                 workspace.sums.data());
  }
  for (int i = 0; i < moments.counts[0]; ++i) {
    for (int j = 0; j < moments.counts[1]; ++j)
      moments.values[static_cast<std::size_t>(i * moments.counts[1] + j)] +=
          0.5 * normalisation(j) / normalisation(i) *
          sum_of(workspace.sums[static_cast<std::size_t>(i * columns + j)].value);
  }
  for (std::size_t k = 0; k < rule.x.size(); ++k) moments.absolute += std::abs(rule.x[k] * rule.dy[k]);
}

void add_moments_of_strip(double first, double last, RegionMoments& moments) {
  // The primitive of P_j is (P_(j + 1) - P_(j - 1)) / (2 (2 j + 1)); across the cell only q_0 has an integral.
  const int columns = moments.counts[1];
  std::vector<double> at_first;
  std::vector<double> at_last;
  legendre_polynomials(first, columns + 1, at_first);
  legendre_polynomials(last, columns + 1, at_last);
  moments.values[0] += last - first;
  for (int j = 1; j < columns; ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double rise = (at_last[k + 1] - at_first[k + 1]) - (at_last[k - 1] - at_first[k - 1]);
    moments.values[k] += 0.5 * rise / normalisation(j);
  }
  moments.absolute += std::abs(last - first);
}

std::span<const Packet> weights_of_regions(std::span<const RegionMoments* const> regions, const Orders<2>& nodes) {
  static thread_local std::array<std::vector<Packet>, 3> workspace;
  const auto size = static_cast<std::size_t>(nodes[0] * nodes[1]);
  for (std::vector<Packet>& packets : workspace) packets.resize(size);
  for (std::size_t lane = 0; lane < kernel_lanes; ++lane) {
    const RegionMoments& moments = *regions[lane < regions.size() ? lane : 0];
    for (int i = 0; i < nodes[0]; ++i) {
      for (int j = 0; j < nodes[1]; ++j)
        workspace[0][static_cast<std::size_t>(i * nodes[1] + j)].value[static_cast<int>(lane)] =
            moments.values[static_cast<std::size_t>(i * moments.counts[1] + j)];
    }
  }
  const WeightInput input{legendre_at_nodes(nodes[0]).data(), legendre_at_nodes(nodes[1]).data(), workspace[0].data(),
                          nodes};
  kernels().weights_from_moments(input, workspace[1].data(), workspace[2].data());
  return workspace[2];
}

void region_weights(const RegionMoments& moments, const Orders<2>& nodes, std::vector<double>& weights) {
  const RegionMoments* region = &moments;
  const std::span<const Packet> packets = weights_of_regions({&region, 1}, nodes);
  weights.resize(packets.size());
  for (int a = 0; a < nodes[0]; ++a) {
    for (int b = 0; b < nodes[1]; ++b)
      weights[static_cast<std::size_t>(a + b * nodes[0])] =
          packets[static_cast<std::size_t>(a * nodes[1] + b)].value[0];
  }
}

}  // namespace isorim::quadrature
