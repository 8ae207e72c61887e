
#include "accuracy/contact/cases.h"
#include "accuracy/contact/runs.h"
#include "support/numbers.h"
#include "support/rods.h"

/// Rods that hit a wall and rods that are hit: what leaves, and when.
namespace tendril::contact {
namespace {

using tendril::test::kPi;

/// When a rod that met a wall end-on comes off it, over L / c, and with what momentum, over m V.
struct Rebound {
  double release, momentum;
};

/// A rod of E A = rho A = 1 along x whose end rests at the edge of the wall's range while all others come at
/// it with V, as if it had stuck there.
Rebound rebound(int edges, Law law) {
  const double radius = 0.05, area = kPi * radius * radius, speed = 1e-3;
  Rod rod = tendril::test::straight_rod(edges, 1.0 / area, radius, 1.0 / area);
  const auto scene_at = [&](double wall) {
    const Collider solid{"wall",
                         half_space(),
                         {.rotation = Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()).toRotationMatrix(),
                          .position = Vec3(wall, 0, 0)}};
    Scene scene;
    scene.rods = {rod};
    scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                                 std::vector<Collider>{solid}, law)};
    return scene;
  };
  // The gap is taken a little smaller than it is: by how much is read off.
  double wall = -radius - 0.9 * law.range;
  for (int k = 0; k < 3; ++k) {
    const System system(scene_at(wall));
    const Simulation simulation(system, system.rest_state(), {});
    const std::vector<Contact> contacts = memory_of(simulation.state()).contacts;
    if (contacts.empty()) break;
    wall -= law.range * (1.0 - 1e-12) - contacts[0].gap;
  }
  const System system(scene_at(wall));
  State start = system.rest_state();
  const auto n = static_cast<Eigen::Index>(edges) + 1;
  for (Eigen::Index i = 1; i < n; ++i) start.y[3 * (n + i)] = -speed;
  SimulationOptions options;
  options.tolerance = 1e-11;
  options.method = Method::cash_karp;
  Simulation simulation(system, start, options);
  Rebound out{0.0, 0.0};
  // It comes off where its first edge is as long as at rest.
  double before = 0.0, longer_before = 0.0;
  simulation.on_progress([&](double) {
    const State& state = simulation.state();
    const double longer = state.y[3] - state.y[0] - 1.0 / edges;
    if (longer_before < 0.0 && longer >= 0.0 && out.release == 0.0)
      out.release = before + (state.time - before) * longer_before / (longer_before - longer);
    before = state.time, longer_before = longer;
    return true;
  });
  run_to(simulation, 2.2);
  require(memory_of(simulation.state()).contacts.empty(), "a rod that met a wall comes off it");
  for (Eigen::Index i = 0; i < n; ++i)
    out.momentum += rod.mass[static_cast<std::size_t>(i)] * simulation.state().y[3 * (n + i)] / speed;
  return out;
}

/// \param references  edges, release, momentum
Case end_on(std::string id, std::vector<std::tuple<int, double, double>> references) {
  Case out{std::move(id), "Rod that meets a wall end-on",
           "its first mass sticks, and comes off after about 2 L / c with about V: digits of the lumped "
           "chain, L = c = V = mass = 1"};
  for (const auto& [edges, release, momentum] : references) {
    const std::string of = ", " + std::to_string(edges) + " edges";
    Quantity when{"release" + of, release, "absolute"},
        what{"momentum afterwards" + of, momentum, "absolute"};
    const Rebound found =
        rebound(edges, {.kind = Law::Kind::penalty, .stiffness = 1e7 * edges, .range = 1e-4});
    when.rows = {{edges, found.release, found.release - release}};
    what.rows = {{edges, found.momentum, found.momentum - momentum}};
    when.limits = what.limits = {{edges, 1e-6}};
    out.quantities.push_back(when);
    out.quantities.push_back(what);
  }
  return out;
}

/// v / V at a time of a mass that landed on a long beam of B = m = 1 and stays on it: e^(a^2 t) erfc(a
/// sqrt(t)), a = 2 sqrt(2) (B m^3)^(1/4) / M = 1/2.
double landed(int edges, double length, double time) {
  const double speed = 3e-3;
  const Law law{.stiffness = 1e7, .range = 1e-5, .damping = 1e4};
  const double radius = 0.02, inertia = kPi * std::pow(radius, 4) / 4, area = kPi * radius * radius;
  const double ball_radius = 0.1;
  std::vector<Vec3> p, q;
  for (int i = 0; i <= edges; ++i) {
    p.emplace_back(length * (static_cast<double>(i) / edges - 0.5), 0, 0);
    q.push_back(p.back() + 0.1 * Vec3::UnitY());
  }
  const Rod rod = make_rod(p, q, {1.0 / inertia, 1.0 / inertia / 3, 1.0 / area}, circular_section(radius));
  Scene scene;
  scene.rods = {rod};
  Body body;
  body.mass = 4.0 * std::sqrt(2.0);
  body.inertia = 0.4 * body.mass * ball_radius * ball_radius * Mat3::Identity();
  body.position = Vec3(0, 0, radius + ball_radius + law.range);
  body.velocity = Vec3(0, 0, -speed);
  scene.bodies = {body};
  Collider collider{"mass", ball(ball_radius), {}};
  collider.body = 0;
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                               std::vector<Collider>{collider}, law)};
  const System system(scene);
  SimulationOptions options;
  options.tolerance = 1e-8;
  Simulation simulation(system, system.rest_state(), options);
  run_to(simulation, time);
  require(!memory_of(simulation.state()).contacts.empty(), "what landed stays");
  return -system.bodies(simulation.state())[0].velocity.z() / speed;
}

}  // namespace

Case end_on_impact() {
  return end_on("K10", {{8, 2.054765, 0.914567}, {32, 2.024207, 0.969695}});
}

Case end_on_impact_finely() {
  return end_on("K10", {{128, 2.009934, 0.988545}});
}

Case landing_mass() {
  Case out{"K9", "Mass that lands on a long beam and stays",
           "v / V = e^(a^2 t) erfc(a sqrt(t)), a = 2 sqrt(2) (B m^3)^(1/4) / M"};
  // Beams so long that what their ends throw back is not there yet.
  Quantity early{"v / V at a^2 t = 1/4", 0.615690, "relative"},
      late{"v / V at a^2 t = 1", 0.427584, "relative"};
  for (const int edges : {32, 64})
    early.rows.push_back(relative(edges, landed(edges, 16.0, 1.0), early.reference));
  late.rows = {relative(64, landed(64, 40.0, 4.0), late.reference)};
  early.limits = late.limits = {{64, 1e-3}};
  early.order = Order{2.4, 0.6, 64};
  out.quantities = {early, late};
  return out;
}

}  // namespace tendril::contact
