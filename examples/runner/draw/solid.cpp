#include "draw/solid.h"

#include <cmath>
#include <numbers>

namespace tendril::runner {
namespace {

using Type = scene::SolidShape::Type;

constexpr int kAround = 48;  // corners of a circle
constexpr int kArc = 12;     // from a pole to the equator
constexpr bind::Color kSolid{205, 190, 160, 255};
constexpr double kGround = 1.2;  // half a half space's square, over what is seen

struct Ring {
  double radius, z;
};

/// What a line of rings sweeps about the axis; between rings of radius 0 there is nothing.
void add_rings(const std::vector<Ring>& rings, const scene::SolidPose& pose, bind::PolygonMesh& to) {
  const auto first = static_cast<std::uint32_t>(to.points.size());
  for (const Ring& ring : rings)
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kAround;
      to.points.push_back(pose.position + pose.rotation * Vec3(ring.radius * std::cos(angle),
                                                               ring.radius * std::sin(angle), ring.z));
      to.point_colors.push_back(kSolid);
    }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t next = (k + 1) % kAround, low = first + r * kAround, high = low + kAround;
      to.corners.insert(to.corners.end(), {low + k, low + next, high + next, high + k});
      to.face_begin.push_back(static_cast<std::uint32_t>(to.corners.size()));
    }
}

/// From the lower pole to the upper one.
std::vector<Ring> capsule_rings(double radius, double half) {
  std::vector<Ring> rings;
  for (int i = -kArc; i <= kArc; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kArc;
    if (i == 0) rings.push_back({radius, -half});
    rings.push_back({i == -kArc || i == kArc ? 1e-6 * radius : radius * std::cos(angle),
                     radius * std::sin(angle) + (i < 0 ? -half : half)});
  }
  return rings;
}

void add_box(const Vec3& half, const scene::SolidPose& pose, bind::PolygonMesh& to) {
  constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const auto first = static_cast<std::uint32_t>(to.points.size());
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    to.points.push_back(pose.position + pose.rotation * half.cwiseProduct(sign));
    to.point_colors.push_back(kSolid);
  }
  for (const auto& face : kFaces) {
    for (const std::uint32_t corner : face) to.corners.push_back(first + corner);
    to.face_begin.push_back(static_cast<std::uint32_t>(to.corners.size()));
  }
}

void add_mesh(const bind::PolygonMesh& mesh, const scene::SolidPose& pose, bind::PolygonMesh& to) {
  const auto first = static_cast<std::uint32_t>(to.points.size());
  for (const Vec3& p : mesh.points) {
    to.points.push_back(pose.position + pose.rotation * p);
    to.point_colors.push_back(kSolid);
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    for (const std::uint32_t corner : mesh.face(f)) to.corners.push_back(first + corner);
    to.face_begin.push_back(static_cast<std::uint32_t>(to.corners.size()));
  }
}

void add_ground(const scene::SolidPose& pose, const Vec3& centre, double size, bind::PolygonMesh& to) {
  const Vec3 up = pose.rotation.col(2);
  scene::SolidPose at = pose;
  at.position = centre - up.dot(centre - pose.position) * up - 1e-3 * size * up;
  add_box({kGround * size, kGround * size, 1e-3 * size}, at, to);
}

}  // namespace

void add_solid(const scene::SolidShape& shape, const scene::SolidPose& pose, const Vec3& centre, double size,
               bind::PolygonMesh& to) {
  const double r = shape.radius, h = shape.half;
  switch (shape.type) {
    case Type::half_space:
      return add_ground(pose, centre, size, to);
    case Type::box:
      return add_box(shape.size, pose, to);
    case Type::mesh:
      return add_mesh(*shape.mesh, pose, to);
    case Type::ball:
    case Type::capsule:
      return add_rings(capsule_rings(r, h), pose, to);
    case Type::cylinder:
      return add_rings({{1e-6 * r, -h}, {r, -h}, {r, h}, {1e-6 * r, h}}, pose, to);
    case Type::tube:
      return add_rings({{shape.inner, -h}, {r, -h}, {r, h}, {shape.inner, h}, {shape.inner, -h}}, pose, to);
  }
}

std::vector<Vec3> reach_of(const scene::SolidShape& shape, const scene::SolidPose& pose) {
  if (shape.type == Type::half_space) return {};
  if (shape.type == Type::mesh) {
    std::vector<Vec3> points;
    for (const Vec3& p : shape.mesh->points) points.push_back(pose.position + pose.rotation * p);
    return points;
  }
  const double along =
      shape.half + (shape.type == Type::ball || shape.type == Type::capsule ? shape.radius : 0.0);
  const Vec3 half = shape.type == Type::box ? shape.size : Vec3(shape.radius, shape.radius, along);
  std::vector<Vec3> out;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    out.push_back(pose.position + pose.rotation * half.cwiseProduct(sign));
  }
  return out;
}

}  // namespace tendril::runner
