#pragma once

#include <tendril/base/error.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

namespace tendril::bind {

inline void require_threads(int threads) {
  if (threads < 1 || threads > 256) throw InvalidInput("threads", std::to_string(threads), "1 to 256");
}

/// Runs body(begin, end) over [0, count) in `threads` contiguous parts of at least `least` each. What a part
/// writes must depend on its own indices only: then the result is the same for any number of threads. An
/// exception in a part other than the first ends the program, so bodies check their input before. Where a
/// thread cannot be started, those running are waited for and std::system_error goes up.
template <class Body>
void in_parts(std::size_t count, int threads, std::size_t least, const Body& body) {
  const std::size_t parts =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::max(threads, 1)), 1, count / least + 1);
  std::vector<std::jthread> others;  // joined where it goes
  for (std::size_t part = 1; part < parts; ++part)
    others.emplace_back([=, &body] { body(count * part / parts, count * (part + 1) / parts); });
  body(0, count / parts);
}

template <class Body>
void in_parts(std::size_t count, int threads, const Body& body) {
  in_parts(count, threads, 256, body);
}

}  // namespace tendril::bind
