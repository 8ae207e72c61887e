#include <tendril/dynamics/simulation.h>

#include <numeric>

#include "accuracy/cases.h"
#include "support/numbers.h"
#include "support/vibrations.h"

namespace tendril::accuracy {
namespace {

using tendril::test::kPi;
constexpr double kYoung = 1e6, kShear = kYoung / 3, kDensity = 1000;

System rod_of(int edges, double radius, bool held, double disc = 0.0) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(edges, kYoung, radius, kDensity));
  scene.rods[0].inertia.back() += disc;
  if (held) scene.anchors.push_back({0, 0, true, true, {}});
  scene.twist = Scene::Twist::everywhere;
  return System(scene);
}

/// Motions along one axis, or about it: on a straight rod they do not mix.
enum class Motion { along, across, about };
test::Vibrations motions(const System& system, Motion motion) {
  const auto n = static_cast<Eigen::Index>(system.node_count());
  return test::vibrations(system, system.rest_state(), [&](Eigen::Index k) {
    if (motion == Motion::about) return k >= 3 * n;
    return k < 3 * n && k % 3 == (motion == Motion::along ? 0 : 2);
  });
}

std::string ordinal(int k, const char* what) {
  return std::string(what) + " frequency " + std::to_string(k + 1);
}

/// A clamped rod's mode beside the beam's.
Figure mode_figure(int edges, const double* roots) {
  Figure figure{"Clamped modes, 32 edges", "x / L", "deflection", {}};
  const System system = rod_of(edges, 1e-2, true);
  const test::Vibrations found = motions(system, Motion::across);
  for (int k = 0; k < 3; ++k) {
    const double b = roots[k], sigma = (std::sinh(b) - std::sin(b)) / (std::cosh(b) + std::cos(b));
    const auto shape = [&](double x) {
      return 0.5 * (std::cosh(b * x) - std::cos(b * x) - sigma * (std::sinh(b * x) - std::sin(b * x)));
    };
    Curve exact{"", {}, Curve::Kind::reference}, marks{ordinal(k, "bending"), {{0, 0}}, Curve::Kind::marks};
    for (int i = 0; i <= 200; ++i) exact.points.emplace_back(i / 200.0, shape(i / 200.0));
    const double scale = shape(1) / found.shape(found.shape.rows() - 1, k);
    for (Eigen::Index i = 0; i < found.shape.rows(); ++i)
      marks.points.emplace_back(static_cast<double>(i + 1) / edges, scale * found.shape(i, k));
    figure.curves.push_back(exact);
    figure.curves.push_back(marks);
  }
  return figure;
}

}  // namespace

Case bending_frequencies() {
  Case out{"C6a", "Bending frequencies",
           "w = (beta L)^2 sqrt(E I / rho A L^4) with cos(beta L) cosh(beta L) = -1 (clamped and free) or 1 "
           "(free), "
           "Euler and Bernoulli; values over sqrt(E I / rho A L^4)",
           "A3"};
  const double clamped[] = {1.875104069, 4.694091133, 7.854757438, 10.995540735};
  const double free[] = {4.730040745, 7.853204624, 10.995607838};
  const double limits[] = {1e-3, 5e-3, 1e-2, 2e-2};
  const double unit = std::sqrt(kYoung / kDensity) * 0.5e-2;  // sqrt(E I / rho A), radius 1e-2
  std::vector<Quantity> all;
  for (const bool held : {true, false})
    for (int k = 0; k < (held ? 4 : 3); ++k) {
      const double root = held ? clamped[k] : free[k];
      all.push_back({ordinal(k, held ? "clamped" : "free"), root * root, "relative"});
      all.back().limits.push_back({32, held ? limits[k] : limits[k + 1]});
      all.back().order = Order{2.0, 0.1, 32};
    }
  for (const int edges : {16, 32, 64, 128}) {
    std::size_t next = 0;
    for (const bool held : {true, false}) {
      const test::Vibrations found = motions(rod_of(edges, 1e-2, held), Motion::across);
      for (int k = 0; k < (held ? 4 : 3); ++k, ++next) {
        const double value = found.frequency[k + (held ? 0 : 2)] / unit;  // a free rod has two rigid motions
        all[next].rows.push_back({edges, value, value / all[next].reference - 1});
      }
    }
  }
  out.quantities = all;
  out.figures.push_back(mode_figure(32, clamped));
  return out;
}

Case axial_and_torsional_frequencies() {
  Case out{
      "C6b", "Axial and torsional frequencies",
      "w_k = (2k - 1) pi c / 2 L of a clamped rod, c = sqrt(E / rho) or sqrt(G / rho); values over c / L",
      "A3"};
  for (const Motion motion : {Motion::along, Motion::about})
    for (int k = 0; k < 2; ++k) {
      const double speed = std::sqrt((motion == Motion::along ? kYoung : kShear) / kDensity);
      Quantity one{ordinal(k, motion == Motion::along ? "axial" : "torsional"), (2 * k + 1) * kPi / 2,
                   "relative"};
      for (const int edges : {16, 32, 64, 128}) {
        const double value = motions(rod_of(edges, 1e-2, true), motion).frequency[k] / speed;
        one.rows.push_back({edges, value, value / one.reference - 1});
      }
      one.limits.push_back({32, k == 0 ? 1.1e-4 : 1e-3});
      one.order = Order{2.0, 0.05, 32};
      out.quantities.push_back(one);
    }
  return out;
}

namespace {

/// Turned as in its lowest mode and let go: after five quarters of the closed form's period the end's angle
/// would be back at 0; what is left of it is the relative error of the frequency, and of the motion.
double pendulum_in_motion(const System& system, double exact, Method method) {
  const test::Vibrations found = motions(system, Motion::about);
  State state = system.rest_state();
  const double turn = 0.5 / found.shape(found.shape.rows() - 1, 0);
  for (std::size_t k = 0; k < found.y.size(); ++k)
    state.y[found.y[k]] = turn * found.shape(static_cast<Eigen::Index>(k), 0);
  const auto work = system.make_workspace();
  if (!system.rebase(state, *work).ok()) throw std::runtime_error("cannot be turned");
  SimulationOptions options;
  options.method = method;
  options.tolerance = 1e-9;
  Simulation simulation(system, state, options);
  const Report report = simulation.run(2.5 * kPi / exact);
  if (report.stop != Stop::finished) throw std::runtime_error(report.reason);
  const double left = std::accumulate(simulation.state().twist.begin(), simulation.state().twist.end(), 0.0);
  return -left / 0.5 / (2.5 * kPi);
}

}  // namespace

Case torsional_pendulum() {
  Case out{"C6c", "Torsional pendulum: a rod with a disc at its end",
           "beta tan(beta) = I_rod / I_disc, w = beta c_T / L; values are beta", "A4"};
  const double radius = 2e-2, speed = std::sqrt(kShear / kDensity);
  const double rod = kDensity * kPi * std::pow(radius, 4) / 2;
  const std::pair<double, double> exact[] = {{0.01, 0.0998336386}, {0.1, 0.3110528482}, {10, 1.4288700112}};
  for (const auto& [ratio, beta] : exact) {
    char name[64];
    std::snprintf(name, sizeof name, "I_rod / I_disc = %g", ratio);
    Quantity one{name, beta, "relative"};
    for (const int edges : {16, 32, 64}) {
      const System system = rod_of(edges, radius, true, rod / ratio);
      const double value = motions(system, Motion::about).frequency[0] / speed;
      one.rows.push_back({edges, value, value / beta - 1});
    }
    one.limits.push_back({32, 1e-4});
    // With a heavy disc the ten digits of the reference are soon reached.
    if (ratio > 1) one.order = Order{2.0, 0.05, 32};
    out.quantities.push_back(one);
  }
  const System system = rod_of(32, radius, true, rod / 0.1);
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    const double off = pendulum_in_motion(system, exact[1].second * speed, method);
    Quantity one{std::string("I_rod / I_disc = 0.1, in motion by ") + to_string(method),
                 exact[1].second,
                 "relative",
                 {{32, exact[1].second * (1 + off), off}}};
    one.limits.push_back({32, 1e-4});
    out.quantities.push_back(one);
  }
  return out;
}

}  // namespace tendril::accuracy
