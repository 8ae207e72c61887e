// Leaves that touch each other in wind: seconds of one thread for a second of motion, and pairs of triangles
// that meet at its end, exactly. Arguments: leaves, triangles along a leaf, seconds.
#include <tendril/contact/surface_self_contact.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "contact/bush.h"

namespace tendril {
namespace {

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Sums {
  long in_contact = 0, steps = 0, touches = 0;
  double least = std::numeric_limits<double>::infinity();
};

int bench(std::size_t leaves, std::uint32_t along, double seconds, bool contact) {
  test::Random random(1);
  const double skin = 4e-4, range = 8e-4;
  const test::Bush bush(random, leaves, along, 5, 0.006);
  const contact::ContactSurface surface = bush.sheets.surface(skin);
  Scene scene;
  scene.rods = bush.sheets.rods;
  for (std::size_t r = 0; r < leaves; ++r) scene.anchors.push_back({.rod = r, .node = 0});
  if (contact) {
    const contact::Law law{.stiffness = 2e7, .range = range, .friction = 0.0, .damping = 0.02};
    scene.forces.push_back(
        std::make_shared<contact::SurfaceSelfContact>(surface, law, contact::Meets::other_parts));
  }
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  WindOptions wind;
  wind.mean = Vec3(2, 0, 0);
  wind.gust = 0.5;
  wind.gust_frequency = 2.0;
  scene.forces.push_back(std::make_shared<Wind>(wind));
  const System system(scene);
  Simulation simulation(system, system.rest_state(), {.method = Method::cash_karp, .tolerance = 1e-3});
  Sums sums;
  simulation.on_progress([&](double) {
    ++sums.steps;
    if (!contact) return true;
    const auto& memory = dynamic_cast<const contact::SurfaceSelfMemory&>(*simulation.state().memory.at(0));
    sums.in_contact += !memory.touches.empty();
    sums.touches += static_cast<long>(memory.touches.size());
    for (const contact::SelfTouch& touch : memory.touches) sums.least = std::min(sums.least, touch.gap);
    return true;
  });
  const double begin = cpu_seconds();
  const Report report = simulation.run(seconds);
  const double took = cpu_seconds() - begin;
  std::printf(
      "%zu leaves, %zu triangles, contact %s: %.2f s for %.2f s, %ld evaluations of %.0f us, stop %s\n",
      leaves, bush.sheets.mesh.triangles.size(), contact ? "on" : "off", took, seconds,
      static_cast<long>(report.evaluations), 1e6 * took / static_cast<double>(report.evaluations),
      report.stop == Stop::finished ? "finished" : report.reason.c_str());
  const auto work = system.make_workspace();
  std::vector<std::uint32_t> all(surface.rest.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  std::vector<Vec3> at(all.size());
  surface.points->points().place(surface.points->curves().pairs(system, simulation.state(), *work), all, at);
  const long met = test::meeting_pairs(bush, at);
  std::fflush(stdout);
  std::printf(
      "  %ld steps, %ld in contact, %.0f touches a step, least gap %.3g of the range, pairs that meet %ld",
      sums.steps, sums.in_contact, static_cast<double>(sums.touches) / static_cast<double>(sums.steps),
      sums.least / range, met);
  if (contact) {
    const auto& memory = dynamic_cast<const contact::SurfaceSelfMemory&>(*simulation.state().memory.at(0));
    std::printf(", searches %ld, vertices placed %ld", memory.searches, memory.placed);
  }
  std::printf("\n");
  return contact && (met > 0 || report.stop != Stop::finished) ? 1 : 0;
}

}  // namespace
}  // namespace tendril

int main(int argc, char** argv) {
  const auto number = [&](int i, double otherwise) { return i < argc ? std::atof(argv[i]) : otherwise; };
  const auto leaves = static_cast<std::size_t>(number(1, 200));
  const auto along = static_cast<std::uint32_t>(number(2, 25));
  tendril::bench(leaves, along, number(3, 1.0), false);
  return tendril::bench(leaves, along, number(3, 1.0), true);
}
