// Extension point: a force of one's own. A magnet under the tip pulls with an inverse-square law; because it
// has an energy, the run's energy balance covers it.
#include <tendril/dynamics/force.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>
#include <cstdio>

using namespace tendril;

class Magnet : public Force {
 public:
  Magnet(std::size_t node, const Vec3& position, double strength)
      : node_(node), position_(position), strength_(strength) {}

  // [readme]
  void add(const StateView& state, const Loads& loads) const override {
    const Vec3 d = position_ - state.p[node_];
    const double r = d.norm();
    loads.force[node_] += strength_ / (r * r * r) * d;
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::among({node_}); }
  // [readme]
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override {
    return -strength_ / (position_ - state.p[node_]).norm();
  }

 private:
  std::size_t node_;
  Vec3 position_;
  double strength_;
};

int main() {
  std::vector<Vec3> p;
  for (int i = 0; i <= 12; ++i) p.emplace_back(i / 12.0, 0, 0);
  Scene scene;
  scene.rods.push_back(
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e6, 4e5, 1000}, circular_section(0.01)));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Magnet>(12, Vec3(1, 0, -0.3), 0.002));
  const System system(scene);

  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-7});
  const Report report = simulation.run(2.0);
  std::printf("%s, energy off by %.1e of the largest seen\n", to_string(report.stop), report.imbalance);
  return report.stop == Stop::finished && std::abs(report.imbalance) < 1e-6 ? 0 : 1;
}
