#pragma once

#include <tendril/bind/polygon_mesh.h>

namespace tendril::runner {

using Vec3f = Eigen::Vector3f;

/// A mesh made ready to be drawn: triangles, a normal and a colour (linear light) at each corner.
struct Shape {
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> triangles;  ///< three points each
  std::vector<Vec3f> normals;            ///< three each
  std::vector<Vec3f> colors;             ///< three each, or empty
};

/// Polygons become fans. A corner's normal is the mean of the neighbouring faces' normals that turn by less
/// than 40 degrees, weighted by area, so that edges of a box stay sharp and a fine surface looks smooth.
/// Points are (p - centre) / size, so that single precision is relative to what is seen.
Shape make_shape(const bind::PolygonMesh& mesh, const Vec3& centre, double size);

}  // namespace tendril::runner
