#pragma once

#include "scene/json/json_node.h"

#include <tendril/scene/scene_file.h>

namespace tendril::scene {

/// The bodies, the contact of rods with them, and of rods with each other: the last forces of the scene.
/// \param file  the whole scene, all else read
void read_contact(const JsonNode& file, SceneFile& out);

/// As make_system, whether or not the contact of the mesh is there yet (scene_file.cpp).
System make_bare_system(const SceneFile& file);

/// Where rods are in contact with bodies at an accepted state of the scene.
std::vector<ContactPoint> contacts_of(const SceneFile& file, const State& state);
/// And the mesh; faces are triangles of MeshContact still.
std::vector<MeshContactPoint> mesh_contacts_of(const SceneFile& file, const State& state);
/// And with itself, likewise.
std::vector<MeshSelfContactPoint> mesh_self_contacts_of(const SceneFile& file, const State& state);
/// And with each other and themselves.
std::vector<RodContactPoint> rod_contacts_of(const SceneFile& file, const State& state);

}  // namespace tendril::scene
