#include "write/interrupt.h"

#include <csignal>

namespace tendril::runner {
namespace {

volatile std::sig_atomic_t requested_ = 0;
struct sigaction earlier_interrupt, earlier_terminate;

extern "C" void request(int) {
  requested_ = 1;
}

}  // namespace

Interrupt::Interrupt() {
  requested_ = 0;
  struct sigaction action {};
  action.sa_handler = request;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &earlier_interrupt);
  sigaction(SIGTERM, &action, &earlier_terminate);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &earlier_interrupt, nullptr);
  sigaction(SIGTERM, &earlier_terminate, nullptr);
}

bool Interrupt::requested() {
  return requested_ != 0;
}

}  // namespace tendril::runner
