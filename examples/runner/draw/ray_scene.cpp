#include "draw/ray_scene.h"

#include <embree3/rtcore.h>

#include <array>
#include <stdexcept>

namespace tendril::runner {
namespace {

const Vec3f kWarmGrey(0.44F, 0.36F, 0.29F);

struct Deleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, Deleter>;
using SceneHandle = std::unique_ptr<RTCSceneTy, Deleter>;

template <class T>
std::span<T> new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  auto* data = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count);
  if (data == nullptr) throw std::bad_alloc();
  return {static_cast<T*>(data), count};
}

void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

void attach_shape(RTCDevice device, RTCScene scene, const Shape& shape) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto vertices = new_buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                                         shape.points.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = {shape.points[i].x(), shape.points[i].y(), shape.points[i].z()};
  }
  const auto triangles = new_buffer<std::array<std::uint32_t, 3>>(
      geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, shape.triangles.size() / 3);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    triangles[k] = {shape.triangles[3 * k], shape.triangles[3 * k + 1], shape.triangles[3 * k + 2]};
  }
  attach(scene, geometry, 0);
}

void attach_strand(RTCDevice device, RTCScene scene, const Strand& strand, unsigned id, const Vec3& centre,
                   double size) {
  const bool tube = strand.kind == Strand::Kind::tube;
  RTCGeometry geometry =
      rtcNewGeometry(device, tube ? RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE : RTC_GEOMETRY_TYPE_SPHERE_POINT);
  const auto vertices = new_buffer<std::array<float, 4>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                                         strand.points.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3f p = ((strand.points[i] - centre) / size).cast<float>();
    const double radius = strand.radii.empty() ? strand.radius : strand.radii[i];
    vertices[i] = {p.x(), p.y(), p.z(), static_cast<float>(radius / size)};
  }
  if (tube) {
    const auto segments =
        new_buffer<std::uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, strand.points.size() - 1);
    for (std::size_t i = 0; i < segments.size(); ++i) segments[i] = static_cast<std::uint32_t>(i);
  }
  attach(scene, geometry, id);
}

RTCRay make_ray(const Vec3f& origin, const Vec3f& direction, float reach) {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tfar = reach;
  ray.mask = ~0U;
  return ray;
}

}  // namespace

struct RayScene::Implementation {
  Device device;
  SceneHandle scene;
  Shape shape;
  std::vector<Vec3f> strand_colors;

  Hit describe(const RTCRayHit& found, const Vec3f& direction) const {
    const RTCHit& at = found.hit;
    Hit hit;
    hit.distance = found.ray.tfar;
    hit.flat = Vec3f(at.Ng_x, at.Ng_y, at.Ng_z).normalized();
    hit.normal = hit.flat;
    if (at.geomID == 0) {
      const std::size_t k = 3 * static_cast<std::size_t>(at.primID);
      const float w = 1.0F - at.u - at.v;
      hit.normal =
          (w * shape.normals[k] + at.u * shape.normals[k + 1] + at.v * shape.normals[k + 2]).normalized();
      hit.color = shape.colors.empty()
                      ? kWarmGrey
                      : Vec3f(w * shape.colors[k] + at.u * shape.colors[k + 1] + at.v * shape.colors[k + 2]);
    } else {
      hit.color = strand_colors[at.geomID - 1];
    }
    if (hit.flat.dot(direction) > 0.0F) hit.flat = -hit.flat;
    if (hit.normal.dot(hit.flat) < 0.0F) hit.normal = -hit.normal;
    return hit;
  }
};

RayScene::RayScene(const bind::PolygonMesh* mesh, std::span<const Strand> strands, const Vec3& centre,
                   double size)
    : self_(std::make_unique<Implementation>()) {
  // One thread builds, so that the tree, and with it the choice between equal hits, is always the same.
  self_->device.reset(rtcNewDevice("threads=1,set_affinity=0"));
  if (!self_->device) throw std::runtime_error("Embree gives no device");
  self_->scene.reset(rtcNewScene(self_->device.get()));
  rtcSetSceneFlags(self_->scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (mesh != nullptr && mesh->face_count() > 0) {
    self_->shape = make_shape(*mesh, centre, size);
    attach_shape(self_->device.get(), self_->scene.get(), self_->shape);
  }
  unsigned id = 1;
  for (const Strand& strand : strands) {
    attach_strand(self_->device.get(), self_->scene.get(), strand, id++, centre, size);
    self_->strand_colors.push_back(strand.color);
  }
  rtcCommitScene(self_->scene.get());
}

RayScene::~RayScene() = default;

std::optional<Hit> RayScene::nearest(const Vec3f& origin, const Vec3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit found{};
  found.ray = make_ray(origin, direction, 1e30F);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(self_->scene.get(), &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return self_->describe(found, direction);
}

bool RayScene::blocked(const Vec3f& origin, const Vec3f& direction, float reach) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = make_ray(origin, direction, reach);
  rtcOccluded1(self_->scene.get(), &context, &ray);
  return ray.tfar < 0.0F;
}

}  // namespace tendril::runner
