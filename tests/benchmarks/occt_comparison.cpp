// How do our integrals compare with OpenCASCADE's on the same file? For every case with an expected volume: the
// relative error of the volume and the processor's time of the integration alone (area, volume, centroid and inertia)
// on one thread; ours, and each of OpenCASCADE's overloads. Whoever claims an error has it shown beside the true one.
//
//   build/bin/occt_comparison [--tolerance T] [--limit SECONDS] [CASE.toml or folder ...]
//
// default: BRepGProp::VolumeProperties and SurfaceProperties; adaptive: those with Eps; Gauss-Kronrod:
// VolumePropertiesGK (it has no area). Each runs in a process of its own that is ended after the limit.

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/case/case_file.h"
#include "io/results/compute.h"
#include "solver/properties.h"

namespace {

using namespace isorim;

/// Of the processor, which a busy machine disturbs less than the clock on the wall.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A volume, its claimed relative error (negative: none claimed) and the seconds that it took.
struct Outcome {
  double volume = 0.0;
  double claimed = -1.0;
  double seconds = 0.0;
};

/// The best of some repetitions; as many as fit into a fifth of a second.
Outcome best_of(const std::function<Outcome()>& measure) {
  Outcome best;
  const double begin = processor_seconds();
  for (int count = 0; count == 0 || (processor_seconds() - begin < 0.2 && count < 1000); ++count) {
    const double start = processor_seconds();
    Outcome outcome = measure();
    outcome.seconds = processor_seconds() - start;
    if (count == 0 || outcome.seconds < best.seconds) best = outcome;
  }
  return best;
}

/// Runs in a child process, so that neither a crash nor an endless loop of a library ends the comparison.
std::optional<Outcome> in_child(const std::function<Outcome()>& measure, unsigned limit) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  const pid_t child = fork();
  if (child == 0) {
    alarm(limit);
    const Outcome outcome = best_of(measure);
    const bool sent = write(ends[1], &outcome, sizeof outcome) == ssize_t{sizeof outcome};
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  Outcome outcome;
  const bool received = child > 0 && read(ends[0], &outcome, sizeof outcome) == ssize_t{sizeof outcome};
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return received ? std::optional(outcome) : std::nullopt;
}

// --- OpenCASCADE ----------------------------------------------------------------------------------------------

/// The solids of a file: its faces sewn, each closed shell turned outward.
TopoDS_Shape read_solids(const std::string& path) {
  IGESControl_Reader reader;
  reader.SetReadVisible(true);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return {};
  reader.TransferRoots();
  BRepBuilderAPI_Sewing sewing(1e-4);
  sewing.Add(reader.OneShape());
  sewing.Perform();
  BRep_Builder builder;
  TopoDS_Compound solids;
  builder.MakeCompound(solids);
  int shells = 0;
  for (TopExp_Explorer shell(sewing.SewedShape(), TopAbs_SHELL); shell.More(); shell.Next(), ++shells) {
    TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(shell.Current())).Solid();
    BRepLib::OrientClosedSolid(solid);
    builder.Add(solids, solid);
  }
  return shells > 0 ? TopoDS_Shape(solids) : sewing.SewedShape();
}

Outcome by_default(const TopoDS_Shape& shape) {
  GProp_GProps volume, area;
  BRepGProp::VolumeProperties(shape, volume);
  BRepGProp::SurfaceProperties(shape, area);
  return {volume.Mass()};
}

Outcome adaptively(const TopoDS_Shape& shape) {
  GProp_GProps volume, area;
  const double claimed = BRepGProp::VolumeProperties(shape, volume, 1e-9);
  BRepGProp::SurfaceProperties(shape, area, 1e-9);
  return {volume.Mass(), std::abs(claimed)};
}

Outcome by_gauss_kronrod(const TopoDS_Shape& shape) {
  GProp_GProps volume;
  const double claimed = BRepGProp::VolumePropertiesGK(shape, volume, 1e-6, false, false, true, true);
  return {volume.Mass(), std::abs(claimed)};
}

// --- Ours -----------------------------------------------------------------------------------------------------

Outcome by_isorim(const geometry::ElementTable<3>& table, double tolerance) {
  solver::PropertyOptions<3> options;
  options.integration.tolerance = tolerance;
  options.integration.threads = 1;
  const auto properties = solver::geometric_properties(table, options);
  const quadrature::Estimate& volume = properties.domain->measure;
  return {volume.value, volume.error / std::abs(volume.value)};
}

// --- The table ------------------------------------------------------------------------------------------------

std::string text_of(const std::optional<Outcome>& outcome, double exact) {
  if (!outcome) return fmt::format("{:>27}", "failed or too slow");
  const double error = std::abs(outcome->volume - exact) / std::abs(exact);
  const std::string claimed = outcome->claimed < 0.0 ? "   -   " : fmt::format("{:7.1e}", outcome->claimed);
  return fmt::format("{:7.1e} {} {:8.3f} ms", error, claimed, 1e3 * outcome->seconds);
}

struct Arguments {
  double tolerance = 1e-12;
  unsigned limit = 20;
  std::vector<std::filesystem::path> cases;
};

void compare(const std::filesystem::path& path, const Arguments& arguments) {
  const io::CaseFile file = io::read_case(path);
  const auto* keys = std::get_if<io::FileKeys>(&file.keys.geometry);
  const auto& quantities = file.keys.expect.quantities;
  const auto expected = std::ranges::find(quantities, "volume", [](const auto& quantity) { return quantity.first; });
  if (!keys || expected == quantities.end()) return;
  const double exact = expected->second.value.values.front();
  const io::AnyModel model = io::build_model(file);
  const geometry::ElementTable<3>& table = std::get<io::Model<3>>(model).table;
  const TopoDS_Shape shape = read_solids((keys->folder / keys->path).string());
  const auto row = [&](const std::function<Outcome()>& measure) {
    return text_of(in_child(measure, arguments.limit), exact);
  };
  std::fputs(
      fmt::format("{:44} | {} | {} | {} | {}\n", file.name(),
                  row([&] { return by_isorim(table, arguments.tolerance); }), row([&] { return by_default(shape); }),
                  row([&] { return adaptively(shape); }), row([&] { return by_gauss_kronrod(shape); }))
          .c_str(),
      stdout);
  std::fflush(stdout);
}

Arguments parse(int count, char** words) {
  Arguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--tolerance" && i + 1 < count) {
      arguments.tolerance = std::strtod(words[++i], nullptr);
    } else if (word == "--limit" && i + 1 < count) {
      arguments.limit = static_cast<unsigned>(std::strtoul(words[++i], nullptr, 10));
    } else if (std::filesystem::is_directory(word)) {
      for (const auto& entry : std::filesystem::directory_iterator(word))
        if (entry.path().extension() == ".toml") arguments.cases.push_back(entry.path());
    } else {
      arguments.cases.emplace_back(word);
    }
  }
  if (arguments.cases.empty()) {
    for (const auto& entry : std::filesystem::directory_iterator("cases/cad"))
      if (entry.path().extension() == ".toml") arguments.cases.push_back(entry.path());
  }
  std::ranges::sort(arguments.cases);
  return arguments;
}

}  // namespace

int main(int count, char** words) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  try {
    const Arguments arguments = parse(count, words);
    constexpr std::string_view columns = "true err claimed        time";
    std::fputs(fmt::format("{:44} | {:27} | {:27} | {:27} | {:27}\n{:44} | {:27} | {:27} | {:27} | {:27}\n", "",
                           "isorim", "OpenCASCADE, default", "OpenCASCADE, Eps = 1e-9", "OpenCASCADE, Gauss-Kronrod",
                           "case", columns, columns, columns, columns)
                   .c_str(),
               stdout);
    for (const std::filesystem::path& path : arguments.cases) compare(path, arguments);
    return 0;
  } catch (const std::exception& error) {
    std::fputs(fmt::format("occt_comparison: {}\n", error.what()).c_str(), stderr);
    return 2;
  }
}
