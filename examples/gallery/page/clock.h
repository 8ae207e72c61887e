#pragma once

#include <time.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace tendril::gallery {

/// CPU time of this thread [s]: what others do on the machine counts only through caches and clock rates.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Median seconds of each of several calls, which take turns, so that what the machine does meanwhile slows
/// all of them alike. The first round is not counted.
inline std::vector<double> median_seconds(int rounds, const std::vector<std::function<void()>>& calls) {
  std::vector<std::vector<double>> seconds(calls.size());
  for (int round = 0; round <= rounds; ++round)
    for (std::size_t k = 0; k < calls.size(); ++k) {
      const double begin = cpu_seconds();
      calls[k]();
      if (round > 0) seconds[k].push_back(cpu_seconds() - begin);
    }
  std::vector<double> out;
  for (std::vector<double>& one : seconds) {
    std::nth_element(one.begin(), one.begin() + rounds / 2, one.end());
    out.push_back(one[static_cast<std::size_t>(rounds / 2)]);
  }
  return out;
}

}  // namespace tendril::gallery
