#include "io/sweep/processes.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace isorim::io {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Both ends of a pipe, closed at the end of the scope.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) fail("making a pipe");
  }
  ~Pipe() {
    close_reading();
    close_writing();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  Pipe(Pipe&& other) noexcept : ends_(std::exchange(other.ends_, {-1, -1})) {}
  Pipe& operator=(Pipe&& other) noexcept {
    std::swap(ends_, other.ends_);
    return *this;
  }

  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void close_reading() { close_end(ends_[0]); }
  void close_writing() { close_end(ends_[1]); }

 private:
  static void close_end(int& end) {
    if (end >= 0) close(end);
    end = -1;
  }

  std::array<int, 2> ends_{-1, -1};
};

/// Appends what the pipe holds; false at its end.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t count = read(descriptor, buffer.data(), buffer.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0;
}

void write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) _exit(1);
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

// --- In the process of a task ---------------------------------------------------------------------------------

constexpr int returned = 0;
constexpr int threw = 1;

void redirect_streams(int errors) {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(null, STDIN_FILENO);
  dup2(null, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
}

/// The system shall end this process before others when memory runs out; if it does not allow to say so, it decides.
void volunteer_for_ending() {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const ssize_t written = write(file, "1000", 4);
  close(file);
}

void settle(pid_t parent, const ProcessOptions& options) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // It may have died before.
  if (getppid() != parent) _exit(threw);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  volunteer_for_ending();
  if (options.memory) {
    const rlimit limit{static_cast<rlim_t>(*options.memory), static_cast<rlim_t>(*options.memory)};
    setrlimit(RLIMIT_DATA, &limit);
  }
}

[[noreturn]] void serve(const std::function<std::string(std::size_t)>& work, std::size_t task, int output) {
  int status = returned;
  try {
    write_all(output, work(task));
  } catch (const std::bad_alloc&) {
    write_all(STDERR_FILENO, "out of memory");
    status = threw;
  } catch (const std::exception& error) {
    write_all(STDERR_FILENO, error.what());
    status = threw;
  }
  // Not exit(): what this process would do at its end belongs to the one it is a copy of.
  _exit(status);
}

// --- In the process of the caller -----------------------------------------------------------------------------

/// A task that is running.
struct Running {
  std::size_t task = 0;
  pid_t process = -1;
  Pipe output;
  Pipe errors;
  bool output_ended = false;
  bool errors_ended = false;
  bool timed_out = false;
  std::string output_text;
  std::string error_text;
  Clock::time_point start = Clock::now();

  double seconds() const { return std::chrono::duration<double>(Clock::now() - start).count(); }
};

std::string signal_text(int signal) {
  const char* name = sigdescr_np(signal);
  return fmt::format("{} (signal {})", name ? name : "unknown", signal);
}

/// The last lines of what the process has said, on one line.
std::string tail(const std::string& text) {
  constexpr std::size_t most = 300;
  std::string result = text.size() > most ? "..." + text.substr(text.size() - most) : text;
  while (!result.empty() && std::isspace(static_cast<unsigned char>(result.back())) != 0) result.pop_back();
  return result;
}

std::string failure_text(const Running& running, int status, const ProcessOptions& options) {
  const std::string said = tail(running.error_text);
  if (running.timed_out) return fmt::format("not finished after {:g} s", *options.timeout);
  if (WIFSIGNALED(status)) {
    std::string text = fmt::format("ended by {}", signal_text(WTERMSIG(status)));
    if (WTERMSIG(status) == SIGKILL) text += ", perhaps because memory ran out";
    return said.empty() ? text : text + ": " + said;
  }
  if (WEXITSTATUS(status) == returned) return "";
  return said.empty() ? fmt::format("ended with status {}", WEXITSTATUS(status)) : said;
}

class ProcessPool {
 public:
  ProcessPool(const std::function<std::string(std::size_t)>& work,
              const std::function<AfterTask(const TaskEnd&)>& finished, const ProcessOptions& options)
      : work_(work), finished_(finished), options_(options) {}
  ~ProcessPool() { kill_all(); }
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  bool run(std::span<const std::size_t> tasks) {
    bool begins = true;
    while ((begins && !tasks.empty()) || !running_.empty()) {
      if (options_.stop && options_.stop()) {
        kill_all();
        return false;
      }
      while (begins && !tasks.empty() && running_.size() < static_cast<std::size_t>(options_.processes)) {
        begin(tasks.front());
        tasks = tasks.subspan(1);
      }
      listen();
      end_late_ones();
      if (!report_ended()) begins = false;
    }
    return tasks.empty();
  }

 private:
  void begin(std::size_t task) {
    Running& running = running_.emplace_back();
    running.task = task;
    const pid_t parent = getpid();
    running.process = fork();
    if (running.process < 0) {
      running_.pop_back();
      fail("starting a process");
    }
    if (running.process == 0) {
      redirect_streams(running.errors.writing());
      settle(parent, options_);
      serve(work_, task, running.output.writing());
    }
    running.output.close_writing();
    running.errors.close_writing();
  }

  /// Waits for a fifth of a second, or until a task says something or ends.
  void listen() {
    std::vector<pollfd> polled;
    for (const Running& one : running_) {
      polled.push_back({one.output_ended ? -1 : one.output.reading(), POLLIN, 0});
      polled.push_back({one.errors_ended ? -1 : one.errors.reading(), POLLIN, 0});
    }
    // Interrupted by signals: the caller's `stop` will know.
    if (poll(polled.data(), polled.size(), 200) <= 0) return;
    auto next = polled.begin();
    for (Running& one : running_) {
      if ((next++)->revents != 0) one.output_ended = !read_some(one.output.reading(), one.output_text);
      if ((next++)->revents != 0) one.errors_ended = !read_some(one.errors.reading(), one.error_text);
      // Only its end is ever shown.
      if (one.error_text.size() > 100000) one.error_text.erase(0, one.error_text.size() - 1000);
    }
  }

  void end_late_ones() {
    for (Running& one : running_) {
      if (!options_.timeout || one.timed_out || one.seconds() < *options_.timeout) continue;
      one.timed_out = true;
      kill(one.process, SIGKILL);
    }
  }

  /// False if no more tasks shall begin.
  bool report_ended() {
    bool go_on = true;
    for (std::size_t i = 0; i < running_.size();) {
      if (!running_[i].output_ended || !running_[i].errors_ended) {
        ++i;
        continue;
      }
      const Running ended = std::move(running_[i]);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      if (finished_(end_of(ended)) == AfterTask::begin_no_more) go_on = false;
    }
    return go_on;
  }

  TaskEnd end_of(const Running& ended) const {
    int status = 0;
    rusage usage{};
    while (wait4(ended.process, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    TaskEnd end;
    end.task = ended.task;
    end.failure = failure_text(ended, status, options_);
    end.is_timed_out = ended.timed_out;
    if (end.failure.empty()) end.output = ended.output_text;
    end.seconds = ended.seconds();
    end.peak_memory = std::int64_t{1024} * usage.ru_maxrss;
    return end;
  }

  void kill_all() {
    for (const Running& one : running_) kill(one.process, SIGKILL);
    for (const Running& one : running_) {
      while (waitpid(one.process, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
    running_.clear();
  }

  const std::function<std::string(std::size_t)>& work_;
  const std::function<AfterTask(const TaskEnd&)>& finished_;
  const ProcessOptions& options_;
  std::vector<Running> running_;
};

}  // namespace

bool run_in_processes(std::span<const std::size_t> tasks, const std::function<std::string(std::size_t)>& work,
                      const std::function<AfterTask(const TaskEnd&)>& finished, const ProcessOptions& options) {
  return ProcessPool(work, finished, options).run(tasks);
}

}  // namespace isorim::io
