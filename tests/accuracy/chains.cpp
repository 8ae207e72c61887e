#include <tendril/dynamics/simulation.h>

#include "accuracy/cases.h"
#include "support/equilibria.h"
#include "support/numbers.h"
#include "support/vibrations.h"

namespace tendril::accuracy {
namespace {

using tendril::test::kPi;

/// Of unit line density, half an edge's mass at each end, without bending stiffness.
Rod chain(int edges, double length, double tension) {
  Rod rod = test::round_rod(edges, length, 0.0, 0.0, tension);
  rod.mass.front() = rod.mass.back() = 0.5 * length / edges;
  return rod;
}

Equilibrium hung_between(int edges, double length) {
  Scene scene;
  scene.rods.push_back(chain(edges, length, 1e6));
  scene.anchors.push_back({0, 0, true, false, {}});
  Anchor moved =
      test::mover(static_cast<std::size_t>(edges), Vec3(length, 0, 0), Vec3(1 - length, 0, 0), 0.0);
  moved.holds_frame = false;
  scene.anchors.push_back(moved);
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -1)));
  StaticsOptions options;
  options.until = 1.0;
  Equilibrium found = test::balanced(System(scene), options);
  if (found.stability.kind != Stability::Kind::stable) throw std::runtime_error("a hanging chain is stable");
  return found;
}

Curve catenary_curve(double a) {
  Curve out{a > 0.5 ? "" : "closed form", {}, Curve::Kind::reference};
  for (int i = 0; i <= 100; ++i) {
    const double x = i / 100.0;
    out.points.emplace_back(x, a * (std::cosh((x - 0.5) / a) - std::cosh(0.5 / a)));
  }
  return out;
}

}  // namespace

Case catenary() {
  Case out{"C9a", "Catenary",
           "z = a cosh(x / a), 2 a sinh(1 / 2 a) = L / span; sag over the span, end tension over the weight",
           "A7"};
  struct Hung {
    double length, a, sag, tension;
  };
  Figure figure{"Hanging chains, 96 edges", "x / span", "z / span", {}, true};
  for (const Hung& exact : {Hung{1.1, 0.6549639476, 0.2003007907, 0.7775133985},
                            Hung{2, 0.2296402151, 0.7963883559, 0.5130142855}}) {
    char name[48];
    std::snprintf(name, sizeof name, "%g spans long, ", exact.length);
    Quantity sag{std::string(name) + "sag", exact.sag, "of the span"};
    Quantity tension{std::string(name) + "end tension", exact.tension, "of the weight"};
    for (const int edges : {24, 48, 96}) {
      const Equilibrium found = hung_between(edges, exact.length);
      const double low = -test::at(found.state.y, static_cast<std::size_t>(edges / 2)).z();
      const double pull = found.support[0].norm() / exact.length;
      sag.rows.push_back({edges, low, low - exact.sag});
      tension.rows.push_back({edges, pull, pull - exact.tension});
      if (edges == 96)
        figure.curves.push_back(
            {name + std::string("computed"), test::side_view(found.state), Curve::Kind::marks});
    }
    figure.curves.push_back(catenary_curve(exact.a));
    sag.limits.push_back({96, 1e-4});
    tension.limits.push_back({96, 1e-4});
    sag.order = Order{2.0, 0.1, 48};
    out.quantities.push_back(sag);
    out.quantities.push_back(tension);
  }
  out.figures.push_back(figure);
  return out;
}

Case hanging_chain() {
  Case out{"C9b", "Swinging of a hanging chain",
           "w_k = (j_0k / 2) sqrt(g / L), zeros of the Bessel function J_0 (Bernoulli 1732); values over "
           "sqrt(g / L)"};
  const double exact[] = {1.2024127788, 2.7600390551, 4.3268639565};
  for (int k = 0; k < 3; ++k) {
    out.quantities.push_back({"frequency " + std::to_string(k + 1), exact[k], "relative"});
    out.quantities.back().limits.push_back({64, k == 0 ? 1e-4 : k == 1 ? 1e-3 : 5e-3});
    out.quantities.back().order = Order{2.0, 0.05, 64};
  }
  for (const int edges : {16, 32, 64, 128}) {
    Scene scene;
    scene.rods.push_back(chain(edges, 1.0, 1e7));
    scene.anchors.push_back({0, 0, true, false, {}});
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(1, 0, 0)));  // down is x
    const System system(scene);
    const Equilibrium found = test::balanced(system);
    const auto across = [&](Eigen::Index i) { return i % 3 == 2; };
    const test::Vibrations swings = test::vibrations(system, found.state, across);
    for (int k = 0; k < 3; ++k) {
      Quantity& one = out.quantities[static_cast<std::size_t>(k)];
      one.rows.push_back({edges, swings.frequency[k], swings.frequency[k] / exact[k] - 1});
    }
  }
  return out;
}

namespace {

/// A free rod of unit length and wave speed in which a bump of axial displacement runs to the right.
struct Pulse {
  static constexpr double kHeight = 1e-4, kWidth = 0.05, kFrom = 0.3, kTime = 0.4;
  static double shape(double x) { return kHeight * std::exp(-0.5 * std::pow((x - kFrom) / kWidth, 2)); }

  explicit Pulse(int edges) : system(scene(edges)), state(system.rest_state()) {
    const auto n = static_cast<Eigen::Index>(system.node_count());
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = state.y[3 * i];
      state.y[3 * i] += shape(x);
      state.y[3 * n + 3 * i] = (x - kFrom) / (kWidth * kWidth) * shape(x);
    }
    const auto work = system.make_workspace();
    if (!system.rebase(state, *work).ok()) throw std::runtime_error("pulse too high");
    SimulationOptions options;
    options.tolerance = 1e-9;
    Simulation simulation(system, state, options);
    const Report report = simulation.run(kTime);
    if (report.stop != Stop::finished) throw std::runtime_error(report.reason);
    state = simulation.state();
  }
  static Scene scene(int edges) {
    Scene out;
    out.rods.push_back(test::straight_rod(edges, 1000, 1e-2));
    return out;
  }
  double displacement(int i, int edges) const { return state.y[3 * i] - static_cast<double>(i) / edges; }
  System system;
  State state;
};

/// Where the bump is highest: the top of the parabola through the highest node and its neighbours.
double top_of(const Pulse& pulse, int edges) {
  int top = 1;
  for (int i = 1; i < edges; ++i)
    if (pulse.displacement(i, edges) > pulse.displacement(top, edges)) top = i;
  const double a = pulse.displacement(top - 1, edges), b = pulse.displacement(top, edges),
               c = pulse.displacement(top + 1, edges);
  return (top + 0.5 * (a - c) / (a - 2 * b + c)) / edges;
}

/// Largest difference of a free chain's axial frequencies from (2 c / h) sin(k h / 2), k L = pi, 2 pi, ...
Quantity dispersion(int edges) {
  const System system(Pulse::scene(edges));
  const test::Vibrations found =
      test::vibrations(system, system.rest_state(), [](Eigen::Index i) { return i % 3 == 0; });
  Quantity out{"dispersion, highest frequency over c / h", 2.0, "relative, worst of all"};
  double worst = 0.0;
  for (int k = 1; k <= edges; ++k)
    worst =
        std::max(worst, std::abs(found.frequency[k] / (2.0 * edges * std::sin(kPi * k / (2.0 * edges))) - 1));
  out.rows.push_back({edges, found.frequency[edges] / edges, worst});
  out.limits.push_back({edges, 1e-10});
  return out;
}

}  // namespace

Case wave_speed() {
  Case out{"C11", "Axial waves",
           "u(x, t) = f(x - c t), c = sqrt(E / rho); of the chain w = (2 c / h) sin(k h / 2). A bump of "
           "width 0.05 L "
           "runs 0.4 L, by Cash-Karp at 1e-9"};
  Quantity speed{"speed of the bump's top over c", 1.0, "relative"};
  Quantity shape{"largest difference from f(x - c t)", 0.0, "of the bump's height"};
  Figure figure{"A bump that ran 0.4 L", "x / L", "displacement, of the height", {}};
  for (const int edges : {64, 128, 256, 512}) {
    const Pulse pulse(edges);
    const double value = (top_of(pulse, edges) - Pulse::kFrom) / Pulse::kTime;
    speed.rows.push_back({edges, value, value - 1});
    double worst = 0.0;
    Curve curve{std::to_string(edges) + " edges", {}};
    for (int i = 0; i <= edges; ++i) {
      const double x = static_cast<double>(i) / edges;
      worst = std::max(worst, std::abs(pulse.displacement(i, edges) - Pulse::shape(x - Pulse::kTime)));
      curve.points.emplace_back(x, pulse.displacement(i, edges) / Pulse::kHeight);
    }
    shape.rows.push_back({edges, worst / Pulse::kHeight, worst / Pulse::kHeight});
    if (edges <= 128) figure.curves.push_back(curve);
  }
  speed.limits.push_back({256, 1e-3});
  speed.order = Order{2.0, 0.1, 256};
  shape.limits.push_back({256, 5e-3});
  shape.order = Order{2.0, 0.1, 256};
  out.quantities = {speed, shape, dispersion(64)};
  out.figures.push_back(figure);
  return out;
}

}  // namespace tendril::accuracy
