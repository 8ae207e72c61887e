// Extension point: an integrator of one's own on the system's equations. The classic Runge-Kutta method with
// a fixed step; halving the step divides its error by 2^4. A Simulation takes it in place of its own.
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>
#include <cstdio>

using namespace tendril;

class Classic : public Stepper {
 public:
  explicit Classic(const System& system) : system_(system), work_(system.make_workspace()) {}

  Evaluation advance(State& state, double h) override {
    const double t = state.time;
    Eigen::VectorXd k1, k2, k3, k4;
    if (const Evaluation at = rate(state, t, state.y, k1); !at.ok()) return at;
    if (const Evaluation at = rate(state, t + h / 2, state.y + h / 2 * k1, k2); !at.ok()) return at;
    if (const Evaluation at = rate(state, t + h / 2, state.y + h / 2 * k2, k3); !at.ok()) return at;
    if (const Evaluation at = rate(state, t + h, state.y + h * k3, k4); !at.ok()) return at;
    state.y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    state.time += h;
    return system_.rebase(state, *work_);
  }
  long evaluations() const override { return evaluations_; }
  const char* name() const override { return "my Runge-Kutta 4"; }

 private:
  Evaluation rate(const State& state, double t, const Eigen::VectorXd& y, Eigen::VectorXd& k) {
    ++evaluations_;
    return system_.derivative(state, t, y, k, *work_);
  }

  const System& system_;
  System::WorkspacePtr work_;
  long evaluations_ = 0;
};

Vec3 tip_after(const System& system, int steps) {
  SimulationOptions options;
  options.own_stepper = [](const System& of) { return std::make_unique<Classic>(of); };
  options.fixed_step = 0.5 / steps;
  Simulation simulation(system, system.rest_state(), options);
  if (simulation.run(0.5).stop != Stop::finished) return Vec3::Constant(std::nan(""));
  return simulation.state().y.segment<3>(3 * static_cast<Eigen::Index>(system.node_count() - 1));
}

int main() {
  std::vector<Vec3> p;
  for (int i = 0; i <= 8; ++i) p.emplace_back(i / 8.0, 0.02 * i * i / 8.0, 0);
  Scene scene;
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e5, 4e4, 1000},
                                elliptic_section(0.03, 0.02)));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  const System system(scene);

  const Vec3 reference = tip_after(system, 3200);
  const double order =
      std::log2((tip_after(system, 400) - reference).norm() / (tip_after(system, 800) - reference).norm());
  std::printf("order %.2f\n", order);
  return std::abs(order - 4.0) < 0.2 ? 0 : 1;
}
