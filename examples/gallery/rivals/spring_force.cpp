#include "spring_force.h"

namespace tendril::gallery {

void SpringForce::add(const StateView& state, const Loads& loads) const {
  add_forces(net_, state.p, loads.force);
}

Couplings SpringForce::couplings(std::span<const NodeRange>) const {
  std::vector<Couplings::Pair> pairs;
  for (const Spring& spring : net_.springs) pairs.emplace_back(spring.a, spring.b);
  return Couplings::between(pairs).with([net = net_](const StateView& state, LoadDerivatives& to) {
    for (const Spring& spring : net.springs) {
      const Vec3 d = state.p[spring.b] - state.p[spring.a];
      const double length = d.norm();
      if (length == 0.0) continue;
      const Vec3 u = d / length;
      const Mat3 along = u * u.transpose();
      const Mat3 k = spring.stiffness * (along + (1.0 - spring.rest / length) * (Mat3::Identity() - along));
      to.add_by_position(spring.a, spring.a, -k);
      to.add_by_position(spring.b, spring.b, -k);
      to.add_by_position(spring.a, spring.b, k);
      to.add_by_position(spring.b, spring.a, k);
    }
  });
}

void UniformPush::add(const StateView& state, const Loads& loads) const {
  const Vec3 a = acceleration_(state.time);
  for (std::size_t i = 0; i < state.mass.size(); ++i) loads.force[i] += state.mass[i] * a;
}

}  // namespace tendril::gallery
