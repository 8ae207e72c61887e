#include "rebase.h"

#include <algorithm>

#include "dynamics/rhs/kinematics.h"
#include "dynamics/vector/column_access.h"

namespace tendril {
namespace {

/// Where the reference of nodes stands, three numbers a node or one, from the first of a range on.
struct ToReference {
  double* __restrict tangent;
  double* __restrict director;
  double* __restrict twist;
};

/// Makes the present frames of nodes [first, end) the reference, and follows the twists of the edges that
/// begin there beyond half a turn: by the angle of m_b about t_b from m_a, carried by the smallest rotation.
TENDRIL_LANES void take_reference(std::size_t first, std::size_t end, const Kinematics& kin,
                                  const ToReference& to) {
  const lanes::Reader m(kin.frame.y), t(kin.frame.z);
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const lanes::V3 ta = t.at(i), tb = t.at(i + 1), ma = m.at(i), mb = m.at(i + 1);
    // Rounding would let the director lean towards the tangent over many steps.
    const lanes::V3 across = ma - lanes::dot(ma, ta) * ta;
    const double length = lanes::norm(across);
    const lanes::V3 director{across.x / length, across.y / length, across.z / length};
    const lanes::V3 carried = ma - (lanes::dot(tb, ma) / (1.0 + lanes::dot(ta, tb))) * (ta + tb);
    const double raw = lanes::angle(lanes::dot(lanes::cross(carried, mb), tb), lanes::dot(carried, mb));
    const std::size_t k = i - first;
    to.tangent[3 * k] = ta.x;
    to.tangent[3 * k + 1] = ta.y;
    to.tangent[3 * k + 2] = ta.z;
    to.director[3 * k] = director.x;
    to.director[3 * k + 1] = director.y;
    to.director[3 * k + 2] = director.z;
    to.twist[k] += lanes::less_turns(raw - to.twist[k]);
  }
}

void rebase_twisted(const Model& model, const Model::Segment& segment, const Seen& seen, State& state) {
  const std::size_t first = std::max(segment.first + seen.begin, seen.first);
  const std::size_t end = std::min(segment.end + seen.begin, seen.end);
  if (first >= end) return;
  take_reference(first - seen.begin, end - seen.begin, seen.kin,
                 {state.tangent[first].data(), state.director[first].data(), &state.twist[first]});
  const Eigen::Index k = model.twist_index[first];
  const auto count = static_cast<Eigen::Index>(end - first);
  state.y.segment(model.theta_begin() + k, count).setZero();
  std::copy_n(seen.kin.spin.data() + (first - seen.begin), count, state.y.data() + model.spin_begin() + k);
}

/// What of a rod lies in sight.
void rebase_rod(const Model& model, std::size_t r, const Seen& seen, State& state) {
  const NodeRange& rod = model.rods[r];
  // No edge begins at a rod's last node.
  const std::size_t last = rod.first + rod.count - 1;
  if (seen.has(last)) state.twist[last] = 0.0;
  const std::size_t seed = model.seed[r];
  if (model.has_twist(rod.first) || !seen.has(seed)) return;
  const Frame frame = seen.kin.frame[seed - seen.begin];
  state.director[seed] = director_of_seed(model, state, seed, frame);
  state.tangent[seed] = frame.z;
}

/// The frames of what is seen become the reference, held nodes get their pose.
void rebase_nodes(const Model& model, const Seen& seen, State& state) {
  const auto put = [&](std::size_t i) {
    const auto at = 3 * static_cast<Eigen::Index>(i + seen.begin);
    if (!seen.has(i + seen.begin)) return;
    state.y.segment<3>(at) = seen.kin.p[i];
    state.y.segment<3>(model.v_begin() + at) = seen.kin.v[i];
  };
  for (const std::size_t i : seen.part.held_positions) put(i);
  for (const Model::Slider& slider : seen.part.sliders) put(slider.node);
  for (const Model::Segment& segment : seen.part.segments)
    if (segment.twist) rebase_twisted(model, segment, seen, state);
  for (std::size_t k = 0; k < seen.part.swivels.size(); ++k)
    state.y[model.spin_begin() + model.twist_index[seen.part.swivels[k].node]] = seen.kin.swivel_spin[k];
}

}  // namespace

Vec3 director_of_seed(const Model& model, const State& state, std::size_t seed, const Frame& seen) {
  if (model.holds_frame(seed)) return seen.y;
  const Vec3 t = seen.z;
  const Vec3 carried = rotate_smallest(state.tangent[seed], t, state.director[seed]);
  return (carried - carried.dot(t) * t).normalized();
}

void rebase_seen(const Model& model, const Seen& seen, std::size_t& rod, State& state) {
  rebase_nodes(model, seen, state);
  for (; rod < model.rods.size() && model.rods[rod].first < seen.end; ++rod) {
    rebase_rod(model, rod, seen, state);
    if (model.rods[rod].first + model.rods[rod].count > seen.end) return;  // goes on in the next
  }
}

bool rebase_tiles(const Model& model, State& state, System::Workspace& work) {
  TileScratch& scratch = TileScratch::of(model, work);
  std::size_t rod = 0;
  for (const Tiles::Tile& tile : model.tiles->all()) {
    const Model& part = scratch.model(tile);
    const State& there = scratch.take(tile, state);
    Kinematics& kin = scratch.workspace(tile).kinematics;
    if (!kinematics(part, there, there.time, there.y, Motion::positions, kin).ok()) return false;
    rebase_seen(model, {part, kin, tile.begin, tile.first, tile.end}, rod, state);
  }
  return true;
}

}  // namespace tendril
