#pragma once

#include <tendril/dynamics/system.h>

#include <vector>

namespace tendril {

/// What the error of a step is relative to: see SimulationOptions.
class ErrorScale {
 public:
  /// \param system  kept by reference
  explicit ErrorScale(const System& system);

  /// Takes the speeds of a state into the largest so far.
  void see(const State& state);
  void see(double speed) { speed_ = speed > speed_ ? speed : speed_; }

  /// Largest component of an error laid out like y, relative to its scale.
  double norm(const Eigen::VectorXd& error) const;

  double speed() const { return speed_; }
  double longest() const { return longest_; }

 private:
  void see_bodies(const State& state);
  double norm_of_bodies(const Eigen::VectorXd& error, double speed) const;

  const System& system_;
  std::vector<double> rod_length_;
  std::vector<double> speed_share_;  ///< per node, what an error of its velocity counts
  std::vector<double> body_size_;    ///< radius of gyration
  double longest_ = 0.0, speed_ = 0.0;
};

}  // namespace tendril
