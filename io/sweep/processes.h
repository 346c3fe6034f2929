#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

/// Tasks in processes of their own, so that none can take the others or the caller with it: not by a crash, not by
/// memory without bounds, not by never ending.
namespace isorim::io {

/// How a task has ended.
struct TaskEnd {
  std::size_t task = 0;
  /// What the work returned; empty if it did not return.
  std::string output;
  /// Why not: what it threw, the signal that killed it, the time it was given. Empty if it returned.
  std::string failure;
  bool is_timed_out = false;
  /// Seconds from its begin.
  double seconds = 0.0;
  /// Bytes.
  std::int64_t peak_memory = 0;
};

enum class AfterTask { go_on, begin_no_more };

struct ProcessOptions {
  /// Tasks at a time.
  int processes = 1;
  /// Seconds for a task.
  std::optional<double> timeout;
  /// Bytes of data for a task; what asks for more gets std::bad_alloc.
  std::optional<std::int64_t> memory;
  /// Called about five times a second; true ends the tasks that are running and begins no more.
  std::function<bool()> stop;
};

/// Runs work(task) for each task, begun in the order of the list, each in a process forked for it, and calls
/// finished(end) from this process as they end. Returns true if all tasks were begun and ended, false if `finished` or
/// `stop` ended it early: after begin_no_more those that are running are waited for, after a stop they are killed and
/// not reported.
///
/// The processes leave signals of the terminal (SIGINT, SIGTERM, SIGHUP) to this one, are killed if it dies however it
/// does, and are the first that the system ends when memory runs out. Their standard input and output are /dev/null;
/// the end of what they write to standard error becomes part of the failure. They begin as copies of this process,
/// which must not have run parallel regions of OpenMP if they are to run some with more than one thread. About a
/// millisecond a task. Throws std::system_error if the system has no processes or pipes left.
bool run_in_processes(std::span<const std::size_t> tasks, const std::function<std::string(std::size_t)>& work,
                      const std::function<AfterTask(const TaskEnd&)>& finished, const ProcessOptions& options);

}  // namespace isorim::io
