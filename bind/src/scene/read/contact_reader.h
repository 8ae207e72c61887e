#pragma once

#include "scene/json/json_node.h"

#include <tendril/scene/scene_file.h>

namespace tendril::scene {

/// The bodies, and the contact of rods with them, as the last force of the scene.
/// \param file  the whole scene, its rods and forces read
void read_contact(const JsonNode& file, SceneFile& out);

/// Where rods are in contact at an accepted state of the scene.
std::vector<ContactPoint> contacts_of(const SceneFile& file, const State& state);

}  // namespace tendril::scene
