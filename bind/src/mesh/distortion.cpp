#include <tendril/base/error.h>
#include <tendril/bind/distortion.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mesh/disjoint_sets.h"

namespace tendril::bind {
namespace {

constexpr double kFlat = 1e-12;  // area, over the square of the longest edge, of a triangle that counts

using Corners = std::array<std::uint32_t, 3>;

/// The two edges of a triangle from its first corner, and their cross product.
struct Edges {
  Vec3 a, b, area;

  Edges(Points points, const Corners& t)
      : a(points[t[1]] - points[t[0]]), b(points[t[2]] - points[t[0]]), area(a.cross(b)) {}
  bool flat() const {
    return !(area.norm() > kFlat * std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()}));
  }
};

/// Calls `each` with every triangle's face and corners.
template <class Each>
void for_triangles(const PolygonMesh& mesh, const Each& each) {
  std::vector<std::size_t> face_of;
  const std::vector<Corners> triangles = fan_triangles(mesh, &face_of);
  for (std::size_t t = 0; t < triangles.size(); ++t) each(face_of[t], triangles[t]);
}

/// Singular values of the map from one pair of edges to the other, the larger first: the roots of the
/// eigenvalues of G^-1 G', the Gram matrices of the edges. The smaller one comes from the product, which is
/// the ratio of areas: the difference of two near equal numbers would lose it where a triangle is crushed.
std::array<double, 2> singular_values(const Edges& rest, const Edges& posed) {
  const double e = rest.a.squaredNorm(), f = rest.a.dot(rest.b), g = rest.b.squaredNorm();
  const double e2 = posed.a.squaredNorm(), f2 = posed.a.dot(posed.b), g2 = posed.b.squaredNorm();
  const double half = 0.5 * (e * g2 - 2.0 * f * f2 + g * e2) / rest.area.squaredNorm();
  const double product = posed.area.norm() / rest.area.norm();
  const double most = std::sqrt(half + std::sqrt(std::max(0.0, half * half - product * product)));
  return {most, most > 0.0 ? product / most : 0.0};
}

/// v as the frame of the point's nearest projection takes it from rest to the pose. A fold is told against
/// that, not against the normal at rest: a limb that is turned by 180 degrees has turned normals and no
/// folds.
class Carrier {
 public:
  Carrier(const Binding& binding, std::span<const CurvePair> rest, std::span<const CurvePair> posed)
      : binding_(binding), rest_(rest), posed_(posed) {}

  Vec3 operator()(std::uint32_t point, const Vec3& v) const {
    const std::size_t pair = binding_.pair_of(point);
    const double t = binding_.records()[point].t;
    const Frame from = rest_[pair].frame(t).frame, to = posed_[pair].frame(t).frame;
    return from.x.dot(v) * to.x + from.y.dot(v) * to.y + from.z.dot(v) * to.z;
  }

 private:
  const Binding& binding_;
  std::span<const CurvePair> rest_, posed_;
};

struct Spoilt {
  std::uint32_t face;
  Corners corners;
  double area;
};

/// Zones of triangles that share points, by points and not by edges: a zone that is thin in places stays one.
std::vector<SpoiltZone> zones_of(Points points, const std::vector<Spoilt>& spoilt, double area) {
  DisjointSets sets(points.size());
  for (const Spoilt& t : spoilt)
    for (const std::uint32_t corner : t.corners) sets.join(t.corners[0], corner);
  std::vector<std::uint32_t> zone(points.size(), 0);
  std::vector<SpoiltZone> zones;
  for (const Spoilt& t : spoilt) {
    std::uint32_t& at = zone[sets.root(t.corners[0])];
    if (at == 0) {
      zones.emplace_back();
      at = static_cast<std::uint32_t>(zones.size());
    }
    SpoiltZone& one = zones[at - 1];
    one.area += t.area;
    for (const std::uint32_t corner : t.corners) one.centre += t.area / 3.0 * points[corner];
    if (one.faces.empty() || one.faces.back() != t.face) one.faces.push_back(t.face);
  }
  for (SpoiltZone& one : zones) one.centre /= one.area;
  for (const Spoilt& t : spoilt) {
    SpoiltZone& one = zones[zone[sets.root(t.corners[0])] - 1];
    for (const std::uint32_t corner : t.corners)
      one.radius = std::max(one.radius, (points[corner] - one.centre).norm());
  }
  for (SpoiltZone& one : zones) one.area /= area;
  std::stable_sort(zones.begin(), zones.end(),
                   [](const SpoiltZone& a, const SpoiltZone& b) { return a.area > b.area; });
  return zones;
}

void require_size(const char* what, std::size_t given, std::size_t expected) {
  if (given != expected)
    throw InvalidInput(what, std::to_string(given) + " of them", std::to_string(expected));
}

/// From the edges and the unit normal at rest to those posed, applied to normals: the inverse transpose.
Vec3 turned(const Edges& rest, const Edges& posed, const Vec3& normal) {
  Mat3 from, to;
  from << rest.a, rest.b, rest.area.normalized();
  to << posed.a, posed.b, posed.area.normalized();
  const Mat3 inverse = from * to.inverse();
  return inverse.transpose() * normal;
}

}  // namespace

Distortion measure_distortion(const Binding& binding, std::span<const CurvePair> rest,
                              const PolygonMesh& mesh, std::span<const CurvePair> posed, Points points,
                              double limit) {
  require_valid(mesh);
  require_size("points", points.size(), mesh.points.size());
  require_size("binding", binding.size(), mesh.points.size());
  require_size("rest", rest.size(), binding.pair_count());
  require_size("posed", posed.size(), binding.pair_count());
  if (!(limit > 1.0)) throw InvalidInput("limit", std::to_string(limit), "above 1");
  const Carrier carried(binding, rest, posed);
  Distortion out;
  std::vector<Spoilt> spoilt;
  double area = 0.0, bad = 0.0;
  for_triangles(mesh, [&](std::size_t face, const Corners& t) {
    const Edges before(mesh.points, t), after(points, t);
    if (before.flat()) return;
    const auto [most, least] = singular_values(before, after);
    const bool folded = after.area.dot(carried(t[0], before.area)) < 0.0;
    const double size = 0.5 * before.area.norm();
    ++out.triangles;
    out.most_stretch = std::max(out.most_stretch, most);
    out.least_stretch = std::min(out.least_stretch, least);
    out.stretched += most > limit;
    out.crushed += least < 1.0 / limit;
    out.folded += folded;
    area += size;
    if (!folded && !(most > limit) && !(least < 1.0 / limit)) return;
    bad += size;
    spoilt.push_back({static_cast<std::uint32_t>(face), t, size});
  });
  if (spoilt.empty()) return out;
  out.spoilt = bad / area;
  out.zones = zones_of(mesh.points, spoilt, area);
  return out;
}

std::vector<Vec3> posed_normals(const PolygonMesh& mesh, Points points) {
  require_valid(mesh);
  require_size("points", points.size(), mesh.points.size());
  require_size("normals", mesh.point_normals.size(), mesh.points.size());
  std::vector<Vec3> sum(points.size(), Vec3::Zero());
  for_triangles(mesh, [&](std::size_t, const Corners& t) {
    const Edges before(mesh.points, t), after(points, t);
    if (before.flat() || after.flat()) return;
    for (const std::uint32_t i : t)
      sum[i] += before.area.norm() * turned(before, after, mesh.point_normals[i]).normalized();
  });
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] = sum[i].norm() > 0.0 ? Vec3(sum[i].normalized()) : mesh.point_normals[i];
  return sum;
}

}  // namespace tendril::bind
