#include "quadrature/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <utility>

#include <omp.h>

namespace isorim::quadrature {

namespace {

/// The exception of the smallest failing task.
class FirstFailure {
 public:
  void keep(std::size_t task, std::exception_ptr exception) {
    const std::lock_guard lock(mutex_);
    if (task < task_) {
      task_ = task;
      exception_ = std::move(exception);
    }
    failed_ = true;
  }
  bool failed() const { return failed_; }
  void rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> failed_ = false;
  std::size_t task_ = std::numeric_limits<std::size_t>::max();
  std::exception_ptr exception_;
};

}  // namespace

int thread_count(int threads) {
  return threads > 0 ? threads : omp_get_max_threads();
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, int)>& body,
                  const std::function<void(double)>& progress) {
  FirstFailure failure;
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> finished = 0;
  const auto work = [&](int thread) {
    while (!failure.failed()) {
      const std::size_t task = next.fetch_add(1);
      if (task >= count) return;
      try {
        body(task, thread);
        const std::size_t done = finished.fetch_add(1) + 1;
        if (thread == 0 && progress) progress(static_cast<double>(done) / static_cast<double>(count));
      } catch (...) {
        failure.keep(task, std::current_exception());
      }
    }
  };
  const int team = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(thread_count(threads)), count));
  if (team <= 1) {
    work(0);
  } else {
#pragma omp parallel num_threads(team)
    work(omp_get_thread_num());
  }
  failure.rethrow();
}

void with_team(int threads, const std::function<void()>& body) {
  const int team = thread_count(threads);
  if (team <= 1) return body();
  FirstFailure failure;
#pragma omp parallel num_threads(team)
#pragma omp single
  try {
    body();
  } catch (...) {
    failure.keep(0, std::current_exception());
  }
  failure.rethrow();
}

void together(std::span<const std::function<void()>> tasks) {
  FirstFailure failure;
  const auto run = [&](std::size_t task) {
    try {
      tasks[task]();
    } catch (...) {
      failure.keep(task, std::current_exception());
    }
  };
  for (std::size_t task = 1; task < tasks.size(); ++task) {
#pragma omp task default(none) firstprivate(task) shared(run)
    run(task);
  }
  if (!tasks.empty()) run(0);
#pragma omp taskwait
  failure.rethrow();
}

}  // namespace isorim::quadrature
