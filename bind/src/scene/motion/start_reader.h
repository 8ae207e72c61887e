#pragma once

#include "scene/json/json_node.h"

#include <tendril/scene/scene_file.h>

namespace tendril::scene {

/// What the scene says under `start`; spins ask for a twist state everywhere.
void read_start(const JsonNode& start, SceneFile& out);

}  // namespace tendril::scene
