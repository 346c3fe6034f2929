#include <chrono>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/cli/commands.h"
#include "io/cli/interrupts.h"
#include "io/results/case_files.h"
#include "io/results/compute.h"
#include "io/results/json.h"
#include "io/results/table.h"

namespace isorim::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
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
  if (folder) {
    const HeldInterrupts held;
    io::write_case_files(*folder, file, model, study, report);
  }
  return report;
}

int run_case(const RunArguments& arguments, std::ostream& out, std::ostream& err) {
  const Clock::time_point start = Clock::now();
  const io::CaseFile file =
      io::read_case_or_cad(arguments.case_file, arguments.overrides, {.threads = arguments.threads});
  const std::filesystem::path folder = arguments.output.value_or(std::filesystem::path("out") / file.name());
  io::require_writable_folder(folder);
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
  if (arguments.format == OutputFormat::json) {
    out << io::to_json(report);
  } else if (arguments.verbosity == Verbosity::normal) {
    out << io::results_text(report) << fmt::format("  results in {}\n", folder.string());
  }
  return io::exit_status(report.status);
}

}  // namespace isorim::cli
