#include "io/sweep/processes.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <map>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace isorim::io {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  bool is_complete = false;
  std::map<std::size_t, TaskEnd> ends;
};

Outcome run(std::size_t count, const std::function<std::string(std::size_t)>& work,
            const ProcessOptions& options = {}) {
  std::vector<std::size_t> tasks;
  for (std::size_t i = 0; i < count; ++i) tasks.push_back(i);
  Outcome outcome;
  const auto finished = [&](const TaskEnd& end) {
    EXPECT_TRUE(outcome.ends.emplace(end.task, end).second);
    return AfterTask::go_on;
  };
  outcome.is_complete = run_in_processes(tasks, work, finished, options);
  return outcome;
}

double seconds_of(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

[[noreturn]] void sleep_for_ever() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

TEST(Processes, ReturnWhatTheWorkReturns) {
  const Outcome outcome =
      run(20, [](std::size_t i) { return std::string(i * 100000, 'x') + std::to_string(i); }, {.processes = 3});
  EXPECT_TRUE(outcome.is_complete);
  ASSERT_EQ(outcome.ends.size(), 20);
  for (const auto& [i, end] : outcome.ends) {
    EXPECT_EQ(end.output, std::string(i * 100000, 'x') + std::to_string(i));
    EXPECT_EQ(end.failure, "");
    EXPECT_GT(end.peak_memory, 100000);
  }
}

TEST(Processes, SurviveWhateverATaskDoes) {
  const Outcome outcome = run(6, [](std::size_t i) -> std::string {
    if (i == 0) std::raise(SIGSEGV);
    if (i == 1) std::abort();
    if (i == 2) throw std::runtime_error("thrown");
    if (i == 3) _exit(7);
    if (i == 4) {
      std::cerr << "last words" << std::endl;
      std::raise(SIGKILL);
    }
    std::cout << "not the result" << std::endl;
    return "well";
  });
  EXPECT_TRUE(outcome.is_complete);
  ASSERT_EQ(outcome.ends.size(), 6);
  EXPECT_THAT(outcome.ends.at(0).failure, HasSubstr("Segmentation fault (signal 11)"));
  EXPECT_THAT(outcome.ends.at(1).failure, HasSubstr("Aborted (signal 6)"));
  EXPECT_EQ(outcome.ends.at(2).failure, "thrown");
  EXPECT_THAT(outcome.ends.at(3).failure, HasSubstr("ended with status 7"));
  EXPECT_THAT(outcome.ends.at(4).failure, HasSubstr("perhaps because memory ran out: last words"));
  EXPECT_EQ(outcome.ends.at(5).output, "well");
}

TEST(Processes, LimitMemory) {
  const auto work = [](std::size_t i) {
    std::vector<std::vector<char>> blocks;
    for (std::size_t k = 0; i == 1 && k < 100; ++k) blocks.emplace_back(10000000, 'x');
    return std::to_string(blocks.size());
  };
  const Outcome outcome = run(2, work, {.memory = 300000000});
  EXPECT_EQ(outcome.ends.at(0).output, "0");
  EXPECT_THAT(outcome.ends.at(1).failure, HasSubstr("out of memory"));
}

TEST(Processes, EndTasksThatTakeTooLong) {
  Outcome outcome;
  const double seconds = seconds_of([&] {
    outcome = run(3,
                  [](std::size_t i) -> std::string {
                    if (i == 1) sleep_for_ever();
                    return "well";
                  },
                  {.processes = 2, .timeout = 0.5});
  });
  EXPECT_LT(seconds, 30.0);
  EXPECT_TRUE(outcome.ends.at(1).is_timed_out);
  EXPECT_EQ(outcome.ends.at(1).failure, "not finished after 0.5 s");
  EXPECT_EQ(outcome.ends.at(0).output, "well");
  EXPECT_EQ(outcome.ends.at(2).output, "well");
}

TEST(Processes, StopAtOnceWhenAsked) {
  Outcome outcome;
  int asked = 0;
  const double seconds = seconds_of([&] {
    outcome = run(5,
                  [](std::size_t i) -> std::string {
                    if (i > 0) sleep_for_ever();
                    return "well";
                  },
                  {.processes = 2, .stop = [&] { return ++asked > 4; }});
  });
  EXPECT_LT(seconds, 30.0);
  EXPECT_FALSE(outcome.is_complete);
  EXPECT_EQ(outcome.ends.size(), 1);
}

TEST(Processes, BeginNoMoreWhenToldSo) {
  std::vector<std::size_t> ended;
  const std::vector<std::size_t> tasks{4, 3, 2, 1, 0};
  const bool complete = run_in_processes(
      tasks, [](std::size_t) { return std::string("well"); },
      [&](const TaskEnd& end) {
        ended.push_back(end.task);
        return end.task == 3 ? AfterTask::begin_no_more : AfterTask::go_on;
      },
      {});
  EXPECT_FALSE(complete);
  EXPECT_THAT(ended, ::testing::ElementsAre(4, 3));
}

TEST(Processes, DieWithTheirParent) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const std::vector<std::size_t> tasks{0};
    run_in_processes(
        tasks,
        [&](std::size_t) -> std::string {
          const pid_t self = getpid();
          if (write(ends[1], &self, sizeof(self)) != sizeof(self)) _exit(1);
          sleep_for_ever();
        },
        [](const TaskEnd&) { return AfterTask::go_on; }, {});
    _exit(0);
  }
  pid_t task = 0;
  ASSERT_EQ(read(ends[0], &task, sizeof(task)), ssize_t{sizeof(task)});
  ASSERT_EQ(kill(task, 0), 0);
  kill(child, SIGKILL);
  close(ends[1]);
  // The pipe ends when nobody holds it open any more.
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 0);
  close(ends[0]);
}

TEST(Processes, CostMilliseconds) {
  const double seconds = seconds_of([] {
    const Outcome outcome = run(200, [](std::size_t) { return std::string("well"); }, {.processes = 2});
    EXPECT_TRUE(outcome.is_complete);
  });
  // About 0.2 s on a machine at rest; starting the program anew for each would take 20.
  EXPECT_LT(seconds, 10.0);
}

}  // namespace
}  // namespace isorim::io
