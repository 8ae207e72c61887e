#pragma once

#include <tendril/dynamics/force.h>

#include "support/random.h"

namespace tendril::test {

/// What a force is shown of rods whose nodes stand and move anyhow.
struct Shown {
  std::vector<Vec3> p, v, t, m, turn;
  std::vector<double> spin, mass, width;
  std::vector<NodeRange> rods;
  std::shared_ptr<const ForceMemory> memory;
  std::vector<BodyView> bodies;

  StateView view() const { return {0.25, p, v, t, spin, mass, width, rods, m, memory.get(), bodies, turn}; }
};

inline Shown shown(Random& random, const std::vector<Vec3>& at, double speed) {
  Shown s;
  s.p = at;
  for (std::size_t i = 0; i < at.size(); ++i) {
    s.v.push_back(random.in_cube(speed));
    s.t.push_back(Vec3::UnitX());
    s.m.push_back(Vec3::UnitZ());
    s.spin.push_back(0.0);
    s.turn.push_back(Vec3::Zero());
    s.mass.push_back(1.0);
    s.width.push_back(0.1);
  }
  s.rods = {{0, at.size()}};
  return s;
}

}  // namespace tendril::test
