#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/frames.h>
#include <tendril/dynamics/scene.h>
#include <tendril/dynamics/state.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace tendril {

/// A scene flattened once into the arrays its motion needs: no twist source, no twist state; no force, no
/// loads. Equations of motion: rods whose bending is measured in node frames
/// shared by both edges, with the elastic energy of rod.h, its exact gradient, the
/// connection term of the carried director and the gyroscopic force of the spin. Const and pure: safe to call
/// from several threads, each with its own Workspace.
class TENDRIL_CORE_API System {
 public:
  /// Throws InvalidInput naming rod or body, node and field ("rods[0].mass[3]", "bodies[1].inertia").
  /// \param scene  copied
  /// \param from  anchors released at this time or before hold nothing; the layout of the state is that of
  ///              the whole scene whatever is released
  explicit System(Scene scene, double from = -std::numeric_limits<double>::infinity());
  ~System();
  System(System&&) noexcept;             ///< leaves an object to be destroyed or assigned to
  System& operator=(System&&) noexcept;  ///< the same

  class Workspace;  ///< scratch arrays of one evaluation
  struct TENDRIL_CORE_API Release {
    void operator()(Workspace* work) const;  ///< deletes it
  };
  using WorkspacePtr = std::unique_ptr<Workspace, Release>;  ///< owns a workspace
  WorkspacePtr make_workspace() const;                       ///< for calls on this system, one at a time

  std::span<const NodeRange> rods() const;  ///< nodes of each rod
  std::size_t node_count() const;           ///< n
  std::size_t twist_count() const;          ///< nodes with a twist state
  std::size_t body_count() const;           ///< k, free rigid bodies
  const Scene& scene() const;               ///< the copy
  /// What the scene did not need, one sentence each.
  const std::vector<std::string>& left_out() const;

  /// All nodes at rest, anchors as at `time`, bodies as the scene says.
  State rest_state(double time = 0.0) const;

  /// dy/dt at (t, y). On failure dy is not to be used.
  Evaluation derivative(const State& reference, double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy,
                        Workspace& work) const;

  /// Elastic energy, its gradient: 3n entries dE/dp, then m entries dE/dspin (an infinitesimal turn about the
  /// tangent).
  Evaluation elastic_gradient(const State& reference, double t, const Eigen::VectorXd& y, double& energy,
                              Eigen::VectorXd& gradient, Workspace& work) const;

  /// Energies of a state whose equations can be evaluated.
  Energies energies(const State& state, Workspace& work) const;

  /// Makes the state's own frames its reference: theta becomes 0, twists are unwrapped, anchored entries get
  /// their pose.
  Evaluation rebase(State& state, Workspace& work) const;

  /// The bodies of a state, k of them; none where one turned too far from its reference.
  std::vector<BodyView> bodies(const State& state) const;

  /// Puts a body of a state elsewhere, or gives it another motion, as an impact does (Simulation::change).
  /// The rotation is taken to the nearest one; the mass is not looked at.
  void set_body(State& state, std::size_t body, const BodyView& to) const;

  /// Asks the forces that may refuse a state (Force::refuses) whether they refuse this one. A Simulation does
  /// so before it accepts a step; who drives a stepper does.
  Evaluation refusal(const State& state, Workspace& work) const;

  /// Asks every force what to remember at a state (Force::remember), and counts as work what that changes in
  /// their energy. A Simulation does so at its start and after each accepted step; who drives a stepper does.
  /// True when something was remembered anew: then steppers restart.
  bool remember(State& state, Workspace& work) const;

  /// Node frames of a state (l, m, t), n of them.
  std::vector<Frame> frames(const State& state, Workspace& work) const;

  /// Orientation masses q_i = p_i + r_i (a_i m_i + b_i t_i), with r_i, a_i, b_i those of the rest shape.
  std::vector<Vec3> orientation_masses(const State& state, Workspace& work) const;

  /// Estimate of the largest frequency [rad / time] about the state: Lanczos's method [Lanczos 1950] on
  /// M^-1 dF/dx with `vectors` evaluations; no less than that of the nutation of a body that spins.
  double largest_frequency(const State& state, int vectors, Workspace& work) const;

 private:
  friend struct SystemAccess;
  struct Model;  ///< the flat arrays
  std::unique_ptr<const Model> model_;
};

}  // namespace tendril
