#include "bodies.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "turn.h"

namespace tendril {
namespace {

using Outcome = Evaluation::Outcome;

/// Where a body's numbers stand in y.
struct Numbers {
  Numbers(const Model& model, std::size_t b)
      : x(model.x_begin() + 3 * static_cast<Eigen::Index>(b)),
        phi(x + model.bodies_span()),
        u(phi + model.bodies_span()),
        omega(u + model.bodies_span()) {}
  Eigen::Index x, phi, u, omega;
};

/// omega' = I^-1 (T - omega x I omega), in the body's axes, where I stays the same.
Vec3 spin_rate(const RigidBody& body, const BodyView& at, const Vec3& torque) {
  const Vec3 omega = at.rotation.transpose() * at.spin;
  const Vec3 own = at.rotation.transpose() * torque;
  if (body.isotropic) return at.rotation * (body.inverse * own);
  return at.rotation * (body.inverse * (own - omega.cross(body.inertia * omega)));
}

}  // namespace

Evaluation place_bodies(const Model& model, const State& reference, const Eigen::VectorXd& y,
                        std::vector<BodyView>& bodies) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Numbers at(model, b);
    const Vec3 phi = y.segment<3>(at.phi);
    if (const double turn = phi.norm(); !(turn <= kMostTurn))
      return {std::isfinite(turn) ? Outcome::turned_too_far : Outcome::not_finite, model.nodes + 2 * b + 1};
    bodies[b] = {y.segment<3>(at.x), rotation_of(phi) * reference.rotation[b], y.segment<3>(at.u),
                 y.segment<3>(at.omega), model.bodies[b].mass};
  }
  return {};
}

bool body_rates(const Model& model, const Eigen::VectorXd& y, const std::vector<BodyView>& bodies,
                const std::vector<Wrench>& loads, Eigen::VectorXd& dy) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Numbers at(model, b);
    dy.segment<3>(at.x) = bodies[b].velocity;
    dy.segment<3>(at.phi) = turning_rate(y.segment<3>(at.phi)) * bodies[b].spin;
    dy.segment<3>(at.u) = loads[b].force / bodies[b].mass + model.gravity;
    dy.segment<3>(at.omega) = spin_rate(model.bodies[b], bodies[b], loads[b].torque);
  }
  return dy.segment(model.x_begin(), 4 * model.bodies_span()).allFinite();
}

void put_body_loads(const Model& model, const std::vector<Wrench>& loads, Eigen::VectorXd& out) {
  for (std::size_t b = 0; b < loads.size(); ++b) {
    const Numbers at(model, b);
    out.segment<3>(at.u) = loads[b].force;
    out.segment<3>(at.omega) = loads[b].torque;
  }
}

double power_on_bodies(const std::vector<BodyView>& bodies, const std::vector<Wrench>& loads) {
  double power = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    power += loads[b].force.dot(bodies[b].velocity) + loads[b].torque.dot(bodies[b].spin);
  return power;
}

void add_body_energies(const Model& model, const std::vector<BodyView>& bodies, Energies& to) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vec3 omega = bodies[b].rotation.transpose() * bodies[b].spin;
    to.kinetic += 0.5 * (bodies[b].mass * bodies[b].velocity.squaredNorm() +
                         omega.dot(model.bodies[b].inertia * omega));
    to.potential -= bodies[b].mass * model.gravity.dot(bodies[b].position);
  }
}

void put_body(const Model& model, std::size_t body, const BodyView& to, State& state) {
  const Numbers at(model, body);
  state.y.segment<3>(at.x) = to.position;
  state.y.segment<3>(at.phi).setZero();
  state.y.segment<3>(at.u) = to.velocity;
  state.y.segment<3>(at.omega) = to.spin;
  state.rotation[body] = nearest_rotation(to.rotation);
}

void start_bodies(const Model& model, State& state) {
  state.rotation.resize(model.bodies.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.scene.bodies[b];
    put_body(model, b, {body.position, body.rotation, body.velocity, body.spin, body.mass}, state);
  }
}

/// The rotation is projected onto the rotations every time, so that rounding does not add up over turns.
void rebase_bodies(const Model& model, const std::vector<BodyView>& bodies, State& state) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    state.y.segment<3>(Numbers(model, b).phi).setZero();
    state.rotation[b] = nearest_rotation(bodies[b].rotation);
  }
}

/// Half way along the cubic in phi through both ends. Its ends' rates are phi' = T(phi) omega: at the start
/// T is the identity, phi being counted from there. The middle's omega is T^-1 of the cubic's slope, so
/// that work by torque . omega is that of the motion itself and not of phi'.
void bend_turns(const Model& model, double h, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                Eigen::VectorXd& middle) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Numbers at(model, b);
    const Vec3 end = to.segment<3>(at.phi);
    const Vec3 first = from.segment<3>(at.omega);
    const Vec3 last = turning_rate(end) * to.segment<3>(at.omega);
    const Vec3 half = 0.5 * end + h / 8 * (first - last);
    middle.segment<3>(at.phi) = half;
    middle.segment<3>(at.omega) = turning_rate(half).inverse() * (1.5 / h * end - 0.25 * (first + last));
  }
}

/// Lanczos's method needs a symmetric operator, M^-1/2 K M^-1/2. In the body's principal axes the inertia is
/// diagonal, as masses are, so bodies are turned into these before and back after.
void turn_from_principal_axes(const Model& model, const State& state, Eigen::VectorXd& y) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Numbers at(model, b);
    const Vec3 own = y.segment<3>(at.phi) - state.y.segment<3>(at.phi);
    y.segment<3>(at.phi) = state.y.segment<3>(at.phi) + state.rotation[b] * (model.bodies[b].axes * own);
  }
}

void turn_to_principal_axes(const Model& model, const State& state, Eigen::VectorXd& dy) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Numbers at(model, b);
    const Vec3 world = dy.segment<3>(at.omega);
    dy.segment<3>(at.omega) = model.bodies[b].axes.transpose() * (state.rotation[b].transpose() * world);
  }
}

/// A symmetric body wobbles, seen from the world, at I3 / I1 of its spin; no principal moment exceeds the
/// sum of the two others, so that is twice the spin at most.
double fastest_nutation(const Model& model, const State& state) {
  double fastest = 0.0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].isotropic)
      fastest = std::max(fastest, 2.0 * state.y.segment<3>(Numbers(model, b).omega).norm());
  return fastest;
}

}  // namespace tendril
