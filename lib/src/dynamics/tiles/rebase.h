#pragma once

#include "tiles.h"

namespace tendril {

/// Kinematics of a scene, or of a tile of it whose nodes begin at the scene's node `begin`; of them
/// [first, end) are to be rebased, as flat nodes of the scene.
struct Seen {
  const Model& part;
  const Kinematics& kin;
  std::size_t begin, first, end;

  bool has(std::size_t node) const { return node >= first && node < end; }
};

/// The frames of what is seen become the reference, held nodes get their pose.
/// \param rod  the first that may be seen; moves on past those that end there
void rebase_seen(const Model& model, const Seen& seen, std::size_t& rod, State& state);

/// One tile after the other: the next one's frames are found from a state of which the tiles before are
/// rebased already, which is the same state. False where one has no frames.
bool rebase_tiles(const Model& model, State& state, System::Workspace& work);

/// Director of the node of a rod without twist state that the others follow: held, or carried in time.
/// \param seen  the frame that kinematics give it, where a held one has a director
Vec3 director_of_seed(const Model& model, const State& state, std::size_t seed, const Frame& seen);

}  // namespace tendril
