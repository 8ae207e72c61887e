#pragma once

#include <tendril/bind/polygon_mesh.h>

namespace tendril::gallery {

/// A closed square bar along x from 0 to its length, with ribs around it: the features that a twist has to
/// keep. Faces are triangles, seen from outside.
struct RibbedBar {
  double length = 1.0, half = 0.09, rib = 0.12;  ///< half the width, of the bar and of its ribs
  int ribs = 6, per_side = 4, cuts = 4;          ///< rings a stretch, less one
};
bind::PolygonMesh ribbed_bar(const RibbedBar& bar);

/// Points round the bar in a ring, and how many rings there are; ring r begins at point r * ring_size(bar).
std::size_t ring_size(const RibbedBar& bar);
std::size_t ring_count(const RibbedBar& bar);

/// A point of the axis inside, for each triangle: with it the triangle makes a tetrahedron of positive
/// volume.
std::vector<Vec3> axis_points(const bind::PolygonMesh& mesh);

/// Volume of a closed mesh of triangles whose points are at `points`.
double volume(const bind::PolygonMesh& mesh, Points points);
/// Triangles whose tetrahedron with its axis point is turned inside out.
long inverted(const bind::PolygonMesh& mesh, Points points, Points axis);

}  // namespace tendril::gallery
