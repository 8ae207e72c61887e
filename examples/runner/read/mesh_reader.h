#pragma once

#include <tendril/bind/import.h>
#include <tendril/scene/scene_file.h>

namespace tendril::runner {

/// Reads a mesh; what is odd about the file but not refused goes to standard error.
bind::PolygonMesh read_mesh(const std::string& path);
/// The same of a scene's mesh; an empty one where it names none.
bind::PolygonMesh read_mesh(const scene::SceneFile& file);

/// Writes a mesh; what the format has no place for goes to standard error.
void save_mesh(const std::string& path, const bind::PolygonMesh& mesh);

}  // namespace tendril::runner
