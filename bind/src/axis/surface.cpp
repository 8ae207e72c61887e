#include "surface.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include <cmath>

#include "to_cgal.h"

namespace tendril::axis {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<CgalMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

struct Surface::Implementation {
  CgalMesh mesh;
  Tree tree;
  CGAL::Side_of_triangle_mesh<CgalMesh, Kernel, CGAL::Default, Tree> side;

  explicit Implementation(CgalMesh given)
      : mesh(std::move(given)), tree(faces(mesh).begin(), faces(mesh).end(), mesh), side(tree) {
    tree.accelerate_distance_queries();
  }
};

Surface::Surface(const bind::PolygonMesh& mesh) : self_(std::make_unique<Implementation>(to_cgal(mesh))) {}
Surface::~Surface() = default;

Vec3 Surface::nearest(const Vec3& p) const {
  const Kernel::Point_3 q = self_->tree.closest_point(point(p));
  return {q.x(), q.y(), q.z()};
}

double Surface::distance(const Vec3& p) const {
  return std::sqrt(self_->tree.squared_distance(point(p)));
}

std::optional<double> Surface::first_hit(const Vec3& p, const Vec3& d) const {
  const Kernel::Ray_3 ray(point(p), Kernel::Vector_3(d.x(), d.y(), d.z()));
  const auto hit = self_->tree.first_intersection(ray);
  if (!hit) return std::nullopt;
  const auto* at = boost::get<Kernel::Point_3>(&hit->first);
  if (at == nullptr) return std::nullopt;  // along a triangle
  return (Vec3(at->x(), at->y(), at->z()) - p).dot(d);
}

bool Surface::holds(const Vec3& p) const {
  return self_->side(point(p)) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace tendril::axis
