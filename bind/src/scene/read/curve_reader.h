#pragma once

#include "scene/json/json_node.h"

#include <tendril/curve/fit.h>

namespace tendril::scene {

Parametrisation read_parametrisation(const JsonNode& parent);

/// Orientation points for `p`: `orientation` is one direction for all, or a list of as many points.
std::vector<Vec3> read_orientation(const JsonNode& orientation, const std::vector<Vec3>& p, double offset);

/// Mean edge length of a chain; SceneError at a point equal to the one before it.
double mean_edge(const JsonNode& points, const std::vector<Vec3>& p);

}  // namespace tendril::scene
