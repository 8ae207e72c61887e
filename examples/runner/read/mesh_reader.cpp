#include "read/mesh_reader.h"

#include <tendril/bind/export.h>
#include <tendril/scene/bound_mesh.h>

#include <iostream>

namespace tendril::runner {
namespace {

void tell(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) std::cerr << "tendril: note: " << note << '\n';
}

}  // namespace

bind::PolygonMesh read_mesh(const std::string& path) {
  std::vector<std::string> notes;
  bind::PolygonMesh mesh = bind::read_mesh(path, &notes);
  tell(notes);
  return mesh;
}

bind::PolygonMesh read_mesh(const scene::SceneFile& file) {
  std::vector<std::string> notes;
  bind::PolygonMesh mesh = scene::read_scene_mesh(file, &notes);
  tell(notes);
  return mesh;
}

void save_mesh(const std::string& path, const bind::PolygonMesh& mesh) {
  bind::write_mesh(path, mesh);
  if (path.ends_with(".off") && !mesh.corner_texture.empty())
    tell({path + ": OFF has no place for texture coordinates of corners: left out"});
}

}  // namespace tendril::runner
