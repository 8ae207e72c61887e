#pragma once

#include <chrono>
#include <string>

namespace tendril::runner {

/// A progress bar on standard error, when that is a terminal; otherwise nothing. Redrawn at most ten times a
/// second and wiped at the end.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// \param part  0 to 1
  void show(const std::string& what, double part);

 private:
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace tendril::runner
