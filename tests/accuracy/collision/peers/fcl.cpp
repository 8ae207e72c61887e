#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include "accuracy/collision/adapter.h"

namespace tendril::suite {
namespace {

using Intersect = fcl::detail::Intersect<double>;

class Mesh : public MeshPeer {
  using Model = fcl::BVHModel<fcl::OBBRSSd>;

 public:
  Mesh(Points points, Triangles triangles) : model_(std::make_shared<Model>()), object_(model_) {
    std::vector<fcl::Triangle> corners;
    for (const auto& [a, b, c] : triangles) corners.emplace_back(a, b, c);
    model_->beginModel();
    model_->addSubModel({points.begin(), points.end()}, corners);
    model_->endModel();
    object_.computeAABB();
  }
  Said meets(const Vec3& centre, double radius) override {
    fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(radius), Mat3::Identity(), centre);
    fcl::CollisionResultd result;
    return fcl::collide(&object_, &ball, fcl::CollisionRequestd(), result) > 0;
  }

 private:
  std::shared_ptr<Model> model_;
  fcl::CollisionObjectd object_;
};

/// A cubic solver in doubles, for straight paths.
Said moving(collision::Features features, const collision::Paths<1>& p) {
  double time = 0.0;
  Vec3 where;
  if (features == collision::Features::vertex_face)
    return Intersect::intersect_VF(p[1][0], p[2][0], p[3][0], p[0][0], p[1][1], p[2][1], p[3][1], p[0][1],
                                   &time, &where);
  return Intersect::intersect_EE(p[0][0], p[1][0], p[2][0], p[3][0], p[0][1], p[1][1], p[2][1], p[3][1],
                                 &time, &where);
}

}  // namespace

Adapter fcl_adapter() {
  Adapter out{"FCL " FCL_VERSION};
  out.proper = true;
  out.triangles = [](const Corners& a, const Corners& b) -> Said {
    return Intersect::intersect_Triangle(a[0], a[1], a[2], b[0], b[1], b[2]);
  };
  out.distance = [](const Corners& a, const Corners& b) {
    Vec3 p, q;
    return fcl::detail::TriangleDistance<double>::triDistance(a.data(), b.data(), p, q);
  };
  out.mesh = mesh_of<Mesh>;
  out.meets = true;
  out.straight = moving;
  return out;
}

}  // namespace tendril::suite
