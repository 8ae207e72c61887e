#include <tendril/curve/axial.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include <cmath>
#include <stdexcept>

#include "figures.h"
#include "page/chart.h"
#include "page/sketch.h"
#include "spared.h"

namespace tendril::gallery {
namespace {

constexpr double kHeight = 0.4, kLeaf = 0.2, kWindEnds = 5.0, kPlantDuration = 12.0;
constexpr int kStemEdges = 8, kLeafEdges = 6, kLeaves = 5;
const Material kPlant{.young = 1e8, .shear = 4e7, .density = 800};
/// The node that is watched: near the tip of the third leaf.
constexpr std::size_t kWatchedRod = 3, kWatchedNode = 5;

Rod damped(Rod rod) {
  rod.mass_damping = 1.5;
  rod.viscosity = 0.01;
  return rod;
}

Rod stem() {
  std::vector<Vec3> p;
  for (int i = 0; i <= kStemEdges; ++i) p.emplace_back(0, 0, kHeight * i / kStemEdges);
  return damped(make_rod(p, orientation_towards(p, Vec3::UnitX(), 0.05), kPlant, circular_section(0.004)));
}

/// A crooked leaf that grows from a point of the stem outwards and droops.
Rod leaf(const Vec3& root, double around) {
  const Vec3 outwards(std::cos(around), std::sin(around), 0);
  std::vector<Vec3> p{root};
  for (int i = 0; i < kLeafEdges; ++i) {
    const double rise = 0.9 - 1.3 * (i + 0.5) / kLeafEdges;
    p.push_back(p.back() + kLeaf / kLeafEdges * (std::cos(rise) * outwards + std::sin(rise) * Vec3::UnitZ()));
  }
  return damped(
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.03), kPlant, elliptic_section(0.012, 0.001)));
}

/// \param reaction  of the joints: whether the stem feels its leaves
Scene plant(bool reaction) {
  Scene scene;
  scene.rods.push_back(stem());
  scene.anchors.push_back({.rod = 0, .node = 0});
  for (std::size_t k = 0; k < kLeaves; ++k) {
    const std::size_t node = 3 + k;
    scene.rods.push_back(leaf(scene.rods[0].p[node], 2.4 * static_cast<double>(k)));
    scene.joints.push_back({.parent = 0, .node = node, .child = k + 1, .reaction = reaction});
  }
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  scene.twist = Scene::Twist::everywhere;
  return scene;
}

Scene in_wind() {
  Scene scene = plant(true);
  WindOptions wind;
  wind.mean = Vec3(2.5, 1.0, 0);
  wind.gust = 0.6;
  wind.gust_frequency = 0.8;
  wind.switched = Signal::table({{0, 0}, {0.5, 1}, {kWindEnds, 1}, {kWindEnds + 0.2, 0}});
  scene.forces.push_back(std::make_shared<Wind>(wind));
  return scene;
}

Equilibrium balanced(const System& system) {
  Equilibrium found = find_equilibrium(system, system.rest_state());
  if (found.balance != Balance::converged) throw std::runtime_error(found.reason);
  return found;
}

/// Of the edges between a leaf's root and a node, unwrapped [degrees].
double twist_of(const System& system, const State& state, std::size_t rod, std::size_t node) {
  double sum = 0.0;
  for (std::size_t i = 0; i < node; ++i) sum += state.twist[system.rods()[rod].first + i];
  return sum * 180 / kPi;
}

double farthest(const Eigen::VectorXd& a, const Eigen::VectorXd& b, std::size_t nodes) {
  double most = 0.0;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(nodes); ++i)
    most = std::max(most, (a.segment<3>(3 * i) - b.segment<3>(3 * i)).norm());
  return most;
}

/// A blade on each leaf's curve-pair: points by (t, u).
void draw_blade(const CurvePair& pair, Sketch& sketch) {
  constexpr int kAlong = 12, kAcross = 2;
  bind::PolygonMesh mesh;
  for (int i = 0; i <= kAlong; ++i)
    for (int j = -kAcross / 2; j <= kAcross / 2; ++j) {
      const double t = double(i) / kAlong, width = 0.026 * std::sqrt(std::sin(kPi * (0.04 + 0.95 * t)));
      mesh.points.push_back(from_axial(pair, {t, j * width, 0, 0}));
    }
  for (std::uint32_t i = 0; i < kAlong; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const std::uint32_t a = i * (kAcross + 1) + j, b = a + kAcross + 1;
      mesh.corners.insert(mesh.corners.end(), {a, a + 1, b + 1, b});
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  sketch.faces(mesh, mesh.points, "#4c9a3a");
}

std::string drawn(const System& system, const State& state, const std::string& title) {
  const auto work = system.make_workspace();
  const std::vector<CurvePair> pairs = RodCurves(system).pairs(system, state, *work);
  Sketch sketch(seen_from(Vec3(0.9, -0.6, 0.35)));
  // Corners that make all pictures cover the same stretch.
  for (const Vec3& corner : {Vec3(-0.12, -0.18, 0), Vec3(0.18, 0.24, 0), Vec3(0, 0, 0.48)})
    sketch.dot(corner, "#ffffff", 0.1);
  std::vector<Vec3> along;
  for (int k = 0; k <= 24; ++k) along.push_back(pairs[0].primary().value(k / 24.0));
  sketch.line(along, "#6b4a1f", 3.5);
  for (std::size_t r = 1; r < pairs.size(); ++r) draw_blade(pairs[r], sketch);
  sketch.dot(place(system, state, kWatchedRod, kWatchedNode), "#d00000", 4);
  return sketch.svg(250, title);
}

/// The plant in wind, from where it rests under its weight.
struct Windy {
  Line twist{"", {}}, displacement{"", {}};
  double most_twist = 0.0, most_displacement = 0.0, residual = 0.0;
  std::vector<Picture> pictures;
};

Windy blown() {
  const System calm(plant(true)), windy(in_wind());
  const State start = balanced(calm).state;
  Simulation simulation(windy, start, {.tolerance = 1e-3});
  Windy out;
  const double twist0 = twist_of(windy, start, kWatchedRod, kWatchedNode);
  const Vec3 place0 = place(windy, start, kWatchedRod, kWatchedNode);
  for (int k = 0; k * 0.05 <= kPlantDuration + 1e-9; ++k) {
    const double time = 0.05 * k;
    if (const Report report = simulation.run(time); report.stop != Stop::finished)
      throw std::runtime_error(report.reason);
    const State& now = simulation.state();
    const double twist = twist_of(windy, now, kWatchedRod, kWatchedNode) - twist0;
    const double moved = (place(windy, now, kWatchedRod, kWatchedNode) - place0).norm();
    out.twist.points.emplace_back(time, twist);
    out.displacement.points.emplace_back(time, 100 * moved);
    out.most_twist = std::max(out.most_twist, std::abs(twist));
    out.most_displacement = std::max(out.most_displacement, moved);
    if (k % 40 == 0 && k <= 120) out.pictures.push_back({drawn(windy, now, text("%.0f s", time)), ""});
  }
  out.residual = farthest(simulation.state().y, start.y, windy.node_count()) / kHeight;
  return out;
}

/// How far stem and the leaf above move where one leaf is pulled down.
struct Pulled {
  double leaf, stem, sibling;  ///< of the height
};

Pulled pulled(bool reaction) {
  const System free(plant(reaction));
  Scene scene = plant(reaction);
  scene.forces.push_back(std::make_shared<PointLoad>(PointLoad::Kind::force, kWatchedRod, kLeafEdges,
                                                     Vec3(0, 0, -0.1), Signal::constant(1.0)));
  const System loaded(scene);
  const State before = balanced(free).state, after = balanced(loaded).state;
  const auto moved = [&](std::size_t rod, std::size_t node) {
    return (place(loaded, after, rod, node) - place(free, before, rod, node)).norm() / kHeight;
  };
  return {moved(kWatchedRod, kLeafEdges), moved(0, kStemEdges), moved(5, kLeafEdges)};
}

}  // namespace

Figure plant_in_wind() {
  Windy wind = blown();
  const Pulled both = pulled(true), one_way = pulled(false);
  Figure out{"4.5", "A plant in wind, and one leaf pulled (also 3.19, 3.21, 4.6)",
             "A stem with five crooked leaves, each a curve-pair joined to the stem's, rests under its "
             "weight. A gusty wind "
             "blows for five seconds and stops; the node in red is watched. Then, without wind, the tip of "
             "one leaf is pulled "
             "down by 0.1 N, with joints whose reaction the stem feels and with one-way joints."};
  out.pictures = std::move(wind.pictures);
  out.pictures.push_back(
      {Chart{"Twist of the red node against its leaf's root", "time [s]", "degrees", {wind.twist}}.svg(),
       "Wind until 5 s."});
  out.pictures.push_back({Chart{"Displacement of the red node", "time [s]", "cm", {wind.displacement}}.svg(),
                          "Wind until 5 s."});
  out.numbers = {
      {"largest twist of the red node [degrees]", wind.most_twist, Bounds{0.5, 90}},
      {"largest displacement of the red node, of the height", wind.most_displacement / kHeight,
       Bounds{0.05, 0.6}},
      {"residual seven seconds after the wind, of the height", wind.residual, Bounds{0, 1e-3}},
      {"leaf pulled: its tip moves, of the height", both.leaf, Bounds{0.02, 0.6}},
      {"leaf pulled: the stem's end moves, of the height", both.stem, Bounds{0.002, 0.3}},
      {"leaf pulled: a sibling's tip moves, of the height", both.sibling, Bounds{0.002, 0.3}},
      {"leaf pulled, one-way joints: its tip moves, of the height", one_way.leaf, Bounds{0.02, 0.6}},
      {"leaf pulled, one-way joints: the stem's end moves", one_way.stem, Bounds{0, 1e-9}},
      {"leaf pulled, one-way joints: a sibling's tip moves", one_way.sibling, Bounds{0, 1e-9}}};
  out.claims = {
      {"leaves bend and twist in the wind, and the plant restores its shape",
       text("the red node twists by up to %.1f degrees and moves by up to ", wind.most_twist) +
           text("%.1f %% of the height; seven seconds after the wind all nodes are within ",
                100 * wind.most_displacement / kHeight) +
           text("%.0e of the height of where they were", wind.residual),
       wind.residual < 1e-3 && wind.most_twist > 0.5 ? Verdict::holds : Verdict::partly},
      {"as a leaf is pulled, stem and siblings deform; in the parent-child hierarchy a child does not affect "
       "its parent",
       text("a leaf's tip pulled by %.1f %% of the height moves the stem's end by ", 100 * both.leaf) +
           text("%.1f %% and a sibling's tip by ", 100 * both.stem) +
           text("%.1f %%; with one-way joints both stay to 1e-9", 100 * both.sibling),
       both.stem > 1e-3 && one_way.stem < 1e-9 ? Verdict::holds : Verdict::fails}};
  say_left_out(in_wind(), Parts::rods, out);
  return out;
}

}  // namespace tendril::gallery
