#pragma once

#include <tendril/dynamics/simulation.h>

#include <functional>
#include <limits>
#include <optional>

namespace tendril {

/// Counts accepted steps between two looks at something.
class Interval {
 public:
  bool passed(long steps) const { return at_once_ || count_ >= steps; }
  void count() { ++count_; }
  void begin_anew() { count_ = 0, at_once_ = false; }
  void end_at_once() { at_once_ = true; }

 private:
  long count_ = 0;
  bool at_once_ = false;
};

constexpr long kFrequencyCost = 32;  ///< evaluations that an estimate of the largest frequency counts as

/// Estimate of the largest frequency about a state.
double fastest_motion(const System& system, const State& state, System::Workspace& work);

/// The step in which the body that spins fastest turns by 1.5 rad, well within what a step may turn it by;
/// infinite where none spins.
double longest_turn(const System& system, const State& state);

/// The cap on explicit steps that keeps a method from amplifying the fastest oscillations (stability.h),
/// from estimates of the largest frequency now and then.
class Guard {
 public:
  using Growth = std::function<double(double, double, double, double)>;

  /// Both are kept by reference.
  Guard(const System& system, const SimulationOptions& options) : system_(system), options_(options) {}

  /// Takes the frequency at a state; the cap changes when it does by more than a hundredth.
  /// \param duration  of the run
  /// \param growth    of the method whose steps are capped, as cash_karp_growth
  void measure(const State& state, double duration, const Growth& growth, System::Workspace& work);

  /// The cap of another method, for the frequency as it was measured.
  void cap(const Growth& growth) { step_ = step_of(growth); }
  double step_of(const Growth& growth) const;

  /// Accepted steps since it was measured.
  Interval& since() { return since_; }

  double last_frequency() const { return last_; }
  std::optional<double> frequency() const { return frequency_; }  ///< that the cap is for, once measured
  double step() const { return step_; }                           ///< infinite when nothing limits it

 private:
  const System& system_;
  const SimulationOptions& options_;
  Interval since_;
  std::optional<double> frequency_;
  double last_ = 0.0, duration_ = 0.0;
  double step_ = std::numeric_limits<double>::infinity();
};

}  // namespace tendril
