#pragma once

#include <tendril/dynamics/system.h>

#include <vector>

#include "dynamics/scene/free_bodies.h"

namespace tendril {

/// What the error of a step is relative to: see SimulationOptions. Speeds are those of a tree (rods joined so
/// that each feels the other). Of one that nothing holds, the error of the common velocity counts by that
/// velocity, and the rest by how the tree moves in itself: a fall must not hide what becomes of a spin.
class ErrorScale {
 public:
  /// \param system  kept by reference
  explicit ErrorScale(const System& system);

  /// Largest speeds of a tree or a rigid body so far.
  struct Speed {
    double own = 0.0;     ///< about the common velocity, or at all where something holds it
    double common = 0.0;  ///< 0 where something holds it, and of a rigid body
  };

  /// Takes the speeds of a state into the largest so far.
  void see(const State& state);
  /// Takes the speeds that accelerations give over the longest rod's length, of a body over its own.
  /// \param rate  y' of a state
  void see_start(const Eigen::VectorXd& rate);
  /// Goes on with those of the same bodies in a scene laid out anew.
  void see(const std::vector<Speed>& speeds);
  /// No speed scale is below a thousandth of a length in this time.
  void begin(double duration) { slowest_ = duration > 0.0 ? kLeast * longest_ / duration : 0.0; }
  /// Looks ahead to the end of a run. A tree that nothing holds goes on with the turn that it has, and one
  /// that is let go before the end with all its velocity: over the flight their errors become errors of
  /// place. They count by what the flight makes of them, if that is more.
  void look_ahead(double now, double until);

  /// Largest component of an error laid out like y, made in a step h to y, relative to its scale.
  double norm(const Eigen::VectorXd& error, const Eigen::VectorXd& y, double h) const;

  /// Of the speed that steps' errors are measured on, that which a flight to come allows instead; at most 1.
  double share_of_flight() const;

  const std::vector<Speed>& speeds() const { return speeds_; }  ///< per tree, then per rigid body
  double energy() const;                                        ///< kinetic, at their own speeds
  double energy_of_bodies() const;                              ///< of these, that of the rigid bodies
  double common_energy() const;                                 ///< kinetic, at their common speeds
  /// The largest kinetic energy of masses and bodies that was seen, and of it without the common motions.
  double most_kinetic() const { return most_kinetic_; }
  double most_own_kinetic() const { return most_own_kinetic_; }
  /// In which the fastest, however it moves, goes the longest rod's length; infinite where nothing moves.
  double time_of_a_length() const { return longest_ / fastest_; }
  double rate() const;  ///< the largest of these, in lengths of the longest rod a time unit

 private:
  struct Flight {
    double speed;  ///< that goes the tree's longest rod's length in it; infinite where there is none
    double over;   ///< the time over which errors add up
  };

  static constexpr double kLeast = 1e-3;  ///< of the fastest tree's speed, too

  /// Into the largest so far.
  void take(std::size_t part, const Speed& speed);
  double least_speed() const;
  double speed_of(std::size_t body, const Eigen::VectorXd& y) const;
  double norm_of_bodies(const Eigen::VectorXd& error) const;
  double own_speed(std::size_t part) const;
  double flying_speed(std::size_t tree, double h) const;
  double turn_of(std::size_t tree, const Eigen::VectorXd& error, const Eigen::VectorXd& y) const;
  double velocity_norm(std::size_t tree, double speed, const Eigen::VectorXd& error) const;
  double turning_norm(std::size_t tree, double speed, const Eigen::VectorXd& error) const;

  const System& system_;
  std::vector<Tree> trees_;
  std::vector<double> tree_mass_;
  std::vector<double> rod_length_;
  std::vector<double> mass_;         ///< per node
  std::vector<double> speed_share_;  ///< per node, what an error of its velocity counts
  std::vector<double> body_size_;    ///< radius of gyration
  std::vector<double> body_length_;  ///< that errors of its place are measured on
  std::vector<Flight> flights_;      ///< per tree
  std::vector<Speed> speeds_;        ///< see speeds()
  double longest_ = 0.0, slowest_ = 0.0;
  double fastest_ = 0.0;  ///< of all speeds: each tree's is held against it, at every step
  double most_kinetic_ = 0.0, most_own_kinetic_ = 0.0;
};

}  // namespace tendril
