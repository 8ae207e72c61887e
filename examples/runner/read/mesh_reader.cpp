#include "mesh_reader.h"

#include <iostream>

namespace tendril::runner {

bind::PolygonMesh read_mesh(const std::string& path) {
  std::vector<std::string> notes;
  bind::PolygonMesh mesh = bind::read_mesh(path, &notes);
  for (const std::string& note : notes) std::cerr << "tendril: note: " << note << '\n';
  return mesh;
}

}  // namespace tendril::runner
