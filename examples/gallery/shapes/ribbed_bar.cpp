#include "ribbed_bar.h"

#include <algorithm>
#include <array>

namespace tendril::gallery {
namespace {

/// Where a ring of points goes round, and how wide.
struct Ring {
  double x, half;
};

/// Narrow and wide stretches in turn, each cut into rings.
std::vector<Ring> rings_of(const RibbedBar& bar) {
  const int stretches = 2 * bar.ribs + 1;
  const double width = bar.length / stretches, slant = 0.1 * width;
  std::vector<Ring> rings;
  for (int s = 0; s < stretches; ++s) {
    const double from = s * width + (s > 0 ? slant : 0.0);
    const double to = (s + 1) * width - (s + 1 < stretches ? slant : 0.0);
    for (int c = 0; c <= bar.cuts; ++c)
      rings.push_back({from + (to - from) * c / bar.cuts, s % 2 == 1 ? bar.rib : bar.half});
  }
  return rings;
}

/// Round a square, counterclockwise seen against x.
std::vector<Vec3> round_square(const Ring& ring, int per_side) {
  constexpr std::array<std::array<int, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::vector<Vec3> out;
  for (std::size_t side = 0; side < 4; ++side) {
    const auto [y, z] = kCorners[side];
    const auto [to_y, to_z] = kCorners[(side + 1) % 4];
    for (int k = 0; k < per_side; ++k) {
      const double part = double(k) / per_side;
      out.emplace_back(ring.x, ring.half * (y + part * (to_y - y)), ring.half * (z + part * (to_z - z)));
    }
  }
  return out;
}

void add_triangle(bind::PolygonMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.corners.insert(mesh.corners.end(), {a, b, c});
  mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (a - d).dot((b - d).cross(c - d));
}

}  // namespace

std::size_t ring_size(const RibbedBar& bar) {
  return static_cast<std::size_t>(4 * bar.per_side);
}

std::size_t ring_count(const RibbedBar& bar) {
  return rings_of(bar).size();
}

bind::PolygonMesh ribbed_bar(const RibbedBar& bar) {
  bind::PolygonMesh mesh;
  const std::vector<Ring> rings = rings_of(bar);
  const auto n = static_cast<std::uint32_t>(ring_size(bar));
  for (const Ring& ring : rings)
    for (const Vec3& point : round_square(ring, bar.per_side)) mesh.points.push_back(point);
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = r * n + k, b = r * n + (k + 1) % n;
      add_triangle(mesh, a, b, b + n);
      add_triangle(mesh, a, b + n, a + n);
    }
  const auto end = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.emplace_back(0, 0, 0);
  mesh.points.emplace_back(bar.length, 0, 0);
  for (std::uint32_t k = 0; k < n; ++k) {
    add_triangle(mesh, end, (k + 1) % n, k);
    add_triangle(mesh, end + 1, end - n + k, end - n + (k + 1) % n);
  }
  return mesh;
}

std::vector<Vec3> axis_points(const bind::PolygonMesh& mesh) {
  double length = 0.0;
  for (const Vec3& point : mesh.points) length = std::max(length, point.x());
  std::vector<Vec3> out;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    double x = 0.0;
    for (const std::uint32_t k : mesh.face(f)) x += mesh.points[k].x() / 3;
    out.emplace_back(std::clamp(x, 0.02 * length, 0.98 * length), 0.0, 0.0);
  }
  return out;
}

double volume(const bind::PolygonMesh& mesh, Points points) {
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    sum += six_volumes(points[face[0]], points[face[1]], points[face[2]], points[0]);
  }
  return sum / 6;
}

long inverted(const bind::PolygonMesh& mesh, Points points, Points axis) {
  long count = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    count += six_volumes(points[face[0]], points[face[1]], points[face[2]], axis[f]) <= 0.0;
  }
  return count;
}

}  // namespace tendril::gallery
