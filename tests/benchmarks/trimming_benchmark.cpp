// How fast are trimmed surfaces cut into elements?
//
//   build/bin/benchmark_trimming --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
//
// ManyFaces: 3000 faces, every other one a bilinear patch, the rest biquadratic with 2 x 2 to 6 x 6 spans, each with 4
// to 40 trimming curves in up to five loops. SphereWithHole: a sphere with a hole whose one curve has 100 cubic spans.
// FineGrid: one hole in a surface of 1000 x 1000 spans.

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "geometry/bezier/element_table.h"
#include "geometry/shapes/solids.h"
#include "geometry/trimming/trimmed_surface.h"

namespace {

using namespace isorim::geometry;

/// A clockwise circle of `arcs` rational quadratic arcs, each a curve of its own.
TrimLoop hole(const Point2& centre, const Vector2& radii, int arcs) {
  TrimLoop loop;
  const double half = std::numbers::pi / arcs;
  const auto at = [&](double angle, double reach) {
    return Point2(centre + reach * radii.cwiseProduct(Vector2(std::cos(angle), -std::sin(angle))));
  };
  for (int k = 0; k < arcs; ++k) {
    Points<2> points(2, 3);
    points << at(2 * k * half, 1.0), at((2 * k + 1) * half, 1.0 / std::cos(half)), at((2 * k + 2) * half, 1.0);
    const std::vector<double> weights{1.0, std::cos(half), 1.0};
    loop.curves.push_back(NurbsCurve<2>::from_points(KnotVector::bezier(2), points, weights));
  }
  return loop;
}

NurbsSurface<3> sheet(int degree, int spans) {
  const KnotVector knots = KnotVector::clamped_uniform(degree, spans);
  const std::vector<double> places = knots.greville_abscissae();
  Points<3> points(3, knots.basis_count() * knots.basis_count());
  Eigen::Index next = 0;
  for (const double v : places)
    for (const double u : places) points.col(next++) << u, v, 0.1 * std::sin(3.0 * u * v);
  return NurbsSurface<3>::from_points(knots, knots, points);
}

Boundary<3> many_faces(int count) {
  std::mt19937 random(7);
  Boundary<3> boundary;
  for (int i = 0; i < count; ++i) {
    const NurbsSurface<3> surface = i % 2 == 0 ? sheet(1, 1) : sheet(2, 2 + static_cast<int>(random() % 5));
    std::vector<TrimLoop> loops{domain_loop(surface)};
    const int holes = static_cast<int>(random() % 5);
    for (int k = 0; k < holes; ++k) {
      const Point2 centre(k % 2 == 0 ? 0.25 : 0.75, k < 2 ? 0.25 : 0.75);
      loops.push_back(hole(centre, {0.2, 0.2}, 3 + static_cast<int>(random() % 7)));
    }
    boundary.patches.push_back({"face", TrimmedSurface(surface, loops)});
  }
  return boundary;
}

Boundary<3> sphere_with_hole() {
  const NurbsSurface<3> surface = surface_of(sphere(1.0).patches.front().shape);
  const Point2 middle(surface.knots_u().domain().middle(), surface.knots_v().domain().middle());
  const Vector2 size(surface.knots_u().domain().length(), surface.knots_v().domain().length());
  std::vector<double> breakpoints;
  for (int i = 0; i <= 100; ++i) breakpoints.push_back(i / 100.0);
  const KnotVector knots = KnotVector::periodic(3, breakpoints);
  Points<2> points(2, knots.basis_count());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double angle = -2.0 * std::numbers::pi * static_cast<double>(i) / 100.0;
    const double wave = 1.0 + 0.1 * std::sin(5.0 * angle);
    points.col(i) = middle + 0.3 * wave * size.cwiseProduct(Vector2(std::cos(angle), std::sin(angle)));
  }
  return {{{"sphere", TrimmedSurface(surface, {domain_loop(surface), {{NurbsCurve<2>::from_points(knots, points)}}})}}};
}

void cut(benchmark::State& state, const Boundary<3>& boundary) {
  std::size_t cut_elements = 0;
  std::size_t elements = 0;
  for (auto _ : state) {
    const ElementTable<3> table = bezier_elements(boundary);
    cut_elements = table.regions.size();
    elements = table.elements.size();
  }
  state.counters["elements"] = static_cast<double>(elements);
  state.counters["cut"] = static_cast<double>(cut_elements);
}

void ManyFaces(benchmark::State& state) {
  cut(state, many_faces(static_cast<int>(state.range(0))));
}

void SphereWithHole(benchmark::State& state) {
  cut(state, sphere_with_hole());
}

void FineGrid(benchmark::State& state) {
  const NurbsSurface<3> surface = sheet(1, static_cast<int>(state.range(0)));
  cut(state, {{{"sheet", TrimmedSurface(surface, {domain_loop(surface), hole({0.5, 0.5}, {0.3, 0.3}, 4)})}}});
}

}  // namespace

BENCHMARK(ManyFaces)->Arg(300)->Arg(3000)->Unit(benchmark::kMillisecond);
BENCHMARK(SphereWithHole)->Unit(benchmark::kMillisecond);
BENCHMARK(FineGrid)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);
