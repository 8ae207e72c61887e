#include "step_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tendril {
namespace {

constexpr double kSafety = 0.93;  // [Chan 2008] 3.34
constexpr double kStiffSafety = 0.85;
constexpr double kShrink = 0.2;  // bounds of the factor
constexpr double kGrow = 5.0;
constexpr double kLeastError = 1e-2;  // that a prediction counts with, of the tolerance

}  // namespace

void StepControl::begin(double h) {
  if (!step_) step_ = h;
}

void StepControl::reject(double h, std::optional<double> error) {
  rejected_ = true;
  step_ = h * (error ? std::max(kShrink, kSafety * std::pow(*error, -0.25)) : kShrink);
}

/// How the error changed from step to step tells what it will do next: without it every third step or so of a
/// ringing rod is tried in vain. After a step tried in vain the two steps are too unlike to tell anything.
double StepControl::wished_factor(double h, double error, const EmbeddedStepper& by) {
  const double grow = -1.0 / (by.error_order() + 1);  // -0.2 for Cash-Karp
  const double safety = by.stiff() ? kStiffSafety : kSafety;
  double wish = error > 0.0 ? safety * std::pow(error, grow) : kGrow;
  if (!by.stiff()) return wish;
  const double e = std::max(error, kLeastError);
  if (std::exchange(rejected_, false))
    wish = std::min(wish, 1.0);
  else if (last_stiff_)
    wish = std::min(
        wish, std::max(kShrink, safety * std::pow(last_stiff_->error / (e * e), -grow) * h / last_stiff_->h));
  last_stiff_ = {h, e};
  return wish;
}

void StepControl::accept(double h, double error, const EmbeddedStepper& by) {
  const double wish = wished_factor(h, error, by);
  const double factor = std::min(kGrow, wish);
  wish_ = h * wish;
  // A step cut short by an output says little about the next one.
  const bool cut = h < 0.99 * *step_;
  step_ = cut ? std::max(*step_ * std::min(factor, 1.0), h * factor) : h * factor;
}

}  // namespace tendril
