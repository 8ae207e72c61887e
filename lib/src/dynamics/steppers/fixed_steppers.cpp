#include <tendril/dynamics/fixed_steppers.h>

#include <tendril/base/error.h>

#include <array>

#include "dynamics/scene/model.h"

namespace tendril {
namespace {

/// Takes y for the state h later.
Evaluation arrive(const System& system, const Eigen::VectorXd& y, double h, State& state,
                  System::Workspace& work) {
  state.y = y;
  state.time += h;
  return system.rebase(state, work);
}

bool velocities_matter(const System& system) {
  // With twist, the gyroscopic force does; viscosity brings twist along.
  if (system.twist_count() > 0) return true;
  for (const Rod& rod : system.scene().rods)
    if (rod.mass_damping > 0.0) return true;
  for (const auto& force : system.scene().forces)
    if (!force->has_energy()) return true;
  return false;
}

}  // namespace

struct ExplicitEuler::Implementation {
  const System& system;
  System::WorkspacePtr work = system.make_workspace();
  Eigen::VectorXd rate = {};
  long evaluations = 0;
};

ExplicitEuler::ExplicitEuler(const System& system) : self_(new Implementation{system}) {}
ExplicitEuler::~ExplicitEuler() = default;

Evaluation ExplicitEuler::advance(State& state, double h) {
  auto& [system, work, rate, evaluations] = *self_;
  ++evaluations;
  const Evaluation at = system.derivative(state, state.time, state.y, rate, *work);
  if (!at.ok()) return at;
  return arrive(system, state.y + h * rate, h, state, *work);
}

long ExplicitEuler::evaluations() const {
  return self_->evaluations;
}

struct ClassicRungeKutta::Implementation {
  const System& system;
  System::WorkspacePtr work = system.make_workspace();
  std::array<Eigen::VectorXd, 4> k = {};
  Eigen::VectorXd stage = {};
  long evaluations = 0;
};

ClassicRungeKutta::ClassicRungeKutta(const System& system) : self_(new Implementation{system}) {}
ClassicRungeKutta::~ClassicRungeKutta() = default;

Evaluation ClassicRungeKutta::advance(State& state, double h) {
  constexpr std::array<double, 4> kAt{0.0, 0.5, 0.5, 1.0};
  auto& [system, work, k, stage, evaluations] = *self_;
  for (std::size_t s = 0; s < 4; ++s) {
    stage = state.y;
    if (s > 0) stage.noalias() += (kAt[s] * h) * k[s - 1];
    ++evaluations;
    const Evaluation at = system.derivative(state, state.time + kAt[s] * h, stage, k[s], *work);
    if (!at.ok()) return at;
  }
  stage = state.y + (h / 6) * (k[0] + 2 * k[1] + 2 * k[2] + k[3]);
  return arrive(system, stage, h, state, *work);
}

long ClassicRungeKutta::evaluations() const {
  return self_->evaluations;
}

struct VelocityVerlet::Implementation {
  const System& system;
  int passes = velocities_matter(system) ? 2 : 1;
  System::WorkspacePtr work = system.make_workspace();
  Eigen::VectorXd rate = {}, half = {}, y = {};
  bool known = false;  ///< rate is that of the present state
  long evaluations = 0;
};

VelocityVerlet::VelocityVerlet(const System& system) : self_(new Implementation{system}) {
  const std::vector<RigidBody>& bodies = model_of(system).bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!bodies[b].isotropic)
      throw InvalidInput(
          "method", "verlet with bodies[" + std::to_string(b) + "].inertia of unequal moments",
          "another method: the spin of such a body changes without a torque, and a kick by what "
          "it was before loses what makes Verlet keep energy");
}
VelocityVerlet::~VelocityVerlet() = default;

Evaluation VelocityVerlet::advance(State& state, double h) {
  auto& [system, passes, work, rate, half, y, known, evaluations] = *self_;
  const auto n = 3 * static_cast<Eigen::Index>(system.node_count());
  const auto m = static_cast<Eigen::Index>(system.twist_count());
  const auto k = 3 * static_cast<Eigen::Index>(system.body_count());
  const Eigen::Index x = 2 * (n + m);
  if (!known) {
    ++evaluations;
    if (const Evaluation at = system.derivative(state, state.time, state.y, rate, *work); !at.ok()) return at;
  }
  known = false;  // until this step has arrived
  // Kick: velocities, spins and the work done.
  const auto kick = [n, m, k, h, &kicks = self_->rate](Eigen::VectorXd& at) {
    at.segment(n, n) += 0.5 * h * kicks.segment(n, n);
    at.segment(2 * n + m, m) += 0.5 * h * kicks.segment(2 * n + m, m);
    at.tail(2 * k + 1) += 0.5 * h * kicks.tail(2 * k + 1);
  };
  half = state.y;
  kick(half);
  half.head(n) += h * half.segment(n, n);
  half.segment(2 * n, m) = h * half.segment(2 * n + m, m);
  half.segment(x, k) += h * half.segment(x + 2 * k, k);
  half.segment(x + k, k) = h * half.segment(x + 3 * k, k);
  y = half;
  for (int pass = 0; pass < passes; ++pass) {
    ++evaluations;
    if (const Evaluation at = system.derivative(state, state.time + h, y, rate, *work); !at.ok()) return at;
    y = half;
    kick(y);
  }
  const Evaluation at = arrive(system, y, h, state, *work);
  known = at.ok();
  return at;
}

void VelocityVerlet::restart() {
  self_->known = false;
}

long VelocityVerlet::evaluations() const {
  return self_->evaluations;
}

}  // namespace tendril
