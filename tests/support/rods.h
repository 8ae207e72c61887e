#pragma once

#include <tendril/base/error.h>
#include <tendril/dynamics/system.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "support/random.h"

namespace tendril::test {

/// Straight chain of `edges` equal edges along x, orientation towards z.
inline std::vector<Vec3> straight(int edges, double length) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.emplace_back(length * i / edges, 0, 0);
  return p;
}

/// Straight homogeneous rod of unit length, circular section.
inline Rod straight_rod(int edges, double young, double radius, double density = 1000.0) {
  const std::vector<Vec3> p = straight(edges, 1.0);
  return make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {young, young / 3, density},
                  circular_section(radius));
}

/// A rod with everything uneven: curved and twisted rest shape, springs of all kinds, masses over a decade.
inline Rod uneven_rod(Random& random, int nodes) {
  std::vector<Vec3> p{Vec3::Zero()};
  for (int i = 1; i < nodes; ++i) {
    const Vec3 way = Vec3::UnitX() + random.in_cube(0.5);
    p.push_back(p.back() + random.uniform(0.5, 1.5) * way);
  }
  std::vector<Vec3> q;
  for (int i = 0; i < nodes; ++i)
    q.push_back(p[static_cast<std::size_t>(i)] + rotate_about(Vec3::UnitX(), 0.4 * i, Vec3::UnitZ()) +
                random.in_cube(0.2));
  Rod rod;
  rod.p = p;
  rod.q = q;
  for (int i = 0; i < nodes; ++i) {
    rod.mass.push_back(random.uniform(0.2, 2));
    rod.inertia.push_back(random.uniform(0.05, 0.3));
    rod.bend_l.push_back(random.uniform(1, 9));
    rod.bend_m.push_back(random.uniform(1, 9));
    rod.bend_t.push_back(random.uniform(0.5, 3));
    if (i + 1 == nodes) continue;
    rod.stretch.push_back(random.uniform(20, 60));
    rod.twist.push_back(random.uniform(1, 6));
    rod.width.push_back(0.2);
  }
  return rod;
}

/// Where a scene is refused, or "accepted".
inline std::string place_of_refusal(const Scene& scene) {
  try {
    const System system(scene);
  } catch (const InvalidInput& error) {
    return error.place();
  }
  return "accepted";
}

/// Which springs a rod keeps.
enum class Keep { all, stretch, bend_l, bend_m, bend_t, twist };

inline void keep(Rod& rod, Keep what) {
  const auto drop = [&](Keep which, std::vector<double>& values) {
    if (what != Keep::all && what != which) std::fill(values.begin(), values.end(), 0.0);
  };
  drop(Keep::stretch, rod.stretch);
  drop(Keep::bend_l, rod.bend_l);
  drop(Keep::bend_m, rod.bend_m);
  drop(Keep::bend_t, rod.bend_t);
  drop(Keep::twist, rod.twist);
}

inline Vec3 at(const Eigen::VectorXd& y, std::size_t node) {
  return y.segment<3>(3 * static_cast<Eigen::Index>(node));
}

/// A state away from rest: every mass moved, every director turned; velocities and spins too.
inline State stirred(const System& system, Random& random, double by) {
  State state = system.rest_state();
  const auto n = static_cast<Eigen::Index>(system.node_count());
  const auto m = static_cast<Eigen::Index>(system.twist_count());
  for (Eigen::Index i = 0; i < 6 * n + 2 * m; ++i) state.y[i] += random.uniform(-by, by);
  const auto work = system.make_workspace();
  if (!system.rebase(state, *work).ok()) throw std::runtime_error("stirred too much");
  return state;
}

/// Spin inertias per node, with those that joined roots pass on: what turns about their parent's node's
/// tangent. Joints stand parents first.
inline std::vector<double> spin_inertias(const System& system) {
  const Scene& scene = system.scene();
  std::vector<double> inertia;
  for (const Rod& rod : scene.rods) inertia.insert(inertia.end(), rod.inertia.begin(), rod.inertia.end());
  for (auto joint = scene.joints.rbegin(); joint != scene.joints.rend(); ++joint) {
    const Rod &parent = scene.rods[joint->parent], &child = scene.rods[joint->child];
    const double along =
        node_frames(parent.p, parent.q).frame[joint->node].z.dot(node_frames(child.p, child.q).frame[0].z);
    if (joint->reaction)
      inertia[system.rods()[joint->parent].first + joint->node] +=
          along * along * inertia[system.rods()[joint->child].first];
  }
  return inertia;
}

/// Linear and angular momentum, sum m v and sum p x m v + I w t; joined roots have passed on their spin
/// inertia.
struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};
inline Momentum momentum(const System& system, const State& state) {
  const auto work = system.make_workspace();
  const std::vector<Frame> frames = system.frames(state, *work);
  const auto n = static_cast<Eigen::Index>(system.node_count());
  const auto m = static_cast<Eigen::Index>(system.twist_count());
  std::vector<bool> rides(system.rods().size(), false);
  for (const Joint& joint : system.scene().joints) rides[joint.child] = true;
  const std::vector<double> inertia = spin_inertias(system);
  Momentum sum;
  std::size_t node = 0;
  for (std::size_t r = 0; r < system.rods().size(); ++r) {
    const Rod& rod = system.scene().rods[r];
    for (std::size_t i = 0; i < rod.p.size(); ++i, ++node) {
      const auto k = static_cast<Eigen::Index>(node);
      const Vec3 mv = rod.mass[i] * state.y.segment<3>(3 * n + 3 * k);
      sum.linear += mv;
      sum.angular += at(state.y, node).cross(mv);
      if (m == n && !(i == 0 && rides[r]))
        sum.angular += inertia[node] * state.y[6 * n + m + k] * frames[node].z;
    }
  }
  return sum;
}

}  // namespace tendril::test
