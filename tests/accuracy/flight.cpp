#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/fixed_steppers.h>
#include <tendril/dynamics/simulation.h>

#include "accuracy/cases.h"
#include "support/free_flight.h"

namespace tendril::accuracy {
namespace {

using test::FreeFlight;

/// What should stay, over what it was, less 1.
struct Kept {
  double energy, linear, angular;
};
Kept kept(const FreeFlight& flight, const State& end) {
  const auto work = flight.system.make_workspace();
  const test::Momentum before = test::momentum(flight.system, flight.state);
  const test::Momentum after = test::momentum(flight.system, end);
  return {
      flight.system.energies(end, *work).total() / flight.system.energies(flight.state, *work).total() - 1,
      (after.linear - before.linear).norm() / before.linear.norm(),
      (after.angular - before.angular).norm() / before.angular.norm()};
}

Quantity held(std::string name, std::vector<Row> rows, double limit) {
  const int last = rows.back().n;
  return {std::move(name), 0.0, "relative", std::move(rows), {{last, limit}}};
}

/// Energy left over by runs that choose their steps, over the tolerance they were given.
Quantity by_tolerance(const FreeFlight& flight) {
  Quantity out{"energy after a run at tolerance 10^-N, over the tolerance", 0.0, "of the tolerance"};
  for (const int digits : {3, 5, 7, 9}) {
    SimulationOptions options;
    options.method = Method::automatic;
    options.tolerance = std::pow(10.0, -digits);
    Simulation simulation(flight.system, flight.state, options);
    const Report report = simulation.run(1.0);
    if (report.stop != Stop::finished) throw std::runtime_error(report.reason);
    const double value = kept(flight, simulation.state()).energy / options.tolerance;
    out.rows.push_back({digits, value, value});
    out.limits.push_back({digits, 1.0});
  }
  return out;
}

}  // namespace

Case free_flight() {
  Case out{"C10", "Free flight of a curved rod that spins and turns",
           "linear and angular momentum sum m v and sum p x m v + I w t stay to rounding, energy to the "
           "order of the "
           "method; one second, 8 masses with flywheels",
           "A9", "steps"};
  const FreeFlight flight;
  const Kept by_cash_karp = kept(flight, flight.run(Method::cash_karp, 2000));
  out.quantities = {
      held("linear momentum, Cash-Karp", {{2000, by_cash_karp.linear, by_cash_karp.linear}}, 1e-14),
      held("angular momentum, Cash-Karp", {{2000, by_cash_karp.angular, by_cash_karp.angular}}, 1e-12),
      held("energy, Cash-Karp", {{2000, by_cash_karp.energy, by_cash_karp.energy}}, 1e-12)};
  out.quantities.push_back(by_tolerance(flight));
  Figure figure{"Ends of the rod, one second", "x", "z", {{"first mass", {}}, {"last mass", {}}}, true};
  CashKarp stepper(flight.system);
  State state = flight.state;
  for (int i = 0; i <= 1000; ++i) {
    if (i % 10 == 0)
      for (const std::size_t end : {0u, 1u}) {
        const Vec3 p = test::at(state.y, 7 * end);
        figure.curves[end].points.emplace_back(p.x(), p.z());
      }
    if (!stepper.advance(state, 1e-3).ok()) throw std::runtime_error("step failed");
  }
  out.figures.push_back(figure);
  return out;
}

namespace {

struct Stepped {
  Method method;
  const char* name;
  double order, within;
  std::vector<int> steps;
};

/// Steps at which the error is past the first wiggles and not yet near the rounding.
const std::vector<Stepped>& all_steppers() {
  static const std::vector<Stepped> all{{Method::cash_karp, "Cash-Karp 4(5)", 5, 0.1, {200, 280, 400}},
                                        {Method::rodas, "RODAS 4(3)", 4, 0.1, {400, 800, 1600}},
                                        {Method::runge_kutta4, "Runge-Kutta 4", 4, 0.1, {400, 800, 1600}},
                                        {Method::verlet, "velocity Verlet", 2, 0.1, {400, 800, 1600}},
                                        {Method::explicit_euler, "explicit Euler", 1, 0.15, {64000, 128000}},
                                        {Method::backward_euler, "backward Euler", 1, 0.15, {8000, 16000}}};
  return all;
}

Eigen::VectorXd positions(const FreeFlight& flight, Method method, int steps) {
  return flight.run(method, steps).y.head(24);
}

}  // namespace

Case integrator_orders() {
  Case out{"I1", "Order of the integrators on the free flight",
           "error of the masses' positions after one second against Cash-Karp with 3200 steps (whose own "
           "error, by its "
           "order, is below 1e-14)",
           "A10", "steps"};
  const FreeFlight flight;
  const Eigen::VectorXd exact = positions(flight, Method::cash_karp, 3200);
  for (const Stepped& one : all_steppers()) {
    Quantity quantity{one.name, 0.0, "norm of all positions"};
    for (const int steps : one.steps) {
      const double error = (positions(flight, one.method, steps) - exact).norm();
      quantity.rows.push_back({steps, error, error});
    }
    quantity.order = Order{one.order, one.within, one.steps[1]};
    out.quantities.push_back(quantity);
  }
  return out;
}

Case energy_orders() {
  Case out{"I2", "Order of the integrators' energy on the free flight",
           "energy after one second over that at the start, less 1", "A10", "steps"};
  const FreeFlight flight;
  // The last power of h that the methods leave in the positions turns rather than stretches: the energy of
  // those of order 4 is one better.
  const std::vector<Stepped> all{{Method::cash_karp, "Cash-Karp 4(5)", 5, 0.1, {100, 200, 400}},
                                 {Method::rodas, "RODAS 4(3)", 5, 0.5, {100, 200, 400}},
                                 {Method::runge_kutta4, "Runge-Kutta 4", 5, 0.3, {25, 50, 100}},
                                 {Method::verlet, "velocity Verlet", 2, 0.2, {200, 400, 800}}};
  for (const Stepped& one : all) {
    Quantity quantity{one.name, 0.0, "relative"};
    for (const int steps : one.steps) {
      const double off = kept(flight, flight.run(one.method, steps)).energy;
      quantity.rows.push_back({steps, off, off});
    }
    quantity.order = Order{one.order, one.within, one.steps[1]};
    out.quantities.push_back(quantity);
  }
  return out;
}

}  // namespace tendril::accuracy
