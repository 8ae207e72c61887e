#pragma once

#include <tendril/dynamics/stepper.h>

#include <optional>

namespace tendril {

/// The next step from the errors of the last ones, all relative to the tolerance: [Chan 2008] 3.34, and for
/// stiff methods predictive control [Gustafsson 1994].
class StepControl {
 public:
  /// Where no step is known yet, or the last one was given up.
  /// \param h  positive
  void begin(double h);

  double step() const { return *step_; }
  /// What the last error would have allowed, without the bounds of a factor.
  double wish() const { return wish_.value_or(*step_); }

  /// A step was tried in vain.
  /// \param error  none where it could not be evaluated
  void reject(double h, std::optional<double> error);
  /// There is no step at all.
  void give_up() { step_.reset(); }
  void accept(double h, double error, const EmbeddedStepper& by);
  /// Goes on with this step, whatever the last ones were.
  void go_on_with(double h) { step_ = h, last_stiff_.reset(); }
  /// What comes next is not to be told from what was.
  void at_most(double h) { step_ = h < *step_ ? h : *step_; }

 private:
  double wished_factor(double h, double error, const EmbeddedStepper& by);

  struct Step {
    double h, error;
  };
  std::optional<double> step_, wish_;
  std::optional<Step> last_stiff_;  ///< accepted
  bool rejected_ = false;  ///< a step was tried in vain since the last accepted one of a stiff method
};

}  // namespace tendril
