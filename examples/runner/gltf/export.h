#pragma once

#include "gltf/glb.h"
#include "gltf/skin.h"

namespace tendril::runner {

struct GltfOptions {
  std::string name;  ///< of the mesh in the file
  SkinOptions skin = {};
  bool morph = false;  ///< a morph target a moment, exact, in place of a skin
};

/// A file, and what it says of itself in `extras`.
struct GltfFile {
  std::string bytes;
  Glb::Json notes;  ///< kind, joints, error over the mesh's size, tolerance, whether it is kept
};

/// The run as binary glTF 2.0: the mesh with normals, colors and texture coordinates, moved by a skin
/// (fit_skin) whose joints have translations and rotations, one a moment and linear in between, or by morph
/// targets; and the scene's solids, each a mesh on a node that moves as they do. Times begin with 0, the
/// scene's up is the file's +y, and vertices are about the mesh's middle, where single precision is best; the
/// unit of length stays the scene's. The file's asset and skin have `extras` with the number of joints and
/// the largest distance of the skinned points from the exact ones.
/// \param film  of a scene with a mesh, at least one moment
/// \param look  the mesh as it was read, for its normals, colors and texture
GltfFile make_gltf(const Film& film, const bind::PolygonMesh& look, const GltfOptions& options);

}  // namespace tendril::runner
