#pragma once

#include "statics_tangent.h"

namespace tendril {

/// Newton's method from near an equilibrium.
class StaticNewton {
 public:
  /// Kept by reference.
  StaticNewton(StaticProblem& problem, const StaticsOptions& options);

  enum class Outcome { found, stalled, work_limit, not_evaluable, too_unstable, unheld };
  /// Moves `at` (evaluated) to an equilibrium at its load and time. On another outcome `at` is not to be
  /// used, and reason() says why.
  /// \param most_unstable  directions that may be unstable where it begins
  Outcome find(StaticState& at, int most_unstable);

  /// Moves `at`, found, off what is unstable at all, however hardly, and to balance again.
  Outcome settle(StaticState& at);

  /// -K^-1 rate, with the tangent at the static state; empty when there is none.
  Eigen::VectorXd follow(const StaticState& at, const Eigen::VectorXd& rate);

  int unstable() const { return unstable_; }  ///< directions at the last tangent
  const std::string& reason() const { return reason_; }
  double last_step() const { return last_step_; }
  int last_iterations() const { return last_iterations_; }
  StaticTangent& tangent() { return tangent_; }
  long iterations = 0;
  int left = 0;  ///< unstable equilibria left

 private:
  struct Step {
    Eigen::VectorXd x;
    double size = 0.0;  ///< of x, whole
    double part = 1.0;  ///< of it that may be taken
    bool downhill = true;
  };
  bool out_of_work();
  bool factorise(const StaticState& at);
  double least_lift() const;
  bool lift(double least);
  bool plan(const StaticState& at, Step& step);
  Outcome approach(StaticState& at);
  Outcome descend(StaticState& at);
  Outcome contract(StaticState& at);
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  double size_of(const Eigen::VectorXd& x, const StaticState& at) const;
  bool chords(StaticState& at, Step& step);
  bool take_downhill(StaticState& at, const Step& step);
  bool leave(StaticState& at, double threshold);
  bool fall(const StaticState& at, double amplitude, const Eigen::VectorXd& x, StaticState& lowest);
  bool try_move(const StaticState& from, const Eigen::VectorXd& x, StaticState& to);
  double noise(const StaticState& at) const;
  // Of balance, in statics_balance.cpp.
  bool balanced(const StaticState& at) const;
  bool tighten(StaticState& at);
  Outcome balance(StaticState& at, bool leaving);
  bool stiffen(const StaticState& at);
  bool fall_or_contract(StaticState& at, const Step& step);
  void polish(StaticState& at);
  bool unheld(const StaticState& at, const Eigen::VectorXd& x);
  Outcome fail_to_balance(const StaticState& at, const Eigen::VectorXd& x);
  Outcome without_resistance(const StaticState& at);
  bool gains_nothing(const StaticState& at, const Step& step) const;
  Outcome fail(Outcome outcome, std::string reason);

  StaticProblem& problem_;
  const StaticsOptions& options_;
  StaticTangent tangent_;
  bool seeks_stable_;
  bool factored_ = false;
  int unstable_ = 0, most_unstable_ = 0;
  bool indefinite_ = false;
  bool cautious_ = false;  ///< neutral directions are kept out of steps
  double shift_ = 0.0;
  StaticState best_;  ///< lowest energy so far
  int uphill_ = 0;    ///< steps since
  double limit_ = 1.0;
  std::string reason_;
  Evaluation failure_;
  double last_step_ = 0.0;
  int last_iterations_ = 0;
};

}  // namespace tendril
