#include "io/cli/sweep_case.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/case/case_file.h"
#include "io/cli/commands.h"

namespace isorim::cli {
namespace {

/// Onto the disk, before the journal says that they are there.
void synchronise(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

/// The names of what a case has written.
std::vector<std::string> written_files(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    synchronise(entry.path());
    names.push_back(entry.path().filename().string());
  }
  synchronise(folder);
  std::sort(names.begin(), names.end());
  return names;
}

void add_report(const io::Report& report, const SweepCaseOptions& options, io::CaseRecord& record) {
  record.status = std::string(io::status_name(report.status));
  record.exit_status = io::exit_status(report.status);
  record.message = fmt::format("{}", fmt::join(shortfalls(report), "; "));
  for (const io::ExpectationResult& result : report.expectations) {
    (result.met ? record.expectations_met : record.expectations_missed) += 1;
  }
  record.results = io::flat_results(report, options.plan->keys.output.results);
}

/// From nothing: a case that was interrupted may have left files.
std::filesystem::path empty_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  io::make_folder(folder);
  return folder;
}

}  // namespace

io::CaseRecord run_sweep_case(const SweepCaseOptions& options, std::size_t index) {
  io::CaseRecord record;
  record.index = index;
  record.status = "failed";
  const io::SweepPlan& plan = *options.plan;
  try {
    const auto start = std::chrono::steady_clock::now();
    const io::CaseFile file = io::read_case(io::case_tree(plan, index), plan.base_path, {.threads = options.threads});
    std::optional<std::filesystem::path> folder;
    if (plan.keys.output.case_files) {
      record.folder = "cases/" + plan.case_name(index);
      folder = empty_folder(options.folder / record.folder);
    }
    const io::Report report = compute_and_write(file, start, {options.threads, {}}, folder);
    if (folder) record.files = written_files(*folder);
    add_report(report, options, record);
  } catch (const std::bad_alloc&) {
    record.exit_status = 3;
    record.message =
        plan.keys.run.memory ? fmt::format("needs more than {:g} MB", *plan.keys.run.memory) : "out of memory";
  } catch (const std::exception& error) {
    record.exit_status = exit_status_of(error);
    record.message = error.what();
  }
  return record;
}

}  // namespace isorim::cli
