#include <tendril/scene/scene_run.h>

#include <iostream>

using namespace tendril;

namespace {

// A stiff pendulum of two masses, let go from the side: after a while it hangs lower than it began.
constexpr const char* kPendulum = R"({
  "version": 1,
  "curve_pairs": [{
    "name": "arm", "points": [[0, 0, 0], [1, 0, 0]], "orientation": [0, 0, 1],
    "springs": {"stretch": 1000, "bend_l": 0, "bend_m": 0, "twist": 0, "mass": 1, "inertia": 0.1},
    "anchors": [{"node": 0, "hold": "position"}]
  }],
  "forces": [{"type": "gravity", "acceleration": [0, -10, 0]}],
  "simulation": {"duration": 0.2, "frames": 3}
})";

}  // namespace

int main() {
  scene::SceneRun run(scene::parse_scene(kPendulum, "pendulum"));
  double lowest = 0.0;
  const Report report = run.run([&](const scene::Snapshot& now) { lowest = now.masses[0].back().y(); });
  if (report.stop != Stop::finished || run.outputs() != 3) return 1;
  if (lowest > -0.1 || lowest < -0.3) return 2;  // falls a tenth of g or so: 10 * 0.2^2 / 2
  try {
    scene::parse_scene("{\"version\": 1", "broken");
    return 3;
  } catch (const scene::SceneError& error) {
    if (error.at().file != "broken" || error.at().line != 1) return 4;
  }
  std::cout << "scene works\n";
}
