#include <chrono>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/analysis/solution_pictures.h"
#include "io/cli/commands.h"
#include "io/cli/interrupts.h"
#include "io/fit/fit_pictures.h"
#include "io/hull/lines_plan.h"
#include "io/hydrostatics/hydrostatics_report.h"
#include "io/results/compute.h"
#include "io/results/convergence.h"
#include "io/results/drawings.h"
#include "io/results/hdf5.h"
#include "io/results/json.h"
#include "io/results/pictures.h"
#include "io/results/plane_sections.h"
#include "io/results/table.h"

namespace isorim::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Of an analysis: fields on the boundary, probes and grids.
void write_fields(const io::AnyModel& model, const io::Report& report, const std::filesystem::path& folder) {
  io::write_solution_vtu(folder / "solution.vtu", model, *report.fields);
  io::write_fields_vtu(folder / "fields.vtu", *report.fields, report.threads);
  io::write_samples(folder, *report.analysis);
}

void write_outputs(const io::CaseFile& file, const io::AnyModel& model, const io::Convergence& study,
                   io::Report& report, const std::filesystem::path& folder) {
  const HeldInterrupts held;
  const Clock::time_point start = Clock::now();
  make_folder(folder);
  const io::OutputKeys& output = file.keys.output;
  if (output.vtk) io::write_boundary_vtu(folder / "boundary.vtu", model);
  if (output.vtk && io::has_edges(model)) io::write_edges_vtu(folder / "edges.vtu", model);
  if (output.vtk && report.fields) write_fields(model, report, folder);
  if (output.stl) io::write_boundary_stl(folder / "boundary.stl", file, model);
  if (output.svg) io::write_boundary_svg(folder / "boundary.svg", report.title, model);
  if (output.svg) io::write_tmesh_svgs(folder, file.shape);
  if (report.sections) io::write_sections(folder, *report.sections, output);
  for (std::string& message : io::write_drawings(folder, file, model, report.threads))
    report.warnings.push_back(std::move(message));
  if (report.hydrostatics) io::write_hydrostatics(folder, *report.hydrostatics, output);
  if (file.fit) io::write_fit_points(folder / "fit_points.csv", *file.fit);
  if (file.fit && output.svg) io::write_fit_svg(folder / "fit.svg", report.title, *file.fit);
  if (file.hull && file.keys.lines_plan) io::write_lines_plan(folder, *file.hull, *file.keys.lines_plan);
  if (file.keys.convergence) {
    io::write_convergence_csv(folder / "convergence.csv", study);
    io::write_convergence_svg(folder / "convergence.svg", report.title, study);
  }
  report.timings.write = seconds_since(start);
  if (output.hdf5) io::write_hdf5(folder / "results.h5", report, model);
  report.timings.write = seconds_since(start);
  // Last: whoever finds it finds the rest as well.
  io::write_json(folder / "results.json", report);
}

}  // namespace

std::vector<std::string> shortfalls(const io::Report& report) {
  std::vector<std::string> lines;
  std::vector<std::string> unreached;
  for (const auto* list : {&report.properties, &report.integrals}) {
    for (const io::Quantity& quantity : *list) {
      if (quantity.status == quadrature::Status::tolerance_not_reached) unreached.push_back(quantity.name);
    }
  }
  if (!unreached.empty()) lines.push_back(fmt::format("the tolerance is not reached: {}", fmt::join(unreached, ", ")));
  if (report.analysis && report.analysis->adaptive && !report.analysis->adaptive->is_reached())
    lines.push_back(report.analysis->adaptive->shortfall);
  for (const io::ExpectationResult& result : report.expectations) {
    if (result.met) continue;
    const std::string off = result.difference ? fmt::format("off by {:.2g}", *result.difference) : "without a value";
    lines.push_back(fmt::format("the expectation of {} is missed: {}; expected at most atol = {:g}, rtol = {:g}",
                                result.quantity, off, result.atol, result.rtol));
  }
  return lines;
}

io::Report compute_and_write(const io::CaseFile& file, Clock::time_point start, const io::RunOptions& options,
                             const std::optional<std::filesystem::path>& folder) {
  const io::AnyModel model = io::build_model(file);
  const double read = seconds_since(start);
  io::Report report = io::compute(file, model, options);
  const io::Convergence study = io::study_convergence(file, model, options);
  report.timings.read = read;
  if (folder) write_outputs(file, model, study, report, *folder);
  return report;
}

int run_case(const RunArguments& arguments, std::ostream& out, std::ostream& err) {
  const Clock::time_point start = Clock::now();
  const io::CaseFile file =
      io::read_case_or_cad(arguments.case_file, arguments.overrides, {.threads = arguments.threads});
  const std::filesystem::path folder = arguments.output.value_or(std::filesystem::path("out") / file.name());
  io::Report report;
  {
    ProgressLine progress(err);
    report = compute_and_write(file, start, {arguments.threads, progress.reporter()}, folder);
  }
  for (const std::string& warning : report.warnings) {
    print_message(err, fmt::format("{}: {}", arguments.case_file.string(), warning));
  }
  for (const std::string& line : shortfalls(report)) {
    print_message(err, fmt::format("{}: {}", arguments.case_file.string(), line));
  }
  if (arguments.verbosity == Verbosity::normal) {
    out << io::results_text(report) << fmt::format("  results in {}\n", folder.string());
  }
  return io::exit_status(report.status);
}

}  // namespace isorim::cli
