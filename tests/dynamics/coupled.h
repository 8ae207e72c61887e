#pragma once

#include <gtest/gtest.h>

#include "dynamics/scene/model.h"
#include "dynamics/steppers/stiff_solver.h"
#include "support/rods.h"
#include "support/springs.h"

namespace tendril::test {

inline Rod rod_at(double y, int edges, bool twist) {
  std::vector<Vec3> p = straight(edges, 1.0);
  for (Vec3& point : p) point.y() = y;
  return make_rod(p, orientation_towards(p, Vec3(0, 0.5, 1), 0.1), {1e5, 1e5 / 3, 1000},
                  elliptic_section(0.02, twist ? 0.012 : 0.02));
}

/// What solves (s - J) U = r, put back with J U by central differences of the equations, over the size of J
/// U.
inline double coupled_residual(const System& system, double s) {
  const Model& model = model_of(system);
  Random random(5);
  State state = stirred(system, random, 0.02);
  const auto n = static_cast<Eigen::Index>(3 * model.nodes);
  for (Eigen::Index i = 0; i < n; ++i) state.y[n + i] = random.uniform(-1, 1);
  const auto work = system.make_workspace();
  Eigen::VectorXd rate, up, down, r(state.y.size()), u;
  if (!system.rebase(state, *work).ok()) return 1.0;
  if (!system.derivative(state, state.time, state.y, rate, *work).ok()) return 1.0;
  const auto solver = make_stiff_solver(system, *work);
  if (solver->differentiate(state, rate) < 0 || !solver->factor(s)) return 1.0;
  for (double& x : r) x = random.uniform(-1, 1);
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    if (model.holds_position(i)) r.segment<3>(at).setZero(), r.segment<3>(n + at).setZero();
    if (!model.has_twist(i) || !model.holds_frame(i)) continue;
    r[model.theta_begin() + model.twist_index[i]] = r[model.spin_begin() + model.twist_index[i]] = 0.0;
  }
  solver->solve(s, r, u);
  const double h = 1e-6 / u.cwiseAbs().maxCoeff();
  if (!system.derivative(state, state.time, state.y + h * u, up, *work).ok()) return 1.0;
  if (!system.derivative(state, state.time, state.y - h * u, down, *work).ok()) return 1.0;
  const Eigen::VectorXd turned = (up - down) / (2 * h);
  return (s * u - turned - r).head(u.size() - 1).cwiseAbs().maxCoeff() /
         turned.head(u.size() - 1).cwiseAbs().maxCoeff();
}

/// A far spring that says it couples all nodes of the first rod.
struct Everything : FarSpring {
  using FarSpring::FarSpring;
  Couplings couplings(std::span<const NodeRange> rods) const override {
    std::vector<std::size_t> nodes(rods[0].count);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = i;
    return Couplings::among(nodes);
  }
};

/// Two stirred rods and what forces see of them.
struct Seen {
  Seen() {
    Random random(3);
    for (std::size_t i = 0; i < 9; ++i) {
      p.push_back(Vec3(0.3 * static_cast<double>(i), 0, 0) + 0.1 * random.in_cube());
      v.push_back(2.0 * random.in_cube());
      t.push_back(random.in_cube().normalized());
      m.push_back(t.back().cross(random.in_cube()).normalized());
    }
  }
  StateView view() const { return {0.37, p, v, t, spin, mass, width, rods, m}; }
  std::vector<Vec3> p, v, t, m;
  std::vector<double> spin = std::vector<double>(9, 0.1), mass = std::vector<double>(9, 1.0),
                      width = std::vector<double>(9, 0.02);
  std::vector<NodeRange> rods{{0, 5}, {5, 4}};
};

}  // namespace tendril::test
