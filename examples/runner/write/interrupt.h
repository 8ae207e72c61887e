#pragma once

namespace tendril::runner {

/// While one lives, Ctrl-C (SIGINT) and SIGTERM only set a flag, so that a run can end in order. The earlier
/// behaviour comes back afterwards.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  static bool requested();
};

}  // namespace tendril::runner
