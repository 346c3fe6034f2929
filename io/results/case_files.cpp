#include "io/results/case_files.h"

#include <chrono>
#include <string>
#include <system_error>
#include <utility>

#include "io/analysis/solution_pictures.h"
#include "io/atomic_file.h"
#include "io/fit/fit_pictures.h"
#include "io/hull/lines_plan.h"
#include "io/hydrostatics/hydrostatics_report.h"
#include "io/results/convergence.h"
#include "io/results/drawings.h"
#include "io/results/hdf5.h"
#include "io/results/json.h"
#include "io/results/pictures.h"
#include "io/results/plane_sections.h"

namespace isorim::io {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void write_boundary_pictures(const std::filesystem::path& folder, const CaseFile& file, const AnyModel& model,
                             const std::string& title) {
  const OutputKeys& output = file.keys.output;
  if (output.vtk) write_boundary_vtu(folder / "boundary.vtu", model);
  if (output.vtk && has_edges(model)) write_edges_vtu(folder / "edges.vtu", model);
  if (output.stl) write_boundary_stl(folder / "boundary.stl", file, model);
  if (output.svg) write_boundary_svg(folder / "boundary.svg", title, model);
  if (output.svg) write_tmesh_svgs(folder, file.shape);
}

/// Of an analysis: fields on the boundary, probes and grids.
void write_fields(const std::filesystem::path& folder, const AnyModel& model, const Report& report) {
  write_solution_vtu(folder / "solution.vtu", model, *report.fields);
  write_fields_vtu(folder / "fields.vtu", *report.fields, report.threads);
  write_samples(folder, *report.analysis);
}

}  // namespace

void write_case_files(const std::filesystem::path& folder, const CaseFile& file, const AnyModel& model,
                      const Convergence& study, Report& report) {
  const Clock::time_point start = Clock::now();
  make_folder(folder);
  // Of an earlier run: it would stand for files that change from here on.
  std::error_code none;
  std::filesystem::remove(folder / "results.json", none);
  const OutputKeys& output = file.keys.output;
  write_boundary_pictures(folder, file, model, report.title);
  if (output.vtk && report.fields) write_fields(folder, model, report);
  if (report.sections) write_sections(folder, *report.sections, output);
  for (std::string& message : write_drawings(folder, file, model, report.threads))
    report.warnings.push_back(std::move(message));
  if (report.hydrostatics) write_hydrostatics(folder, *report.hydrostatics, output);
  if (file.fit) write_fit_points(folder / "fit_points.csv", *file.fit);
  if (file.fit && output.svg) write_fit_svg(folder / "fit.svg", report.title, *file.fit);
  if (file.hull && file.keys.lines_plan) write_lines_plan(folder, *file.hull, *file.keys.lines_plan);
  if (file.keys.convergence) {
    write_convergence_csv(folder / "convergence.csv", study);
    write_convergence_svg(folder / "convergence.svg", report.title, study);
  }
  report.timings.write = seconds_since(start);
  if (output.hdf5) write_hdf5(folder / "results.h5", report, model);
  report.timings.write = seconds_since(start);
  write_json(folder / "results.json", report);
}

}  // namespace isorim::io
