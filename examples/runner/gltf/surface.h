#pragma once

#include "draw/shape.h"

#include <tendril/bind/polygon_mesh.h>

namespace tendril::runner {

/// A mesh as pipelines draw it: triangles, and vertices that have one normal, one color and one place in a
/// texture each.
struct Surface {
  std::vector<std::uint32_t> point;           ///< of the mesh, per vertex
  std::vector<Vec3f> normals;                 ///< one a vertex, unit; none of a mesh without faces
  std::vector<std::array<float, 4>> colors;   ///< one a vertex, linear light; or none
  std::vector<std::array<float, 2>> texture;  ///< one a vertex, from a picture's upper left corner; or none
  std::vector<std::uint32_t> triangles;       ///< three vertices each
};

/// Polygons become fans; a point is as many vertices as it has different normals, colors and
/// texture coordinates; those of corners go before those of points. Normals are those of the mesh, and where
/// it has none those that pictures are drawn with. Points of no face are left
/// out, unless there are no faces.
/// \param mesh  valid
Surface make_surface(const bind::PolygonMesh& mesh);

}  // namespace tendril::runner
