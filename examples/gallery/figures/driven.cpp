#include <tendril/curve/axial.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/dynamics/simulation.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "figures.h"
#include "page/chart.h"
#include "page/sketch.h"
#include "spared.h"

namespace tendril::gallery {
namespace {

void run_to(Simulation& simulation, double time) {
  if (const Report report = simulation.run(time); report.stop != Stop::finished)
    throw std::runtime_error(std::string(to_string(report.stop)) + ": " + report.reason);
}

/// Makes pictures cover the same box whatever is in them.
void cover(const Vec3& low, const Vec3& high, Sketch& sketch) {
  for (const double x : {low.x(), high.x()})
    for (const double y : {low.y(), high.y()})
      for (const double z : {low.z(), high.z()}) sketch.dot(Vec3(x, y, z), "#ffffff", 0.1);
}

/// A sheet about a curve-pair, `width(t)` to either side along the frame's x.
template <class Width>
void draw_sheet(const CurvePair& pair, const Width& width, const std::string& colour, Sketch& sketch) {
  constexpr std::uint32_t kAlong = 40;
  bind::PolygonMesh mesh;
  for (std::uint32_t i = 0; i <= kAlong; ++i)
    for (const double side : {-1.0, 0.0, 1.0}) {
      const double t = double(i) / kAlong;
      mesh.points.push_back(from_axial(pair, {t, side * width(t), 0, 0}));
    }
  for (std::uint32_t i = 0; i < kAlong; ++i)
    for (std::uint32_t j = 0; j < 2; ++j) {
      const std::uint32_t a = 3 * i + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + 1, a + 4, a + 3});
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  sketch.faces(mesh, mesh.points, colour);
}

std::vector<Vec3> line_of(const Vec3& from, const Vec3& step, int edges) {
  std::vector<Vec3> p{from};
  for (int i = 0; i < edges; ++i) p.push_back(p.back() + step);
  return p;
}

// ---- the stingray: a body, a fin to either side, a tail

constexpr double kBeat = 1.0, kSwim = 6.0;
constexpr int kFinEdges = 5, kTailEdges = 8;

Scene stingray() {
  Scene scene;
  const Material flesh{.young = 3e5, .shear = 1e5, .density = 1000};
  const auto add = [&](const std::vector<Vec3>& p, const Section& section) {
    scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.05), flesh, section));
    scene.rods.back().mass_damping = 4.0;  // of the water
    scene.rods.back().viscosity = 0.01;
  };
  add(line_of(Vec3(0, 0, 0), Vec3(-0.05, 0, 0), 4), elliptic_section(0.05, 0.02));
  add(line_of(Vec3(-0.1, 0, 0), Vec3(0, 0.05, 0), kFinEdges), elliptic_section(0.08, 0.008));
  add(line_of(Vec3(-0.1, 0, 0), Vec3(0, -0.05, 0), kFinEdges), elliptic_section(0.08, 0.008));
  add(line_of(Vec3(-0.2, 0, 0), Vec3(-0.05, 0, 0), kTailEdges), circular_section(0.01));
  for (std::size_t child = 1; child <= 3; ++child)
    scene.joints.push_back({.parent = 0, .node = child == 3 ? 4u : 2u, .child = child});
  const auto drive = [&](std::size_t rod, std::size_t node, const Vec3& force) {
    scene.forces.push_back(
        std::make_shared<PointLoad>(PointLoad::Kind::force, rod, node, force, Signal::sinusoid(1.0, kBeat)));
  };
  drive(1, kFinEdges, Vec3(0, 0, 0.3));
  drive(2, kFinEdges, Vec3(0, 0, 0.3));
  drive(3, kTailEdges, Vec3(0, 0.04, 0));
  scene.twist = Scene::Twist::everywhere;
  return scene;
}

std::string drawn_ray(const System& system, const State& state, const std::string& title) {
  const auto work = system.make_workspace();
  const std::vector<CurvePair> pairs = RodCurves(system).pairs(system, state, *work);
  Sketch sketch(seen_from(Vec3(0.9, -0.6, 0.7)));
  cover(Vec3(-0.55, -0.2, -0.05), Vec3(-0.05, 0.2, 0.1), sketch);
  const auto tapered = [](double root, double tip) {
    return [=](double t) { return root + (tip - root) * t; };
  };
  draw_sheet(
      pairs[0], [](double t) { return 0.05 * std::sqrt(std::sin(kPi * (0.1 + 0.85 * t))); }, "#6f7f8f",
      sketch);
  draw_sheet(pairs[1], tapered(0.1, 0.01), "#8496a8", sketch);
  draw_sheet(pairs[2], tapered(0.1, 0.01), "#8496a8", sketch);
  draw_sheet(pairs[3], tapered(0.012, 0.002), "#4f5f6f", sketch);
  return sketch.svg(300, title);
}

/// Share of a signal's variance that is at a frequency.
double share_at(const std::vector<std::pair<double, double>>& points, double frequency) {
  double mean = 0.0, all = 0.0;
  for (const auto& [t, value] : points) mean += value / static_cast<double>(points.size());
  std::complex<double> sum = 0.0;
  for (const auto& [t, value] : points) {
    sum += (value - mean) * std::polar(1.0, -2 * kPi * frequency * t);
    all += (value - mean) * (value - mean);
  }
  return 2 * std::norm(sum) / (all * static_cast<double>(points.size()));
}

}  // namespace

Figure stingray_swims() {
  const System system(stingray());
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-3});
  Line fin{"tip of a fin, up and down, against the body", {}}, tail{"tip of the tail, sideways", {}},
      body{"the body, up and down", {}};
  Figure out{"4.3", "A stingray, its fins and tail driven by A u sin t",
             "A body, a fin to either side and a tail, each a curve-pair, joined; nothing is held. A force A "
             "u sin t acts on "
             "the tip of each fin and of the tail, water resists. The forces are gentle: at four to six "
             "times as much "
             "the fins move at other frequencies too. The thesis says that forces on a few "
             "points do what else "
             "takes every control point by hand."};
  double differ = 0.0;
  for (int k = 1; k * 0.05 <= kSwim + 1e-9; ++k) {
    const double time = 0.05 * k;
    run_to(simulation, time);
    const State& now = simulation.state();
    const Vec3 middle = place(system, now, 0, 2), left = place(system, now, 1, kFinEdges),
               right = place(system, now, 2, kFinEdges);
    differ = std::max(differ, std::abs(left.z() - right.z()));
    body.points.emplace_back(time, 100 * middle.z());
    if (time > 2.0 + 1e-9) {
      fin.points.emplace_back(time, 100 * (left.z() - middle.z()));
      tail.points.emplace_back(time, 100 * place(system, now, 3, kTailEdges).y());
    }
    if (k == 85 || k == 90 || k == 95)
      out.pictures.push_back({drawn_ray(system, now, text("%.2f s", time)), ""});
  }
  const auto swing = [](const Line& line) {
    const auto [low, high] =
        std::minmax_element(line.points.begin(), line.points.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; });
    return high->second - low->second;
  };
  out.pictures.push_back({Chart{"What the forces make of it", "time [s]", "cm", {fin, tail, body}}.svg(),
                          "From 2 s on, when it has settled to the beat."});
  const double at_beat = share_at(fin.points, kBeat),
               coordinates = 3.0 * static_cast<double>(2 * system.node_count());
  out.numbers = {
      {"fin against the body, from low to high [cm]", swing(fin), Bounds{3, 60}},
      {"tail, from side to side [cm]", swing(tail), Bounds{1, 80}},
      {"share of the fin's motion at the beat of the force", at_beat, Bounds{0.9, 1.0}},
      {"body, from low to high [cm]", swing(body), Bounds{0.1, 60}},
      {"left and right fin differ in height by [cm]", 100 * differ, Bounds{0, 10}},
      {"coordinates of points of the four curve-pairs, each frame", coordinates, Bounds{156, 156}}};
  out.claims = {{"forces A u sin t on three points swim; by hand every control point would have to be moved",
                 text("3 signals instead of %.0f coordinates a frame: the fins beat by ", coordinates) +
                     text("%.0f cm against the body, ", swing(fin)) +
                     text("%.0f %% of it at the beat of the force, and the body answers by ", 100 * at_beat) +
                     text("%.1f cm", swing(body)),
                 at_beat > 0.9 && swing(body) > 0.1 ? Verdict::holds : Verdict::partly}};
  say_left_out(stingray(), Parts::rods, out);
  return out;
}

namespace {

// ---- the ribbon: one end follows a hand

constexpr int kRibbonEdges = 40;
constexpr double kRibbon = 2.0, kDance = 4.0;

/// A hand that draws an eight, and turns as it goes.
AnchorPose hand(double time) {
  const double w = 2 * kPi * 0.6, ease = std::min(1.0, time), slope = time < 1.0 ? 1.0 : 0.0;
  const double y = 0.5 * std::sin(w * time), z = 0.25 * std::sin(2 * w * time);
  const double dy = 0.5 * w * std::cos(w * time), dz = 0.5 * w * std::cos(2 * w * time);
  AnchorPose pose;
  pose.position = Vec3(0, ease * y, 1.5 + ease * z);
  pose.velocity = Vec3(0, slope * y + ease * dy, slope * z + ease * dz);
  pose.frame = frame_towards(Vec3::UnitX(), Vec3::UnitZ()).frame;
  return pose;
}

Scene ribbon() {
  Scene scene;
  const std::vector<Vec3> p = line_of(Vec3(0, 0, 1.5), Vec3(kRibbon / kRibbonEdges, 0, 0), kRibbonEdges);
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.05), {1e6, 4e5, 300},
                                elliptic_section(0.012, 0.002)));
  scene.rods[0].mass_damping = 0.2;
  scene.rods[0].viscosity = 0.002;
  Anchor held{.rod = 0, .node = 0};
  held.motion = hand;
  held.breaks = {1.0};
  held.period = 1 / 1.2;
  scene.anchors.push_back(held);
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  WindOptions air;
  air.mean = Vec3(0.5, 0, 0);
  air.gust = 0.3;
  scene.forces.push_back(std::make_shared<Wind>(air));
  return scene;
}

}  // namespace

Figure ribbon_dance() {
  const System system(ribbon());
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-3});
  Figure out{"4.7", "A ribbon whose end follows a hand",
             "A ribbon of two metres is held at one end by a hand that draws an eight; gravity and a light "
             "gusty wind act on it."};
  double off_hand = 0.0, stretch = 0.0, lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (int k = 1; k <= 40; ++k) {
    const double time = kDance * k / 40;
    run_to(simulation, time);
    const State& now = simulation.state();
    off_hand = std::max(off_hand, (place(system, now, 0, 0) - hand(time).position).norm());
    for (std::size_t i = 0; i < kRibbonEdges; ++i)
      stretch = std::max(stretch, std::abs((place(system, now, 0, i + 1) - place(system, now, 0, i)).norm() /
                                               (kRibbon / kRibbonEdges) -
                                           1));
    const double tip = place(system, now, 0, kRibbonEdges).y();
    lowest = std::min(lowest, tip), highest = std::max(highest, tip);
    if (k < 22 || k % 5 != 0) continue;
    Sketch sketch(seen_from(Vec3(0.9, -0.8, 0.4)));
    cover(Vec3(-0.1, -1.0, -0.3), Vec3(0.7, 1.0, 1.7), sketch);
    draw_sheet(
        simulation.pairs()[0], [](double) { return 0.03; }, "#cc3377", sketch);
    sketch.dot(hand(time).position, "#222222", 4);
    out.pictures.push_back({sketch.svg(220, text("%.1f s", time)), ""});
  }
  out.numbers = {{"held end off the hand's path [m]", off_hand, Bounds{0, 1e-12}},
                 {"largest stretch of an edge", stretch, Bounds{0, 0.05}},
                 {"free end, from side to side [m]", highest - lowest, Bounds{0.2, 4}},
                 {"time reached [s]", simulation.state().time, Bounds{kDance, kDance}}};
  out.claims = {{"with one tip fixed to the dancer's hand, gravity and wind, a waving ribbon is simulated",
                 text("the end is on the hand's path to %.0e m, ", off_hand) +
                     text("edges stretch by at most %.2f %%, the free end swings through ", 100 * stretch) +
                     text("%.1f m", highest - lowest),
                 off_hand < 1e-9 && highest - lowest > 0.2 ? Verdict::holds : Verdict::partly}};
  say_left_out(ribbon(), Parts::rods, out);
  return out;
}

}  // namespace tendril::gallery
