// CGAL's exact-predicate kernel, and of its packages under the GPL the point-in-mesh test and the hierarchy
// of boxes.
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/squared_distance_3.h>
#include <CGAL/version.h>

#include <boost/preprocessor/stringize.hpp>

#include <cmath>

#include "accuracy/collision/adapter.h"

namespace tendril::suite {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Surface>>>;

Kernel::Point_3 point(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}
Kernel::Triangle_3 triangle(const Corners& t) {
  return {point(t[0]), point(t[1]), point(t[2])};
}

Surface surface_of(Points points, Triangles triangles) {
  Surface out;
  for (const Vec3& x : points) out.add_vertex(point(x));
  for (const auto& [a, b, c] : triangles)
    out.add_face(Surface::Vertex_index(a), Surface::Vertex_index(b), Surface::Vertex_index(c));
  return out;
}

class Mesh : public MeshPeer {
 public:
  Mesh(Points points, Triangles triangles)
      : surface_(surface_of(points, triangles)),
        tree_(faces(surface_).begin(), faces(surface_).end(), surface_),
        side_(tree_) {
    tree_.accelerate_distance_queries();
  }
  Said holds(const Vec3& x) override { return side_(point(x)) != CGAL::ON_UNBOUNDED_SIDE; }
  Said meets(const Vec3& centre, double radius) override {
    return tree_.squared_distance(point(centre)) <= radius * radius;
  }

 private:
  Surface surface_;
  Tree tree_;
  CGAL::Side_of_triangle_mesh<Surface, Kernel> side_;
};

}  // namespace

Adapter cgal_adapter() {
  Adapter out{"CGAL " BOOST_STRINGIZE(CGAL_VERSION)};
  out.proper = true;
  out.triangles = [](const Corners& a, const Corners& b) -> Said {
    return CGAL::do_intersect(triangle(a), triangle(b));
  };
  out.segment = [](const Corners& a, const Ends& s) -> Said {
    return CGAL::do_intersect(triangle(a), Kernel::Segment_3(point(s[0]), point(s[1])));
  };
  out.distance = [](const Corners& a, const Corners& b) {
    return std::sqrt(CGAL::squared_distance(triangle(a), triangle(b)));
  };
  out.mesh = mesh_of<Mesh>;
  out.holds = out.meets = true;
  return out;
}

}  // namespace tendril::suite
