#pragma once

#include "statics_tangent.h"

namespace tendril {

/// Newton's method from near an equilibrium.
class StaticNewton {
 public:
  /// Kept by reference.
  StaticNewton(StaticProblem& problem, const StaticsOptions& options);

  enum class Outcome { found, stalled, work_limit, not_evaluable, too_unstable };
  /// Moves `at` (settled) to an equilibrium at its load and time. On another outcome `at` is not to be used,
  /// and reason() says why.
  /// \param most_unstable  directions that may be unstable where it begins
  Outcome find(Poise& at, int most_unstable);

  /// -K^-1 rate, with the tangent at the poise; empty when there is none.
  Eigen::VectorXd follow(const Poise& at, const Eigen::VectorXd& rate);

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
  bool factorise(const Poise& at);
  double least_lift() const;
  bool lift(double least);
  bool plan(const Poise& at, Step& step);
  Outcome descend(Poise& at);
  Outcome contract(Poise& at);
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  double size_of(const Eigen::VectorXd& x, const Poise& at) const;
  bool chords(Poise& at, Step& step);
  bool take_downhill(Poise& at, const Step& step);
  bool leave(Poise& at);
  bool fall(const Poise& at, double amplitude, const Eigen::VectorXd& x, Poise& lowest);
  bool try_move(const Poise& from, const Eigen::VectorXd& x, Poise& to);
  double noise(const Poise& at) const;
  bool gains_nothing(const Poise& at, const Step& step) const;
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
  Poise best_;      ///< lowest energy so far
  int uphill_ = 0;  ///< steps since
  double limit_ = 1.0;
  std::string reason_;
  Evaluation failure_;
  double last_step_ = 0.0;
  int last_iterations_ = 0;
};

}  // namespace tendril
