#pragma once

#include <Eigen/Cholesky>
#include <stdexcept>

#include "support/rods.h"

namespace tendril::test {

/// The free coordinates of a system: places in y of those that no anchor holds, and their rows in the
/// gradient.
struct FreeCoordinates {
  explicit FreeCoordinates(const System& system) {
    const auto n = static_cast<Eigen::Index>(system.node_count());
    std::vector<bool> position(system.node_count(), true);
    std::vector<bool> frame(system.node_count(), system.twist_count() > 0);
    for (const Anchor& anchor : system.scene().anchors) {
      const std::size_t node = system.rods()[anchor.rod].first + anchor.node;
      if (anchor.holds_position) position[node] = false;
      if (anchor.holds_frame) frame[node] = false;
    }
    for (const Joint& joint : system.scene().joints)
      position[system.rods()[joint.child].first] = frame[system.rods()[joint.child].first] = false;
    for (Eigen::Index i = 0; i < n; ++i)
      for (int axis = 0; axis < 3 && position[static_cast<std::size_t>(i)]; ++axis)
        add(3 * i + axis, 3 * i + axis);
    for (Eigen::Index i = 0; i < n; ++i)
      if (frame[static_cast<std::size_t>(i)]) add(6 * n + i, 3 * n + i);
  }
  void add(Eigen::Index in_y, Eigen::Index in_gradient) {
    y.push_back(in_y);
    gradient.push_back(in_gradient);
  }
  std::vector<Eigen::Index> y, gradient;
};

/// dE/dx of the free coordinates at a state.
inline Eigen::VectorXd elastic_gradient(const System& system, const FreeCoordinates& free, const State& state,
                                        const Eigen::VectorXd& y) {
  const auto work = system.make_workspace();
  double energy = 0.0;
  Eigen::VectorXd gradient;
  if (!system.elastic_gradient(state, state.time, y, energy, gradient, *work).ok())
    throw std::runtime_error("no gradient");
  return gradient(free.gradient);
}

/// The same by (p, theta) away from the reference, where theta's axis is carried along: what a Hessian is the
/// derivative of. The carried director spins by -((t_s x t).dt) / (1 + t_s.t) of its own.
inline Eigen::VectorXd coordinate_gradient(const System& system, const FreeCoordinates& free,
                                           const State& state, const Eigen::VectorXd& y) {
  const auto work = system.make_workspace();
  double unused = 0.0;
  Eigen::VectorXd gradient;
  const double h = 1e-6;
  if (!system.elastic_gradient(state, state.time, y, unused, gradient, *work).ok())
    throw std::runtime_error("no gradient");
  const auto n = static_cast<Eigen::Index>(system.node_count());
  const Eigen::VectorXd torque = gradient.tail(gradient.size() - 3 * n);
  if (torque.size() == 0) return gradient(free.gradient);
  // t_s x t weighted with the torques is pulled back to the positions by differences: it vanishes at the
  // reference.
  const auto tangents = [&](const Eigen::VectorXd& at) {
    State moved = state;
    moved.y = at;
    std::vector<Vec3> t;
    for (const Frame& frame : system.frames(moved, *work)) t.push_back(frame.z);
    return t;
  };
  const std::vector<Vec3> now = tangents(y);
  for (const Eigen::Index k : free.gradient) {
    if (k >= 3 * n) continue;
    Eigen::VectorXd up = y;
    Eigen::VectorXd down = y;
    up[k] += h;
    down[k] -= h;
    const std::vector<Vec3> above = tangents(up);
    const std::vector<Vec3> below = tangents(down);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Vec3 rate = (above[i] - below[i]) / (2 * h);
      const Vec3& from = state.tangent[i];
      gradient[k] -=
          torque[static_cast<Eigen::Index>(i)] * from.cross(now[i]).dot(rate) / (1 + from.dot(now[i]));
    }
  }
  return gradient(free.gradient);
}

/// Hessian of the elastic energy by central differences of the exact gradient, made symmetric.
inline Eigen::MatrixXd stiffness(const System& system, const FreeCoordinates& free, const State& state,
                                 double h = 1e-6) {
  const auto size = static_cast<Eigen::Index>(free.y.size());
  Eigen::MatrixXd k(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    Eigen::VectorXd up = state.y;
    Eigen::VectorXd down = state.y;
    up[free.y[static_cast<std::size_t>(i)]] += h;
    down[free.y[static_cast<std::size_t>(i)]] -= h;
    k.col(i) =
        (elastic_gradient(system, free, state, up) - elastic_gradient(system, free, state, down)) / (2 * h);
  }
  return 0.5 * (k + k.transpose());
}

/// Equilibrium under a dead load on one node, by Newton's method along a ladder of load shares.
inline State equilibrium(const System& system, std::size_t node, const Vec3& load, int shares) {
  const FreeCoordinates free(system);
  State state = system.rest_state();
  const auto work = system.make_workspace();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(state.y.size());
  force.segment<3>(3 * static_cast<Eigen::Index>(node)) = load;
  for (int share = 1; share <= shares; ++share) {
    for (int iteration = 0; iteration < 60; ++iteration) {
      const Eigen::VectorXd residual = elastic_gradient(system, free, state, state.y) -
                                       force(free.y) * (static_cast<double>(share) / shares);
      const Eigen::VectorXd step = stiffness(system, free, state).ldlt().solve(residual);
      // A long rod bends far in one Newton step: no coordinate moves more than an edge or half a radian at
      // once.
      const double damping = std::min(1.0, 0.02 / step.cwiseAbs().maxCoeff());
      state.y(free.y) -= damping * step;
      if (!system.rebase(state, *work).ok()) throw std::runtime_error("Newton left the domain");
      if (damping == 1.0 && step.cwiseAbs().maxCoeff() < 1e-10) break;
      if (iteration == 59) throw std::runtime_error("Newton did not converge");
    }
  }
  return state;
}

}  // namespace tendril::test
