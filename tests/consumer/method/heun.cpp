#include "dynamics/steppers/method_row.h"

namespace tendril {
namespace {

/// Heun's method: y + h / 2 (f(t, y) + f(t + h, y + h f(t, y))).
class Heun : public Stepper {
 public:
  explicit Heun(const System& system) : system_(system), work_(system.make_workspace()) {}

  Evaluation advance(State& state, double h) override {
    evaluations_ += 2;
    Evaluation at = system_.derivative(state, state.time, state.y, first_, *work_);
    if (at.ok()) at = system_.derivative(state, state.time + h, state.y + h * first_, second_, *work_);
    if (!at.ok()) return at;
    state.y += 0.5 * h * (first_ + second_);
    state.time += h;
    return system_.rebase(state, *work_);
  }
  long evaluations() const override { return evaluations_; }
  const char* name() const override { return "Heun 2"; }

 private:
  const System& system_;
  System::WorkspacePtr work_;
  Eigen::VectorXd first_, second_;
  long evaluations_ = 0;
};

}  // namespace

// |R(i y)|^2 = 1 + y^4 / 4.
MethodInfo heun_method() {
  return {kUnnumbered, "heun", 2, 2, {0.0, 2.0}, false, Chooses::nothing, made<Heun>};
}

}  // namespace tendril
