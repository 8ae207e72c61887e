#pragma once

#include <tendril/contact/rod_rod_contact.h>
#include <tendril/dynamics/state.h>

#include "support/rods.h"

namespace tendril::contact {

inline const RodRodMemory& memory_of(const std::shared_ptr<const ForceMemory>& memory) {
  return dynamic_cast<const RodRodMemory&>(*memory);
}

inline Vec3 place(const State& state, std::size_t node) {
  return state.y.segment<3>(static_cast<Eigen::Index>(3 * node));
}

inline Rod moved(Rod rod, const Mat3& turn, const Vec3& by) {
  for (std::vector<Vec3>* of : {&rod.p, &rod.q})
    for (Vec3& x : *of) x = turn * x + by;
  return rod;
}

/// A rod across another, above it.
inline Rod crossing(int edges, double young, double radius, double height, double angle) {
  return moved(test::straight_rod(edges, young, radius),
               Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(),
               Vec3(0.5 - 0.5 * std::cos(angle), -0.5 * std::sin(angle), height));
}

}  // namespace tendril::contact
