#include "quadrature/parallel.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace isorim::quadrature {
namespace {

TEST(ParallelFor, RunsEveryTaskOnce) {
  for (const int threads : {1, 2, 5}) {
    std::vector<std::atomic<int>> runs(1000);
    parallel_for(runs.size(), threads, [&](std::size_t task, int thread) {
      EXPECT_LT(thread, threads);
      ++runs[task];
    });
    for (const std::atomic<int>& count : runs) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelFor, RethrowsTheFailureOfTheSmallestTask) {
  for (const int threads : {1, 4}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::string message;
      try {
        parallel_for(200, threads, [](std::size_t task, int) {
          // The smaller failing task takes longer, so it is usually not the first to fail.
          if (task == 50) std::this_thread::sleep_for(std::chrono::milliseconds(2));
          if (task >= 50) throw std::runtime_error(std::to_string(task));
        });
      } catch (const std::runtime_error& error) {
        message = error.what();
      }
      EXPECT_EQ(message, "50");
    }
  }
}

TEST(ParallelFor, ReportsProgressFromTheCallingThread) {
  const std::thread::id caller = std::this_thread::get_id();
  double last = 0.0;
  parallel_for(
      100, 1, [](std::size_t, int) {},
      [&](double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_GT(fraction, last);
        last = fraction;
      });
  EXPECT_EQ(last, 1.0);
}

TEST(ParallelFor, DoesNothingWithoutTasks) {
  parallel_for(0, 3, [](std::size_t, int) { FAIL(); });
}

/// 2^depth, each half by a task of its own.
int leaves(int depth) {
  if (depth == 0) return 1;
  int left = 0;
  int right = 0;
  const std::vector<std::function<void()>> tasks{[&] { left = leaves(depth - 1); }, [&] { right = leaves(depth - 1); }};
  together(tasks);
  return left + right;
}

TEST(Together, TasksMayCallTasks) {
  EXPECT_EQ(leaves(6), 64);
  for (const int threads : {1, 2, 5}) {
    int calls = 0;
    int sum = 0;
    with_team(threads, [&] {
      ++calls;
      sum = leaves(10);
    });
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(sum, 1024);
  }
  together({});
}

TEST(Together, TheFirstExceptionInTheListIsRethrownAfterAllHaveEnded) {
  for (const int threads : {1, 4}) {
    std::atomic<int> ended = 0;
    std::vector<std::function<void()>> tasks;
    for (int task = 0; task < 20; ++task) {
      tasks.emplace_back([&ended, task] {
        ++ended;
        if (task % 7 == 3) throw std::runtime_error(std::to_string(task));
      });
    }
    std::string message;
    try {
      with_team(threads, [&] { together(tasks); });
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    EXPECT_EQ(message, "3");
    EXPECT_EQ(ended, 20);
  }
}

}  // namespace
}  // namespace isorim::quadrature
