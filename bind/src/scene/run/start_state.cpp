#include <tendril/dynamics/statics.h>
#include <tendril/scene/scene_file.h>

namespace tendril::scene {
namespace {

SceneError at_start(const SceneFile& file, const std::string& reason, const std::string& expected) {
  const InvalidInput plain("start", reason, expected);
  return in_scene(file, plain);
}

State equilibrium(const SceneFile& file, const System& system) {
  Equilibrium found = find_equilibrium(system, system.rest_state(), file.statics);
  if (found.balance != Balance::converged)
    throw at_start(
        file, std::string("no equilibrium to start from, ") + to_string(found.balance) + ": " + found.reason,
        "a scene that rests somewhere; \"from\": \"rest\"");
  return std::move(found.state);
}

/// The centre of mass of some rods.
Vec3 centre_of(const SceneFile& file, const System& system, const State& state,
               const std::vector<std::size_t>& rods) {
  double mass = 0.0;
  Vec3 moment = Vec3::Zero();
  for (const std::size_t r : rods) {
    const NodeRange nodes = system.rods()[r];
    for (std::size_t i = 0; i < nodes.count; ++i) {
      const double m = file.scene.rods[r].mass[i];
      mass += m;
      moment += m * state.y.segment<3>(3 * static_cast<Eigen::Index>(nodes.first + i));
    }
  }
  return moment / mass;
}

/// The axis about which a node's spin counts: that of a swivel, else the tangent.
Vec3 spin_axis(const SceneFile& file, const State& state, std::size_t rod, const NodeRange& nodes,
               std::size_t i) {
  for (const Anchor& anchor : file.scene.anchors)
    if (anchor.swivels && anchor.rod == rod && nodes.first + anchor.node == i)
      return anchor.swivel_axis.stableNormalized();
  return state.tangent[i];
}

/// y = (p 3n | v 3n | theta m | w m | ...): a spin in space turns a node's frame about its tangent by the
/// spin's part along it.
void set_moving(const SceneFile& file, const System& system, const StartMotion& motion, State& state) {
  const auto n = static_cast<Eigen::Index>(system.node_count());
  const auto m = static_cast<Eigen::Index>(system.twist_count());
  const Vec3 about = motion.about ? *motion.about : centre_of(file, system, state, motion.curve_pairs);
  for (const std::size_t r : motion.curve_pairs) {
    const NodeRange nodes = system.rods()[r];
    for (std::size_t i = nodes.first; i < nodes.first + nodes.count; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Vec3 p = state.y.segment<3>(3 * at);
      state.y.segment<3>(3 * n + 3 * at) += motion.velocity + motion.spin.cross(p - about);
      if (m == n) state.y[6 * n + m + at] += motion.spin.dot(spin_axis(file, state, r, nodes, i));
    }
  }
}

}  // namespace

State start_state(const SceneFile& file, const System& system) {
  State state = file.start_at_equilibrium ? equilibrium(file, system) : system.rest_state();
  if (file.start_motions.empty()) return state;
  for (const StartMotion& motion : file.start_motions) set_moving(file, system, motion, state);
  const System::WorkspacePtr work = system.make_workspace();
  if (const Evaluation at = system.rebase(state, *work); !at.ok())
    throw at_start(file, "a motion at which the equations cannot be evaluated",
                   "finite velocities and spins");
  return state;
}

}  // namespace tendril::scene
