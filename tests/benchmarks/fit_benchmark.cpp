/// Fits of the four measured sections at their numbers of control points, and of a million points. The labels say how
/// near the curves are; fit_against_scipy.py sets the times beside SciPy's.

#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "geometry/fitting/curve_fit.h"
#include "tests/geometry/fitting/held_out_sections.h"
#include "tests/geometry/fitting/measured_sections.h"
#include "tests/geometry/random_splines.h"

namespace {

using namespace isorim::geometry;

void report(benchmark::State& state, const FitQuality<2>& quality) {
  state.SetLabel(fmt::format("max {:.4f} rms {:.4f} bending {:.1f} sign changes {}", quality.max_distance,
                             quality.rms_distance, quality.bending_energy, quality.curvature_sign_changes));
}

void fit_section(benchmark::State& state, const CurveFitOptions<2>& options) {
  const auto& section = isorim::geometry::testing::measured_sections()[static_cast<std::size_t>(state.range(0) - 1)];
  CurveFitOptions<2> with_count = options;
  with_count.control_points = section.control_points;
  FitQuality<2> quality;
  for (auto _ : state) quality = fit_points(section.points, with_count).quality;
  report(state, quality);
}

void free_fit(benchmark::State& state) {
  fit_section(state, {});
}
BENCHMARK(free_fit)->DenseRange(1, 4)->Unit(benchmark::kMillisecond);

void free_fit_with_peak_steps(benchmark::State& state) {
  CurveFitOptions<2> options;
  options.knot_steps = 8;
  options.peak_steps = 8;
  fit_section(state, options);
}
BENCHMARK(free_fit_with_peak_steps)->DenseRange(1, 4)->Unit(benchmark::kMillisecond);

void fixed_knots(benchmark::State& state) {
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  fit_section(state, options);
}
BENCHMARK(fixed_knots)->DenseRange(1, 4)->Unit(benchmark::kMillisecond);

void corrected_fixed_knots(benchmark::State& state) {
  CurveFitOptions<2> options;
  options.method = FitMethod::fixed_knots;
  options.parameter_corrections = 10;
  fit_section(state, options);
}
BENCHMARK(corrected_fixed_knots)->DenseRange(1, 4)->Unit(benchmark::kMillisecond);

/// The held-out sections, 100 points with noise of 1e-4, at 28 control points; fit_against_scipy.py does the same.
void fit_held_out(benchmark::State& state) {
  namespace sections = isorim::geometry::testing;
  const std::size_t shape = static_cast<std::size_t>(state.range(0) - 1);
  const Points<2> points = sections::held_out_scan(shape, 100, 1e-4);
  CurveFitOptions<2> options;
  options.control_points = 28;
  for (auto _ : state) benchmark::DoNotOptimize(fit_points(points, options).control_points);
  const double error = sections::distance_from_truth(shape, fit_points(points, options).curve);
  state.SetLabel(fmt::format("{} off the truth by {:.2e}", sections::held_out_names[shape], error));
}
BENCHMARK(fit_held_out)->DenseRange(1, 4)->Unit(benchmark::kMillisecond);

/// A wavy circle with noise of a thousandth of its radius.
void million_points(benchmark::State& state) {
  constexpr int count = 1'000'000;
  isorim::geometry::testing::Random random(1);
  Points<2> points(2, count);
  for (int i = 0; i < count; ++i) {
    const double t = 2 * std::numbers::pi * i / count;
    const double r = 1 + 0.2 * std::cos(3 * t) + 0.05 * std::sin(11 * t) + random.real(-1e-3, 1e-3);
    points.col(i) << r * std::cos(t), r * std::sin(t);
  }
  CurveFitOptions<2> options;
  options.parameters = FitParameters::uniform;
  options.control_points = static_cast<int>(state.range(0));
  FitQuality<2> quality;
  for (auto _ : state) quality = fit_points(points, options).quality;
  report(state, quality);
}
BENCHMARK(million_points)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
