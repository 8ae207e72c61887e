#pragma once

#include <tendril/dynamics/statics.h>
#include <tendril/dynamics/supports.h>

#include "statics_loads.h"

namespace tendril {

/// A state that is its own reference, and how far it is from balance.
struct StaticState {
  State state;
  double load = 0.0;
  double elastic = 0.0, potential = 0.0;
  Eigen::VectorXd gradient;  ///< elastic, in the order of System::elastic_gradient
  Eigen::VectorXd loads;     ///< on the free coordinates, at their full share
  Eigen::VectorXd residual;  ///< elastic gradient less the share of the loads
  double pushed = 0.0;       ///< sum of the loads' sizes, at their full share
  double energy() const { return elastic + load * potential; }
};

/// Unbalanced forces and tangent of a system at rest.
class StaticProblem {
 public:
  explicit StaticProblem(const System& system);

  const System& system() const { return system_; }
  const StaticCoordinates& coordinates() const { return coordinates_; }
  Eigen::Index size() const { return coordinates_.size(); }
  bool conservative() const { return conservative_; }

  /// Renews the frames of a static state whose state and load are set, and fills the rest.
  Evaluation evaluate(StaticState& at);

  /// A static state moved by x at its load and on to `time`, evaluated.
  Evaluation move(const StaticState& from, const Eigen::VectorXd& x, double time, double load,
                  StaticState& to);

  /// d residual / ds on the path (load, time) + s (by_load, by_time), 0 <= s <= 1.
  Evaluation drift(const StaticState& at, double by_load, double by_time, Eigen::VectorXd& rate);

  /// d residual / dx, of conservative scenes the lower triangle.
  Evaluation tangent(const StaticState& at, Eigen::SparseMatrix<double>& k);

  /// What unbalanced forces count as none against: 1e-9 of the larger of the loads and the reactions of held
  /// nodes, or what rounding makes of them, where that is more.
  double goal(const StaticState& at) const;
  /// Equilibrium::force_scale.
  double force_scale(const StaticState& at) const;
  /// Largest force, or torque over the length.
  double largest(const Eigen::VectorXd& residual) const;
  /// What anchors do to their nodes; empty where that cannot be evaluated.
  std::vector<Support> supports(const StaticState& at);

 private:
  double pushed(const StaticState& at) const;
  std::vector<Vec3> elastic_torques(const StaticState& at);
  double rounding(const StaticState& at) const;
  void add_turning(const StaticState& at, std::vector<Eigen::Triplet<double>>& out) const;
  void put_turning(std::size_t k, std::size_t j, double c, const Vec3& t, const Vec3& dk, const Vec3& dj,
                   std::vector<Eigen::Triplet<double>>& out) const;

  const System& system_;
  System::WorkspacePtr work_;
  StaticCoordinates coordinates_;
  StaticLoads loads_;
  bool conservative_;
  Eigen::SparseMatrix<double> elastic_;  ///< the last Hessian
  // The same scene with anchors that turn, but stay where they are at the clock's time.
  std::shared_ptr<double> clock_ = std::make_shared<double>(0.0);
  std::optional<System> turning_;
  System::WorkspacePtr turning_work_;
};

}  // namespace tendril
