#include <tendril/dynamics/forces.h>

#include "accuracy/contact/cases.h"
#include "accuracy/contact/runs.h"
#include "support/numbers.h"
#include "support/rods.h"

/// References for contact with known digits: one degree of freedom in a potential, friction, beams on
/// supports.
namespace tendril::contact {
namespace {

using tendril::test::kPi;

Vec3 velocity(const State& state, std::size_t nodes, std::size_t node) {
  return place(state, nodes + node);
}
void set_velocity(State& state, std::size_t nodes, const Vec3& v) {
  for (std::size_t i = 0; i < nodes; ++i) state.y.segment<3>(static_cast<Eigen::Index>(3 * (nodes + i))) = v;
}

/// A rod of two masses of 1/2 and of weight 1 that moves as one.
Rod bar() {
  Rod rod = tendril::test::straight_rod(1, 1e4, 0.05);
  rod.mass = {0.5, 0.5};
  return rod;
}

/// \param floors  on each other
std::shared_ptr<RodContact> on_floor(const Rod& rod, double radius, double height, const Law& law,
                                     std::size_t floors = 1) {
  const Collider floor{"floor", half_space(), {.position = Vec3(0, 0, height)}};
  return std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                      std::vector<Collider>(floors, floor), law);
}

SimulationOptions within(double tolerance, Method method = Method::cash_karp) {
  SimulationOptions options;
  options.tolerance = tolerance;
  options.method = method;
  return options;
}

struct Bounce {
  double time;   ///< within the range
  double least;  ///< gap
  double speed;  ///< afterwards
};

/// A mass of 1 that meets a floor with speed 1, from 1/10 above its range.
Bounce bounce(const Law& law) {
  const Rod rod = bar();
  Scene scene;
  scene.rods = {rod};
  const double radius = 0.1, above = 0.1;
  scene.forces = {on_floor(rod, radius, -radius - law.range - above, law)};
  const System system(scene);
  State start = system.rest_state();
  set_velocity(start, 2, Vec3(0, 0, -1));
  SimulationOptions options = within(1e-12);
  options.largest_step = 2e-5;
  Simulation simulation(system, start, options);
  Bounce result{0.0, law.range, 0.0};
  // The parabola through a state's place and speed, bent by the force there, has its lowest point here.
  simulation.on_progress([&](double) {
    const ContactMemory& memory = memory_of(simulation.state());
    if (memory.contacts.empty()) return true;
    double force = 0.0;
    for (const Contact& c : memory.contacts) force += c.force.z();
    const double v = velocity(simulation.state(), 2, 0).z();
    const double gap = memory.contacts[0].gap, fall = v * v / (2.0 * force);
    if (fall < 1e-5 * gap) result.least = std::min(result.least, gap - fall);
    return true;
  });
  const double end = 0.4;
  run_to(simulation, end);
  result.speed = velocity(simulation.state(), 2, 0).z();
  result.time = end - above - (place(simulation.state(), 0).z() + above) / result.speed;
  return result;
}

/// Block on a slope of which the tangent is a share of the friction: it holds, or slides by what is left.
struct Slope {
  double creep;  ///< [length / time]
  double slip;   ///< way after a second
  bool sticks;
};
/// \param floors  that lie on each other and carry it together
Slope on_slope(double friction, double share, double duration, std::size_t floors = 1) {
  const Rod rod = bar();
  const double angle = std::atan(share * friction), g = 9.81;
  Law law{.stiffness = 1e4, .range = 0.01, .friction = friction, .damping = 30.0};
  Scene scene;
  scene.rods = {rod};
  scene.rods[0].mass_damping = 5.0;
  scene.forces = {on_floor(rod, 0.1, -0.1 - 0.005, law, floors),
                  std::make_shared<Gravity>(g * Vec3(std::sin(angle), 0, -std::cos(angle)))};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), within(1e-8, Method::automatic));
  run_to(simulation, duration / 2);
  const double before = place(simulation.state(), 0).x();
  run_to(simulation, duration);
  const double after = place(simulation.state(), 0).x();
  const ContactMemory& memory = memory_of(simulation.state());
  return {(after - before) / (duration / 2), after,
          !memory.contacts.empty() && std::all_of(memory.contacts.begin(), memory.contacts.end(),
                                                  [](const Contact& c) { return c.sticks; })};
}

/// A mass on a spring k that friction brakes: from 10.3 mu N / k it comes to rest at -0.3 mu N / k, after
/// five half periods.
double rest_on_friction() {
  const Rod rod = bar();
  const double mu = 0.2, g = 10.0, k = 50.0, unit = mu * g / k, omega = std::sqrt(k);
  Law law{.stiffness = 1e5, .range = 0.001, .friction = mu, .stick_stiffness = 1e7};
  // Begins where the floor carries it.
  double gap = 0.0005;
  for (int i = 0; i < 60; ++i) {
    const Potential b = potential(law, gap);
    gap -= (-law.stiffness * b.slope - g) / (-law.stiffness * b.bend);
  }
  Scene scene;
  scene.rods = {rod};
  scene.forces = {on_floor(rod, 0.1, -0.1 - gap, law), std::make_shared<Gravity>(Vec3(0, 0, -g)),
                  std::make_shared<PullTowards>(0, 0, Vec3(-10.3 * unit, 0, 0), k / 2),
                  std::make_shared<PullTowards>(0, 1, Vec3(1.0 - 10.3 * unit, 0, 0), k / 2)};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), within(1e-9));
  const double rest = 15.70796 / omega;
  run_to(simulation, 0.98 * rest);
  require(velocity(simulation.state(), 2, 0).x() < -1e-4, "it comes to rest no earlier");
  run_to(simulation, 1.2 * rest);
  require(memory_of(simulation.state()).contacts.at(0).sticks, "what rests on friction sticks");
  return place(simulation.state(), 0).x() / unit + 10.3;
}

/// A rod on a rough floor drawn at its end by F gives way by F^2 / (2 E A mu q); the rest of it sticks.
double given_way(int edges, double mu, double weight, double pull, double tension) {
  const double radius = 0.02;
  Rod rod = tendril::test::straight_rod(edges, 1.0, radius);
  const double area = kPi * radius * radius;
  rod = make_rod(rod.p, rod.q, {tension / area, tension / area / 3, weight / area}, circular_section(radius));
  rod.mass_damping = 20.0;
  Law law{.stiffness = 1.0, .range = 1e-3, .friction = mu, .stick_stiffness = 1e7};
  law.stiffness = weight / -potential({.stiffness = 1.0, .range = 1e-3}, 5e-4).slope;
  Scene scene;
  scene.rods = {rod};
  scene.forces = {on_floor(rod, radius, -radius - 5e-4, law), std::make_shared<Gravity>(Vec3(0, 0, -1)),
                  std::make_shared<PointLoad>(PointLoad::Kind::force, 0, static_cast<std::size_t>(edges),
                                              Vec3(pull, 0, 0), Signal::table({{0.0, 0.0}, {20.0, 1.0}}))};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), within(1e-6, Method::rodas));
  run_to(simulation, 21.0);
  require(memory_of(simulation.state()).contacts.front().sticks, "the rest of it sticks");
  return place(simulation.state(), static_cast<std::size_t>(edges)).x() - 1.0;
}

}  // namespace

Case mass_and_barrier() {
  Case out{"K11", "Mass that meets a floor with V = 1",
           "in the barrier -kappa (d - range)^2 ln(d / range), m = 1, range = 0.01: least gap and time by "
           "quadrature; on a spring pi sqrt(m / k)",
           "", "masses"};
  const auto add = [&](std::string name, double reference, double value, double scale, double limit) {
    Quantity one{std::move(name), reference, "relative"};
    one.rows = {{1, value, (value - reference) / scale}};
    one.limits = {{1, limit}};
    out.quantities.push_back(one);
  };
  for (const auto& [kappa, least, time] :
       {std::tuple(1e4, 3.291860e-3, 1.789636e-2), std::tuple(1e6, 8.340216e-3, 4.621420e-3)}) {
    const Bounce found = bounce({.stiffness = kappa, .range = 0.01});
    const std::string of = kappa < 1e5 ? ", kappa = 1e4" : ", kappa = 1e6";
    add("least gap" + of, least, found.least, 0.01, 1e-6);
    add("time" + of, time, found.time, time, 1e-6);
    add("speed afterwards" + of, 1.0, found.speed, 1.0, 1e-9);
  }
  for (const double k : {1e4, 1e6}) {
    const Bounce found = bounce({.kind = Law::Kind::penalty, .stiffness = k, .range = 0.01});
    const std::string of = k < 1e5 ? ", k = 1e4" : ", k = 1e6";
    const double time = kPi / std::sqrt(k);
    add("time on a spring" + of, time, found.time, time, 1e-6);
    add("speed afterwards" + of, 1.0, found.speed, 1.0, 1e-9);
  }
  return out;
}

Case stick_and_slip() {
  Case out{"K12", "What friction holds, and lets go",
           "a block at 0.95 of the friction cone does not creep; a mass on a spring from 10.3 mu N / k comes "
           "to rest at -0.3 mu N / k; a rod drawn by F on a rough plane gives way by F^2 / (2 E A mu q)",
           "", "masses or edges"};
  const auto add = [&](const char* name, double reference, const char* error_is, Row row, double limit) {
    Quantity one{name, reference, error_is};
    one.rows = {row};
    one.limits = {{row.n, limit}};
    out.quantities.push_back(one);
  };
  const Slope held = on_slope(0.5, 0.95, 60.0);
  // Nor does what two solids hold at once; it takes longer to come to rest.
  const Slope between = on_slope(0.5, 0.95, 240.0, 2);
  const Slope slid = on_slope(0.5, 1.05, 2.0);
  require(held.sticks && between.sticks && !slid.sticks && slid.slip > 0.01,
          "it sticks below the cone and slides above");
  add("creep in a second", 0.0, "of the length", {2, held.creep, held.creep}, 1e-12);
  add("creep in a second, between two floors", 0.0, "of the length", {2, between.creep, between.creep},
      1e-12);
  const double rest = rest_on_friction();
  add("rest of a mass on a spring, over mu N / k", -0.3, "absolute", {2, rest, rest + 0.3}, 1e-3);
  const double mu = 0.5, weight = 4.0, pull = 1.0, tension = 100.0;
  const double exact = pull * pull / (2.0 * tension * mu * weight);
  add("way of a drawn end", exact, "relative", relative(16, given_way(16, mu, weight, pull, tension), exact),
      1e-3);
  return out;
}

}  // namespace tendril::contact
