// Embree, in single precision: points by the parity of a ray upwards, balls by the hierarchy alone with
// distances of its boxes' triangles in doubles.
#include <embree3/rtcore.h>

#include <limits>

#include "accuracy/collision/adapter.h"

namespace tendril::suite {
namespace {

/// Square of the distance of a point and a triangle, in doubles.
double square(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, n = ab.cross(ac);
  const auto to_edge = [&](const Vec3& from, const Vec3& along) {
    const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - from - t * along).squaredNorm();
  };
  const double edges = std::min({to_edge(a, ab), to_edge(b, c - b), to_edge(c, a - c)});
  const bool above =
      n.dot(ab.cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 && n.dot((a - c).cross(p - c)) >= 0;
  const double height = n.dot(p - a);
  return above ? std::min(edges, height * height / n.squaredNorm()) : edges;
}

class Mesh : public MeshPeer {
 public:
  Mesh(Points points, Triangles triangles)
      : points_(points),
        triangles_(triangles),
        device_(rtcNewDevice("threads=1")),
        scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
    for (const Vec3& x : points)
      for (const double coordinate : x) *vertices++ = static_cast<float>(coordinate);
    void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), triangles.size());
    std::copy(triangles.begin(), triangles.end(), static_cast<collision::Triangle*>(corners));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Mesh() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  /// Ray by ray from hit to hit.
  Said holds(const Vec3& x) override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    int crossed = 0;
    float from = 0.0f;
    for (int step = 0; step < 1000; ++step) {
      RTCRayHit ray{};
      ray.ray.org_x = static_cast<float>(x.x());
      ray.ray.org_y = static_cast<float>(x.y());
      ray.ray.org_z = static_cast<float>(x.z());
      ray.ray.dir_z = 1.0f;
      ray.ray.tnear = from;
      ray.ray.tfar = std::numeric_limits<float>::infinity();
      ray.ray.mask = ~0U;
      ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &ray);
      if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
      if (ray.ray.tfar == 0.0f) return true;
      ++crossed;
      from = std::nextafter(ray.ray.tfar, std::numeric_limits<float>::infinity());
    }
    return crossed % 2 != 0;
  }
  Said meets(const Vec3& centre, double radius) override {
    Query query{this, centre, radius * radius, false};
    RTCPointQuery point{static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                        static_cast<float>(centre.z()), 0.0f, static_cast<float>(radius) * 1.00001f};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &point, &context, visit, &query);
    return query.found;
  }

 private:
  struct Query {
    Mesh* self;
    Vec3 centre;
    double square;
    bool found;
  };
  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const auto& t = query.self->triangles_[arguments->primID];
    const Points at = query.self->points_;
    query.found = query.found || square(query.centre, at[t[0]], at[t[1]], at[t[2]]) <= query.square;
    return false;
  }

  Points points_;
  Triangles triangles_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace

Adapter embree_adapter() {
  Adapter out{"Embree " RTC_VERSION_STRING ", float"};
  out.mesh = mesh_of<Mesh>;
  out.holds = out.meets = true;
  return out;
}

}  // namespace tendril::suite
