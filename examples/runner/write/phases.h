#pragma once

#include <tendril/scene/scene_run.h>

#include <array>
#include <chrono>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace tendril::runner {

/// Where a run's wall time went.
struct Phases {
  enum Phase : std::size_t { import, bind, simulate, update, write, draw, count };
  static constexpr std::array<const char*, count> names{"import", "bind",  "simulate",
                                                        "update", "write", "draw"};
  std::array<double, count> seconds{};

  double total() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

  /// Adds what a run took.
  void take(const scene::RunSeconds& run) {
    seconds[bind] += run.bind;
    seconds[simulate] += run.simulate;
    seconds[update] += run.update;
  }

  std::vector<std::pair<std::string, double>> named() const {
    std::vector<std::pair<std::string, double>> out;
    for (std::size_t k = 0; k < count; ++k) out.emplace_back(names[k], seconds[k]);
    return out;
  }

  /// Adds the time from its making to its end to a phase.
  class Timer {
   public:
    Timer(Phases& phases, Phase phase) : phases_(phases), phase_(phase) {}
    ~Timer() {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
      phases_.seconds[phase_] += spent.count();
    }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    Phases& phases_;
    Phase phase_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  };
};

}  // namespace tendril::runner
