#pragma once

#include <tendril/base/error.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

namespace tendril::bind {

inline void require_threads(int threads) {
  if (threads < 1 || threads > 256) throw InvalidInput("threads", std::to_string(threads), "1 to 256");
}

/// Runs body(begin, end) over [0, count) in contiguous parts of at least `least` each, which each thread
/// takes as it comes to them: some cost much more than others. What a part writes must depend on its own
/// indices only: then the result is the same for any number of threads. An exception in another thread ends
/// the program, so bodies check their input before. Where a thread cannot be started, those running are
/// waited for and std::system_error goes up.
template <class Body>
void in_parts(std::size_t count, int threads, std::size_t least, const Body& body) {
  constexpr std::size_t kPartsEach = 8;
  const std::size_t most = count / least + 1;
  const std::size_t workers =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::max(threads, 1)), 1, most);
  if (workers == 1) return body(0, count);
  const std::size_t parts = std::min(kPartsEach * workers, most);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t part = next++; part < parts; part = next++)
      body(count * part / parts, count * (part + 1) / parts);
  };
  std::vector<std::jthread> others;  // joined where it goes
  for (std::size_t k = 1; k < workers; ++k) others.emplace_back(work);
  work();
}

template <class Body>
void in_parts(std::size_t count, int threads, const Body& body) {
  in_parts(count, threads, 256, body);
}

}  // namespace tendril::bind
