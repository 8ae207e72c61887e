#include "loose_parts.h"

#include <algorithm>
#include <numeric>

#include "mesh/disjoint_sets.h"

namespace tendril::bind {
namespace {

struct Centre {
  Vec3 sum = Vec3::Zero(), any = Vec3::Zero();
  double area = 0.0, radius = 0.0;
  bool has_faces = false;

  Vec3 at() const { return area > 0.0 ? Vec3(sum / area) : any; }
};

/// Points at one place are one: soups and seams fall into no parts.
void join_coinciding(Points points, DisjointSets& sets) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(points[a].begin(), points[a].end(), points[b].begin(),
                                        points[b].end());
  };
  std::sort(order.begin(), order.end(), less);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i]] == points[order[i - 1]]) sets.join(order[i], order[i - 1]);
}

/// The centres of the parts, and how far their points are from them.
std::vector<Centre> centres_of(const PolygonMesh& body, const std::vector<std::uint32_t>& part_of,
                               std::size_t parts) {
  std::vector<Centre> out(parts);
  for (std::size_t i = 0; i < part_of.size(); ++i) out[part_of[i]].any = body.points[i];
  for (std::size_t f = 0; f < body.face_count(); ++f) {
    const auto face = body.face(f);
    out[part_of[face[0]]].has_faces = true;
    for (std::size_t k = 2; k < face.size(); ++k) {
      const Vec3 &a = body.points[face[0]], &b = body.points[face[k - 1]], &c = body.points[face[k]];
      const double area = 0.5 * (b - a).cross(c - a).norm();
      out[part_of[face[0]]].area += area;
      out[part_of[face[0]]].sum += area / 3.0 * (a + b + c);
    }
  }
  for (std::size_t i = 0; i < part_of.size(); ++i) {
    Centre& centre = out[part_of[i]];
    centre.radius = std::max(centre.radius, (body.points[i] - centre.at()).norm());
  }
  return out;
}

}  // namespace

LooseParts::LooseParts(const PolygonMesh& body, std::span<const CurveProjector> projectors,
                       const FactorOf& factor_of) {
  DisjointSets sets(body.points.size());
  for (std::size_t f = 0; f < body.face_count(); ++f)
    for (const std::uint32_t corner : body.face(f)) sets.join(body.face(f)[0], corner);
  join_coinciding(body.points, sets);
  std::uint32_t parts = 0;
  std::vector<std::uint32_t> part(body.points.size());
  for (std::uint32_t i = 0; i < part.size(); ++i) part[i] = sets.is_root(i) ? parts++ : part[sets.root(i)];
  for (std::size_t f = 0; f < body.face_count(); ++f) part_of_.push_back(part[body.face(f)[0]]);
  held_.resize(parts);
  if (parts < 2) return;
  const std::vector<Centre> centres = centres_of(body, part, parts);
  std::vector<std::vector<double>> factors(parts, std::vector<double>(projectors.size(), 10.0));
  for (std::uint32_t i = 0; i < part.size(); ++i)
    for (std::uint32_t k = 0; k < projectors.size() && centres[part[i]].has_faces; ++k)
      factors[part[i]][k] = std::min(factors[part[i]][k], factor_of(i, k));
  for (std::uint32_t one = 0; one < parts; ++one) {
    const Vec3 centre = centres[one].at();
    std::optional<Candidate> best;
    bool beside = centres[one].has_faces;
    for (std::uint32_t k = 0; k < projectors.size(); ++k) {
      const Projection at = projectors[k].nearest(centre);
      const double factor = factors[one][k];
      beside = beside && centres[one].radius < at.distance;
      if (!best || factor * at.distance < best->distance())
        best = Candidate{k, {at, std::max(0.0, at.lambda), false, 1}, factor};
    }
    if (beside) held_[one] = best;
  }
  enlist(part);
}

void LooseParts::enlist(const std::vector<std::uint32_t>& part_of_point) {
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> place(held_.size(), none);
  for (std::uint32_t i = 0; i < part_of_point.size(); ++i) {
    const std::uint32_t part = part_of_point[i];
    if (!held_[part]) continue;
    if (place[part] == none) {
      place[part] = list_.size();
      list_.push_back({i, 0, held_[part]->pair, held_[part]->at.t});
    }
    ++list_[place[part]].points;
  }
}

}  // namespace tendril::bind
