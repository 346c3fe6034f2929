#include "quadrature/parallel.h"

#include <atomic>
#include <chrono>
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

}  // namespace
}  // namespace isorim::quadrature
