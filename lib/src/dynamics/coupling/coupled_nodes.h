#pragma once

#include <utility>
#include <vector>

#include "dynamics/scene/model.h"

namespace tendril {

using NodePairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Pairs of nodes that springs couple: with twist up to the third neighbour, without (a hinge) up to the
/// second; the first edge of a child sees its parent's frame, and at a hub that of all children. Under the
/// nodes that carry them.
NodePairs coupled_by_springs(const Model& model);

/// Pairs of nodes that a force couples in the equations, under the nodes that carry them.
/// \param by_frames  the pairs it names, and also the neighbours that turn the frames it may see and those
///                   that its torques push: what differences need
NodePairs coupled_by_force(const Model& model, const Couplings& couplings, bool by_frames);
/// The same of pairs alone.
NodePairs coupled_by_pairs(const Model& model, const NodePairs& named, bool by_frames);

}  // namespace tendril
