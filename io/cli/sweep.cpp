#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/cli/commands.h"
#include "io/cli/interrupts.h"
#include "io/cli/sweep_case.h"
#include "io/results/json.h"
#include "io/sweep/journal.h"
#include "io/sweep/merge.h"
#include "io/sweep/plan.h"
#include "io/sweep/processes.h"
#include "io/sweep/results.h"

namespace isorim::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string clock_text(double seconds) {
  const auto whole = std::llround(seconds);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

/// How far a sweep is: one line that is written over at a terminal, else a line a minute.
class SweepProgress {
 public:
  SweepProgress(std::size_t cases, std::size_t finished, std::ostream& err)
      : err_(err),
        is_terminal_(&err == &std::cerr && isatty(STDERR_FILENO) != 0),
        cases_(cases),
        finished_(finished),
        shown_at_(is_terminal_ ? 0.5 : 60.0) {}
  ~SweepProgress() { wipe(); }
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  void count(bool failed) {
    ++finished_;
    ++finished_now_;
    failed_ += failed ? 1 : 0;
  }
  /// Called often; shows something now and then.
  void show() {
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    if (elapsed < shown_at_) return;
    shown_at_ = elapsed + (is_terminal_ ? 0.2 : 60.0);
    err_ << (is_terminal_ ? "\r\033[K" : "") << text(elapsed) << (is_terminal_ ? "" : "\n") << std::flush;
    is_shown_ = is_terminal_;
  }
  /// Before a message.
  void wipe() {
    if (is_shown_) err_ << "\r\033[K" << std::flush;
    is_shown_ = false;
  }

 private:
  std::string text(double elapsed) const {
    std::string line = fmt::format("isorim: {} of {} cases", finished_, cases_);
    if (failed_ > 0) line += fmt::format(", {} failed", failed_);
    if (finished_now_ == 0) return line;
    const auto left = static_cast<double>(cases_ - finished_);
    return line + fmt::format(", {} left", clock_text(elapsed / static_cast<double>(finished_now_) * left));
  }

  std::ostream& err_;
  bool is_terminal_;
  std::size_t cases_;
  std::size_t finished_;
  std::size_t finished_now_ = 0;
  std::size_t failed_ = 0;
  double shown_at_;
  bool is_shown_ = false;
  Clock::time_point start_ = Clock::now();
};

fs::path sweep_folder(const SweepArguments& arguments, const io::SweepPlan& plan) {
  return arguments.output.value_or(fs::path("out") / plan.name());
}

fs::path shard_folder(const fs::path& folder, const io::Shard& shard) {
  return shard.is_everything() ? folder : folder / fmt::format("shard_{}_of_{}", shard.part, shard.count);
}

/// Removes the folders of cases, which are numbers; what else stands there is not ours.
void discard_cases(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> discarded;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_number = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
    if (is_number && entry.is_directory()) discarded.push_back(entry.path());
  }
  for (const fs::path& path : discarded) fs::remove_all(path, error);
}

/// The journal to write to, and in `results` what it holds already.
io::Journal open_journal(const fs::path& folder, const SweepArguments& arguments, io::SweepResults& results) {
  const fs::path path = io::journal_path(folder);
  const io::SweepPlan& plan = *results.plan;
  if (io::has_journal(folder) && arguments.earlier != EarlierCases::discard) {
    if (arguments.earlier == EarlierCases::refuse) {
      throw InputError(
          fmt::format("{}: holds a sweep already; expected --resume to go on with it, --restart to discard "
                      "it, or another folder (-o DIR)",
                      folder.string()));
    }
    io::JournalContent content;
    io::Journal journal = io::Journal::resume(path, content);
    io::require_same_sweep(path, content.identity, plan);
    if (content.shard.text() != results.shard.text()) {
      throw InputError(
          fmt::format("{}: is of shard {}; expected {}", path.string(), content.shard.text(), results.shard.text()));
    }
    results.records = std::move(content.records);
    return journal;
  }
  const bool is_discarded = io::has_journal(folder);
  io::Journal journal = io::Journal::make(path, io::identity_of(plan), results.shard);
  if (is_discarded) discard_cases(folder / "cases");
  return journal;
}

/// What a process has left behind, as a record.
io::CaseRecord record_of(const io::TaskEnd& end) {
  io::CaseRecord record;
  record.index = end.task;
  if (end.failure.empty()) {
    record = io::parse_record(end.output);
  } else {
    record.status = end.is_timed_out ? "timed_out" : "crashed";
    record.exit_status = 3;
    record.message = end.failure;
  }
  record.seconds = end.seconds;
  record.peak_memory = end.peak_memory;
  return record;
}

/// Runs the cases that are left.
class SweepRunner {
 public:
  SweepRunner(const SweepArguments& arguments, const fs::path& folder, io::SweepResults& results, std::ostream& err)
      : arguments_(arguments), folder_(folder), results_(results), err_(err) {}

  /// What the user has been told already of the results as a whole.
  const std::vector<std::string>& told() const { return told_; }

  /// Returns when all cases have ended, or when it was ended early.
  void run(io::Journal& journal) {
    std::vector<std::size_t> tasks = results_.share();
    std::erase_if(tasks, [&](std::size_t index) {
      const io::CaseRecord* record = results_.find(index);
      return record && !(arguments_.retries && record->is_failed());
    });
    if (tasks.empty()) return;
    const std::size_t share = results_.share().size();
    SweepProgress progress(share, share - tasks.size(), err_);
    const io::ProcessOptions options = process_options(tasks.size(), progress);
    // The same results for any number of threads: whatever processors are left over serve single cases.
    const SweepCaseOptions case_options{results_.plan, folder_, std::max(1, processors() / options.processes)};
    const auto work = [&](std::size_t index) { return io::record_json(run_sweep_case(case_options, index)); };
    const auto finished = [&](const io::TaskEnd& end) { return record_end(end, journal, progress); };
    io::run_in_processes(tasks, work, finished, options);
  }

 private:
  int processors() const {
    if (arguments_.processes > 0) return arguments_.processes;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }

  io::ProcessOptions process_options(std::size_t tasks, SweepProgress& progress) const {
    io::ProcessOptions options;
    options.processes = static_cast<int>(std::min<std::size_t>(tasks, static_cast<std::size_t>(processors())));
    options.timeout = results_.plan->keys.run.timeout;
    if (results_.plan->keys.run.memory) {
      options.memory = static_cast<std::int64_t>(1e6 * *results_.plan->keys.run.memory);
    }
    options.stop = [&progress] {
      progress.show();
      return HeldInterrupts::is_pending();
    };
    return options;
  }

  io::AfterTask record_end(const io::TaskEnd& end, io::Journal& journal, SweepProgress& progress) {
    io::CaseRecord record = record_of(end);
    journal.append(record);
    progress.count(record.is_failed());
    if (record.status != "ok") {
      progress.wipe();
      print_message(err_, fmt::format("case {} ({}): {}: {}", end.task + 1, results_.plan->describe(end.task),
                                      record.status, record.message));
    }
    const bool is_first = !has_results_ && record.has_results();
    const bool failed = record.is_failed();
    results_.records[end.task] = std::move(record);
    if (is_first) {
      // Now, not after hours.
      has_results_ = true;
      told_ = io::unknown_results(results_);
      for (const std::string& message : told_) print_message(err_, message);
    }
    return failed && results_.plan->keys.run.stop_on_failure ? io::AfterTask::begin_no_more : io::AfterTask::go_on;
  }

  const SweepArguments& arguments_;
  const fs::path& folder_;
  io::SweepResults& results_;
  std::ostream& err_;
  bool has_results_ = false;
  std::vector<std::string> told_;
};

std::string summary_text(const io::SweepResults& results, const fs::path& folder) {
  const io::SweepCounts counts = io::count(results);
  std::string text = fmt::format("{}\n  {} cases: {} finished, {} of them failed\n", results.plan->title(),
                                 counts.cases, counts.finished, counts.failed);
  const int expectations = counts.expectations_met + counts.expectations_missed;
  if (expectations > 0) text += fmt::format("  {} expectations of {} met\n", counts.expectations_met, expectations);
  return text + fmt::format("  results in {}\n", folder.string());
}

/// "3, 5-9 and 17", at most a few of them.
std::string number_list(const std::vector<std::size_t>& indices) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t last = i;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    parts.push_back(last == i ? fmt::format("{}", indices[i] + 1)
                              : fmt::format("{}-{}", indices[i] + 1, indices[last] + 1));
    i = last + 1;
    if (parts.size() == 20 && i < indices.size()) {
      parts.emplace_back("...");
      break;
    }
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Writes the files of the whole and the summary.
int conclude(const SweepArguments& arguments, const io::SweepResults& results, const fs::path& folder,
             const std::vector<std::string>& told, std::ostream& out, std::ostream& err) {
  const std::vector<std::string> messages = io::write_sweep_files(folder, results);
  for (const std::string& message : messages) {
    if (std::ranges::find(told, message) == told.end()) print_message(err, message);
  }
  const std::vector<std::size_t> missing = results.missing();
  if (!missing.empty()) {
    print_message(err, fmt::format("{} cases of {} are missing: {}; --resume runs them", missing.size(),
                                   results.share().size(), number_list(missing)));
  }
  out << (arguments.format == OutputFormat::json ? io::sweep_json(results, folder) : summary_text(results, folder))
      << std::flush;
  return messages.empty() ? io::exit_status(results) : 2;
}

int list_cases(const SweepArguments& arguments, const io::SweepPlan& plan, const io::Shard& shard, std::ostream& out) {
  out << (arguments.format == OutputFormat::json ? io::plan_json(plan, shard) : io::plan_text(plan, shard));
  return 0;
}

}  // namespace

int run_sweep(const SweepArguments& arguments, std::ostream& out, std::ostream& err) {
  const io::SweepPlan plan = io::read_sweep(arguments.sweep_file);
  const io::Shard shard = arguments.shard ? io::parse_shard(*arguments.shard) : io::Shard{};
  if (arguments.action == SweepAction::list) return list_cases(arguments, plan, shard, out);
  const fs::path folder = shard_folder(sweep_folder(arguments, plan), shard);
  const HeldInterrupts held;
  if (arguments.action == SweepAction::merge) {
    const io::SweepResults results = io::merge_shards(plan, folder);
    const int status = conclude(arguments, results, folder, {}, out, err);
    return results.missing().empty() ? status : 2;
  }
  io::make_folder(folder);
  io::SweepResults results{&plan, shard, {}};
  io::Journal journal = open_journal(folder, arguments, results);
  SweepRunner runner(arguments, folder, results, err);
  runner.run(journal);
  return conclude(arguments, results, folder, runner.told(), out, err);
}

}  // namespace isorim::cli
