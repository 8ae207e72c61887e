// A mesh on a swaying axis, in the fewest lines: read, bind, move, write.
//   sway MESH.off OUT.ply
#include <tendril/base/error.h>
#include <tendril/bind/export.h>

#include <cstdio>
// [readme]
#include <tendril/bind/import.h>
#include <tendril/bind/mesh_follower.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
// [readme]

using namespace tendril;

int main(int argc, char** argv) try {
  if (argc != 3) return std::puts("usage: sway MESH OUT.ply"), 2;

  // [readme]
  bind::PolygonMesh mesh = bind::read_mesh(argv[1]);
  std::vector<Vec3> spine(10);  // ten masses along the mesh's x axis
  for (int i = 0; i < 10; ++i) spine[i] = Vec3(-0.45 + 0.1 * i, 0, 0);
  const auto side = orientation_towards(spine, Vec3::UnitZ(), 0.1);

  Scene scene;
  const Material rubber{.young = 2e5, .shear = 7e4, .density = 1000};
  scene.rods.push_back(make_rod(spine, side, rubber, circular_section(0.04)));
  scene.anchors.push_back({.rod = 0, .node = 0});  // clamped at its first mass
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  const System system(scene);

  Simulation simulation(system, system.rest_state());
  const bind::Binding binding(simulation.pairs()[0], mesh.points);
  bind::MeshFollower follower(binding, 0, mesh.points);
  simulation.add(follower, Simulation::When::accepted_step);
  const Report report = simulation.run(1.0);
  if (report.stop != Stop::finished)  // the mesh is then that of report.time
    std::fprintf(stderr, "%s: %s\n", to_string(report.stop), report.reason.c_str());
  const Vec3 tip = simulation.state().y.segment<3>(3 * 9);  // position of mass 9
  // [readme]

  bind::write_mesh(argv[2], mesh);
  std::printf("%s: %ld steps, mesh moved %ld times, energy off by %.1e, tip at z = %.3f\n",
              to_string(report.stop), report.accepted, follower.updates(), report.imbalance, tip.z());
  return report.stop == Stop::finished ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
