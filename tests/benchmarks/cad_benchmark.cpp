#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "geometry/shapes/transforms.h"
#include "io/cad/assemble.h"
#include "io/cad/read_cad.h"
#include "io/results/compute.h"
#include "solver/properties.h"

/// A large IGES file on two threads: 3570 trimmed faces in 510 solids, read, assembled, matched and oriented,
/// integrated. The file is made here by repeating the plate with a round hole of cases/cad; its volume is known.
namespace isorim::io {
namespace {

using geometry::NurbsCurve;
using geometry::NurbsSurface;

/// Writes IGES entities into a text that grows.
class IgesText {
 public:
  /// Adds an entity; returns the sequence number of its directory entry.
  int add(int type, const std::string& status, const std::string& parameters) {
    const int number = 2 * entity_count_++ + 1;
    const int first_line = parameter_line_ + 1;
    append_parameters(fmt::format("{},{};", type, parameters), number);
    directory_ += fmt::format("{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:>8}D{:07}\n", type, first_line, 0, 0, 0, 0, 0, 0,
                              status, number);
    directory_ += fmt::format("{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}D{:07}\n", type, 0, 0,
                              parameter_line_ - first_line + 1, 0, "", "", "", 0, number + 1);
    return number;
  }

  std::string text() const {
    const std::string global = "1H,,1H;,5Hplate,9Hplate.igs,6Hisorim,6Hisorim,32,308,15,308,15,5Hplate,";
    const std::string more = "1.0,2,2HMM,1,0.01,15H20260101.000000,1E-9,1000.0,6Hisorim,6Hisorim,11,0;";
    std::string result =
        fmt::format("{:72}S0000001\n{:72}G0000001\n{:72}G0000002\n", "A pattern of plates", global, more);
    result += directory_ + parameters_;
    return result + fmt::format("S{:7}G{:7}D{:7}P{:7}{:40}T0000001\n", 1, 2, 2 * entity_count_, parameter_line_, "");
  }

 private:
  /// Lines of 64 columns, broken after commas.
  void append_parameters(const std::string& record, int number) {
    for (std::size_t begin = 0; begin < record.size();) {
      std::size_t length = std::min<std::size_t>(64, record.size() - begin);
      if (begin + length < record.size()) length = record.rfind(',', begin + length - 1) + 1 - begin;
      parameters_ += fmt::format("{:64}{:8}P{:07}\n", record.substr(begin, length), number, ++parameter_line_);
      begin += length;
    }
  }

  std::string directory_;
  std::string parameters_;
  int entity_count_ = 0;
  int parameter_line_ = 0;
};

template <class Range>
std::string reals(const Range& range) {
  std::string text;
  for (const double x : range) text += fmt::format(",{:.17G}", x).append(x == static_cast<int>(x) ? "." : "");
  return text;
}

template <int Dim>
std::string coordinates(const geometry::Points<Dim>& points) {
  std::string text;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    text += reals(std::vector<double>{points(0, i), points(1, i), Dim == 3 ? points(Dim - 1, i) : 0.0});
  }
  return text;
}

int add_pcurve(IgesText& text, const NurbsCurve<2>& curve) {
  const geometry::Interval domain = curve.domain();
  return text.add(126, "00010500",
                  fmt::format("{},{},1,0,{},0{}{}{}{},0.,0.,1.", curve.knots().basis_count() - 1, curve.degree(),
                              curve.is_polynomial() ? 1 : 0, reals(curve.knots().knots()), reals(curve.weights()),
                              coordinates<2>(curve.control_points()), reals(std::vector{domain.first, domain.last})));
}

int add_surface(IgesText& text, const NurbsSurface<3>& surface) {
  const geometry::Interval u = surface.knots_u().domain();
  const geometry::Interval v = surface.knots_v().domain();
  return text.add(
      128, "00010000",
      fmt::format("{},{},{},{},0,0,{},0,0{}{}{}{}{}", surface.count_u() - 1, surface.count_v() - 1,
                  surface.knots_u().degree(), surface.knots_v().degree(), surface.is_polynomial() ? 1 : 0,
                  reals(surface.knots_u().knots()), reals(surface.knots_v().knots()), reals(surface.weights()),
                  coordinates<3>(surface.control_points()), reals(std::vector{u.first, u.last, v.first, v.last})));
}

void add_face(IgesText& text, const geometry::SurfaceShape& face) {
  const int surface = add_surface(text, geometry::surface_of(face));
  const std::vector<geometry::TrimLoop> face_loops = geometry::trim_loops(face);
  std::string loops;
  for (const geometry::TrimLoop& loop : face_loops) {
    std::string curves;
    for (const NurbsCurve<2>& curve : loop.curves) curves += fmt::format(",{}", add_pcurve(text, curve));
    const int composite = text.add(102, "00010500", fmt::format("{}{}", loop.curves.size(), curves));
    loops += fmt::format(",{}", text.add(142, "00010500", fmt::format("0,{},{},0,1", surface, composite)));
  }
  text.add(144, "00000000", fmt::format("{},1,{}{}", surface, face_loops.size() - 1, loops));
}

constexpr int copies = 510;
/// Of the plate 2 x 2 x 1 with a hole of radius 0.5.
constexpr double plate_volume = 3.2146018366025517;

std::filesystem::path write_pattern() {
  const std::filesystem::path source = std::filesystem::path(ISORIM_SOURCE_DIR) / "cases/cad";
  const AssembledModel plate = assemble(read_cad(source / "box_cyl_hole_nurbs_faces_p17.igs"));
  IgesText text;
  for (int i = 0; i < copies; ++i) {
    const auto move = geometry::translation<3>(geometry::Vector3(3.0 * (i % 20), 3.0 * (i / 20 % 20), 3.0 * (i / 400)));
    for (const auto& patch : std::get<geometry::Boundary<3>>(plate.boundary).patches) {
      add_face(text, geometry::transform(patch.shape, move));
    }
  }
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "isorim_benchmark_pattern.igs";
  std::ofstream(path, std::ios::binary) << text.text();
  return path;
}

class Stopwatch {
 public:
  /// Seconds since the last call.
  double lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

void pattern_of_plates(benchmark::State& state) {
  const std::filesystem::path path = write_pattern();
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  constexpr int threads = 2;
  double read = 0.0;
  double match = 0.0;
  double integrate = 0.0;
  double error = 0.0;
  for ([[maybe_unused]] auto round : state) {
    Stopwatch watch;
    const CadModel cad = read_cad(path);
    read += watch.lap();
    const AssembledModel assembled = assemble(cad, {.threads = threads});
    const auto oriented = geometry::orient<3>(std::get<geometry::Boundary<3>>(assembled.boundary));
    match += watch.lap();
    if (!oriented.topology.closed || oriented.boundary.patches.size() != 7 * copies) {
      state.SkipWithError("the pattern is not closed");
      break;
    }
    const auto table = geometry::bezier_elements(oriented.boundary);
    solver::PropertyOptions<3> options;
    options.integration.tolerance = 1e-9;
    options.integration.threads = threads;
    error = solver::geometric_properties(table, options).domain->measure.value / (copies * plate_volume) - 1.0;
    integrate += watch.lap();
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["MB"] = size / 1e6;
  state.counters["faces"] = 7.0 * copies;
  state.counters["read_s"] = read / rounds;
  state.counters["match_s"] = match / rounds;
  state.counters["integrate_s"] = integrate / rounds;
  state.counters["rel_error"] = error;
  std::filesystem::remove(path);
}
BENCHMARK(pattern_of_plates)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace isorim::io
