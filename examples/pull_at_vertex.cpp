// A force on the mesh that moves the rod under it: a spring pulls at one vertex, and the binding's transpose
// takes the pull back to the point masses, torques on their frames included. Because it has an energy, the
// run's energy balance covers it.
#include <tendril/bind/binding.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>
#include <cstdio>

using namespace tendril;

class PullAtVertex : public Force {
 public:
  PullAtVertex(const Rod& rod, Points points, std::uint32_t vertex, const Vec3& target, double stiffness)
      : fit_(3, rod.p),
        binding_(through(rod.p, rod.q), points),
        vertex_(vertex),
        target_(target),
        k_(stiffness) {
    const NodeFrames frames = node_frames(rod.p, rod.q);
    for (std::size_t i = 0; i < rod.p.size(); ++i) {
      const Vec3 arm = rod.q[i] - rod.p[i];
      along_m_.push_back(arm.dot(frames.frame[i].y));
      along_t_.push_back(arm.dot(frames.frame[i].z));
    }
  }

  void add(const StateView& state, const Loads& loads) const override {
    const std::vector<Vec3> arm = arms(state);
    const CurvePair pair = posed(state, arm);
    const Vec3 force = k_ * (target_ - binding_.at(pair, vertex_));
    const ControlForces on_controls = binding_.pull_back({&pair, 1}, {&vertex_, 1}, {&force, 1}).front();
    const MassLoads on_masses = loads_on_masses(fit_, on_controls, arm);
    for (std::size_t i = 0; i < arm.size(); ++i) {
      loads.force[i] += on_masses.force[i];
      loads.torque[i] += on_masses.torque[i];
    }
  }
  /// A point of an interpolating curve moves with all masses of its rod.
  Couplings couplings(std::span<const NodeRange>) const override {
    return Couplings::within(along_m_.size());
  }
  bool twists() const override { return true; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override {
    return 0.5 * k_ * (target_ - binding_.at(posed(state, arms(state)), vertex_)).squaredNorm();
  }

 private:
  CurvePair through(const std::vector<Vec3>& p, const std::vector<Vec3>& q) const {
    return {fit_.knots(), fit_.solve(p), fit_.solve(q)};
  }
  std::vector<Vec3> arms(const StateView& state) const {
    std::vector<Vec3> arm;
    for (std::size_t i = 0; i < along_m_.size(); ++i)
      arm.push_back(along_m_[i] * state.m[i] + along_t_[i] * state.t[i]);
    return arm;
  }
  CurvePair posed(const StateView& state, const std::vector<Vec3>& arm) const {
    const std::vector<Vec3> p(state.p.begin(), state.p.end());
    std::vector<Vec3> q = p;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += arm[i];
    return through(p, q);
  }

  Interpolator fit_;
  bind::Binding binding_;
  std::uint32_t vertex_;
  Vec3 target_;
  double k_;
  std::vector<double> along_m_, along_t_;
};

int main() {
  std::vector<Vec3> p;
  for (int i = 0; i <= 12; ++i) p.emplace_back(i / 12.0, 0, 0);
  Scene scene;
  scene.rods.push_back(
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e6, 4e5, 1000}, circular_section(0.02)));
  scene.anchors.push_back({.rod = 0, .node = 0});
  // The corner of a plate at the tip: pulled aside it bends the rod, and twists it.
  const std::vector<Vec3> plate{{0.9, -0.2, 0}, {0.9, 0.2, 0}, {1, 0.2, 0}, {1, -0.2, 0}};
  scene.forces.push_back(std::make_shared<PullAtVertex>(scene.rods[0], plate, 2, Vec3(0.9, 0.2, 0.2), 0.5));
  const System system(scene);

  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-7});
  const Report report = simulation.run(1.0);
  const CurveFrame tip = simulation.pairs()[0].frame(1.0);
  const double turned = std::atan2(-tip.frame.y.y(), tip.frame.y.z());
  std::printf("%s, tip turned by %.2f rad, energy off by %.1e of the largest seen\n", to_string(report.stop),
              turned, report.imbalance);
  return report.stop == Stop::finished && std::abs(report.imbalance) < 1e-6 && std::abs(turned) > 0.1 ? 0 : 1;
}
