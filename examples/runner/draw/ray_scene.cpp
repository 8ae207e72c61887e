#include "draw/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <mutex>
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

/// Embree keeps some of its memory in lists across devices, whose locks no tool sees: one thread at a time
/// makes or ends a scene.
std::mutex& making() {
  static std::mutex out;
  return out;
}

struct alignas(32) Lanes {
  std::array<int, kBundle> valid{};  ///< -1 where there is a ray
};

Lanes first_lanes(std::size_t count) {
  Lanes out;
  std::fill_n(out.valid.begin(), count, -1);
  return out;
}

void set_ray(RTCRay8& rays, std::size_t k, const Vec3f& origin, const Vec3f& direction, float reach) {
  rays.org_x[k] = origin.x();
  rays.org_y[k] = origin.y();
  rays.org_z[k] = origin.z();
  rays.dir_x[k] = direction.x();
  rays.dir_y[k] = direction.y();
  rays.dir_z[k] = direction.z();
  rays.tfar[k] = reach;
  rays.mask[k] = ~0U;
}

RTCIntersectContext context_of(RTCIntersectContextFlags flags) {
  RTCIntersectContext out;
  rtcInitIntersectContext(&out);
  out.flags = flags;
  return out;
}

}  // namespace

struct RayScene::Implementation {
  Device device;
  SceneHandle scene;
  Shape shape;
  std::vector<Vec3f> strand_colors;

  Hit describe(const RTCRayHit8& found, std::size_t lane, const Vec3f& direction) const {
    const RTCHit8& at = found.hit;
    Hit hit;
    hit.distance = found.ray.tfar[lane];
    hit.flat = Vec3f(at.Ng_x[lane], at.Ng_y[lane], at.Ng_z[lane]).normalized();
    hit.normal = hit.flat;
    if (at.geomID[lane] == 0) {
      const std::size_t k = 3 * static_cast<std::size_t>(at.primID[lane]);
      const float u = at.u[lane], v = at.v[lane], w = 1.0F - u - v;
      hit.normal = (w * shape.normals[k] + u * shape.normals[k + 1] + v * shape.normals[k + 2]).normalized();
      hit.color = shape.colors.empty()
                      ? kWarmGrey
                      : Vec3f(w * shape.colors[k] + u * shape.colors[k + 1] + v * shape.colors[k + 2]);
    } else {
      hit.color = strand_colors[at.geomID[lane] - 1];
    }
    if (hit.flat.dot(direction) > 0.0F) hit.flat = -hit.flat;
    if (hit.normal.dot(hit.flat) < 0.0F) hit.normal = -hit.normal;
    return hit;
  }
};

RayScene::RayScene(const bind::PolygonMesh* mesh, std::span<const Strand> strands, const Vec3& centre,
                   double size)
    : self_(std::make_unique<Implementation>()) {
  const bool meshed = mesh != nullptr && mesh->face_count() > 0;
  if (meshed) self_->shape = make_shape(*mesh, centre, size);
  const std::lock_guard lock(making());
  // One thread builds, so that the tree, and with it the choice between equal hits, is always the same.
  self_->device.reset(rtcNewDevice("threads=1,set_affinity=0"));
  if (!self_->device) throw std::runtime_error("Embree gives no device");
  self_->scene.reset(rtcNewScene(self_->device.get()));
  rtcSetSceneFlags(self_->scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (meshed) attach_shape(self_->device.get(), self_->scene.get(), self_->shape);
  unsigned id = 1;
  for (const Strand& strand : strands) {
    attach_strand(self_->device.get(), self_->scene.get(), strand, id++, centre, size);
    self_->strand_colors.push_back(strand.color);
  }
  rtcCommitScene(self_->scene.get());
}

RayScene::~RayScene() {
  const std::lock_guard lock(making());
  self_->scene.reset();
  self_->device.reset();
}

void RayScene::nearest(const Vec3f& origin, std::span<const Vec3f> directions,
                       std::span<std::optional<Hit>> hits) const {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  const Lanes lanes = first_lanes(directions.size());
  RTCRayHit8 found{};
  for (std::size_t k = 0; k < directions.size(); ++k) set_ray(found.ray, k, origin, directions[k], 1e30F);
  std::fill_n(found.hit.geomID, kBundle, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(found.hit.instID[0], kBundle, RTC_INVALID_GEOMETRY_ID);
  rtcIntersect8(lanes.valid.data(), self_->scene.get(), &context, &found);
  for (std::size_t k = 0; k < directions.size(); ++k) {
    hits[k].reset();
    if (found.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID) hits[k] = self_->describe(found, k, directions[k]);
  }
}

std::uint32_t RayScene::blocked(std::span<const Vec3f> origins, std::span<const Vec3f> directions,
                                float reach) const {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  const Lanes lanes = first_lanes(origins.size());
  RTCRay8 rays{};
  for (std::size_t k = 0; k < origins.size(); ++k) set_ray(rays, k, origins[k], directions[k], reach);
  rtcOccluded8(lanes.valid.data(), self_->scene.get(), &context, &rays);
  std::uint32_t out = 0;
  for (std::size_t k = 0; k < origins.size(); ++k) out |= (rays.tfar[k] < 0.0F ? 1U : 0U) << k;
  return out;
}

}  // namespace tendril::runner
