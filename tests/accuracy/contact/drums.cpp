#include <tendril/dynamics/forces.h>

#include "accuracy/contact/cases.h"
#include "accuracy/contact/runs.h"
#include "support/numbers.h"
#include "support/rods.h"

/// Chains and stiff rods that are drawn over a rough drum.
namespace tendril::contact {
namespace {

using tendril::test::kPi;

/// Holds a node by a spring of which the other end goes down.
class Hand final : public Force {
 public:
  Hand(std::size_t node, Vec3 from) : node_(node), from_(std::move(from)) {}
  void add(const StateView& state, const Loads& loads) const override {
    loads.force[node_] += kStiffness * (from_ - kSpeed * state.time * Vec3::UnitZ() - state.p[node_]);
  }
  Couplings couplings(std::span<const NodeRange>) const override {
    return Couplings::among({node_}).with([i = node_](const StateView&, LoadDerivatives& to) {
      to.add_by_position(i, i, -kStiffness * Mat3::Identity());
    });
  }

 private:
  static constexpr double kStiffness = 1e3, kSpeed = 0.002;
  std::size_t node_;
  Vec3 from_;
};

/// A rod that rests straight, of bending stiffness B, over half a drum of which its line is 1 off the axis.
/// Its first end is pulled down by 1, its last one drawn down.
struct Drawn {
  double bending;              ///< B
  double friction;             ///< mu
  double firmness;             ///< of the law: what would press on a length that is half a range off
  std::array<double, 2> tail;  ///< lengths that hang down at first
};

/// What draws it, the mean of ten instants: friction goes by what a step slid, the mean hangs on no single
/// one.
Vec3 drawing_force(const Drawn& drawn, int edges) {
  const double radius = 0.01, range = 1e-3, pull = 1.0;
  Law law{.stiffness = 1.0, .range = range, .friction = drawn.friction, .stick_stiffness = 1e4};
  law.stiffness = drawn.firmness / -potential(law, 0.5 * range).slope;
  // Where it presses by 1.
  double gap = 0.5 * range;
  for (int k = 0; k < 60; ++k)
    gap += (pull + law.stiffness * potential(law, gap).slope) / -(law.stiffness * potential(law, gap).bend);
  const double drum = 1.0 - radius - gap;
  const double whole = kPi + drawn.tail[0] + drawn.tail[1], edge = whole / edges;
  const double corner = 1.0 / std::cos(0.5 * edge);  // edges touch with their middles
  std::vector<Vec3> straight, q, wrapped;
  for (int i = 0; i <= edges; ++i) {
    const double s = edge * i - drawn.tail[0], turn = std::clamp(s, 0.0, kPi);
    const double beyond = s < 0.0 ? s : std::max(0.0, s - kPi);
    wrapped.push_back(corner * Vec3(-std::cos(turn), 0, std::sin(turn)) +
                      beyond * Vec3(std::sin(turn), 0, std::cos(turn)));
    const double longer = i > 0 ? (wrapped.back() - wrapped[wrapped.size() - 2]).norm() : 0.0;
    straight.emplace_back(i > 0 ? straight.back().x() + longer : 0.0, 0, 0);
    q.push_back(straight.back() + 0.1 * Vec3::UnitY());
  }
  const double area = kPi * radius * radius, tension = 1e5;
  Rod rod =
      make_rod(straight, q, {tension / area, tension / area / 3, 1e-2 / area}, circular_section(radius));
  for (auto* springs : {&rod.bend_l, &rod.bend_m, &rod.twist})
    for (double& k : *springs) k *= drawn.bending / (tension * radius * radius / 4);
  rod.mass_damping = 5.0;
  rod.viscosity = 3e-2;
  Scene scene;
  scene.rods = {rod};
  const Collider solid{"drum",
                       cylinder(drum, std::numeric_limits<double>::infinity()),
                       {.rotation = Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()).toRotationMatrix()}};
  scene.forces = {
      std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, straight}},
                                   std::vector<Collider>{solid}, law),
      std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 0, Vec3(0, 0, -pull), Signal::constant(1.0)),
      std::make_shared<Hand>(static_cast<std::size_t>(edges), wrapped.back())};
  const System system(scene);
  State start = system.rest_state();
  for (std::size_t i = 0; i < wrapped.size(); ++i)
    start.y.segment<3>(3 * static_cast<Eigen::Index>(i)) = wrapped[i];
  SimulationOptions options;
  options.tolerance = 1e-5;
  options.method = Method::rodas;
  Simulation simulation(system, start, options);
  Vec3 mean = Vec3::Zero();
  for (int k = 1; k <= 10; ++k) {
    run_to(simulation, 4.0 + 0.1 * k);
    const ContactMemory& memory = memory_of(simulation.state());
    require(memory.friction_work < 0.0, "friction takes work");
    Vec3 sum(0, 0, -pull);
    for (const Contact& c : memory.contacts) sum += c.force;
    require(std::none_of(memory.contacts.begin(), memory.contacts.end(),
                         [](const Contact& c) { return c.sticks; }),
            "what is drawn over a drum slides");
    mean -= sum / 10;
  }
  return mean;
}

/// F2 / F1 of a stiff rod that slides over a drum, its ends' directions `whole` apart: each end lifts off by
/// F (1 - cos phi) = B / 2, and is in balance with what it lies on there.
double ratio_of_stiff(double force, double friction, double whole, double bending) {
  const double phi1 = std::acos(1.0 - 0.5 * bending / force);
  double other = force;
  for (int k = 0; k < 200; ++k) {
    const double phi2 = std::acos(1.0 - 0.5 * bending / other);
    other = force * (std::cos(phi1) + friction * std::sin(phi1)) *
            std::exp(friction * (whole - phi1 - phi2)) / (std::cos(phi2) - friction * std::sin(phi2));
  }
  return other / force;
}

}  // namespace

Case capstan() {
  Case out{"K1", "Chain that is drawn over a drum",
           "half a turn with friction of 0.3: tensions in the ratio e^(mu pi) = 2.566332"};
  Quantity ratio{"ratio of the tensions", std::exp(0.3 * kPi), "relative"};
  for (const int edges : {16, 32, 64})
    ratio.rows.push_back(
        relative(edges, drawing_force({2.5e-3, 0.3, 1.0, {0.2, 0.2}}, edges).norm(), ratio.reference));
  ratio.limits = {{64, 1e-3}};
  ratio.order = Order{2.2, 0.4, 32};
  out.quantities = {ratio};
  return out;
}

Case stiff_rod_over_a_drum() {
  Case out{"K2", "Stiff rod that is drawn over a drum",
           "F (1 - cos phi) = B / (2 rho^2) at each end, F2 (cos phi2 - mu sin phi2) = F1 (cos phi1 + mu sin "
           "phi1) e^(mu (Theta - phi1 - phi2)), mu = 0.3"};
  require(std::abs(ratio_of_stiff(1.0, 0.3, kPi, 1.0) - 2.052777) < 1e-6 &&
              std::abs(ratio_of_stiff(1.0, 0.3, kPi, 0.2) - 2.426001) < 1e-6 &&
              std::abs(ratio_of_stiff(1.0, 0.3, kPi, 0.01) - 2.558141) < 1e-6,
          "the closed form has its known digits");
  for (const int share : {5, 20}) {
    const double bending = 1.0 / share, length = std::sqrt(bending);
    const Vec3 force = drawing_force({bending, 0.3, 50.0, {3.5 * length, 2.5 * length}}, 64);
    // The hand stays where it is, so that the drawn end comes off the vertical.
    const double whole = kPi - std::atan2(force.x(), -force.z());
    Quantity ratio{"F2 / F1 at F1 rho^2 / B = " + std::to_string(share),
                   ratio_of_stiff(1.0, 0.3, whole, bending), "relative"};
    ratio.rows = {relative(64, force.norm(), ratio.reference)};
    ratio.limits = {{64, 1e-3}};
    out.quantities.push_back(ratio);
  }
  return out;
}

}  // namespace tendril::contact
