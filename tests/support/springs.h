#pragma once

#include <tendril/dynamics/force.h>

namespace tendril::test {

/// A spring between any two nodes, of one rod or of two.
struct FarSpring : Force {
  /// How its derivatives are had, or what it says wrongly.
  enum class Says { exact, differences, first_node_alone, exact_of_first_node_alone };
  FarSpring(std::size_t first, std::size_t second, double stiffness, double rest, Says how)
      : a(first), b(second), k(stiffness), length(rest), says(how) {}

  void add(const StateView& state, const Loads& loads) const override {
    const Vec3 d = state.p[b] - state.p[a];
    const Vec3 pull = k * (1 - length / d.norm()) * d;
    loads.force[a] += pull;
    loads.force[b] -= pull;
  }
  Couplings couplings(std::span<const NodeRange>) const override {
    const bool lies = says == Says::first_node_alone || says == Says::exact_of_first_node_alone;
    Couplings all = lies ? Couplings::among({a}) : Couplings::among({a, b});
    if (says == Says::differences || says == Says::first_node_alone) return all;
    return std::move(all).with([this](const StateView& state, LoadDerivatives& to) {
      const Vec3 d = state.p[b] - state.p[a];
      const double ratio = length / d.norm();
      const Mat3 by_d = k * ((1 - ratio) * Mat3::Identity() + ratio / d.squaredNorm() * d * d.transpose());
      to.add_by_position(a, a, -by_d);
      to.add_by_position(a, b, by_d);
      to.add_by_position(b, a, by_d);
      to.add_by_position(b, b, -by_d);
    });
  }
  bool depends_on_time() const override { return false; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override {
    const double stretch = (state.p[b] - state.p[a]).norm() - length;
    return 0.5 * k * stretch * stretch;
  }

  std::size_t a, b;
  double k, length;
  Says says;
};

/// Turns one node towards the director of another, with torques on both: k m_a x m_b.
struct Aligning : Force {
  Aligning(std::size_t first, std::size_t second, double stiffness) : a(first), b(second), k(stiffness) {}
  void add(const StateView& state, const Loads& loads) const override {
    const Vec3 torque = k * state.m[a].cross(state.m[b]);
    loads.torque[a] += torque;
    loads.torque[b] -= torque;
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::between({{a, b}}); }
  bool depends_on_time() const override { return false; }
  bool twists() const override { return true; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override { return -k * state.m[a].dot(state.m[b]); }

  std::size_t a, b;
  double k;
};

}  // namespace tendril::test
