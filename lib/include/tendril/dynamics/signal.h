#pragma once

#include <tendril/base/export.h>

#include <utility>
#include <vector>

namespace tendril {

/// A scalar function of time, by which loads vary: constant, sinusoidal or tabulated. Pure: the same time
/// gives the same value, so that a rejected step can be repeated.
class TENDRIL_CORE_API Signal {
 public:
  /// f(t) = value
  static Signal constant(double value);
  /// f(t) = mean + amplitude sin(2 pi frequency t + phase); frequency in cycles per time unit
  static Signal sinusoid(double amplitude, double frequency, double phase = 0.0, double mean = 0.0);
  /// Piecewise linear through (time, value), constant before and after; times non-decreasing, two equal ones
  /// make a jump (the value at that time is the later one). At least one entry, all finite; else
  /// InvalidInput.
  static Signal table(std::vector<std::pair<double, double>> entries);

  double operator()(double t) const;                            ///< f(t)
  bool is_constant() const { return kind_ == Kind::constant; }  ///< made by constant()
  /// Times where the value or its slope jumps, ascending: the integrator ends a step there.
  std::vector<double> breaks() const;
  double period() const;  ///< of a sinusoid [time]; infinite for the others

 private:
  enum class Kind { constant, sinusoid, table };
  Kind kind_ = Kind::constant;
  double mean_ = 0.0, amplitude_ = 0.0, frequency_ = 0.0, phase_ = 0.0;
  std::vector<std::pair<double, double>> entries_;
};

}  // namespace tendril
