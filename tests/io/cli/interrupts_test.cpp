#include "io/cli/interrupts.h"

#include <csignal>

#include <gtest/gtest.h>

namespace isorim::cli {
namespace {

volatile std::sig_atomic_t received = 0;
extern "C" void receive(int signal) {
  received = signal;
}

TEST(HeldInterrupts, WaitUntilTheEndOfTheScope) {
  for (const int signal : {SIGINT, SIGTERM}) {
    received = 0;
    auto* const before = std::signal(signal, receive);
    {
      const HeldInterrupts held;
      std::raise(signal);
      EXPECT_EQ(received, 0);
    }
    EXPECT_EQ(received, signal);
    std::signal(signal, before);
  }
}

TEST(HeldInterrupts, LeaveIgnoredSignalsIgnored) {
  auto* const before = std::signal(SIGHUP, SIG_IGN);
  {
    const HeldInterrupts held;
    std::raise(SIGHUP);
  }
  EXPECT_EQ(std::signal(SIGHUP, before), SIG_IGN);
}

}  // namespace
}  // namespace isorim::cli
