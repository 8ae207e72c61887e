#pragma once

#include <gtest/gtest.h>
#include <tendril/dynamics/simulation.h>

#include <cstdio>
#include <functional>
#include <string>

#include "support/planar_truth.h"
#include "support/rods.h"

namespace tendril::test {

/// A scene as a user would run it, and whether it has to end.
struct Trial {
  std::string name;
  std::function<Scene()> scene;
  double until = 0.3;
  bool automatic_finishes = true;             ///< else a refusal is right as well
  std::function<void(State&)> start = {};     ///< from the rest state
  long work_limit = 300'000;                  ///< evaluations
  double tolerance = 1e-3, reference = 1e-6;  ///< of the run, of the better of the two references
  double length = 1.0;                        ///< that errors are relative to
  std::function<PlanarRod()> planar = {};     ///< of a motion from rest in the plane x z: what it has to be
};
inline void PrintTo(const Trial& trial, std::ostream* out) {
  *out << trial.name;
}

struct Outcome {
  Report report;
  State state;
  Eigen::VectorXd p(const System& system) const {
    return state.y.head(3 * static_cast<Eigen::Index>(system.node_count()));
  }
};

inline Outcome run(const System& system, const Trial& trial, Method method, double tolerance,
                   long work_limit) {
  State start = system.rest_state();
  if (trial.start) trial.start(start);
  SimulationOptions options;
  options.method = method;
  options.tolerance = tolerance;
  options.work_limit = work_limit;
  Simulation simulation(system, std::move(start), options);
  Outcome out;
  out.report = simulation.run(trial.until);
  out.state = simulation.state();
  return out;
}

/// Never a number that is not finite, never silence, never more than the limit of work.
inline void expect_sound(const Outcome& out, long work_limit) {
  EXPECT_TRUE(out.state.y.allFinite());
  EXPECT_TRUE(std::isfinite(out.report.imbalance));
  EXPECT_TRUE(std::isfinite(out.report.time));
  EXPECT_EQ(out.report.reason.empty(), out.report.stop == Stop::finished);
  EXPECT_NE(out.report.stop, Stop::cancelled);
  EXPECT_LE(out.report.evaluations, work_limit + work_limit / 50 + 200);  // the step under way is finished
}

inline double largest_gap(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double out = 0.0;
  for (Eigen::Index i = 0; i + 2 < a.size(); i += 3)
    out = std::max(out, (a.segment<3>(i) - b.segment<3>(i)).norm());
  return out;
}

/// RODAS at two tolerances: where they agree to the tolerance of the trial, the better is a reference. Where
/// the motion is planar, it is held to equations and an integration that share no code with the library.
inline Eigen::VectorXd certified(const System& system, const Trial& trial) {
  const Outcome coarse = run(system, trial, Method::rodas, 10 * trial.reference, 100 * trial.work_limit);
  const Outcome fine = run(system, trial, Method::rodas, trial.reference, 100 * trial.work_limit);
  EXPECT_EQ(fine.report.stop, Stop::finished) << fine.report.reason;
  const double gap = largest_gap(coarse.p(system), fine.p(system)) / trial.length;
  std::printf("  %-28s reference: %ld steps, agrees to %.1e\n", trial.name.c_str(), fine.report.accepted,
              gap);
  EXPECT_LT(gap, trial.tolerance) << "the reference is not certified";
  if (trial.planar) expect_planar_motion(system, trial.planar(), fine.state, trial.tolerance);
  return fine.p(system);
}

/// By the automatic choice and by Cash-Karp: right to 100 times the tolerance, or a named refusal.
inline void expect_right_or_refused(const System& system, const Trial& trial,
                                    const std::function<Eigen::VectorXd()>& reference) {
  Eigen::VectorXd exact;
  for (const Method method : {Method::automatic, Method::cash_karp}) {
    const Outcome out = run(system, trial, method, trial.tolerance, trial.work_limit);
    expect_sound(out, trial.work_limit);
    std::printf("  %-28s %-10s %s", trial.name.c_str(), to_string(method), to_string(out.report.stop));
    if (out.report.stop == Stop::finished) {
      if (exact.size() == 0) exact = reference();
      const double error = largest_gap(out.p(system), exact) / trial.length;
      std::printf(" by %s: error %.1e, %ld steps, %ld evaluations\n", out.report.method.c_str(), error,
                  out.report.accepted, out.report.evaluations);
      EXPECT_LT(error, 100 * trial.tolerance);
    } else {
      std::printf(": %s\n", out.report.reason.c_str());
    }
    if (method == Method::automatic && trial.automatic_finishes)
      EXPECT_EQ(out.report.stop, Stop::finished) << out.report.reason;
  }
}
inline void expect_right_or_refused(const Trial& trial) {
  const System system(trial.scene());
  expect_right_or_refused(system, trial, [&] { return certified(system, trial); });
}

}  // namespace tendril::test
