#pragma once

#include <functional>
#include <optional>
#include <span>

#include "bench/problems.h"

namespace tendril::bench {

/// One run of one method at one tolerance.
struct Trial {
  double tolerance = 0.0;
  double seconds = 0.0;  ///< CPU time, minimum of repeats
  double reached = 0.0;  ///< simulated time it got to
  long steps = 0;        ///< accepted
  long evaluations = 0;  ///< of the equations
  Eigen::VectorXd p;     ///< 3n positions at the end
  bool capped = false;   ///< stopped because its time was up
  std::string failure;   ///< why it gave up or refused; empty otherwise
  std::string path;      ///< what an automatic run chose
  bool done() const { return !capped && failure.empty(); }
};

/// A method. `run` takes a problem, a tolerance and a cap on the CPU time [s].
struct Solver {
  std::string name;
  std::function<Trial(const Problem&, double, double)> run;
};

std::vector<Solver> own_solvers();
/// Peers that were found when the bench was built; empty when not.
std::vector<Solver> odeint_solvers();
std::vector<Solver> sundials_solvers();
/// Name and version, or that it is absent.
std::string odeint_version();
std::string sundials_version();
std::string mujoco_version();

/// Root mean square distance of the nodes over the problem's length.
double distance(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Where the nodes end, made and checked by two runs.
struct Reference {
  Eigen::VectorXd p;
  double gap = 0.0;          ///< between the two
  std::string by;            ///< names them
  bool independent = false;  ///< two methods, not one at two tolerances
};
/// What each of its runs may take.
struct Effort {
  double seconds;    ///< of CPU
  double tolerance;  ///< no tighter than this
  double gap;        ///< close enough
};
std::optional<Reference> make_reference(const Problem& problem, const Effort& effort);

/// A second opinion that shares nothing with the methods compared: linearly implicit Euler at steps halved
/// until the time is up, its error taken away power by power of the step (Romberg). For rods without twist;
/// O(nodes) a step.
struct Extrapolated {
  Eigen::VectorXd p;
  double settled;  ///< how far the last halving moved it, relative to the length
  int steps;       ///< the most
};
std::optional<Extrapolated> extrapolated_euler(const Problem& problem, double seconds);

/// The equations of a problem as peers see them: dy = f(t, y) on all of System's y. The frames that a rod
/// without twist is measured against may be renewed at any time, so every 32nd step is enough and costs
/// nothing; rods with twist have them renewed after every step, which changes y.
class Flow {
 public:
  explicit Flow(const Problem& problem)
      : problem_(problem), reference_(problem.start), work_(problem.system.make_workspace()) {
    if (problem.system.twist_count() > 0) interval_ = 1;
  }
  Evaluation operator()(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    ++evaluations_;
    return problem_.system.derivative(reference_, t, y, dy, *work_);
  }
  /// \return whether y was changed
  bool accepted(double t, Eigen::VectorXd& y) {
    if (++steps_ % interval_ != 0) return false;
    State next = reference_;
    next.time = t;
    next.y = y;
    if (!problem_.system.rebase(next, *work_).ok()) return false;
    reference_ = std::move(next);
    if (interval_ > 1) return false;
    y = reference_.y;
    return true;
  }
  long evaluations() const { return evaluations_; }
  long steps() const { return steps_; }

 private:
  const Problem& problem_;
  State reference_;
  System::WorkspacePtr work_;
  long evaluations_ = 0, steps_ = 0, interval_ = 32;
};

}  // namespace tendril::bench
