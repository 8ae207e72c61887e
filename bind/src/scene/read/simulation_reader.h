#pragma once

#include "scene/json/json_node.h"

#include <tendril/scene/scene_file.h>

namespace tendril::scene {

/// Duration, outputs, and how the simulation is to be done.
void read_simulation(const JsonNode& simulation, SceneFile& out);

/// How its equilibrium is to be searched for.
void read_statics(const JsonNode& statics, SceneFile& out);

/// How the scene is to be drawn.
/// \param file  the whole scene: up is against its gravity unless it says so
void read_picture(const JsonNode& file, SceneFile& out);

}  // namespace tendril::scene
