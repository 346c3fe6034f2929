// How fast are the integrals? All of area, volume, centroid and inertia at once, in points and elements a second.
//
//   build/bin/benchmark_integration --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
//
// ElementSums: the innermost kernel alone on one core, and the fraction of the core's peak (measured beside it, with
// fused multiply-adds on independent registers) that its arithmetic is. MillionElements: 10^6 elements with error
// estimates on one thread and on two; peak_MiB is the process's largest memory so far.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "geometry/shapes/solids.h"
#include "quadrature/boundary_sums.h"
#include "quadrature/element_sums.h"
#include "solver/properties.h"
#include "tests/quadrature/regions.h"

namespace {

using namespace isorim;

#if defined(__x86_64__) && !defined(__clang__)
#define ISORIM_PEAK_TARGET __attribute__((target("arch=haswell")))
#else
#define ISORIM_PEAK_TARGET
#endif

/// Keeps the compiler from knowing the operands and from dropping the results.
volatile double opaque = 0.999999;

/// Operations (a fused multiply-add counts as two) a second of one core at its best.
ISORIM_PEAK_TARGET double peak_operations() {
  using Register = double __attribute__((vector_size(32)));
  constexpr int chains = 12;
  constexpr int steps = 200000;
  const double value = opaque;
  const Register factor = {value, value, value, value};
  double best = 0.0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    Register sums[chains];
    for (int chain = 0; chain < chains; ++chain) sums[chain] = factor * (1.0 + chain);
    const auto begin = std::chrono::steady_clock::now();
    for (int step = 0; step < steps; ++step) {
      for (int chain = 0; chain < chains; ++chain) sums[chain] = sums[chain] * factor + factor;
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    for (const Register& sum : sums) opaque = sum[0] + sum[1] + sum[2] + sum[3];
    opaque = value;
    best = std::max(best, 8.0 * chains * steps / elapsed.count());
  }
  return best;
}

/// Operations of the kernel for each point of an n x n rule: contraction in the first direction shared by a row,
/// contraction in the second, and the arithmetic at the point.
double operations_per_point(int p, bool polynomial, int n) {
  const int components = polynomial ? 3 : 4;
  const double first = 4.0 * (p + 1) * (p + 1) * components / n;
  const double second = 6.0 * (p + 1) * components;
  return first + second + (polynomial ? 48.0 : 64.0);
}

void ElementSums(benchmark::State& state) {
  const auto degree = static_cast<int>(state.range(0));
  const bool polynomial = state.range(1) == 1;
  const auto points = static_cast<int>(state.range(2));
  std::vector<double> net;
  for (int j = 0; j <= degree; ++j) {
    for (int i = 0; i <= degree; ++i) {
      const double weight = polynomial ? 1.0 : 1.0 + 0.1 * i + 0.05 * j;
      net.insert(net.end(), {weight * i, weight * j, weight * 0.1 * i * j, weight});
    }
  }
  quadrature::ElementBatch<3> batch;
  batch.size = quadrature::kernel_lanes;
  batch.degree = {degree, degree};
  batch.polynomial = polynomial;
  batch.nets.fill(net.data());
  std::array<quadrature::ElementSums<3>, quadrature::kernel_lanes> sums;
  for (auto _ : state) {
    quadrature::sum_over_elements<3>(batch, geometry::Point3(0.1, 0.2, 0.3), {points, points}, sums);
    benchmark::DoNotOptimize(sums);
  }
  const double elements = static_cast<double>(state.iterations()) * batch.size;
  const double evaluations = elements * points * points;
  static const double peak = peak_operations();
  using benchmark::Counter;
  state.counters["elements"] = Counter(elements, Counter::kIsRate);
  state.counters["points"] = Counter(evaluations, Counter::kIsRate);
  state.counters["of_peak"] =
      Counter(evaluations * operations_per_point(degree, polynomial, points) / peak, Counter::kIsRate);
}
BENCHMARK(ElementSums)->ArgNames({"degree", "polynomial", "points"})->ArgsProduct({{2, 3}, {0, 1}, {6, 12}});

/// A torus cut into 1000 x 1000 biquadratic rational elements.
const geometry::ElementTable<3>& million_elements() {
  static const geometry::ElementTable<3> table = [] {
    geometry::Boundary<3> torus = geometry::torus(2.0, 0.5);
    for (const geometry::Direction direction : {geometry::Direction::u, geometry::Direction::v}) {
      std::vector<double> knots;
      for (int i = 1; i < 1000; ++i) {
        if (i % 250 != 0) knots.push_back(i / 1000.0);
      }
      torus.patches[0].shape = refine_knots(surface_of(torus.patches[0].shape), direction, knots);
    }
    return geometry::bezier_elements(torus);
  }();
  return table;
}

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void MillionElements(benchmark::State& state) {
  const geometry::ElementTable<3>& table = million_elements();
  solver::PropertyOptions<3> options;
  options.integration.threads = static_cast<int>(state.range(0));
  options.integration.fixed_points = static_cast<int>(state.range(1));
  std::int64_t evaluations = 0;
  for (auto _ : state) {
    const auto properties = solver::geometric_properties(table, options);
    evaluations += properties.evaluations;
    benchmark::DoNotOptimize(properties);
  }
  using benchmark::Counter;
  state.counters["elements"] = Counter(
      static_cast<double>(table.elements.size() * static_cast<std::size_t>(state.iterations())), Counter::kIsRate);
  state.counters["points"] = Counter(static_cast<double>(evaluations), Counter::kIsRate);
  state.counters["peak_MiB"] = peak_memory_mib();
}
BENCHMARK(MillionElements)
    ->ArgNames({"threads", "points"})
    ->ArgsProduct({{1, 2}, {0, 6}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The whole of a small case's integration: a sphere of eight elements to the tolerance 10^-exponent.
void Sphere(benchmark::State& state) {
  const geometry::ElementTable<3> table = geometry::bezier_elements(geometry::sphere(1.0));
  solver::PropertyOptions<3> options;
  options.integration.tolerance = std::pow(10.0, -static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(solver::geometric_properties(table, options));
}
BENCHMARK(Sphere)->ArgName("exponent")->Arg(6)->Arg(9)->Arg(12)->Unit(benchmark::kMicrosecond);

/// Cuts a hole into each element, its outline `pieces` cubics as CAD programs fit them.
void cut_holes(geometry::ElementTable<3>& table, int pieces) {
  for (geometry::BezierElement<3>& element : table.elements) {
    geometry::TrimmedRegion region = quadrature::testing::whole_cell();
    quadrature::testing::add_blob(region, {0.5, 0.5}, 0.3, 0.1, 3, pieces, -1);
    element.region = static_cast<std::int32_t>(table.regions.size());
    table.regions.push_back(std::move(region));
  }
}

/// A sphere with eight holes, 240 short curves in all.
void TrimmedSphere(benchmark::State& state) {
  geometry::ElementTable<3> table = geometry::bezier_elements(geometry::sphere(1.0));
  cut_holes(table, 30);
  solver::PropertyOptions<3> options;
  options.integration.tolerance = std::pow(10.0, -static_cast<double>(state.range(0)));
  options.integration.threads = 1;
  for (auto _ : state) benchmark::DoNotOptimize(solver::geometric_properties(table, options));
}
BENCHMARK(TrimmedSphere)->ArgName("exponent")->Arg(6)->Arg(9)->Arg(12)->Unit(benchmark::kMicrosecond);

/// 500 tori (16 elements each) and 500 boxes, a hole of 30 curves in each of the 11,000 elements, to 1e-9.
void ManyTrimmedFaces(benchmark::State& state) {
  static const geometry::ElementTable<3> table = [] {
    geometry::Boundary<3> solids;
    for (int i = 0; i < 500; ++i) {
      const geometry::Point3 place(10.0 * i, 0.0, 0.0);
      for (const geometry::Boundary<3>& solid :
           {geometry::torus(2.0, 0.5, place), geometry::box({1.0, 1.0, 1.0}, place)})
        solids.patches.insert(solids.patches.end(), solid.patches.begin(), solid.patches.end());
    }
    geometry::ElementTable<3> made = geometry::bezier_elements(solids);
    cut_holes(made, 30);
    return made;
  }();
  solver::PropertyOptions<3> options;
  options.integration.tolerance = 1e-9;
  options.integration.threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(solver::geometric_properties(table, options));
  state.counters["elements"] =
      benchmark::Counter(static_cast<double>(table.elements.size() * static_cast<std::size_t>(state.iterations())),
                         benchmark::Counter::kIsRate);
  state.counters["elements_in_all"] = static_cast<double>(table.elements.size());
}
BENCHMARK(ManyTrimmedFaces)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
