#include <tendril/bind/binding.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/dynamics/simulation.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "figures.h"
#include "page/sketch.h"
#include "spared.h"

namespace tendril::gallery {
namespace {

constexpr double kMouth = 0.3, kTrumpetGravity = 9.81, kTrumpetRamp = 1.0, kTrumpetSettled = 8.0;
constexpr int kTrumpetEdges = 24, kParentEdges = 3;
constexpr std::size_t kChildren = 4;

/// A chain from the mouth's rim, level there, to the middle above: z = a (cosh((R - r) / a) - 1).
constexpr double kSag = 0.12;
double catenary(double radius) {
  return kSag * (std::cosh((kMouth - radius) / kSag) - 1);
}
/// The children's length is that chain's, so that a cone of straight ones is as high as this.
double cone_height() {
  const double length = kSag * std::sinh(kMouth / kSag);
  return std::sqrt(length * length - kMouth * kMouth);
}

double drop() {
  return cone_height() - catenary(0);
}

/// How far the parent has come down at a time.
double dropped(double time) {
  return time < kTrumpetRamp ? drop() * 0.5 * (1 - std::cos(kPi * time / kTrumpetRamp)) : drop();
}
double dropping(double time) {
  return time < kTrumpetRamp ? drop() * 0.5 * kPi / kTrumpetRamp * std::sin(kPi * time / kTrumpetRamp) : 0.0;
}

Vec3 outwards(std::size_t child) {
  const double around = 0.5 * kPi * static_cast<double>(child - 1);
  return {std::cos(around), std::sin(around), 0};
}

Rod rod_between(const Vec3& from, const Vec3& to, int edges, const Section& section) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.push_back(from + (to - from) * i / edges);
  const Vec3 side = std::abs((to - from).normalized().z()) > 0.99 ? Vec3::UnitX() : Vec3::UnitZ();
  Rod rod = make_rod(p, orientation_towards(p, side, 0.05), {1e9, 4e8, 1000}, section);
  rod.mass_damping = 4.0;
  return rod;
}

/// \param drops    whether the parent comes down, or stays
/// \param angular  of the children's springs against bending and twist, over those of their section
/// \param held     whether their ends are held in place, free to turn
Scene scene_of(bool drops, double angular, bool held) {
  Scene scene;
  const Vec3 apex(0, 0, cone_height());
  scene.rods.push_back(rod_between(apex, apex + Vec3(0, 0, 0.2), kParentEdges, circular_section(0.01)));
  for (std::size_t node = 0; node <= kParentEdges; ++node) {
    Anchor moved{.rod = 0, .node = node};
    moved.motion = [drops, at = scene.rods[0].p[node]](double time) {
      const double down = drops ? dropped(time) : 0.0, rate = drops ? dropping(time) : 0.0;
      return AnchorPose{at - down * Vec3::UnitZ(), frame_towards(Vec3::UnitZ(), Vec3::UnitX()).frame,
                        -rate * Vec3::UnitZ(), Vec3::Zero()};
    };
    moved.breaks = {kTrumpetRamp};
    scene.anchors.push_back(moved);
  }
  Section section = circular_section(0.006);
  section.bending1 *= angular, section.bending2 *= angular, section.torsion *= angular;
  for (std::size_t child = 1; child <= kChildren; ++child) {
    scene.rods.push_back(rod_between(apex, kMouth * outwards(child), kTrumpetEdges, section));
    scene.joints.push_back({.parent = 0, .node = 0, .child = child});
    if (held)
      scene.anchors.push_back(
          {.rod = child, .node = kTrumpetEdges, .holds_position = true, .holds_frame = false});
  }
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kTrumpetGravity)));
  scene.twist = Scene::Twist::everywhere;
  return scene;
}

/// A run's end.
struct Settled {
  std::vector<std::vector<Vec3>> children;  ///< nodes
  std::vector<CurvePair> rest, pairs;       ///< of the children
  double speed = 0.0;                       ///< the largest
};

std::vector<CurvePair> children_of(std::span<const CurvePair> pairs) {
  return {pairs.begin() + 1, pairs.end()};
}

Settled settled(bool drops, double angular, bool held) {
  const System system(scene_of(drops, angular, held));
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-4});
  Settled out;
  out.rest = children_of(simulation.pairs());
  if (const Report report = simulation.run(kTrumpetSettled); report.stop != Stop::finished)
    throw std::runtime_error(std::string(to_string(report.stop)) + ": " + report.reason);
  out.pairs = children_of(simulation.pairs());
  const Eigen::VectorXd& y = simulation.state().y;
  const std::size_t nodes = system.node_count();
  const auto at = [&](std::size_t i) -> Vec3 { return y.segment<3>(3 * static_cast<Eigen::Index>(i)); };
  for (std::size_t i = 0; i < nodes; ++i) out.speed = std::max(out.speed, at(nodes + i).norm());
  for (std::size_t child = 1; child <= kChildren; ++child) {
    std::vector<Vec3>& p = out.children.emplace_back();
    for (std::size_t i = 0; i <= kTrumpetEdges; ++i) p.push_back(at(system.rods()[child].first + i));
  }
  return out;
}

/// Slope of a child's edge against level [degrees].
double slope(const Settled& of, std::size_t edge) {
  const Vec3 d = of.children[0][edge] - of.children[0][edge + 1];
  return std::atan2(d.z(), std::hypot(d.x(), d.y())) * 180 / kPi;
}

/// How far the children are off the chain, over the mouth's radius.
double off_catenary(const Settled& of) {
  double most = 0.0;
  for (const std::vector<Vec3>& child : of.children)
    for (const Vec3& p : child) most = std::max(most, std::abs(p.z() - catenary(std::hypot(p.x(), p.y()))));
  return most / kMouth;
}

/// How far the children's nodes are from where they were against the parent, over the children's length.
double changed(const Settled& before, const Settled& after) {
  double most = 0.0;
  for (std::size_t c = 0; c < kChildren; ++c)
    for (std::size_t i = 0; i <= kTrumpetEdges; ++i)
      most = std::max(most, (after.children[c][i] + drop() * Vec3::UnitZ() - before.children[c][i]).norm());
  return most / (kSag * std::sinh(kMouth / kSag));
}

constexpr std::uint32_t kAround = 32, kRings = 24;

/// The cone that the children lie in, open at its top.
bind::PolygonMesh cone() {
  bind::PolygonMesh mesh;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const double around = 2 * kPi * k / kAround, part = 0.05 + 0.95 * ring / kRings;
      mesh.points.emplace_back(part * kMouth * std::cos(around), part * kMouth * std::sin(around),
                               (1 - part) * cone_height());
    }
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t a = ring * kAround + k, b = ring * kAround + (k + 1) % kAround;
      mesh.corners.insert(mesh.corners.end(), {a, a + kAround, b + kAround, b});
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  return mesh;
}

/// The cone, carried by the children.
std::vector<Vec3> carried(const bind::PolygonMesh& mesh, const Settled& by) {
  std::vector<Vec3> out(mesh.points.size());
  bind::BindOptions options;
  options.band = 1.0;  // each point follows both children beside it
  bind::Binding(by.rest, mesh, options).update(by.pairs, out);
  return out;
}

/// Largest part that a point of a ring is off the ring's mean radius.
double out_of_round(std::span<const Vec3> points) {
  double most = 0.0;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    const auto of = points.subspan(ring * kAround, kAround);
    double mean = 0.0;
    for (const Vec3& p : of) mean += std::hypot(p.x(), p.y()) / kAround;
    for (const Vec3& p : of) most = std::max(most, std::abs(std::hypot(p.x(), p.y()) / mean - 1));
  }
  return most;
}

std::string drawn(const bind::PolygonMesh& mesh, Points points, std::span<const CurvePair> children,
                  double down, const std::string& title) {
  Sketch sketch(seen_from(Vec3(0.35, -1.0, 0.3)));
  for (const double z : {-0.25, 0.9})  // all pictures cover the same box
    for (const double x : {-0.36, 0.36}) sketch.dot(Vec3(x, 0, z), "#ffffff", 0.1);
  sketch.faces(mesh, points, "#e0b040", 0.75);
  for (const CurvePair& child : children) {
    std::vector<Vec3> along;
    for (int k = 0; k <= 40; ++k) along.push_back(child.primary().value(k / 40.0));
    sketch.line(along, "#7a3010", 2.2);
  }
  for (int k = 0; k <= 8; ++k) sketch.dot(Vec3(0, 0, cone_height() - down + 0.2 * k / 8), "#222222", 1.8);
  return sketch.svg(240, title);
}

}  // namespace

Figure trumpet_of_four_children() {
  constexpr double kMinimised = 1e-5;
  const Settled still = settled(false, 1, false), followed = settled(true, 1, false),
                stiff = settled(true, 1, true), weak = settled(true, kMinimised, true);
  const bind::PolygonMesh mesh = cone();
  Figure out{"3.20", "A trumpet, made by moving a parent (also 3.19)",
             "Four children are joined to the lower end of a parent, dotted, and lie in a cone under it. The "
             "parent comes down. "
             "Either the children's ends are free, or they are held in place, free to turn, with the "
             "children's angular springs as they are or minimised to 1e-5. The thesis does not say what else "
             "acts on the children: here it is their weight. Minimised, they hang as chains, and the "
             "parent stops where a chain is level at the mouth. The cone is generated."};
  const std::vector<Vec3> horn = carried(mesh, weak);
  out.pictures = {
      {drawn(mesh, mesh.points, weak.rest, 0, "before"), ""},
      {drawn(mesh, carried(mesh, followed), followed.pairs, drop(), "ends free"),
       "Angular springs as they are."},
      {drawn(mesh, carried(mesh, stiff), stiff.pairs, drop(), "ends held"), "Angular springs as they are."},
      {drawn(mesh, horn, weak.pairs, drop(), "ends held, springs minimised"), "The trumpet."}};
  const double shape = changed(still, followed), throat = slope(weak, 0),
               mouth = slope(weak, kTrumpetEdges - 1);
  const double by_hand = kChildren * 2 * 3 * (kTrumpetEdges + 1);
  out.numbers = {
      {"ends free: nodes moved against the parent, of the children's length", shape, Bounds{0, 1e-4}},
      {"minimised: slope at the throat, against level [degrees]", throat, Bounds{78, 82}},
      {"minimised: slope at the mouth [degrees]", mouth, Bounds{4, 10}},
      {"minimised: off the closed form of a chain, of the mouth's radius", off_catenary(weak),
       Bounds{0, 0.005}},
      {"not minimised: off that chain", off_catenary(stiff), Bounds{0.1, 0.4}},
      {"largest speed in the end [m/s]", std::max(weak.speed, stiff.speed), Bounds{0, 1e-4}},
      {"trumpet's rings are out of round by, of their radius", out_of_round(horn), Bounds{0, 0.2}},
      {"coordinates of the children's points, which else were set by hand", by_hand, Bounds{600, 600}}};
  out.claims = {
      {"the parent moves down and the children with it, their skeletons' shape unchanged (3.19)",
       text("ends free: no node is farther from its place against the parent than %.0e of the children's "
            "length",
            shape),
       shape < 1e-3 ? Verdict::holds : Verdict::fails},
      {"a trumpet is constructed easily: the parent moves down, angular springs on the children minimised",
       text("the four flare from %.0f degrees at the throat to ", throat) +
           text("%.0f at the mouth, ", mouth) +
           text("%.2f %% of the mouth's radius off a hanging chain; with the springs as they are ",
                100 * off_catenary(weak)) +
           text("%.0f %% off it", 100 * off_catenary(stiff)),
       off_catenary(weak) < 0.01 && throat > 70 && mouth < 15 ? Verdict::holds : Verdict::partly,
       "with the children's ends held and their weight, of which it says nothing"},
      {"the parent alone is adjusted, instead of the four children",
       text("one pose of the parent stands for %.0f coordinates", by_hand), Verdict::holds}};
  out.notes = {
      "Between two children the surface follows both, so that the mouth hangs lower there and is not round."};
  say_left_out(scene_of(true, kMinimised, true), Parts::mesh, out);
  return out;
}

}  // namespace tendril::gallery
