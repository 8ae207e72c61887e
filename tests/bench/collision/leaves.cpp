// Leaves that touch each other in wind: seconds of one thread for a second of motion, and pairs of triangles
// that meet at its end, exactly. Arguments: leaves, triangles along a leaf, seconds, a method by its name
// (Cash-Karp without one), and how many times as stiff as plants they are.
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

struct Asked {
  std::size_t leaves = 200;
  std::uint32_t along = 25;
  double seconds = 1.0;
  Method method = Method::cash_karp;
  double stiffer = 1.0;
};

int bench(const Asked& asked, bool contact) {
  const auto [leaves, along, seconds, method, stiffer] = asked;
  test::Random random(1);
  const double skin = 4e-4, range = 8e-4;
  const test::Bush bush(random, leaves, along, 5, 0.006, stiffer);
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
  Simulation simulation(system, system.rest_state(), {.method = method, .tolerance = 1e-3});
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
  tendril::Asked asked;
  asked.leaves = static_cast<std::size_t>(number(1, 200));
  asked.along = static_cast<std::uint32_t>(number(2, 25));
  asked.seconds = number(3, 1.0);
  if (argc > 4) {
    const tendril::MethodInfo* found = tendril::find_method(argv[4]);
    if (!found) {
      std::fprintf(stderr, "%s: no such method\n", argv[4]);
      return 2;
    }
    asked.method = found->method;
  }
  asked.stiffer = number(5, 1.0);
  tendril::bench(asked, false);
  return tendril::bench(asked, true);
}
