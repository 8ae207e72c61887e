#pragma once

#include <Eigen/SparseCore>

#include "dynamics/coupling/coupled_nodes.h"
#include "statics_coordinates.h"

namespace tendril {

/// External forces of a scene at rest, on the free coordinates.
class StaticLoads {
 public:
  /// Both kept by reference.
  StaticLoads(const System& system, const StaticCoordinates& coordinates);

  /// All loads have an energy, or are the same in every state.
  bool conservative() const { return conservative_; }
  bool any() const { return !system_.scene().forces.empty(); }

  /// Loads on the free coordinates at the state's time; `potential` is their energy, by their definition or
  /// as dead loads.
  Evaluation add(const State& state, Eigen::VectorXd& q, double& potential, System::Workspace& work);

  /// dq/dx: exact where a force says its derivatives, else by central differences, coloured by the pairs of
  /// nodes that springs and these forces couple, at this state where they say so.
  /// \param pattern  of the elastic Hessian, in the order of System::elastic_gradient
  Evaluation differentiate(const State& state, const Eigen::SparseMatrix<double>& pattern,
                           std::vector<Eigen::Triplet<double>>& out, System::Workspace& work);
  bool depends_on_state() const { return depends_on_state_; }

  /// Sum of the sizes of the forces last added, of torques over the length.
  double sum() const { return sum_; }
  /// Forces on the nodes last added, with what torques across free tangents push them by.
  const std::vector<Vec3>& force() const { return force_; }
  /// And the torques.
  const std::vector<Vec3>& torque() const { return torque_; }

 private:
  /// One of the scene's forces: what acts, or null and an acceleration of every mass.
  struct External {
    const Model::Acting* acting;
    Vec3 acceleration;
    NodePairs always = {};  ///< what differences of it couple, where that is the same in every state
    /// Without an energy, and the same in every state.
    bool dead() const { return acting && !acting->has_energy && !acting->couplings.any(); }
  };
  /// A force that differences are taken of, and its loads beside a state where it says them.
  struct Differenced {
    const Model::Acting* acting;
    std::function<void(const StateView&, const Loads&)> beside;
  };
  StateView view_of(const State& state, const std::vector<Frame>& frames);
  Loads no_loads(std::size_t* refused = nullptr);
  void add_living(const External& one, const State& state, StateView& view, const Loads& loads,
                  double& potential) const;
  void pass_to_parents();
  void pull_back(const std::vector<Frame>& frames, Eigen::VectorXd& q);
  void pull_back_turn(const NodeRange& rod, std::size_t node, const Vec3& by_tangent);
  void put_exact(const State& state, StateView& view, std::vector<Eigen::Triplet<double>>& out);
  bool dead_torques(const State& state, StateView& view);
  NodePairs find_differenced(const State& state, StateView& view);
  Evaluation take_differences(const State& state, std::vector<Eigen::Triplet<double>>& out,
                              System::Workspace& work);
  void colour(const Eigen::SparseMatrix<double>& pattern, NodePairs pairs);
  Evaluation moved(const State& state, const Eigen::VectorXd& x, Eigen::VectorXd& q, System::Workspace& work);

  const System& system_;
  const StaticCoordinates& coordinates_;
  std::vector<External> forces_;  ///< in the scene's order
  bool conservative_ = true, depends_on_state_ = false;
  double sum_ = 0.0;
  std::vector<double> mass_, width_, spin_;
  std::vector<Vec3> p_, v_, t_, m_, force_, torque_;
  std::vector<Differenced> differenced_;           ///< at the last state
  NodePairs coloured_;                             ///< what they coupled when near_ and colours_ were made
  std::vector<std::vector<std::size_t>> near_;     ///< per node, the nodes it couples with, itself too
  std::vector<std::vector<std::size_t>> colours_;  ///< nodes that feel nothing in common
};

}  // namespace tendril
