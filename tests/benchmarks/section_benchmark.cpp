#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "geometry/intersection/clip.h"
#include "geometry/intersection/plane_section.h"
#include "geometry/shapes/solids.h"
#include "geometry/shapes/transforms.h"
#include "solver/plane_sections.h"

/// A hundred planes through 36 drilled blocks, 252 faces.
namespace isorim {
namespace {

using geometry::Vector3;

geometry::Boundary<3> drilled_blocks() {
  const geometry::Boundary<3> one = geometry::clip(
      geometry::cube(1.0), geometry::CylinderTool{{0.5, 0.5, 0.5}, {0.2, 0.1, 1}, 0.3, geometry::KeptSide::outside});
  geometry::Boundary<3> all;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (geometry::Patch<3> patch :
           geometry::transform(one, geometry::translation<3>(Vector3(1.5 * i, 1.5 * j, 0.1 * i))).patches) {
        patch.name.append("_").append(std::to_string(6 * i + j));
        all.patches.push_back(std::move(patch));
      }
  return all;
}

std::vector<geometry::PlaneFrame> hundred_planes(const Vector3& normal) {
  std::vector<geometry::PlaneFrame> planes;
  for (int k = 0; k < 100; ++k)
    planes.push_back(geometry::plane_frame(Vector3(4.25, 4.25, 0.75) + 0.03 * (k - 49.6) * normal, normal));
  return planes;
}

void cut(benchmark::State& state, double fit_tolerance) {
  const geometry::PlaneCutter cutter(drilled_blocks());
  const std::vector<geometry::PlaneFrame> planes = hundred_planes(Vector3(0.8, 0.3, 0.5).normalized());
  for (auto _ : state) {
    const auto sections = solver::measure_sections(cutter, planes, {.fit_tolerance = fit_tolerance, .threads = 1});
    benchmark::DoNotOptimize(sections.data());
  }
  state.SetItemsProcessed(state.iterations() * 100);
}

void measure(benchmark::State& state) {
  cut(state, 0.0);
}
BENCHMARK(measure)->Unit(benchmark::kMillisecond);

void measure_and_fit(benchmark::State& state) {
  cut(state, 1e-8);
}
BENCHMARK(measure_and_fit)->Unit(benchmark::kMillisecond);

void prepare(benchmark::State& state) {
  const geometry::Boundary<3> boundary = drilled_blocks();
  for (auto _ : state) benchmark::DoNotOptimize(geometry::PlaneCutter(boundary).size());
}
BENCHMARK(prepare)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace isorim
