#pragma once

namespace isorim::cli {

/// While it lives, Ctrl-C and its like (SIGINT, SIGTERM, SIGHUP) wait; the destructor lets the first of them through.
/// Results are written under it, so that an interrupted run leaves all of its files or none. One at a time.
class HeldInterrupts {
 public:
  HeldInterrupts();
  ~HeldInterrupts();
  HeldInterrupts(const HeldInterrupts&) = delete;
  HeldInterrupts& operator=(const HeldInterrupts&) = delete;

  /// Whether one is waiting.
  static bool is_pending();
};

}  // namespace isorim::cli
