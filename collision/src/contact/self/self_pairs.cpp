#include "contact/foot.h"
#include "self_model.h"

namespace tendril::contact {
namespace {

struct Bounds {
  Vec3 low = Vec3::Constant(kInfinite), high = Vec3::Constant(-kInfinite);

  void take(const Vec3& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  bool near(const Vec3& a, const Vec3& b, double far) const {
    return (low.array() - far <= a.cwiseMax(b).array()).all() &&
           (a.cwiseMin(b).array() <= high.array() + far).all();
  }
};

/// Of two patches, what is within a distance of each other. What depends on the rest alone is asked for anew
/// each time: to keep it for all pairs that rest near would take more room than the mesh.
class PairsOfPatches {
 public:
  PairsOfPatches(const SelfModel& model, const SelfGroup& group, const PlacedVertices& at, double far)
      : model_(model),
        mesh_(model.mesh),
        first_(mesh_.patches[group.p]),
        second_(mesh_.patches[group.q]),
        same_(group.p == group.q),
        same_part_(first_.part == second_.part),
        at_(at),
        far_(far) {}

  SelfPairs run() {
    const Bounds first = bounds(first_), second = bounds(second_);
    faces_of(first_, second_, second);
    if (!same_) faces_of(second_, first_, first);
    const std::vector<std::uint32_t> some = near_box(first_, second);
    edges_of(some, same_ ? first_.edges : near_box(second_, first));
    return std::move(out_);
  }

 private:
  Bounds bounds(const SelfPatch& patch) const {
    Bounds result;
    for (const std::uint32_t v : patch.corners) result.take(at_[v]);
    return result;
  }

  /// The vertices of one with the faces of the other.
  void faces_of(const SelfPatch& of, const SelfPatch& with, const Bounds& box) {
    for (const std::uint32_t v : of.vertices) {
      if (!box.near(at_[v], at_[v], far_)) continue;
      for (const std::uint32_t f : with.faces) {
        const auto& [a, b, c] = model_.surface.triangles[f];
        if (v == a || v == b || v == c || !beside(at_[v], {at_[a], at_[b], at_[c]}, far_)) continue;
        const SelfPair pair{v, f};
        if (model_.distance(pair, at_) <= far_ && !(same_part_ && rests_near(v, f)))
          out_.faces.push_back(pair);
      }
    }
  }
  bool rests_near(std::uint32_t v, std::uint32_t f) const {
    const auto& [a, b, c] = model_.surface.triangles[f];
    const auto& rest = model_.surface.rest;
    const double d = (rest[v] - foot_on({rest[a], rest[b], rest[c]}, rest[v]).point).norm();
    return d < model_.left_out(mesh_.longest[v], mesh_.face_longest[f]);
  }

  std::vector<std::uint32_t> near_box(const SelfPatch& of, const Bounds& box) const {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t e : of.edges)
      if (box.near(at_[mesh_.edges[e].end[0]], at_[mesh_.edges[e].end[1]], far_)) result.push_back(e);
    return result;
  }
  void edges_of(const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& second) {
    for (const std::uint32_t e : first)
      for (const std::uint32_t f : second) {
        if (same_ && f <= e) continue;
        const auto& [a, b] = mesh_.edges[e].end;
        const auto& [c, d] = mesh_.edges[f].end;
        if (a == c || a == d || b == c || b == d || !beside(at_[a], at_[b], at_[c], at_[d], far_)) continue;
        const SelfPair pair{e, f};
        if (model_.edge_distance(pair, at_) <= far_ && !(same_part_ && edges_rest_near(e, f)))
          out_.edges.push_back(pair);
      }
  }
  bool edges_rest_near(std::uint32_t e, std::uint32_t f) const {
    const auto& rest = model_.surface.rest;
    const auto& [a, b] = mesh_.edges[e].end;
    const auto& [c, d] = mesh_.edges[f].end;
    return apart(feet_of(rest[a], rest[b], rest[c], rest[d]), rest[a], rest[b], rest[c], rest[d]).norm() <
           model_.left_out(mesh_.edges[e].longest, mesh_.edges[f].longest);
  }

  const SelfModel& model_;
  const SelfMesh& mesh_;
  const SelfPatch &first_, &second_;
  bool same_, same_part_;
  const PlacedVertices& at_;
  double far_;
  SelfPairs out_;
};

}  // namespace

SelfPairs SelfModel::pairs(const SelfGroup& group, const PlacedVertices& at, double far) const {
  return PairsOfPatches(*this, group, at, far).run();
}

double SelfModel::distance(const SelfPair& pair, const PlacedVertices& at) const {
  const auto& [a, b, c] = surface.triangles[pair.second];
  return (at[pair.first] - foot_on({at[a], at[b], at[c]}, at[pair.first]).point).norm();
}

double SelfModel::edge_distance(const SelfPair& pair, const PlacedVertices& at) const {
  const auto& [a, b] = mesh.edges[pair.first].end;
  const auto& [c, d] = mesh.edges[pair.second].end;
  return apart(feet_of(at[a], at[b], at[c], at[d]), at[a], at[b], at[c], at[d]).norm();
}

namespace {

/// Rods that some vertices are bound to, ascending.
std::vector<std::uint32_t> rods_of(const SelfModel& model, const std::array<std::uint32_t, 4>& vertices) {
  std::vector<std::uint32_t> rods;
  std::vector<BoundShare> shares;
  for (const std::uint32_t v : vertices) {
    model.points().points().shares(v, shares);
    for (const BoundShare& share : shares) rods.push_back(static_cast<std::uint32_t>(share.pair));
  }
  sort_once(rods);
  return rods;
}

}  // namespace

SelfInRange in_range(const SelfModel& model, SelfPairs pairs) {
  SelfInRange result{std::move(pairs), {}, {}, {}};
  const auto note = [&](const std::array<std::uint32_t, 4>& vertices) {
    std::vector<std::uint32_t> rods = rods_of(model, vertices);
    result.vertices.insert(result.vertices.end(), vertices.begin(), vertices.end());
    result.rods.insert(result.rods.end(), rods.begin(), rods.end());
    result.together.push_back(std::move(rods));
  };
  for (const SelfPair& pair : result.pairs.faces) {
    const auto& [a, b, c] = model.surface.triangles[pair.second];
    note({pair.first, a, b, c});
  }
  for (const SelfPair& pair : result.pairs.edges) {
    const auto& [a, b] = model.mesh.edges[pair.first].end;
    const auto& [c, d] = model.mesh.edges[pair.second].end;
    note({a, b, c, d});
  }
  sort_once(result.vertices);
  sort_once(result.rods);
  std::sort(result.together.begin(), result.together.end());
  result.together.erase(std::unique(result.together.begin(), result.together.end()), result.together.end());
  return result;
}

}  // namespace tendril::contact
