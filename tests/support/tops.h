#pragma once

#include <gtest/gtest.h>
#include <tendril/curve/frames.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>

namespace tendril::test {

/// exp([phi]).
inline Mat3 turned(const Vec3& phi) {
  Mat3 r = Mat3::Identity();
  const double angle = phi.norm();
  if (angle > 0.0)
    for (int c = 0; c < 3; ++c) r.col(c) = rotate_about(phi / angle, angle, Vec3::Unit(c));
  return r;
}

/// A body askew, with these principal moments about its axes.
inline Body body_of(const Vec3& moments, double mass = 2.0) {
  Body body;
  body.mass = mass;
  body.inertia = moments.asDiagonal();
  body.position = Vec3(0.3, -0.2, 1.1);
  body.rotation = turned({0.4, -1.1, 0.7});
  return body;
}

inline Scene alone(const Body& body) {
  Scene scene;
  scene.bodies = {body};
  return scene;
}

inline Vec3 angular_momentum(const Body& body, const BodyView& at) {
  return at.rotation * (body.inertia * (at.rotation.transpose() * at.spin));
}

/// How a torque-free top with the moments (a, a, c) stands after a time: it spins about its axis at a rate of
/// its own while all turns about the angular momentum at |L| / a.
inline Mat3 symmetric_top(const Body& body, double time) {
  const double a = body.inertia(0, 0);
  const double c = body.inertia(2, 2);
  const Vec3 axis = body.rotation.col(2);
  const Vec3 l = angular_momentum(body, {body.position, body.rotation, body.velocity, body.spin, body.mass});
  const Vec3 own = body.spin.dot(axis) * (1.0 - c / a) * axis;
  return turned(time * l / a) * turned(time * own) * body.rotation;
}

/// Period of the angular velocity, in the body's axes, of a torque-free top with the moments a < b < c and
/// L^2 > 2 E b [Landau and Lifshitz 1976].
inline double period_of_top(const Vec3& moments, const Vec3& spin) {
  const double a = moments[0];
  const double b = moments[1];
  const double c = moments[2];
  const double e2 = spin.dot(moments.cwiseProduct(spin));
  const double l2 = moments.cwiseProduct(spin).squaredNorm();
  const double k2 = (b - a) * (e2 * c - l2) / ((c - b) * (l2 - e2 * a));
  return 4.0 * std::comp_ellint_1(std::sqrt(k2)) * std::sqrt(a * b * c / ((c - b) * (l2 - e2 * a)));
}

inline const Vec3 kUneven(0.4, 0.7, 1.0);  ///< moments

inline SimulationOptions by(Method method, double step) {
  SimulationOptions options;
  options.method = method;
  if (!chooses_steps(method)) options.fixed_step = step;
  return options;
}

/// The first body after a run to the end.
inline BodyView after(const Scene& scene, double time, const SimulationOptions& options, Report& report) {
  const System system(scene);
  Simulation simulation(system, system.rest_state(), options);
  report = simulation.run(time);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(simulation.state().time, time);
  return system.bodies(simulation.state()).at(0);
}
inline BodyView after(const Scene& scene, double time, const SimulationOptions& options) {
  Report report;
  return after(scene, time, options, report);
}

}  // namespace tendril::test
