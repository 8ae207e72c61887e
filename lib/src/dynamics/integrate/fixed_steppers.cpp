#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/fixed_steppers.h>
#include <tendril/dynamics/rodas.h>

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

const char* to_string(Method method) {
  switch (method) {
    case Method::cash_karp:
      return "cash_karp";
    case Method::rodas:
      return "rodas";
    case Method::automatic:
      return "automatic";
    case Method::verlet:
      return "verlet";
    case Method::runge_kutta4:
      return "runge_kutta4";
    case Method::explicit_euler:
      return "explicit_euler";
    case Method::backward_euler:
      return "backward_euler";
  }
  return "unknown";
}

bool chooses_steps(Method method) {
  return method == Method::cash_karp || method == Method::rodas || method == Method::automatic;
}

std::unique_ptr<Stepper> make_stepper(Method method, const System& system) {
  switch (method) {
    case Method::cash_karp:
    case Method::automatic:
      return std::make_unique<CashKarp>(system);
    case Method::rodas:
      return std::make_unique<Rodas>(system);
    case Method::verlet:
      return std::make_unique<VelocityVerlet>(system);
    case Method::runge_kutta4:
      return std::make_unique<ClassicRungeKutta>(system);
    case Method::explicit_euler:
      return std::make_unique<ExplicitEuler>(system);
    case Method::backward_euler:
      return std::make_unique<BackwardEuler>(system);
  }
  return nullptr;
}

ExplicitEuler::ExplicitEuler(const System& system) : system_(system), work_(system.make_workspace()) {}

Evaluation ExplicitEuler::advance(State& state, double h) {
  ++evaluations_;
  const Evaluation at = system_.derivative(state, state.time, state.y, rate_, *work_);
  if (!at.ok()) return at;
  return arrive(system_, state.y + h * rate_, h, state, *work_);
}

ClassicRungeKutta::ClassicRungeKutta(const System& system)
    : system_(system), work_(system.make_workspace()) {}

Evaluation ClassicRungeKutta::advance(State& state, double h) {
  constexpr std::array<double, 4> kAt{0.0, 0.5, 0.5, 1.0};
  for (std::size_t s = 0; s < 4; ++s) {
    stage_ = state.y;
    if (s > 0) stage_.noalias() += (kAt[s] * h) * k_[s - 1];
    ++evaluations_;
    const Evaluation at = system_.derivative(state, state.time + kAt[s] * h, stage_, k_[s], *work_);
    if (!at.ok()) return at;
  }
  stage_ = state.y + (h / 6) * (k_[0] + 2 * k_[1] + 2 * k_[2] + k_[3]);
  return arrive(system_, stage_, h, state, *work_);
}

VelocityVerlet::VelocityVerlet(const System& system)
    : system_(system), work_(system.make_workspace()), passes_(velocities_matter(system) ? 2 : 1) {}

Evaluation VelocityVerlet::advance(State& state, double h) {
  const auto n = 3 * static_cast<Eigen::Index>(system_.node_count());
  const auto m = static_cast<Eigen::Index>(system_.twist_count());
  if (!known_) {
    ++evaluations_;
    if (const Evaluation at = system_.derivative(state, state.time, state.y, rate_, *work_); !at.ok())
      return at;
  }
  known_ = false;  // until this step has arrived
  // Kick: velocities, spins and the work done.
  const auto kick = [&](Eigen::VectorXd& y) {
    y.segment(n, n) += 0.5 * h * rate_.segment(n, n);
    y.tail(m + 1) += 0.5 * h * rate_.tail(m + 1);
  };
  half_ = state.y;
  kick(half_);
  half_.head(n) += h * half_.segment(n, n);
  half_.segment(2 * n, m) = h * half_.segment(2 * n + m, m);
  y_ = half_;
  for (int pass = 0; pass < passes_; ++pass) {
    ++evaluations_;
    if (const Evaluation at = system_.derivative(state, state.time + h, y_, rate_, *work_); !at.ok())
      return at;
    y_ = half_;
    kick(y_);
  }
  const Evaluation at = arrive(system_, y_, h, state, *work_);
  known_ = at.ok();
  return at;
}

}  // namespace tendril
