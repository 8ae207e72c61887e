#pragma once

#include <tendril/dynamics/force.h>

#include "spring_net.h"

namespace tendril::gallery {

/// The straight springs of a net as a force of the library's, with exact derivatives: so a net moves by any
/// method of tendril::Simulation, implicit ones included. Mass i of the net is node i of the scene.
class SpringForce final : public Force {
 public:
  /// \param net  copied
  explicit SpringForce(SpringNet net) : net_(std::move(net)) {}
  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange>) const override;
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override { return elastic_energy(net_, state.p); }
  bool depends_on_time() const override { return false; }

 private:
  SpringNet net_;
};

/// mass times net.acceleration on every node.
class UniformPush final : public Force {
 public:
  /// \param acceleration  of time alone
  explicit UniformPush(std::function<Vec3(double)> acceleration) : acceleration_(std::move(acceleration)) {}
  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }

 private:
  std::function<Vec3(double)> acceleration_;
};

}  // namespace tendril::gallery
