// Extension point: a consumer of steps. This one prints where the tip of a rod is, ten times a second, while
// a clamped rod falls; another could write a file, draw a picture or look for contacts.
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cstdio>

using namespace tendril;

// [readme]
class PrintTip : public Follower {
 public:
  void follow(double time, std::span<const CurvePair> pairs) override {
    const BSpline& axis = pairs[0].primary();
    const Vec3 tip = axis.value(axis.knots().end());
    std::printf("%4.1f s  tip at %7.4f %7.4f %7.4f\n", time, tip.x(), tip.y(), tip.z());
    lowest = std::min(lowest, tip.z());
  }
  double lowest = 0.0;
};
// [readme]

int main() {
  std::vector<Vec3> p;
  for (int i = 0; i <= 12; ++i) p.emplace_back(i / 12.0, 0, 0);
  Scene scene;
  scene.rods.push_back(
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e6, 4e5, 1000}, circular_section(0.01)));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  const System system(scene);

  Simulation simulation(system, system.rest_state());
  PrintTip print;
  simulation.add(print, Simulation::When::output);
  const std::vector<double> outputs{0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  const Report report = simulation.run(0.5, outputs);
  if (report.stop != Stop::finished) {
    std::fprintf(stderr, "%s: %s\n", to_string(report.stop), report.reason.c_str());
    return 1;
  }
  // The curve goes through the masses: its end is the last one, node 12 of the state.
  const Vec3 mass = simulation.state().y.segment<3>(3 * 12);
  const Vec3 tip = simulation.pairs()[0].primary().value(1.0);
  std::printf("lowest %.4f, tip and last mass %.1e apart\n", print.lowest, (tip - mass).norm());
  return print.lowest < -0.3 && (tip - mass).norm() < 1e-12 ? 0 : 1;
}
