#pragma once

#include <time.h>

#include <algorithm>
#include <limits>

namespace tendril::bench {

/// CPU time of this thread [s]: what others do on the machine counts only through caches and clock rates.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of the fastest of `repeats` calls.
template <class F>
double fastest(int repeats, const F& call) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const double begin = cpu_seconds();
    call();
    best = std::min(best, cpu_seconds() - begin);
  }
  return best;
}

/// Seconds of one call, when it takes too little to be timed alone: as many as fill `slice` make one
/// measurement.
template <class F>
double fastest_of_many(int repeats, double slice, const F& call) {
  long count = 1;
  for (double spent = 0.0; spent < slice / 4; count *= 2)
    spent = fastest(1, [&] {
      for (long i = 0; i < count; ++i) call();
    });
  const auto many = [&] {
    for (long i = 0; i < count; ++i) call();
  };
  return fastest(repeats, many) / static_cast<double>(count);
}

/// Asks the clock only every 64th time: it costs as much as a small right-hand side.
class Deadline {
 public:
  explicit Deadline(double seconds) : end_(cpu_seconds() + seconds) {}
  bool passed() { return ++calls_ % 64 == 0 && cpu_seconds() > end_; }

 private:
  double end_;
  long calls_ = 0;
};

}  // namespace tendril::bench
