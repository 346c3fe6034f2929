#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <benchmark/benchmark.h>

#include "geometry/hull/hull.h"
#include "geometry/hull/offset_table.h"
#include "solver/hydrostatics/floating_body.h"
#include "solver/hydrostatics/hydrostatics.h"
#include "solver/hydrostatics/immersed_body.h"
#include "solver/hydrostatics/stability.h"

/// A ship's hull of 23 x 11 offsets, heeled by 20 degrees: the exact surface against triangles with their corners on it
/// that are clipped at the water, as panel programs do. Error: of the volume, against the exact surface's.
namespace isorim {
namespace {

using geometry::Point3;
using geometry::Vector3;

/// Wigley's hull with a fuller after body, so that nothing is polynomial.
geometry::Boundary<3> ship() {
  geometry::OffsetTable table = geometry::wigley_offsets(100.0, 16.0, 8.0, 23, 11);
  for (Eigen::Index i = 0; i < table.half_breadths.cols(); ++i) {
    const double x = table.stations[static_cast<std::size_t>(i)] / table.length;
    table.half_breadths.col(i) *= 1.0 - 0.3 * x + 0.2 * std::sin(4.0 * x);
  }
  return geometry::hull_solid(table);
}

solver::WaterPlane heeled_plane() {
  const double heel = std::numbers::pi / 9.0;
  const Vector3 up(0.0, std::sin(heel), std::cos(heel));
  return {up, up.dot(Point3(0.0, 0.0, 5.0))};
}

double exact_volume() {
  static const double volume = [] {
    const solver::FloatingBody body(ship());
    const solver::WaterPlane plane = heeled_plane();
    return solver::immersed_body(body, plane, body.wetted(plane)).volume.value;
  }();
  return volume;
}

using Triangle = std::array<Point3, 3>;

std::vector<Triangle> triangles_of(const geometry::Boundary<3>& boundary, int cells) {
  std::vector<Triangle> triangles;
  for (const geometry::Patch<3>& patch : boundary.patches) {
    const auto& surface = std::get<geometry::NurbsSurface<3>>(patch.shape);
    const geometry::Interval u = surface.knots_u().domain();
    const geometry::Interval v = surface.knots_v().domain();
    const auto at = [&](int i, int j) {
      return geometry::evaluate(surface, {u.first + u.length() * i / (4 * cells), v.first + v.length() * j / cells});
    };
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < 4 * cells; ++i) {
        const Point3 a = at(i, j);
        const Point3 b = at(i + 1, j);
        const Point3 c = at(i + 1, j + 1);
        const Point3 d = at(i, j + 1);
        const bool turned = patch.orientation < 0;
        triangles.push_back(turned ? Triangle{a, c, b} : Triangle{a, b, c});
        triangles.push_back(turned ? Triangle{a, d, c} : Triangle{a, c, d});
      }
    }
  }
  return triangles;
}

/// Of the pyramids over the parts under water, from a point on the plane.
double clipped_volume(const std::vector<Triangle>& triangles, const solver::WaterPlane& plane) {
  const Point3 pole = plane.offset * plane.up;
  double volume = 0.0;
  for (const Triangle& triangle : triangles) {
    std::array<Point3, 4> kept;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3& a = triangle[k];
      const Point3& b = triangle[(k + 1) % 3];
      const double da = plane.up.dot(a) - plane.offset;
      const double db = plane.up.dot(b) - plane.offset;
      if (da < 0.0) kept[count++] = a;
      if ((da < 0.0) != (db < 0.0)) kept[count++] = a + da / (da - db) * (b - a);
    }
    for (std::size_t k = 2; k < count; ++k)
      volume += (kept[0] - pole).dot((kept[k - 1] - pole).cross(kept[k] - pole)) / 6.0;
  }
  return volume;
}

void prepare_body(benchmark::State& state) {
  const geometry::Boundary<3> hull = ship();
  for (auto _ : state) {
    const solver::FloatingBody body(hull, {.threads = 1});
    benchmark::DoNotOptimize(body.volume());
  }
}
BENCHMARK(prepare_body)->Unit(benchmark::kMillisecond);

void heeled_plane_exactly(benchmark::State& state) {
  const solver::FloatingBody body(ship(), {.threads = 1});
  const solver::WaterPlane plane = heeled_plane();
  double volume = 0.0;
  for (auto _ : state) {
    volume = solver::immersed_body(body, plane, body.wetted(plane)).volume.value;
    benchmark::DoNotOptimize(volume);
  }
  state.counters["error"] = std::abs(volume / exact_volume() - 1.0);
}
BENCHMARK(heeled_plane_exactly)->Unit(benchmark::kMillisecond);

/// The volume alone.
void heeled_plane_of_triangles(benchmark::State& state) {
  const std::vector<Triangle> triangles = triangles_of(ship(), static_cast<int>(state.range(0)));
  const solver::WaterPlane plane = heeled_plane();
  double volume = 0.0;
  for (auto _ : state) {
    volume = clipped_volume(triangles, plane);
    benchmark::DoNotOptimize(volume);
  }
  state.counters["triangles"] = static_cast<double>(triangles.size());
  state.counters["error"] = std::abs(volume / exact_volume() - 1.0);
}
BENCHMARK(heeled_plane_of_triangles)->Arg(10)->Arg(40)->Arg(160)->Arg(640)->Unit(benchmark::kMillisecond);

/// 17 heels with free trim, zeros and the largest arm.
void righting_arms(benchmark::State& state) {
  const solver::FloatingBody body(ship(), {.threads = 1});
  const solver::Loading loading{0.5 * body.volume(), {0.0, 0.0, 5.0}};
  std::vector<double> heels;
  for (int k = 0; k <= 16; ++k) heels.push_back(5.0 * k * std::numbers::pi / 180.0);
  solver::RightingOptions options;
  options.threads = 1;
  for (auto _ : state) {
    const solver::RightingCurve curve = solver::righting_curve(body, loading, heels, options);
    benchmark::DoNotOptimize(curve.points.data());
  }
}
BENCHMARK(righting_arms)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace isorim
