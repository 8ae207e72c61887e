#include "bench/collision/hierarchy_peers.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tendril/collision/box_queries.h>

#include "bench/collision/plain_tree.h"
#ifdef TENDRIL_BENCH_EMBREE
#include <embree3/rtcore.h>
#endif
#ifdef TENDRIL_BENCH_FCL
#include <fcl/fcl.h>
#endif

namespace tendril::bench {

/// Closest point by the regions of Ericson, Real-Time Collision Detection, 5.1.5.
double square_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).squaredNorm();
  const double sum = va + vb + vc;
  return (ap - vb / sum * ab - vc / sum * ac).squaredNorm();
}

namespace {

class OwnRefit : public BallPeer {
 public:
  OwnRefit(Points rest, Triangles triangles) : tree_(rest, triangles) {}
  void move(Points at) override {
    at_ = at;
    tree_.refit(at);
  }
  std::size_t count(const Vec3& centre, double radius) override {
    std::size_t found = 0;
    tree_.descend(
        at_, [&](const auto& box) { return collision::square_distance(box, centre) <= radius * radius; },
        [&](const auto& t) {
          found += square_distance(centre, at_[t[0]], at_[t[1]], at_[t[2]]) <= radius * radius;
        });
    return found;
  }

 private:
  PlainTree tree_;
  Points at_;
};

class CgalRebuild : public BallPeer {
  using K = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Iterator = std::vector<K::Triangle_3>::const_iterator;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<K, CGAL::AABB_triangle_primitive<K, Iterator>>>;

 public:
  explicit CgalRebuild(Triangles triangles) : triangles_(triangles) { soup_.reserve(triangles.size()); }
  void move(Points at) override {
    const auto point = [&](std::uint32_t i) { return K::Point_3(at[i].x(), at[i].y(), at[i].z()); };
    soup_.clear();
    for (const auto& t : triangles_) soup_.emplace_back(point(t[0]), point(t[1]), point(t[2]));
    tree_.rebuild(soup_.begin(), soup_.end());
    tree_.build();
  }
  std::size_t count(const Vec3& centre, double radius) override {
    return tree_.number_of_intersected_primitives(
        K::Sphere_3(K::Point_3(centre.x(), centre.y(), centre.z()), radius * radius));
  }

 private:
  Triangles triangles_;
  std::vector<K::Triangle_3> soup_;
  Tree tree_;
};

#ifdef TENDRIL_BENCH_EMBREE
class EmbreeRefit : public BallPeer {
 public:
  EmbreeRefit(Points rest, Triangles triangles) : triangles_(triangles), size_(rest.size()) {
    device_ = rtcNewDevice("threads=1");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
    vertices_ = static_cast<float*>(rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0,
                                                            RTC_FORMAT_FLOAT3, 3 * sizeof(float), size_));
    void* corners = rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), triangles.size());
    std::copy(triangles.begin(), triangles.end(), static_cast<collision::Triangle*>(corners));
    rtcAttachGeometry(scene_, geometry_);
    rtcReleaseGeometry(geometry_);
    move(rest);
  }
  ~EmbreeRefit() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  void move(Points at) override {
    at_ = at;
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        vertices_[3 * i + k] = static_cast<float>(at[i][static_cast<Eigen::Index>(k)]);
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }
  std::size_t count(const Vec3& centre, double radius) override {
    Query query{this, centre, radius * radius, 0};
    RTCPointQuery point{static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                        static_cast<float>(centre.z()), 0.0f, static_cast<float>(radius) * 1.00001f};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &point, &context, visit, &query);
    return query.found;
  }

 private:
  struct Query {
    EmbreeRefit* self;
    Vec3 centre;
    double square;
    std::size_t found;
  };
  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const auto& t = query.self->triangles_[arguments->primID];
    const Points at = query.self->at_;
    query.found += square_distance(query.centre, at[t[0]], at[t[1]], at[t[2]]) <= query.square;
    return false;
  }

  Triangles triangles_;
  std::size_t size_;
  Points at_;
  RTCDevice device_;
  RTCScene scene_;
  RTCGeometry geometry_;
  float* vertices_;
};
#endif

#ifdef TENDRIL_BENCH_FCL
class FclRefit : public BallPeer {
  using Model = fcl::BVHModel<fcl::OBBRSSd>;

 public:
  FclRefit(Points rest, Triangles triangles)
      : at_(rest.begin(), rest.end()), model_(std::make_shared<Model>()), object_(model_) {
    std::vector<fcl::Triangle> corners;
    for (const auto& t : triangles) corners.emplace_back(t[0], t[1], t[2]);
    model_->beginModel();
    model_->addSubModel(at_, corners);
    model_->endModel();
  }
  void move(Points at) override {
    at_.assign(at.begin(), at.end());
    model_->beginUpdateModel();
    model_->updateSubModel(at_);
    model_->endUpdateModel(true, true);
  }
  std::size_t count(const Vec3& centre, double radius) override {
    fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(radius), Mat3::Identity(), centre);
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    return fcl::collide(&object_, &ball, request, result) > 0 ? 1 : 0;
  }

 private:
  std::vector<Vec3> at_;
  std::shared_ptr<Model> model_;
  fcl::CollisionObjectd object_;
};
#endif

}  // namespace

NamedPeer own_refit(Points rest, Triangles triangles) {
  return {"own refit", std::make_unique<OwnRefit>(rest, triangles)};
}

NamedPeer cgal_rebuild(Points, Triangles triangles) {
  // Its sphere has no inside: triangles within the ball are not counted.
  return {"CGAL rebuild", std::make_unique<CgalRebuild>(triangles), false};
}

NamedPeer embree_refit([[maybe_unused]] Points rest, [[maybe_unused]] Triangles triangles) {
#ifdef TENDRIL_BENCH_EMBREE
  return {"Embree refit", std::make_unique<EmbreeRefit>(rest, triangles)};
#else
  return {"Embree (not installed)", nullptr};
#endif
}

NamedPeer fcl_obbrss_refit([[maybe_unused]] Points rest, [[maybe_unused]] Triangles triangles) {
#ifdef TENDRIL_BENCH_FCL
  return {"FCL OBBRSS refit", std::make_unique<FclRefit>(rest, triangles), false};
#else
  return {"FCL (not installed)", nullptr};
#endif
}

}  // namespace tendril::bench
