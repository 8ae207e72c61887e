#pragma once

#include <gtest/gtest.h>
#include <tendril/dynamics/system.h>

#include <memory>
#include <stdexcept>

#include "support/rods.h"
#include "support/tops.h"

namespace tendril::test {

inline Mat3 cross(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// A spring and a damper between a node and a point of a body's matter.
struct Tie : Force {
  std::size_t node = 0, body = 0;
  Vec3 at = Vec3::Zero();  ///< in the body's axes
  double stiffness = 0.0, damping = 0.0;
  bool derives = true, honest = true;

  /// What pulls on the body, at which arm.
  struct Pull {
    Vec3 arm, stretch, force;
  };
  Pull pull(const StateView& state) const {
    const BodyView& b = state.bodies[body];
    const Vec3 arm = b.rotation * at;
    const Vec3 stretch = b.position + arm - state.p[node];
    const Vec3 rate = b.velocity_at(b.position + arm) - state.v[node];
    return {arm, stretch, -stiffness * stretch - damping * rate};
  }
  void add(const StateView& state, const Loads& loads) const override {
    const Pull f = pull(state);
    loads.force[node] -= f.force;
    loads.bodies[body].add_at(state.bodies[body].position + f.arm, f.force, state.bodies[body].position);
  }
  Couplings couplings(std::span<const NodeRange>) const override {
    throw std::logic_error("asked without the number of bodies");
  }
  Couplings couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const override {
    EXPECT_LT(body, bodies);
    const std::size_t place = rods.back().first + rods.back().count + 2 * body;
    Couplings all = honest ? Couplings::among({node, place, place + 1}) : Couplings::among({node, place});
    if (!derives) return all;
    return std::move(all).with(
        [this, place](const StateView& s, LoadDerivatives& to) { derive(s, place, to); });
  }
  void derive(const StateView& state, std::size_t place, LoadDerivatives& to) const {
    const Pull f = pull(state);
    const Mat3 one = Mat3::Identity();
    const Mat3 arm = cross(f.arm);
    const Mat3 by_turn = stiffness * arm + damping * cross(state.bodies[body].spin) * arm;
    const auto add = [&](std::size_t j, const Mat3& by_x, const Mat3& by_u) {
      to.add_by_position(node, j, -by_x);
      to.add_by_velocity(node, j, -by_u);
      to.add_by_position(place, j, by_x);
      to.add_by_velocity(place, j, by_u);
      to.add_by_position(place + 1, j, arm * by_x);
      to.add_by_velocity(place + 1, j, arm * by_u);
    };
    add(node, stiffness * one, damping * one);
    add(place, -stiffness * one, -damping * one);
    add(place + 1, by_turn, damping * arm);
    to.add_by_position(place + 1, place + 1, cross(f.force) * arm);
  }
  bool depends_on_time() const override { return false; }
  bool has_energy() const override { return damping == 0.0; }
  double energy(const StateView& state) const override {
    return 0.5 * stiffness * pull(state).stretch.squaredNorm();
  }
};

inline Tie tie_of(double stiffness, double damping) {
  Tie tie;
  tie.node = 2;
  tie.body = 1;
  tie.at = Vec3(0.3, -0.1, 0.2);
  tie.stiffness = stiffness;
  tie.damping = damping;
  return tie;
}

/// A free rod that a spring ties to the surface of a spinning body.
inline Scene tied(bool derives, double stiffness, double damping, bool twist = false) {
  Scene scene;
  if (twist) scene.twist = Scene::Twist::everywhere;
  scene.rods.push_back(straight_rod(6, 1e5, 0.02));
  Body body = body_of({0.02, 0.03, 0.04}, 1.0);
  body.position = Vec3(1.0, 0.1, 0.4);
  body.velocity = Vec3(0, 0.3, -0.2);
  body.spin = Vec3(2, -1, 3);
  Body other = body;
  other.position = Vec3(5, 5, 5);
  scene.bodies = {other, body};
  auto tie = std::make_shared<Tie>(tie_of(stiffness, damping));
  tie->node = 6;
  tie->at = Vec3(0.1, 0.0, -0.15);
  tie->derives = derives;
  scene.forces = {tie};
  return scene;
}

}  // namespace tendril::test
