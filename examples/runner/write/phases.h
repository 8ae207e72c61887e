#pragma once

#include <array>
#include <chrono>

namespace tendril::runner {

/// Where a run's wall time went.
struct Phases {
  enum Phase : std::size_t { import, bind, simulate, update, write, draw, count };
  static constexpr std::array<const char*, count> names{"import", "bind",  "simulate",
                                                        "update", "write", "draw"};
  std::array<double, count> seconds{};

  /// Adds the time from its making to its end to a phase; takes it off another one that runs around it.
  class Timer {
   public:
    Timer(Phases& phases, Phase phase) : phases_(phases), phase_(phase) {}
    Timer(Phases& phases, Phase phase, Phase around) : phases_(phases), phase_(phase), around_(around) {}
    ~Timer() {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
      phases_.seconds[phase_] += spent.count();
      if (around_ != count) phases_.seconds[around_] -= spent.count();
    }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    Phases& phases_;
    Phase phase_, around_ = count;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  };
};

}  // namespace tendril::runner
