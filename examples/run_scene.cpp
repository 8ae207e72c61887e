// A scene file, run and read: where the end of each curve-pair is at the scene's outputs.
//   run_scene SCENE.json
#include <tendril/base/number.h>
#include <tendril/scene/scene_run.h>

#include <iostream>

using namespace tendril;

int main(int argc, char** argv) try {
  if (argc != 2) return std::cerr << "usage: run_scene SCENE.json\n", 2;
  scene::SceneRun run(scene::read_scene(argv[1]));
  const Report report = run.run([&](const scene::Snapshot& now) {
    for (std::size_t k = 0; k < now.masses.size(); ++k) {
      const Vec3 end = now.masses[k].back();
      std::cout << run.file().names[k] << " at " << shortest(now.time) << ": " << shortest(end.x()) << ","
                << shortest(end.y()) << "," << shortest(end.z()) << "\n";
    }
  });
  std::cout << to_string(report.stop) << ": " << report.accepted << " steps\n";
  return report.stop == Stop::finished ? 0 : 1;
} catch (const Error& error) {
  return std::cerr << error.what() << "\n", 2;
}
