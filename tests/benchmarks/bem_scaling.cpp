// What do boundary elements cost against unknowns, dense and compressed side by side?
//
//   build/bin/bem_scaling DIR [NAME...]
//
// Interior problems with a source outside and degree 2, tolerance 1e-6; every solve in a process of its own, so that
// peak memory is that of the one solve. Writes DIR/bem_scaling.csv (one row a solve: CPU seconds and peak memory of
// the whole process, relative error at points inside) and pictures of time and memory against unknowns for the sphere.
// NAMEs choose among the series below; without any all are run, which takes an hour of CPU time.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
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
};

struct Measured {
  double unknowns = 0.0;
  double cpu_seconds = 0.0;
  double peak_megabytes = 0.0;
  double matrix_megabytes = 0.0;
  double iterations = 0.0;
  double error = 0.0;
};

geometry::Boundary<3> shape_of(const std::string& series) {
  if (series == "torus") return geometry::torus(2.0, 0.8);
  if (series == "cube") return geometry::cube(1.0);
  return geometry::sphere(1.0);
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

/// A source outside the shape, and points inside.
struct Field {
  Point3 source;
  geometry::Points<3> points;
};

Field field_of(const std::string& series) {
  Field field{Point3(1.0, 0.8, 0.9), geometry::Points<3>(3, 20)};
  for (int i = 0; i < 20; ++i) {
    const double t = i / 20.0;
    field.points.col(i) = 0.8 * t * Vector3(0.6, -0.64, 0.48);
    if (series == "cube") field.points.col(i) = Point3(0.2 + 0.6 * t, 0.5, 0.7 - 0.3 * t);
    if (series == "torus") field.points.col(i) = 2.0 * Vector3(std::cos(6.0 * t), std::sin(6.0 * t), 0.0);
  }
  if (series == "cube") field.source = Point3(1.4, 1.3, 1.5);
  if (series == "torus") field.source = Point3(2.0, 0.0, 1.6);
  return field;
}

quadrature::IntegrandFactory<3> data(std::function<double(const Point3&)> function) {
  return [function = std::move(function)]() -> quadrature::Integrand<3> {
    return [function](const Eigen::Ref<const geometry::Points<3>>& points, const Eigen::Ref<const geometry::Points<3>>&,
                      std::span<double> values) {
      for (Eigen::Index q = 0; q < points.cols(); ++q) values[static_cast<std::size_t>(q)] = function(points.col(q));
    };
  };
}

/// Kelvin's solution as displacement, or 1 / r; every component.
double exact_value(bool elastic, const Point3& source, const Point3& x, Eigen::Index component) {
  const Vector3 d = x - source;
  const double r = d.norm();
  return elastic ? (component == 0 ? (3.0 - 4.0 * 0.3) / r : 0.0) + d[0] * d[component] / (r * r * r) : 1.0 / r;
}

double inside_error(const solver::Problem<3>& problem, const solver::FieldSpace<3>& space,
                    const solver::Solution<3>& solution, const Field& field, bool elastic) {
  const auto found = solver::evaluate_at<3>(problem, space, solution, field.points);
  double error = 0.0;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < field.points.cols(); ++i) {
    const auto& value = found[static_cast<std::size_t>(i)].field.value;
    for (Eigen::Index c = 0; c < (elastic ? 3 : 1); ++c) {
      const double exact = exact_value(elastic, field.source, field.points.col(i), c);
      error = std::max(error, std::abs(value[c] - exact));
      largest = std::max(largest, std::abs(exact));
    }
  }
  return error / largest;
}

/// In the process of its own.
Measured solve_here(const Run& run) {
  const bool elastic = run.series == "elasticity";
  const Field field = field_of(run.series);
  solver::DiscretisationOptions<3> options;
  options.degree = run.degree;
  options.refine = run.refine;
  const auto space = solver::field_space(geometry::orient(cut(shape_of(run.series), run.cuts)), options);
  solver::Problem<3> problem;
  if (elastic)
    problem.equation = solver::Elasticity<3>{1.0, 0.3};
  else
    problem.equation = solver::Laplace<3>{};
  solver::Condition<3> condition{"all", {}, {}};
  for (Eigen::Index c = 0; c < (elastic ? 3 : 1); ++c) {
    const auto value = [=, source = field.source](const Point3& x) { return exact_value(elastic, source, x, c); };
    condition.components.push_back({solver::ConditionKind::value, data(value), {}});
  }
  problem.conditions.push_back(condition);
  problem.condition_of.assign(space.elements.size(), 0);
  solver::SolveOptions solve_options;
  solve_options.method = run.method;
  solve_options.tolerance = 1e-6;
  const auto solution = solver::solve(problem, space, solve_options);

  Measured measured;
  measured.cpu_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  measured.peak_megabytes = static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
  measured.unknowns = static_cast<double>(solution.unknowns);
  measured.matrix_megabytes = static_cast<double>(solution.matrix_memory) / 1e6;
  measured.iterations = solution.iterations;
  measured.error = inside_error(problem, space, solution, field, elastic);
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
  for (int refine = 1; refine <= 4; ++refine) {
    for (int degree = 1; degree <= 8; ++degree) {
      if ((degree + 1) << refine <= 48) runs.push_back({"degrees", 1, refine, degree});
    }
  }
  return runs;
}

const char* name_of(solver::SolveMethod method) {
  return method == solver::SolveMethod::dense ? "dense" : "compressed";
}

io::svg::Series series_of(const std::vector<std::pair<Run, Measured>>& results, solver::SolveMethod method,
                          double Measured::*quantity) {
  io::svg::Series series;
  series.name = name_of(method);
  std::vector<std::pair<double, double>> points;
  for (const auto& [run, measured] : results) {
    if (!run.series.starts_with("sphere") || run.method != method) continue;
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

int run_all(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  std::filesystem::create_directories(folder);
  std::ofstream table(folder / "bem_scaling.csv");
  table << "series,degree,cuts,refine,method,unknowns,cpu_seconds,peak_MB,matrix_MB,iterations,error\n";
  std::vector<std::pair<Run, Measured>> results;
  bool all_well = true;
  for (const Run& run : all_runs()) {
    if (!names.empty() && std::find(names.begin(), names.end(), run.series) == names.end()) continue;
    Measured measured;
    if (!solve_apart(run, measured)) {
      fmt::print(stderr, "{} refine {} degree {} failed\n", run.series, run.refine, run.degree);
      all_well = false;
      continue;
    }
    const std::string line =
        fmt::format("{},{},{},{},{},{},{:.2f},{:.1f},{:.1f},{},{:.2e}\n", run.series, run.degree, run.cuts, run.refine,
                    name_of(run.method), measured.unknowns, measured.cpu_seconds, measured.peak_megabytes,
                    measured.matrix_megabytes, measured.iterations, measured.error);
    table << line << std::flush;
    fmt::print("{}", line);
    std::fflush(stdout);
    results.emplace_back(run, measured);
  }
  draw(results, "CPU seconds", &Measured::cpu_seconds, folder / "bem_time.svg");
  draw(results, "peak memory in MB", &Measured::peak_megabytes, folder / "bem_memory.svg");
  return all_well ? 0 : 1;
}

}  // namespace
}  // namespace isorim

int main(int count, char** arguments) {
  if (count < 2) {
    fmt::print(stderr, "bem_scaling DIR [NAME...]\n");
    return 2;
  }
  return isorim::run_all(arguments[1], {arguments + 2, arguments + count});
}
