#pragma once

#include "scene/json/json_node.h"

#include <tendril/dynamics/anchor.h>
#include <tendril/dynamics/rod.h>

namespace tendril::scene {

/// One entry of a curve-pair's anchors: an anchor for each node it names.
std::vector<Anchor> read_anchors(const JsonNode& anchor, std::size_t rod_index, const Rod& rod);

}  // namespace tendril::scene
