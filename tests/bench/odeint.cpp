#include "bench/contest.h"

#ifdef TENDRIL_BENCH_ODEINT

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_cash_karp54.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/version.hpp>

// Only after the headers it adds to.
#include <boost/numeric/odeint/external/eigen/eigen.hpp>

#include "bench/clock.h"

namespace tendril::bench {
namespace {

namespace ode = boost::numeric::odeint;
using Vector = Eigen::VectorXd;
using CashKarp54 = ode::runge_kutta_cash_karp54<Vector, double, Vector, double, ode::vector_space_algebra>;
using Dopri5 = ode::runge_kutta_dopri5<Vector, double, Vector, double, ode::vector_space_algebra>;

/// odeint has no word for an equation that cannot be evaluated.
struct NotEvaluable {};

template <class Stepper>
void integrate(const Problem& problem, double tolerance, double cap, Flow& flow, Vector& y, Trial& out) {
  auto stepper = ode::make_controlled<Stepper>(tolerance, tolerance);
  const auto equations = [&](const Vector& x, Vector& rate, double t) {
    rate.resize(x.size());
    if (!flow(t, x, rate).ok()) throw NotEvaluable();
  };
  Deadline deadline(cap);
  double t = 0.0, h = problem.duration / 100;
  while (t < problem.duration && !out.capped && out.failure.empty()) {
    h = std::min(h, problem.duration - t);
    const bool last = h == problem.duration - t;
    if (stepper.try_step(equations, y, t, h) == ode::success) {
      if (last) t = problem.duration;
      const bool changed = flow.accepted(t, y);
      if constexpr (requires { stepper.reset(); }) {
        if (changed) stepper.reset();
      }
    }
    if (!(h > 1e-14)) out.failure = "the step fell below 1e-14 s";
    out.capped = deadline.passed();
  }
  out.reached = t;
}

template <class Stepper>
Trial run(const Problem& problem, double tolerance, double cap) {
  Trial out;
  out.tolerance = tolerance;
  const double begin = cpu_seconds();
  Flow flow(problem);
  Vector y = problem.start.y;
  try {
    integrate<Stepper>(problem, tolerance, cap, flow, y, out);
  } catch (const NotEvaluable&) {
    out.failure = "the equations could not be evaluated";
  }
  out.seconds = cpu_seconds() - begin;
  out.steps = flow.steps();
  out.evaluations = flow.evaluations();
  out.p = y.head(3 * static_cast<Eigen::Index>(problem.system.node_count()));
  return out;
}

}  // namespace

std::vector<Solver> odeint_solvers() {
  return {{"odeint CK54", run<CashKarp54>}, {"odeint dopri5", run<Dopri5>}};
}

std::string odeint_version() {
  return "Boost.odeint " + std::to_string(BOOST_VERSION / 100000) + "." +
         std::to_string(BOOST_VERSION / 100 % 1000);
}

}  // namespace tendril::bench

#else

namespace tendril::bench {

std::vector<Solver> odeint_solvers() {
  return {};
}

std::string odeint_version() {
  return "Boost.odeint: absent";
}

}  // namespace tendril::bench

#endif
