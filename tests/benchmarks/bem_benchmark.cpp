// Boundary elements against published and measured figures, with CPU seconds of the whole run (both fields and the
// evaluation at points, all threads), unknowns, iterations and errors. Peak memory is that of the process so far: take
// one at a time with --benchmark_filter to read it.

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "geometry/shapes/curves.h"
#include "geometry/shapes/regions.h"
#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "quadrature/rim.h"
#include "quadrature/target_rules.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"
#include "tests/benchmarks/bem_fields.h"

namespace isorim::solver {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Vector2;
using geometry::Vector3;
using std::numbers::pi;

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void report(benchmark::State& state, std::size_t unknowns, int iterations, double error) {
  state.counters["unknowns"] = static_cast<double>(unknowns);
  state.counters["iterations"] = iterations;
  state.counters["relative_error"] = error;
  state.counters["peak_MB"] = peak_megabytes();
}

FieldSpace<3> space_on(const geometry::Boundary<3>& boundary, int degree, int refine) {
  DiscretisationOptions<3> options;
  options.degree = degree;
  options.refine = refine;
  return field_space(geometry::orient(boundary), options);
}

/// Interior Laplace with values prescribed; the largest error at the points by the largest value there.
void run_dirichlet(benchmark::State& state, const FieldSpace<3>& space, const std::function<double(const Point3&)>& u,
                   const geometry::Points<3>& points, const SolveOptions& options) {
  Problem<3> problem;
  problem.equation = Laplace<3>{};
  problem.conditions.push_back(
      {"all", {{ConditionKind::value, prescribed<3>([u](const Point3& x, const Vector3&) { return u(x); }), {}}}, {}});
  problem.condition_of.assign(space.elements.size(), 0);
  const Solution<3> solution = solve(problem, space, options);
  const auto found = evaluate_at<3>(problem, space, solution, points);
  double error = 0.0;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double exact = u(points.col(i));
    error = std::max(error, std::abs(found[static_cast<std::size_t>(i)].field.value[0] - exact));
    largest = std::max(largest, std::abs(exact));
  }
  report(state, solution.unknowns, solution.iterations, error / largest);
}

/// u = 4 x^2 - 3 y^2 - z^2 in the unit sphere; 10^3 points in [-1/4, 1/4]^3. Arguments: degree, refinement, -log10 of
/// the tolerance.
void sphere(benchmark::State& state) {
  const geometry::Points<3> points = sphere_grid();
  for ([[maybe_unused]] auto _ : state) {
    SolveOptions options;
    options.tolerance = std::pow(10.0, -static_cast<double>(state.range(2)));
    const auto space =
        space_on(geometry::sphere(1.0), static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    run_dirichlet(state, space, saddle, points, options);
  }
}
BENCHMARK(sphere)
    ->Args({4, 1, 7})
    ->Args({6, 1, 8})
    ->Args({8, 1, 10})
    ->Args({12, 1, 13})
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->MeasureProcessCPUTime();

/// The torus with its long parameter lines cut `cuts` times in each quarter.
geometry::Boundary<3> cut_torus(int cuts) {
  geometry::Boundary<3> torus = geometry::torus(2.0, 0.5);
  geometry::NurbsSurface<3> surface = geometry::surface_of(torus.patches[0].shape);
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (int cut = 1; cut <= cuts; ++cut) {
      const double u = (quarter + cut / (cuts + 1.0)) / 4.0;
      surface = geometry::insert_knot(surface, geometry::Direction::u, u);
    }
  }
  torus.patches[0].shape = surface;
  return torus;
}

/// A source at 0.75 above the torus R = 2, r = 0.5; 64 points on its centre circle. Arguments: degree, cuts, 0 for the
/// dense and 1 for the compressed matrix.
void torus(benchmark::State& state) {
  const geometry::Points<3> points = torus_centres();
  for ([[maybe_unused]] auto _ : state) {
    SolveOptions options;
    options.tolerance = 1e-8;
    options.method = state.range(2) == 0 ? SolveMethod::dense : SolveMethod::compressed;
    const auto space = space_on(cut_torus(static_cast<int>(state.range(1))), static_cast<int>(state.range(0)), 0);
    run_dirichlet(state, space, source_beside_torus, points, options);
  }
}
BENCHMARK(torus)
    ->Args({6, 1, 0})
    ->Args({7, 1, 0})
    ->Args({7, 1, 1})
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->MeasureProcessCPUTime();

/// Kirsch's field for tension 1 along x: displacement and stress (plane strain).
struct Kirsch {
  double mu = 1e5 / 2.6;
  double nu = 0.3;

  Vector2 displacement(const Point2& x) const {
    const double r = x.norm(), th = std::atan2(x[1], x[0]), kappa = 3.0 - 4.0 * nu;
    const double a2 = 1.0 / (r * r), a4 = a2 * a2, c = std::cos(2.0 * th), s = std::sin(2.0 * th);
    const double scale = r / (8.0 * mu);
    const double ur = scale * (kappa - 1.0 + 2.0 * c + 2.0 * a2 * (1.0 + (kappa + 1.0) * c) - 2.0 * a4 * c);
    const double ut = scale * s * (-2.0 + 2.0 * a2 * (1.0 - kappa) - 2.0 * a4);
    return {ur * std::cos(th) - ut * std::sin(th), ur * std::sin(th) + ut * std::cos(th)};
  }
  Vector2 traction(const Point2& x, const Vector2& n) const {
    const double r = x.norm(), th = std::atan2(x[1], x[0]);
    const double a2 = 1.0 / (r * r), a4 = a2 * a2, c = std::cos(2.0 * th), s = std::sin(2.0 * th);
    const double sr = 0.5 * (1.0 - a2) + 0.5 * (1.0 - 4.0 * a2 + 3.0 * a4) * c;
    const double st = 0.5 * (1.0 + a2) - 0.5 * (1.0 + 3.0 * a4) * c;
    const double srt = -0.5 * (1.0 + 2.0 * a2 - 3.0 * a4) * s;
    Eigen::Matrix2d turn;
    turn << std::cos(th), -std::sin(th), std::sin(th), std::cos(th);
    Eigen::Matrix2d stress;
    stress << sr, srt, srt, st;
    return turn * stress * turn.transpose() * n;
  }
};

FieldSpace<2> quarter_plate(int degree, int refine) {
  const std::vector<std::vector<geometry::NurbsCurve<2>>> loop{
      {geometry::line_segment<2>({1, 0}, {4, 0}), geometry::line_segment<2>({4, 0}, {4, 4}),
       geometry::line_segment<2>({4, 4}, {0, 4}), geometry::line_segment<2>({0, 4}, {0, 1}),
       geometry::circular_arc(1.0, {0, 0}, 0.5 * pi, 0.0)}};
  DiscretisationOptions<2> options;
  options.degree = degree;
  options.refine = refine;
  return field_space(geometry::orient(geometry::region(loop)), options);
}

Problem<2> kirsch_problem(const Kirsch& exact, const FieldSpace<2>& space) {
  Problem<2> problem;
  problem.equation = Elasticity<2>{exact.mu, exact.nu, logarithm_length(space.table)};
  const auto traction = [exact](int i) {
    return prescribed<2>([exact, i](const Point2& x, const Vector2& n) { return exact.traction(x, n)[i]; });
  };
  const ComponentCondition<2> fixed{ConditionKind::value, {}, {}};
  const ComponentCondition<2> open{ConditionKind::flux, {}, {}};
  problem.conditions = {{"y = 0", {open, fixed}, {}},
                        {"outer", {{ConditionKind::flux, traction(0), {}}, {ConditionKind::flux, traction(1), {}}}, {}},
                        {"x = 0", {fixed, open}, {}},
                        {"hole", {open, open}, {}}};
  const std::vector<std::int32_t> of_patch{0, 1, 1, 2, 3};
  for (const auto& element : space.table.elements)
    problem.condition_of.push_back(of_patch[static_cast<std::size_t>(element.patch)]);
  return problem;
}

/// int |u - u_h| ds / int |u| ds.
double displacement_error(const Kirsch& exact, const FieldSpace<2>& space, const Solution<2>& solution) {
  const quadrature::TargetRules<2> rules(space.table, {1e-12, 10});
  double error = 0.0;
  double norm = 0.0;
  std::vector<double> basis;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const auto nodes = rules.far_nodes(e, 0.5 * rules.sphere(e).radius);
    const auto functions = space.functions_of(e);
    basis.resize(functions.size());
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      basis_values(space, e, geometry::Point<1>(nodes.place[0][q]), std::span<double>(basis));
      Vector2 u = Vector2::Zero();
      for (std::size_t a = 0; a < functions.size(); ++a)
        u += basis[a] * solution.potential.row(functions[a]).transpose();
      const Vector2 known = exact.displacement({nodes.position[0][q], nodes.position[1][q]});
      error += nodes.weight[q] * (u - known).norm();
      norm += nodes.weight[q] * known.norm();
    }
  }
  return error / norm;
}

/// A quarter of the plate 4 x 4 with a hole of radius 1, exact tractions outside. Arguments: degree, refinement.
void kirsch(benchmark::State& state) {
  const Kirsch exact;
  for ([[maybe_unused]] auto _ : state) {
    const FieldSpace<2> space = quarter_plate(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    SolveOptions options;
    options.tolerance = 1e-12;
    const Solution<2> solution = solve(kirsch_problem(exact, space), space, options);
    report(state, solution.unknowns, solution.iterations, displacement_error(exact, space, solution));
  }
}
BENCHMARK(kirsch)
    ->ArgsProduct({{2}, {0, 1, 2, 3, 4, 5}})
    ->ArgsProduct({{4, 5, 8}, {0, 1, 2, 3}})
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->MeasureProcessCPUTime();

/// Dense and compressed matrices side by side: a source outside the unit sphere, values prescribed. Arguments:
/// refinement (degree 2), 0 for dense and 1 for compressed. Larger ones: bem_scaling.cpp.
void compression(benchmark::State& state) {
  geometry::Points<3> points(3, 20);
  for (int i = 0; i < 20; ++i) points.col(i) = 0.04 * i * Vector3(0.6, -0.64, 0.48);
  for ([[maybe_unused]] auto _ : state) {
    SolveOptions options;
    options.tolerance = 1e-6;
    options.method = state.range(1) == 0 ? SolveMethod::dense : SolveMethod::compressed;
    const auto space = space_on(geometry::sphere(1.0), 2, static_cast<int>(state.range(0)));
    run_dirichlet(
        state, space, [](const Point3& x) { return 1.0 / (x - Point3(1.0, 0.8, 0.9)).norm(); }, points, options);
  }
}
BENCHMARK(compression)->ArgsProduct({{3, 4}, {1, 0}})->Iterations(1)->Unit(benchmark::kSecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace isorim::solver
