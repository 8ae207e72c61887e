#pragma once

#include <gtest/gtest.h>
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
  double time = 0.25;

  StateView view() const { return {time, p, v, t, spin, mass, width, rods, m, memory.get(), bodies, turn}; }
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

enum class Felt { nothing, something, refusal };

/// What a force does with what it remembers is, to the last bit, what it does without; but it may refuse a
/// way there.
inline Felt same_without_memory(const Force& force, const Shown& s) {
  const std::vector<Vec3> none(s.p.size(), Vec3::Zero());
  std::vector<Vec3> with = none, without = none, torque = none, turned = none;
  std::size_t refused = Loads::kNone, again = Loads::kNone;
  force.add(s.view(), {with, torque, &refused});
  StateView bare = s.view();
  bare.memory = nullptr;
  force.add(bare, {without, turned, &again});
  if (refused != Loads::kNone) return Felt::refusal;
  EXPECT_EQ(again, Loads::kNone);
  EXPECT_EQ(with, without);
  EXPECT_EQ(torque, turned);
  return with == none ? Felt::nothing : Felt::something;
}

}  // namespace tendril::test
