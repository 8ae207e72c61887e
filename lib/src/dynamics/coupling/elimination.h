#pragma once

#include "dynamics/linear/block_pattern.h"
#include "dynamics/scene/model.h"

namespace tendril {

/// The pattern of the equations of an implicit step: what springs and forces couple, eliminated children
/// before their parents, each rod from its tips. Throws InvalidInput naming the first force with whose
/// couplings it takes more than 2^24 products of blocks, or 64 a node.
BlockPattern pattern_of_equations(const Model& model);

}  // namespace tendril
