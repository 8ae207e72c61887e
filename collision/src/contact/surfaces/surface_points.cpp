#include "surface_points.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "span_list.h"

namespace tendril::contact {
namespace {

constexpr double kMostPoints = 1e7;

std::string place_of(std::size_t triangle) {
  return "contact.surface.triangles[" + std::to_string(triangle) + "]";
}

void check(const ContactSurface& surface) {
  const std::string place = "contact.surface";
  if (!surface.points) throw InvalidInput(place + ".points", "none", "vertices on curve-pairs");
  const std::size_t count = surface.points->points().size();
  if (surface.rest.size() != count)
    throw InvalidInput(place + ".rest", std::to_string(surface.rest.size()) + " points",
                       "as many as are bound, " + std::to_string(count));
  if (!all_finite(surface.rest)) throw InvalidInput(place + ".rest", "not finite", "finite points");
  if (surface.triangles.empty()) throw InvalidInput(place + ".triangles", "none", "at least one");
  if (!(surface.skin > 0.0 && surface.skin < std::numeric_limits<double>::infinity()))
    throw InvalidInput(place + ".skin", std::to_string(surface.skin), "a positive length");
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    for (const std::uint32_t corner : surface.triangles[i])
      if (corner >= count)
        throw InvalidInput(place_of(i), std::to_string(corner), "below " + std::to_string(count));
}

/// Triangles by the set of spans that their corners depend on: one bound on the motion of these spans then
/// holds for all of a patch. Finer patches would share that bound, and gain nothing by it. An ordered map, so
/// that the order of points, and with it that of sums, is the same on every machine.
std::map<std::vector<std::uint32_t>, std::vector<std::uint32_t>> group(const ContactSurface& surface,
                                                                       std::vector<UsedSpan>& spans) {
  SpanList list(*surface.points, spans);
  std::map<std::vector<std::uint32_t>, std::vector<std::uint32_t>> groups;
  std::vector<std::uint32_t> of;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    of.clear();
    for (const std::uint32_t corner : surface.triangles[t]) list.of(corner, of);
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
    groups[of].push_back(t);
  }
  return groups;
}

/// Lays points over the triangles of one patch. A triangle is cut into n^2 alike; each gives a third of its
/// area to each of its corners. Points at vertices are shared by the patch's triangles, those on edges are
/// not: two at one place do what one of their weights' sum would.
class Layer {
 public:
  Layer(const ContactSurface& surface, double apart, Patch& patch, std::vector<SurfacePoint>& points)
      : surface_(surface), apart_(apart), patch_(patch), points_(points) {}

  void add(std::uint32_t triangle) {
    const auto& corners = surface_.triangles[triangle];
    std::array<Vec3, 3> x;
    std::array<std::uint32_t, 3> local;
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = surface_.rest[corners[i]];
      local[i] = local_of(corners[i]);
    }
    const double longest = std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()});
    const double wanted = std::max(1.0, std::ceil(longest / apart_));
    const double third = (x[1] - x[0]).cross(x[2] - x[0]).norm() / (6.0 * wanted * wanted);
    if (!(0.5 * wanted * wanted + static_cast<double>(points_.size()) < kMostPoints))
      throw InvalidInput("contact.law.range",
                         "the surface would need a point every " + std::to_string(apart_),
                         "a range and a skin that less than 1e7 points are enough for");
    const auto n = static_cast<std::uint32_t>(wanted);
    const auto first = static_cast<std::uint32_t>(points_.size());
    const Cut cut{triangle, local, n, third, longest / wanted};
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = i == 0 ? 1 : 0; j <= n - i - (i == 0 ? 1 : 0); ++j) put(cut, {n - i - j, i, j});
    for (std::size_t corner = 0; corner < 3; ++corner) put_corner(cut, corner);
    patch_.triangles.push_back({triangle, local, n, first, static_cast<std::uint32_t>(points_.size())});
  }

 private:
  struct Cut {
    std::uint32_t triangle;
    std::array<std::uint32_t, 3> local;
    std::uint32_t parts;
    double third, side;
  };

  std::uint32_t local_of(std::uint32_t vertex) {
    const auto [at, added] = local_.try_emplace(vertex, patch_.vertices.size());
    if (added) patch_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(at->second);
  }

  void put(const Cut& cut, const std::array<std::uint32_t, 3>& at) {
    const bool on_edge = std::count(at.begin(), at.end(), 0U) > 0;
    SurfacePoint point{{}, (on_edge ? 3.0 : 6.0) * cut.third, cut.side};
    for (std::size_t i = 0; i < 3; ++i)
      point.share[i] = static_cast<double>(at[i]) / static_cast<double>(cut.parts);
    points_.push_back(point);
  }

  void put_corner(const Cut& cut, std::size_t corner) {
    const auto [known, added] = at_vertex_.try_emplace(cut.local[corner], points_.size());
    if (added) {
      points_.push_back({{}, cut.third, cut.side});
      points_.back().share[corner] = 1.0;
    } else {
      SurfacePoint& point = points_[known->second];
      point.weight += cut.third;
      point.side = std::max(point.side, cut.side);
    }
  }

  const ContactSurface& surface_;
  double apart_;
  Patch& patch_;
  std::vector<SurfacePoint>& points_;
  std::map<std::uint32_t, std::size_t> local_, at_vertex_;
};

}  // namespace

ContactSurface checked(ContactSurface surface) {
  check(surface);
  return surface;
}

SurfacePoints::SurfacePoints(const ContactSurface& surface, double apart) {
  fill(surface, apart);
}

void SurfacePoints::fill(const ContactSurface& surface, double apart) {
  for (const auto& [of, triangles] : group(surface, spans)) {
    Patch patch{{}, of, {}};
    Layer layer(surface, apart, patch, points);
    for (const std::uint32_t triangle : triangles) layer.add(triangle);
    patches.push_back(std::move(patch));
  }
}

}  // namespace tendril::contact
