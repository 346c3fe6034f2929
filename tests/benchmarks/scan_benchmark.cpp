#include <cmath>
#include <numbers>
#include <random>

#include <benchmark/benchmark.h>

#include "geometry/fitting/contour_ordering.h"
#include "geometry/fitting/curve_fit.h"
#include "geometry/fitting/point_reduction.h"

/// From the points of a scanned slice to its curve, on one core.
namespace isorim::geometry {
namespace {

/// A lobed contour of size 2 in random order; noise relative to its size.
Points<2> scanned_slice(Eigen::Index count, double noise) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
  std::normal_distribution<double> error(0.0, 2.0 * noise);
  Points<2> points(2, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double angle = turn(random);
    const double radius = 0.8 + 0.15 * std::cos(5.0 * angle);
    points.col(i) << radius * std::cos(angle) + error(random), radius * std::sin(angle) + error(random);
  }
  return points;
}

/// Arguments: points, noise in thousandths.
void ReduceOrderAndFit(benchmark::State& state) {
  const Points<2> points = scanned_slice(state.range(0), 1e-3 * static_cast<double>(state.range(1)));
  double distance = 0.0;
  double cells = 0.0;
  for (auto _ : state) {
    const ReducedPoints reduced = reduce_points(points, automatic_cell_size(points));
    const OrderedContours ordered = order_contours(reduced.points, reduced.counts);
    CurveFitOptions<2> options;
    options.control_points = 40;
    options.weights = FitWeights::given;
    options.point_weights = ordered.contours.front().weights;
    const CurveFit<2> curve = fit_points<2>(ordered.contours.front().points, options);
    benchmark::DoNotOptimize(curve.quality.max_distance);
    distance = curve.quality.rms_distance;
    cells = static_cast<double>(reduced.points.cols());
  }
  state.counters["cells"] = cells;
  state.counters["rms"] = distance;
}
BENCHMARK(ReduceOrderAndFit)
    ->Args({100000, 0})
    ->Args({1000000, 0})
    ->Args({1000000, 1})
    ->Args({1000000, 10})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace isorim::geometry
