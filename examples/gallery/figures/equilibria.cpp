#include <tendril/dynamics/simulation.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>

#include "figures.h"
#include "page/sketch.h"
#include "rivals/flat_run.h"
#include "spared.h"

namespace tendril::gallery {
namespace {

constexpr double kEdge = 0.2, kTurn = 35.0, kEquilibriaMass = 0.05, kStretch = 200.0, kAngular = 0.5;
constexpr double kEquilibriaDamping = 4.0, kEquilibriaSettled = 10.0;
constexpr std::uint32_t kNodes = 6;
constexpr double kLength = kEdge * (kNodes - 1);
/// Two shapes are one where no mass is farther apart than that.
constexpr double kSame = 0.01 * kLength;

/// An arc in the plane x z: every edge turns by the same angle.
std::vector<Vec3> arc() {
  std::vector<Vec3> p{Vec3::Zero()};
  for (std::uint32_t i = 0; i + 1 < kNodes; ++i) {
    const double angle = i * kTurn * std::numbers::pi / 180;
    p.push_back(p.back() + kEdge * Vec3(std::cos(angle), 0, std::sin(angle)));
  }
  return p;
}

using Shape = std::vector<Vec3>;
/// Settles a chain that was at rest and is given these velocities; nothing where that was refused.
using Settle = std::function<std::optional<Shape>(const std::vector<Vec3>& velocities)>;

SpringNet chain() {
  SpringNet net{arc(), std::vector<double>(kNodes, kEquilibriaMass), {}};
  for (std::uint32_t i = 0; i + 1 < kNodes; ++i)
    net.springs.push_back(spring_between(net.rest, i, i + 1, kStretch));
  net.held = {0, 1};
  net.damping = kEquilibriaDamping;
  return net;
}

/// Bending springs between second neighbours (Figure 3.7, left).
SpringNet with_bending_springs() {
  SpringNet net = chain();
  for (std::uint32_t i = 0; i + 2 < kNodes; ++i)
    net.springs.push_back(spring_between(net.rest, i, i + 2, kStretch));
  return net;
}

/// Angular springs between neighbouring edges (Figure 3.7, right).
SpringNet with_angular_springs() {
  SpringNet net = chain();
  for (std::uint32_t i = 1; i + 1 < kNodes; ++i) net.angles.push_back(angle_at(net.rest, i, kAngular));
  return net;
}

Settle settling(const SpringNet& net) {
  return [net](const std::vector<Vec3>& velocities) -> std::optional<Shape> {
    NetState start = at_rest(net);
    for (std::uint32_t i = 2; i < kNodes; ++i) start.v[i] = velocities[i];
    FlatRun run(net, start, {1e-3, kLength, kEquilibriaSettled});
    if (const NetReport& report = run.run(kEquilibriaSettled); !report.finished)
      throw std::runtime_error(report.reason);
    return run.state().p;
  };
}

/// The curve-pair's springs between edges and frames.
Scene frame_springs() {
  Scene scene;
  const SpringConstants springs{.stretch = kStretch,
                                .bend_l = kAngular,
                                .bend_m = kAngular,
                                .bend_t = 0.0,
                                .twist = kAngular,
                                .mass = kEquilibriaMass,
                                .inertia = kEquilibriaMass * kEdge * kEdge / 4};
  scene.rods.push_back(make_rod(arc(), orientation_towards(arc(), Vec3::UnitY(), 0.1), springs));
  scene.rods[0].mass_damping = kEquilibriaDamping;
  scene.anchors.push_back({.rod = 0, .node = 0});
  return scene;
}

Settle settling(const System& system) {
  return [&system](const std::vector<Vec3>& velocities) -> std::optional<Shape> {
    State start = system.rest_state();
    for (Eigen::Index i = 1; i < kNodes; ++i)
      start.y.segment<3>(3 * (kNodes + i)) = velocities[static_cast<std::size_t>(i)];
    // Only where it settles counts: on the way there the motion may be off by more than the default allows.
    Simulation simulation(system, start, {.tolerance = 1e-4, .energy_limit = 0.1, .drift_limit = 1e4});
    if (simulation.run(kEquilibriaSettled).stop != Stop::finished) return {};
    Shape out;
    for (Eigen::Index i = 0; i < kNodes; ++i) out.emplace_back(simulation.state().y.segment<3>(3 * i));
    return out;
  };
}

double apart(const Shape& a, const Shape& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

struct Found {
  std::vector<Shape> distinct;
  int returned = 0;       ///< to the rest shape
  int refused = 0;        ///< where an edge folded back on its neighbour, which leaves a node without a frame
  double farthest = 0.0;  ///< from the rest shape, of the length
};

/// Gives all masses random velocities, again and again.
/// \param flat  within the plane of the arc
Found search(const Settle& settle, int tries, double speed, bool flat) {
  std::mt19937_64 random(1);
  // Plain sums of uniform numbers: the standard's distributions differ between libraries.
  const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
  const Shape rest = arc();
  Found out;
  for (int k = 0; k < tries; ++k) {
    std::vector<Vec3> velocities;
    for (std::uint32_t i = 0; i < kNodes; ++i) {
      velocities.emplace_back(number(), number(), number());
      velocities.back() *= 2 * speed;
      if (flat) velocities.back().y() = 0.0;
    }
    const std::optional<Shape> shape = settle(velocities);
    if (!shape) {
      ++out.refused;
      continue;
    }
    out.returned += apart(*shape, rest) < kSame;
    out.farthest = std::max(out.farthest, apart(*shape, rest) / kLength);
    const bool known = std::any_of(out.distinct.begin(), out.distinct.end(),
                                   [&](const Shape& other) { return apart(*shape, other) < kSame; });
    if (!known) out.distinct.push_back(*shape);
  }
  return out;
}

std::string drawn(const Found& found, const View& view, const std::string& title) {
  Sketch sketch(view);
  // Corners that make all pictures cover the same stretch.
  for (const double x : {-0.02, 0.85})
    for (const double z : {-0.3, 0.7}) sketch.dot(Vec3(x, 0, z), "#ffffff", 0.1);
  const std::vector<Vec3> rest = arc();
  for (const Shape& shape : found.distinct) {
    sketch.line(shape, "#d55e00", 1.0);
    for (const Vec3& p : shape) sketch.dot(p, "#d55e00", 2.0);
  }
  sketch.line(rest, "#0072b2", 2.4);
  for (const Vec3& p : rest) sketch.dot(p, "#0072b2", 3.5);
  return sketch.svg(300, title);
}

constexpr int kTries = 200;
constexpr double kSpeed = 4.0;

/// One kind of springs, in the plane of the arc and in space.
struct Kind {
  std::string name;
  Found flat, space;
};

Kind kind_of(const std::string& name, const Settle& settle) {
  return {name, search(settle, kTries, kSpeed, true), search(settle, kTries, kSpeed, false)};
}

void add(const Kind& kind, Bounds flat, Bounds space, Bounds returned, Figure& out) {
  const View side{Vec3::UnitX(), Vec3::UnitZ()}, above = seen_from(Vec3(0.3, -1, 0.4));
  const auto count = [](const auto& list) { return static_cast<double>(list.size()); };
  out.pictures.push_back({drawn(kind.flat, side, kind.name + ", in the plane"),
                          text("%.0f equilibria found", count(kind.flat.distinct))});
  out.pictures.push_back({drawn(kind.space, above, kind.name + ", in space"),
                          text("%.0f equilibria found", count(kind.space.distinct))});
  out.numbers.push_back(
      {kind.name + ": equilibria found in the plane, 200 tries", count(kind.flat.distinct), flat});
  out.numbers.push_back(
      {kind.name + ": equilibria found in space, 200 tries", count(kind.space.distinct), space});
  out.numbers.push_back(
      {kind.name + ": returned to the rest shape in space", double(kind.space.returned), returned});
  out.numbers.push_back(
      {kind.name + ": refused in space, an edge folded back", double(kind.space.refused), Bounds{0, 30}});
}

std::string found(const Kind& kind) {
  return text("%.0f", double(kind.flat.distinct.size())) + " and " +
         text("%.0f", double(kind.space.distinct.size()));
}

}  // namespace

Figure springs_that_lose_their_shape() {
  const System system(frame_springs());
  const Kind bending = kind_of("bending springs", settling(with_bending_springs()));
  const Kind angular = kind_of("angular springs", settling(with_angular_springs()));
  const Kind frames = kind_of("frame springs", settling(system));
  Figure out{"3.8", "Springs that lose their shape, and springs that return (also 3.3)",
             "A chain of six masses, curved at rest, its first edge held. Each mass is given a random "
             "velocity of up to 4 m/s "
             "(it is a metre long; much faster ones fold the chain, which is refused) along each axis, 200 "
             "times over, and the chain settles under damping: in the "
             "plane of its rest shape, and in space. "
             "Bending springs join second neighbours, angular springs hold the angle between neighbouring "
             "edges, and the "
             "curve-pair's springs hold edges in the frames of its nodes. Blue is the rest shape."};
  add(bending, {6, 16}, {150, 200}, {0, 10}, out);
  add(angular, {6, 16}, {150, 200}, {0, 10}, out);
  add(frames, {1, 1}, {1, 1}, {190, 200}, out);
  out.claims = {
      {"with bending springs between second neighbours, or angular springs between edges, the same chain has "
       "several equilibria and its shape is not restored",
       "equilibria found in the plane and in space, of 200 tries: bending springs " + found(bending) +
           ", angular springs " + found(angular) +
           "; so many in space because nothing resists turning about an edge: they are no points but a "
           "continuum",
       bending.flat.distinct.size() > 4 && angular.flat.distinct.size() > 4 ? Verdict::holds
                                                                            : Verdict::fails},
      {"springs between edges and frames give a predictable and unique shape in most cases",
       "equilibria found in the plane and in space: " + found(frames) +
           text("; %.0f of 200 in space returned to the rest shape", frames.space.returned) +
           text(", %.0f were refused as an edge folded back on its neighbour", frames.space.refused),
       frames.space.distinct.size() == 1 ? Verdict::holds : Verdict::partly}};
  say_left_out(frame_springs(), Parts::rods, out);
  return out;
}

}  // namespace tendril::gallery
