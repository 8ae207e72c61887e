#pragma once

#include "coupled_nodes.h"
#include "dynamics/linear/block_pattern.h"

namespace tendril {

/// The pattern of the equations of an implicit step: what springs and forces couple, eliminated children
/// before their parents, each rod from its tips. Throws InvalidInput naming the first force with whose
/// couplings it takes more than 2^24 products of blocks, or 64 a node. Of forces whose couplings are said at
/// states, those of a state are given.
/// \param now  pairs of nodes that they couple, under the nodes that carry them; where they are too many the
///             pattern is not complete
BlockPattern pattern_of_equations(const Model& model, const NodePairs& now = {});

}  // namespace tendril
