#include <cmath>

#include "dynamics/body/bodies.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/tiles/tiles.h"
#include "dynamics/vector/column_access.h"

namespace tendril {
namespace {

/// Director of the node of a rod without twist state that the others follow: held, or carried in time.
/// \param seen  the frame that kinematics give it, where a held one has a director
Vec3 director_of_seed(const Model& model, const State& state, std::size_t seed, const Frame& seen) {
  if (model.holds_frame(seed)) return seen.y;
  const Vec3 t = seen.z;
  const Vec3 carried = rotate_smallest(state.tangent[seed], t, state.director[seed]);
  return (carried - carried.dot(t) * t).normalized();
}

/// Directors of a rod without twist state: one node's is carried in time (or held), the others' follow along
/// the rod at their rest twist.
void carry_along(const Model& model, const State& state, const NodeRange& rod, std::size_t seed,
                 Kinematics& kin) {
  const std::size_t last = rod.first + rod.count - 1;
  const auto set = [&](std::size_t i, const Vec3& y) {
    const Vec3 t = kin.frame.z[i];
    kin.frame.y.set(i, (y - y.dot(t) * t).normalized());
  };
  kin.frame.y.set(seed, director_of_seed(model, state, seed, kin.frame[seed]));
  const auto turned = [](const Vec3& axis, double angle, const Vec3& v) {
    return angle == 0.0 ? v : rotate_about(axis, angle, v);
  };
  for (std::size_t i = seed; i < last; ++i)
    set(i + 1, turned(kin.frame.z[i + 1], model.rest_twist[i],
                      rotate_smallest(kin.frame.z[i], kin.frame.z[i + 1], kin.frame.y[i])));
  for (std::size_t i = seed; i > rod.first; --i)
    set(i - 1, rotate_smallest(kin.frame.z[i], kin.frame.z[i - 1],
                               turned(kin.frame.z[i], -model.rest_twist[i - 1], kin.frame.y[i])));
}

Evaluation all_frames(const Model& model, const State& state, Kinematics& kin) {
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::positions, kin); !at.ok())
    return at;
  for (std::size_t r = 0; r < model.rods.size(); ++r)
    if (!model.has_twist(model.rods[r].first)) carry_along(model, state, model.rods[r], model.seed[r], kin);
  return {};
}

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

/// Kinematics of a scene, or of a tile of it whose nodes begin at the scene's node `begin`; of them
/// [first, end) are to be rebased, as flat nodes of the scene.
struct Seen {
  const Model& part;
  const Kinematics& kin;
  std::size_t begin, first, end;

  bool has(std::size_t node) const { return node >= first && node < end; }
};

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

/// One tile after the other: the next one's frames are found from a state of which the tiles before are
/// rebased already, which is the same state. False where one has no frames.
bool rebase_tiles(const Model& model, State& state, System::Workspace& work) {
  TileScratch& scratch = TileScratch::of(model, work);
  std::size_t r = 0;
  for (const Tiles::Tile& tile : model.tiles->all()) {
    const State& part = scratch.take(tile, state);
    Kinematics& kin = scratch.workspace(tile).kinematics;
    if (!kinematics(*tile.part, part, part.time, part.y, Motion::positions, kin).ok()) return false;
    const Seen seen{*tile.part, kin, tile.begin, tile.first, tile.end};
    rebase_nodes(model, seen, state);
    for (; r < model.rods.size() && model.rods[r].first < tile.end; ++r) rebase_rod(model, r, seen, state);
    if (model.rods[r - 1].first + model.rods[r - 1].count > tile.end) --r;  // goes on in the next
  }
  return true;
}

}  // namespace

Evaluation System::rebase(State& state, Workspace& work) const {
  const Model& model = *model_;
  // Where a tile has no frames the whole says why.
  if (model.tiles && rebase_tiles(model, state, work)) return {};
  Kinematics& kin = work.kinematics;
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::positions, kin); !at.ok())
    return at;
  const Seen seen{model, kin, 0, 0, model.nodes};
  rebase_nodes(model, seen, state);
  for (std::size_t r = 0; r < model.rods.size(); ++r) rebase_rod(model, r, seen, state);
  rebase_bodies(model, kin.bodies, state);
  return {};
}

std::vector<Frame> System::frames(const State& state, Workspace& work) const {
  std::vector<Frame> frames;
  Kinematics& kin = work.kinematics;
  if (!all_frames(*model_, state, kin).ok()) return frames;
  for (std::size_t i = 0; i < model_->nodes; ++i) frames.push_back(kin.frame[i]);
  return frames;
}

std::vector<Vec3> System::orientation_masses(const State& state, Workspace& work) const {
  std::vector<Vec3> q;
  Kinematics& kin = work.kinematics;
  if (!all_frames(*model_, state, kin).ok()) return q;
  for (std::size_t i = 0; i < model_->nodes; ++i) {
    const Vec3& offset = model_->offset[i];
    q.push_back(kin.p[i] + offset.y() * kin.frame.y[i] + offset.z() * kin.frame.z[i]);
  }
  return q;
}

}  // namespace tendril
