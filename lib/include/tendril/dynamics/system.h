#pragma once

#include <tendril/curve/curve_pair.h>
#include <tendril/dynamics/anchor.h>
#include <tendril/dynamics/force.h>
#include <tendril/dynamics/joint.h>
#include <tendril/dynamics/rod.h>

#include <memory>
#include <string>
#include <vector>

namespace tendril {

/// What a scene is made of, as the user says it.
struct Scene {
  std::vector<Rod> rods;
  std::vector<Anchor> anchors;
  std::vector<Joint> joints;
  std::vector<std::shared_ptr<const Force>> forces;
  /// Whether the twist angle and spin of each node are states. Left out, each rod keeps the directors that
  /// are carried along it without twist, and bends by the angle alone.
  enum class Twist { where_needed, everywhere } twist = Twist::where_needed;
};

/// The state of all rods: the integrated numbers y, and the frames they are measured against.
///
/// y = (p 3n | v 3n | theta m | w m | work 1), n nodes, m of them with twist (all of a rod or none). theta_i
/// is the angle of the director against `director[i]` carried from `tangent[i]` to the tangent by the
/// smallest rotation; w_i the spin about the tangent; work that done so far by forces without an energy, by
/// damping and by moving anchors.
struct State {
  double time = 0.0;
  Eigen::VectorXd y;
  std::vector<Vec3> tangent, director;  ///< reference frames, renewed after every accepted step
  std::vector<double> twist;            ///< unwrapped twist of each edge at the reference
};

/// Whether the equations could be evaluated, and if not, why and where.
struct Evaluation {
  enum class Outcome {
    ok,
    zero_edge,
    fold_back,
    turned_too_far,
    not_finite,
    not_converged  ///< an implicit step's equations
  } outcome = Outcome::ok;
  std::size_t node = 0;  ///< flat index
  bool ok() const { return outcome == Outcome::ok; }
};

/// Energies in the scene's units. total() + work taken out is constant up to the integration error.
struct Energies {
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;
  double total() const { return kinetic + elastic + potential; }
};

/// A scene flattened once into the arrays its motion needs: no twist source, no twist state; no force, no
/// loads. Equations of motion: shared-frame rods with the elastic energy of rod.h, its exact gradient, the
/// connection term of the carried director and the gyroscopic force of the spin. Const and pure: safe to call
/// from several threads, each with its own Workspace.
class System {
 public:
  /// Throws InvalidInput naming rod, node and field ("rods[0].mass[3]").
  explicit System(Scene scene);
  ~System();
  System(System&&) noexcept;
  System& operator=(System&&) noexcept;

  class Workspace;  ///< scratch arrays of one evaluation
  struct Release {
    void operator()(Workspace* work) const;
  };
  using WorkspacePtr = std::unique_ptr<Workspace, Release>;
  WorkspacePtr make_workspace() const;

  std::span<const NodeRange> rods() const;
  std::size_t node_count() const;
  std::size_t twist_count() const;  ///< nodes with a twist state
  const Scene& scene() const;
  /// What the scene did not need, one sentence each.
  const std::vector<std::string>& left_out() const;

  /// All nodes at rest, anchors as at `time`.
  State rest_state(double time = 0.0) const;

  /// dy/dt at (t, y). On failure dy is not to be used.
  Evaluation derivative(const State& reference, double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy,
                        Workspace& work) const;

  /// Elastic energy, its gradient: 3n entries dE/dp, then m entries dE/dspin (an infinitesimal turn about the
  /// tangent).
  Evaluation elastic_gradient(const State& reference, double t, const Eigen::VectorXd& y, double& energy,
                              Eigen::VectorXd& gradient, Workspace& work) const;

  Energies energies(const State& state, Workspace& work) const;

  /// Makes the state's own frames its reference: theta becomes 0, twists are unwrapped, anchored entries get
  /// their pose.
  Evaluation rebase(State& state, Workspace& work) const;

  /// Node frames of a state (l, m, t), n of them.
  std::vector<Frame> frames(const State& state, Workspace& work) const;

  /// Orientation masses q_i = p_i + r_i (a_i m_i + b_i t_i), with r_i, a_i, b_i those of the rest shape.
  std::vector<Vec3> orientation_masses(const State& state, Workspace& work) const;

  /// Estimate of the largest frequency [rad / time] about the state: Lanczos on M^-1 dF/dx with `vectors`
  /// evaluations.
  double largest_frequency(const State& state, int vectors, Workspace& work) const;

  struct Model;  ///< the flat arrays, private to the module
  const Model& model() const { return *model_; }

 private:
  std::unique_ptr<const Model> model_;
};

}  // namespace tendril
