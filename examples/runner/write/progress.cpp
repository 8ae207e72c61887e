#include "write/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>

namespace tendril::runner {

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::cerr << "\r\x1b[K" << std::flush;
}

void Progress::show(const std::string& what, double part) {
  constexpr int width = 40;
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || (drawn_ && now - last_ < std::chrono::milliseconds(100))) return;
  last_ = now;
  drawn_ = true;
  const double bounded = std::clamp(part, 0.0, 1.0);
  const auto full = static_cast<std::size_t>(bounded * width);
  std::cerr << '\r' << what << " [" << std::string(full, '=') << std::string(width - full, ' ') << "] "
            << static_cast<int>(100.0 * bounded) << " %\x1b[K" << std::flush;
}

}  // namespace tendril::runner
