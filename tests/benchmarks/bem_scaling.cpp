// What do boundary elements cost against unknowns, dense and compressed side by side? And against degree and
// refinement, in the form in which others have published theirs?
//
//   build/bin/bem_scaling DIR [SERIES[/DEGREE[/REFINE]]...]
//
// Degree 2 and tolerance 1e-6 in the series sphere, sphere_large, torus, cube and elasticity, with a source outside;
// degrees 1 to 8 in `degrees`; Bembel's problems over degree and refinement, with its own patches and tolerance 1e-12,
// in peer_sphere, peer_torus and peer_neumann; a sphere in several units of length in `units`. Every solve has a
// process of its own, so that peak memory is that of the one solve. Keeps DIR/bem_scaling.csv, one row a solve (CPU
// seconds and peak memory of the whole process with its evaluation inside, the largest error there relative to the
// largest value), of which it replaces what is measured anew; and draws time and memory against unknowns for the
// sphere. Without any SERIES all are run, which takes half an hour of CPU time; `none` draws again what there is.
// OMP_NUM_THREADS=1 keeps CPU seconds free of threads that wait.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "geometry/shapes/solids.h"
#include "geometry/topology/orientation.h"
#include "io/svg/plot.h"
#include "solver/bem/evaluation.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"
#include "solver/bem/solve.h"
#include "tests/benchmarks/bem_fields.h"

namespace isorim {
namespace {

using geometry::Point3;
using geometry::Vector3;

/// A solve: the shape with every span cut into `cuts` and bisected `refine` times.
struct Run {
  std::string series;
  int cuts = 1;
  int refine = 0;
  int degree = 2;
  solver::SolveMethod method = solver::SolveMethod::compressed;
  double tolerance = 1e-6;
  /// The unit of length by that of the series.
  double scale = 1.0;
};

struct Measured {
  double unknowns = 0.0;
  double cpu_seconds = 0.0;
  double peak_megabytes = 0.0;
  double matrix_megabytes = 0.0;
  double iterations = 0.0;
  double error = 0.0;
};

geometry::Boundary<3> shape_of(const Run& run) {
  if (run.series == "torus") return geometry::torus(2.0, 0.8);
  if (run.series == "cube") return geometry::cube(1.0);
  if (run.series == "peer_torus") return geometry::sixteen_patch_torus(2.0, 0.5);
  if (run.series.starts_with("peer_")) return geometry::six_patch_sphere(1.0);
  return geometry::sphere(run.scale);
}

geometry::Boundary<3> cut(geometry::Boundary<3> boundary, int cuts) {
  for (auto& patch : boundary.patches) {
    geometry::NurbsSurface<3> surface = geometry::surface_of(patch.shape);
    for (const auto direction : {geometry::Direction::u, geometry::Direction::v}) {
      const std::vector<double> breakpoints = surface.knots(direction).breakpoints();
      for (std::size_t k = 0; k + 1 < breakpoints.size(); ++k) {
        for (int i = 1; i < cuts; ++i)
          surface = geometry::insert_knot(surface, direction,
                                          breakpoints[k] + (breakpoints[k + 1] - breakpoints[k]) * i / cuts);
      }
    }
    patch.shape = std::move(surface);
  }
  return boundary;
}

/// Kelvin's solution as displacement, or 1 / r; every component.
double source_value(bool elastic, const Point3& source, const Point3& x, Eigen::Index component) {
  const Vector3 d = x - source;
  const double r = d.norm();
  return elastic ? (component == 0 ? (3.0 - 4.0 * 0.3) / r : 0.0) + d[0] * d[component] / (r * r * r) : 1.0 / r;
}

/// The exact field, a function of place and component, and points inside.
struct Field {
  Eigen::Index components = 1;
  std::function<double(const Point3&, Eigen::Index)> value;
  geometry::Points<3> points;
};

/// A source outside the shape.
Field source_field(const std::string& series) {
  Field field;
  field.points.resize(3, 20);
  for (int i = 0; i < 20; ++i) {
    const double t = i / 20.0;
    field.points.col(i) = 0.8 * t * Vector3(0.6, -0.64, 0.48);
    if (series == "cube") field.points.col(i) = Point3(0.2 + 0.6 * t, 0.5, 0.7 - 0.3 * t);
    if (series == "torus") field.points.col(i) = 2.0 * Vector3(std::cos(6.0 * t), std::sin(6.0 * t), 0.0);
  }
  Point3 source(1.0, 0.8, 0.9);
  if (series == "cube") source = Point3(1.4, 1.3, 1.5);
  if (series == "torus") source = Point3(2.0, 0.0, 1.6);
  const bool elastic = series == "elasticity";
  field.components = elastic ? 3 : 1;
  field.value = [=](const Point3& x, Eigen::Index c) { return source_value(elastic, source, x, c); };
  return field;
}

Field field_of(const Run& run) {
  if (run.series == "peer_torus")
    return {1, [](const Point3& x, Eigen::Index) { return source_beside_torus(x); }, torus_centres()};
  if (run.series.starts_with("peer_") || run.series == "units")
    return {1, [](const Point3& x, Eigen::Index) { return saddle(x); }, run.scale * sphere_grid()};
  return source_field(run.series);
}

double inside_error(const solver::Problem<3>& problem, const solver::FieldSpace<3>& space,
                    const solver::Solution<3>& solution, const Field& field) {
  const auto found = solver::evaluate_at<3>(problem, space, solution, field.points);
  double error = 0.0;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < field.points.cols(); ++i) {
    const auto& value = found[static_cast<std::size_t>(i)].field.value;
    for (Eigen::Index c = 0; c < field.components; ++c) {
      const double exact = field.value(field.points.col(i), c);
      error = std::max(error, std::abs(value[c] - exact));
      largest = std::max(largest, std::abs(exact));
    }
  }
  return error / largest;
}

/// Values prescribed, or fluxes.
solver::Problem<3> problem_of(const Run& run, const Field& field, std::size_t elements) {
  solver::Problem<3> problem;
  if (run.series == "elasticity")
    problem.equation = solver::Elasticity<3>{1.0, 0.3};
  else
    problem.equation = solver::Laplace<3>{};
  solver::Condition<3> condition{"all", {}, {}};
  for (Eigen::Index c = 0; c < field.components; ++c) {
    const auto value = [value = field.value, c](const Point3& x, const Vector3&) { return value(x, c); };
    condition.components.push_back({solver::ConditionKind::value, prescribed<3>(value), {}});
  }
  if (run.series == "peer_neumann") {
    const auto flux = [](const Point3& x, const Vector3& n) { return saddle_gradient(x).dot(n); };
    condition.components = {{solver::ConditionKind::flux, prescribed<3>(flux), {}}};
  }
  problem.conditions.push_back(condition);
  problem.condition_of.assign(elements, 0);
  return problem;
}

/// In the process of its own.
Measured solve_here(const Run& run) {
  const Field field = field_of(run);
  solver::DiscretisationOptions<3> options;
  options.degree = run.degree;
  options.refine = run.refine;
  const auto space = solver::field_space(geometry::orient(cut(shape_of(run), run.cuts)), options);
  const auto problem = problem_of(run, field, space.elements.size());
  solver::SolveOptions solve_options;
  solve_options.method = run.method;
  solve_options.tolerance = run.tolerance;
  const auto solution = solver::solve(problem, space, solve_options);

  Measured measured;
  measured.error = inside_error(problem, space, solution, field);
  measured.cpu_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  measured.peak_megabytes = static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
  measured.unknowns = static_cast<double>(solution.unknowns);
  measured.matrix_megabytes = static_cast<double>(solution.matrix_memory) / 1e6;
  measured.iterations = solution.iterations;
  return measured;
}

/// False if the process failed.
bool solve_apart(const Run& run, Measured& measured) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    int status = 1;
    try {
      const Measured found = solve_here(run);
      if (write(ends[1], &found, sizeof found) == static_cast<ssize_t>(sizeof found)) status = 0;
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}\n", error.what());
    }
    _exit(status);
  }
  close(ends[1]);
  const bool complete = read(ends[0], &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return complete && status == 0;
}

/// Bembel's problems, degree by refinement, with a tolerance below all errors of discretisation; the same sphere in
/// metres, millimetres and kilometres.
void append_peers(std::vector<Run>& runs) {
  using solver::SolveMethod;
  for (const std::string series : {"peer_sphere", "peer_torus", "peer_neumann"}) {
    for (int degree = 1; degree <= 8; ++degree) {
      for (int refine = 1; refine <= 4; ++refine) {
        const int patches = series == "peer_torus" ? 16 : 6;
        const int side = (1 << refine) + degree;
        if (patches * side * side > 2600) continue;
        for (const SolveMethod method : {SolveMethod::dense, SolveMethod::compressed})
          runs.push_back({series, 1, refine, degree, method, 1e-12});
      }
    }
  }
  for (const double scale : {1.0, 1e3, 1e-3}) {
    for (const SolveMethod method : {SolveMethod::dense, SolveMethod::compressed})
      runs.push_back({"units", 1, 4, 2, method, 1e-8, scale});
  }
}

/// The sphere up to 50,000 unknowns, dense ones as far as 15,000 (2 GB); others up to about 15,000.
std::vector<Run> all_runs() {
  using solver::SolveMethod;
  std::vector<Run> runs;
  const auto both = [&](const std::string& series, int cuts, int refine) {
    for (const SolveMethod method : {SolveMethod::compressed, SolveMethod::dense})
      runs.push_back({series, cuts, refine, 2, method});
  };
  for (const auto& [cuts, refine] : std::vector<std::pair<int, int>>{{1, 3}, {3, 2}, {1, 4}, {3, 3}, {1, 5}})
    both("sphere", cuts, refine);
  for (const auto& [cuts, refine] : std::vector<std::pair<int, int>>{{5, 4}, {1, 6}, {3, 4}})
    runs.push_back({"sphere_large", cuts, refine});
  both("sphere_large", 5, 3);
  for (const auto& [cuts, refine] : std::vector<std::pair<int, int>>{{1, 3}, {1, 4}, {3, 3}})
    both("torus", cuts, refine);
  for (const auto& [cuts, refine] : std::vector<std::pair<int, int>>{{1, 4}, {3, 3}, {1, 5}})
    both("cube", cuts, refine);
  for (const auto& [cuts, refine] : std::vector<std::pair<int, int>>{{1, 3}, {3, 2}, {7, 1}, {1, 4}})
    both("elasticity", cuts, refine);
  for (int refine = 1; refine <= 5; ++refine) {
    for (int degree = 1; degree <= 8; ++degree) {
      if ((degree + 1) << refine <= 96) runs.push_back({"degrees", 1, refine, degree});
    }
  }
  append_peers(runs);
  return runs;
}

const char* name_of(solver::SolveMethod method) {
  return method == solver::SolveMethod::dense ? "dense" : "compressed";
}

bool is_on_sphere(const Run& run) {
  return run.series.starts_with("sphere");
}

io::svg::Series series_of(const std::vector<std::pair<Run, Measured>>& results, solver::SolveMethod method,
                          double Measured::*quantity) {
  io::svg::Series series;
  series.name = name_of(method);
  std::vector<std::pair<double, double>> points;
  for (const auto& [run, measured] : results) {
    if (!is_on_sphere(run) || run.method != method) continue;
    points.emplace_back(measured.unknowns, measured.*quantity);
  }
  std::sort(points.begin(), points.end());
  for (const auto& [unknowns, value] : points) {
    series.x.push_back(unknowns);
    series.y.push_back(value);
  }
  return series;
}

void draw(const std::vector<std::pair<Run, Measured>>& results, const std::string& title, double Measured::*quantity,
          const std::filesystem::path& path) {
  io::svg::Plot plot;
  plot.x.label = "unknowns";
  plot.y.label = title;
  plot.x.scale = plot.y.scale = io::svg::Scale::logarithmic;
  plot.width = 480;
  plot.height = 360;
  for (const auto method : {solver::SolveMethod::dense, solver::SolveMethod::compressed})
    plot.series.push_back(series_of(results, method, quantity));
  io::svg::write_svg(path, plot);
}

/// By its series, or one degree or refinement of it.
bool is_chosen(const Run& run, const std::vector<std::string>& names) {
  const std::string degree = fmt::format("{}/{}", run.series, run.degree);
  const std::string refine = fmt::format("{}/{}", degree, run.refine);
  return names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
           return name == run.series || name == degree || name == refine;
         });
}

using Results = std::vector<std::pair<Run, Measured>>;

constexpr const char* heading =
    "series,degree,cuts,refine,scale,tolerance,method,unknowns,cpu_seconds,peak_MB,matrix_MB,iterations,error";

std::string line_of(const Run& run, const Measured& measured) {
  return fmt::format("{},{},{},{},{},{:.0e},{},{},{:.2f},{:.1f},{:.1f},{},{:.2e}", run.series, run.degree, run.cuts,
                     run.refine, run.scale, run.tolerance, name_of(run.method), measured.unknowns, measured.cpu_seconds,
                     measured.peak_megabytes, measured.matrix_megabytes, measured.iterations, measured.error);
}

/// What earlier runs have left.
Results read_results(const std::filesystem::path& path) {
  Results results;
  std::ifstream file(path);
  std::string line;
  if (std::getline(file, line) && line != heading)
    throw std::runtime_error(
        fmt::format("{}: found the heading \"{}\"; expected \"{}\"", path.string(), line, heading));
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    const auto number = [&](std::size_t i) { return std::stod(cells.at(i)); };
    const auto whole = [&](std::size_t i) { return std::stoi(cells.at(i)); };
    const auto method = cells.at(6) == "dense" ? solver::SolveMethod::dense : solver::SolveMethod::compressed;
    results.push_back({{cells[0], whole(2), whole(3), whole(1), method, number(5), number(4)},
                       {number(7), number(8), number(9), number(10), number(11), number(12)}});
  }
  return results;
}

/// Replaces what was measured of the same solve.
void add_result(const Run& run, const Measured& measured, Results& results) {
  const auto key = [](const Run& r) {
    return fmt::format("{} {} {} {} {} {}", r.series, r.degree, r.cuts, r.refine, r.scale, name_of(r.method));
  };
  const auto known =
      std::find_if(results.begin(), results.end(), [&](const auto& result) { return key(result.first) == key(run); });
  if (known != results.end())
    *known = {run, measured};
  else
    results.emplace_back(run, measured);
}

void write_results(const std::filesystem::path& path, const Results& results) {
  std::ofstream table(path);
  table << heading << '\n';
  for (const auto& [run, measured] : results) table << line_of(run, measured) << '\n';
}

int run_all(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / "bem_scaling.csv";
  Results results = read_results(path);
  bool all_well = true;
  for (const Run& run : all_runs()) {
    if (!is_chosen(run, names)) continue;
    Measured measured;
    if (!solve_apart(run, measured)) {
      fmt::print(stderr, "{} refine {} degree {} failed\n", run.series, run.refine, run.degree);
      all_well = false;
      continue;
    }
    fmt::print("{}\n", line_of(run, measured));
    std::fflush(stdout);
    add_result(run, measured, results);
    write_results(path, results);
  }
  if (std::any_of(results.begin(), results.end(), [](const auto& result) { return is_on_sphere(result.first); })) {
    draw(results, "CPU seconds", &Measured::cpu_seconds, folder / "bem_time.svg");
    draw(results, "peak memory in MB", &Measured::peak_megabytes, folder / "bem_memory.svg");
  }
  return all_well ? 0 : 1;
}

}  // namespace
}  // namespace isorim

int main(int count, char** arguments) {
  if (count < 2) {
    fmt::print(stderr, "bem_scaling DIR [SERIES[/DEGREE[/REFINE]]...]\n");
    return 2;
  }
  try {
    return isorim::run_all(arguments[1], {arguments + 2, arguments + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "bem_scaling: {}\n", error.what());
    return 2;
  }
}
