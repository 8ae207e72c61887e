#include "bench/problems.h"

#include <tendril/dynamics/forces.h>

#include <cmath>
#include <numbers>

#include "support/rods.h"

namespace tendril::bench {
namespace {

constexpr double kRadius = 5e-3, kDensity = 1000.0;

Rod rod_between(const Vec3& from, const Vec3& to, int nodes, const Vec3& side, double young, double radius) {
  std::vector<Vec3> p;
  for (int i = 0; i < nodes; ++i) p.push_back(from + (to - from) * (static_cast<double>(i) / (nodes - 1)));
  Rod rod =
      make_rod(p, orientation_towards(p, side, 0.1), {young, young / 3, kDensity}, circular_section(radius));
  rod.mass_damping = 0.5;
  return rod;
}

void add_gravity(Scene& scene) {
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
}

Problem at_rest(std::string name, Scene scene, double length) {
  System system(std::move(scene));
  State start = system.rest_state();
  return {std::move(name), std::move(system), std::move(start), length, 1.0};
}

/// Off the start by some thousandths.
void stir(Problem& problem) {
  test::Random random(7);
  const auto n = static_cast<Eigen::Index>(problem.system.node_count());
  const auto m = static_cast<Eigen::Index>(problem.system.twist_count());
  for (Eigen::Index i = 0; i < 6 * n + 2 * m; ++i) problem.start.y[i] += random.uniform(-1e-3, 1e-3);
  const auto work = problem.system.make_workspace();
  if (!problem.system.rebase(problem.start, *work).ok()) throw std::runtime_error("stirred too much");
}

std::string name_of(const Cantilever& what) {
  char name[96];
  std::snprintf(name, sizeof name, "N %d, E %.0e", what.nodes, what.young);
  std::string out = name;
  if (what.viscosity > 0.0) {
    std::snprintf(name, sizeof name, ", beta %.0e s", what.viscosity);
    out += name;
  }
  if (what.mass_ratio > 1.0) {
    std::snprintf(name, sizeof name, ", masses %.0e apart", what.mass_ratio);
    out += name;
  }
  return out;
}

}  // namespace

Problem cantilever(const Cantilever& what) {
  Scene scene;
  Rod rod = rod_between(Vec3::Zero(), Vec3::UnitX(), what.nodes, Vec3::UnitZ(), what.young, kRadius);
  rod.viscosity = what.viscosity;
  for (std::size_t i = 1; i < rod.mass.size(); i += 2) rod.mass[i] /= what.mass_ratio;
  scene.rods.push_back(std::move(rod));
  scene.anchors.push_back({.rod = 0, .node = 0});
  add_gravity(scene);
  if (what.twist) scene.twist = Scene::Twist::everywhere;
  Problem out = at_rest(name_of(what), std::move(scene), 1.0);
  for (Eigen::Index i = 1; i < what.nodes; ++i)
    out.start.y[3 * what.nodes + 3 * i + 1] = 0.05 * static_cast<double>(i) / (what.nodes - 1);
  return out;
}

Problem stirred_rods(int rods, int nodes, bool full) {
  Scene scene;
  const double length = static_cast<double>(nodes - 1) / 31.0;
  for (int r = 0; r < rods; ++r) {
    const Vec3 foot(0, 0.2 * r, 0);
    Rod rod = rod_between(foot, foot + length * Vec3::UnitX(), nodes, Vec3::UnitZ(), 1e6, kRadius);
    if (full) std::fill(rod.bend_t.begin(), rod.bend_t.end(), rod.bend_l[1]);
    scene.rods.push_back(std::move(rod));
  }
  if (full) scene.twist = Scene::Twist::everywhere;
  Problem out = at_rest(full ? "full model" : "without twist", std::move(scene), length);
  stir(out);
  return out;
}

Problem long_chain(int nodes) {
  Scene scene;
  const double length = static_cast<double>(nodes - 1) / 31.0;
  scene.rods.push_back(rod_between(Vec3::Zero(), length * Vec3::UnitX(), nodes, Vec3::UnitZ(), 1e6, kRadius));
  scene.anchors.push_back({.rod = 0, .node = 0});
  add_gravity(scene);
  return at_rest("chain of " + std::to_string(nodes), std::move(scene), length);
}

namespace {

Scene tree(const Plant& what) {
  Scene scene;
  const double height = 0.025 * (what.stem_nodes - 1);
  scene.rods.push_back(rod_between(Vec3::Zero(), height * Vec3::UnitZ(), what.stem_nodes, Vec3::UnitX(),
                                   what.young, 2 * kRadius));
  scene.anchors.push_back({.rod = 0, .node = 0});
  for (int leaf = 0; leaf < what.leaves; ++leaf) {
    const auto node = 1 + static_cast<std::size_t>(leaf) * static_cast<std::size_t>(what.stem_nodes - 1) /
                              static_cast<std::size_t>(what.leaves);
    const double angle = leaf * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const Vec3 out(std::cos(angle), std::sin(angle), 0.6);
    const Vec3 foot = scene.rods[0].p[node];
    scene.rods.push_back(
        rod_between(foot, foot + 0.1 * out.normalized(), 6, Vec3::UnitZ(), what.young, 0.2 * kRadius));
    scene.joints.push_back({.parent = 0, .node = node, .child = scene.rods.size() - 1});
  }
  add_gravity(scene);
  return scene;
}

std::string leaves_of(const Plant& what) {
  return "stem and " + std::to_string(what.leaves) + " leaves";
}

}  // namespace

Problem plant(const Plant& what) {
  return at_rest(leaves_of(what), tree(what), 0.025 * (what.stem_nodes - 1));
}

Problem swaying(const Plant& what, bool wind) {
  Scene scene = tree(what);
  for (Rod& rod : scene.rods) rod.viscosity = 1e-4;
  if (wind) scene.forces.push_back(std::make_shared<Wind>(WindOptions{.mean = Vec3(2, 1, 0), .gust = 0.5}));
  Problem out = at_rest(leaves_of(what), std::move(scene), 0.025 * (what.stem_nodes - 1));
  stir(out);
  return out;
}

}  // namespace tendril::bench
