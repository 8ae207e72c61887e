#pragma once

#include "scene/json/json_node.h"

#include <tendril/dynamics/rod.h>

namespace tendril::scene {

/// The rod of one entry of curve_pairs: its points (resampled evenly when `nodes` is given), its springs from
/// the constants or from material and section. Sections that vary along the points vary linearly between
/// them, and are taken at the nodes for bending and halfway along the edges for stretch, twist and mass.
Rod read_rod(const JsonNode& curve_pair);

/// A size of a curve-pair at each of its nodes: given once, or per point and then linear in between.
std::vector<double> read_along(const JsonNode& curve_pair, const std::string& key);

/// Number of a node of a rod; -1 is the last.
std::size_t read_node(const JsonNode& node, const Rod& rod);

}  // namespace tendril::scene
