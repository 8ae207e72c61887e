// A force on the mesh that moves the rod under it: a spring pulls at one vertex, and the binding's transpose
// takes the pull back to the point masses, torques on their frames included. Because it has an energy, the
// run's energy balance covers it.
#include <tendril/bind/binding.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>
#include <cstdio>

using namespace tendril;

class PullAtVertex : public Force {
 public:
  PullAtVertex(std::span<const Rod> rods, std::size_t rod, Points points, std::uint32_t vertex,
               const Vec3& target, double stiffness)
      : curves_(rods),
        rod_(rod),
        binding_(curves_.through(rod, rods[rod].p, rods[rod].q), points),
        vertex_(vertex),
        target_(target),
        k_(stiffness) {}

  void add(const StateView& state, const Loads& loads) const override {
    const CurvePair pair = curves_.pair(state, rod_);
    const Vec3 force = k_ * (target_ - binding_.at(pair, vertex_));
    const ControlForces on_controls = binding_.pull_back({&pair, 1}, {&vertex_, 1}, {&force, 1}).front();
    curves_.add_loads(state, rod_, on_controls, loads);
  }
  /// A point of an interpolating curve moves with all masses of its rod.
  Couplings couplings(std::span<const NodeRange> rods) const override {
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < rods[rod_].count; ++i) nodes.push_back(rods[rod_].first + i);
    return Couplings::among(nodes);
  }
  bool twists() const override { return true; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override {
    return 0.5 * k_ * (target_ - binding_.at(curves_.pair(state, rod_), vertex_)).squaredNorm();
  }

 private:
  RodCurves curves_;
  std::size_t rod_;
  bind::Binding binding_;
  std::uint32_t vertex_;
  Vec3 target_;
  double k_;
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
  scene.forces.push_back(std::make_shared<PullAtVertex>(scene.rods, 0, plate, 2, Vec3(0.9, 0.2, 0.2), 0.5));
  const System system(scene);

  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-7});
  const Report report = simulation.run(1.0);
  const CurveFrame tip = simulation.pairs()[0].frame(1.0);
  const double turned = std::atan2(-tip.frame.y.y(), tip.frame.y.z());
  std::printf("%s, tip turned by %.2f rad, energy off by %.1e of the largest seen\n", to_string(report.stop),
              turned, report.imbalance);
  return report.stop == Stop::finished && std::abs(report.imbalance) < 1e-6 && std::abs(turned) > 0.1 ? 0 : 1;
}
