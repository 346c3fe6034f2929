#include "io/cli/interrupts.h"

#include <array>
#include <csignal>
#include <cstddef>

namespace isorim::cli {
namespace {

constexpr std::array held{SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, held.size()> before;
volatile std::sig_atomic_t pending = 0;

extern "C" void remember(int signal) {
  if (pending == 0) pending = signal;
}

}  // namespace

HeldInterrupts::HeldInterrupts() {
  pending = 0;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < held.size(); ++i) {
    sigaction(held[i], nullptr, &before[i]);
    // What the caller has told us to ignore (nohup) stays ignored.
    if (before[i].sa_handler != SIG_IGN) sigaction(held[i], &action, nullptr);
  }
}

HeldInterrupts::~HeldInterrupts() {
  for (std::size_t i = 0; i < held.size(); ++i) sigaction(held[i], &before[i], nullptr);
  if (pending != 0) raise(pending);
}

bool HeldInterrupts::is_pending() {
  return pending != 0;
}

}  // namespace isorim::cli
