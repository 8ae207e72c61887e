#include <algorithm>
#include <cmath>

#include "contact/by_key.h"
#include "contact/foot.h"
#include "posed_self.h"

namespace tendril::contact {
namespace {

constexpr std::uint64_t kEdges = std::uint64_t{1} << 63;
constexpr double kFlat = 1e-3;  ///< of the square of a sine at rest: below, edges count as parallel

/// A face in the range of a vertex, or a place of it that counts.
struct Place {
  std::uint32_t face;
  Foot foot;
  Vec3 apart;
  double distance;
};

/// Pairs are looked at first and answered afterwards: the faces in the range of a vertex come from several
/// groups, and what of them counts is known once all are there; sorted, so that sums do not depend on groups.
class SelfTouches {
 public:
  SelfTouches(const SelfModel& model, PosedSelf& surface, const SelfLedger* kept)
      : model_(model), mesh_(model.mesh), surface_(surface), kept_(kept) {}

  SelfMeetings run() {
    for (const std::uint32_t g : surface_.awake()) {
      look_at(g);
      if (out_.closed) return std::move(out_);
    }
    return respond();
  }
  SelfMeetings run(const SelfPairs& pairs) {
    far_ = model_.meets();
    look_at(pairs, nullptr, nullptr, 0.0);
    return out_.closed ? std::move(out_) : respond();
  }

 private:
  SelfMeetings respond() {
    for (const Hit& hit : hits_) out_.pairs.faces.push_back({hit.vertex, hit.place.face});
    for (const auto& [near, flat] : edges_)
      out_.pairs.edges.push_back(
          {static_cast<std::uint32_t>((near.key & ~kEdges) >> 32), static_cast<std::uint32_t>(near.key)});
    std::sort(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) {
      return std::pair(a.vertex, a.place.face) < std::pair(b.vertex, b.place.face);
    });
    for (std::size_t i = 0; i < hits_.size();) {
      std::size_t end = i;
      while (end < hits_.size() && hits_[end].vertex == hits_[i].vertex) ++end;
      count(hits_[i].vertex, i, end);
      i = end;
    }
    for (const auto& [near, flat] : edges_) respond(near, flat);
    return std::move(out_);
  }

  struct Hit {
    std::uint32_t vertex;
    Place place;
  };
  /// m of two edges: value, and its derivatives by their directions.
  struct Flatness {
    double value = 1.0;
    Vec3 by_first = Vec3::Zero(), by_second = Vec3::Zero();
  };

  /// Pairs that the ledger knows, where they are still all that could be near; else those of the patches.
  void look_at(std::uint32_t g) {
    const SelfGroup& group = surface_.list().groups[g];
    const double moved = surface_.moved(group);
    far_ = model_.meets() + (model_.barrier() ? moved : 0.0);
    const NearGroup* known = surface_.known(group);
    if (known && known->left > moved) return look_at(*known->pairs, &known->faces, &known->edges, moved);
    look_at(model_.pairs(group, surface_.placed(), far_), nullptr, nullptr, moved);
  }
  void look_at(const SelfPairs& pairs, const std::vector<double>* faces, const std::vector<double>* edges,
               double moved) {
    for (std::size_t i = 0; i < pairs.faces.size() && !out_.closed; ++i)
      if (!faces || !((*faces)[i] > moved)) look_at_face(pairs.faces[i]);
    for (std::size_t i = 0; i < pairs.edges.size() && !out_.closed; ++i)
      if (!edges || !((*edges)[i] > moved)) look_at_edges(pairs.edges[i]);
  }

  const Vec3& at(std::uint32_t v) const { return surface_.at(v); }
  std::array<Vec3, 3> corners(std::uint32_t face) const {
    const auto& [a, b, c] = model_.surface.triangles[face];
    return {at(a), at(b), at(c)};
  }

  void look_at_face(const SelfPair& pair) {
    const std::array<Vec3, 3> t = corners(pair.second);
    const Vec3& x = at(pair.first);
    if (!beside(x, t, far_)) return;
    ++out_.looked_at;
    const Foot foot = foot_on(t, x);
    const Vec3 apart = x - foot.point;
    const Place place{pair.second, foot, apart, apart.norm()};
    const SelfNear near = near_of(pair.first, place, 0.0);
    if (close(near)) return;
    if (place.distance < model_.meets()) hits_.push_back({pair.first, place});
  }

  void look_at_edges(const SelfPair& pair) {
    const auto& [a, b] = mesh_.edges[pair.first].end;
    const auto& [c, d] = mesh_.edges[pair.second].end;
    const Vec3 &p = at(a), &q = at(b), &r = at(c), &s = at(d);
    if (!beside(p, q, r, s, far_)) return;
    ++out_.looked_at;
    const SegmentFeet feet = feet_of(p, q, r, s);
    const Vec3 way = apart(feet, p, q, r, s);
    const double both = mesh_.edges[pair.first].area + mesh_.edges[pair.second].area;
    // Of edges shorter than the range more than those that cross are near each other.
    const double area = both * both / (16.0 * (both + model_.law.range * model_.meets()));
    const SelfNear near{{a, b, c, d},
                        {1.0 - feet.s, feet.s, feet.t - 1.0, -feet.t},
                        2,
                        {mesh_.edges[pair.first].face, mesh_.edges[pair.second].face},
                        kEdges | (std::uint64_t{pair.first} << 32) | pair.second,
                        way,
                        way.norm(),
                        area};
    if (close(near) || !(near.distance < model_.meets())) return;
    const Flatness flat = flatness(pair, q - p, s - r);
    if (flat.value > 0.0) edges_.emplace_back(near, flat);
  }

  /// [Li et al. 2020] 4: m = (2 - c / e) c / e for c = |u x v|^2 below e = 1e-3 |u|^2 |v|^2 at rest.
  Flatness flatness(const SelfPair& pair, const Vec3& u, const Vec3& v) const {
    const auto square = [&](const SelfEdge& edge) {
      return (model_.surface.rest[edge.end[1]] - model_.surface.rest[edge.end[0]]).squaredNorm();
    };
    const double e = kFlat * square(mesh_.edges[pair.first]) * square(mesh_.edges[pair.second]);
    const Vec3 w = u.cross(v);
    const double c = w.squaredNorm();
    if (c >= e) return {};
    const double slope = 2.0 * (1.0 - c / e) / e;
    return {(2.0 - c / e) * c / e, 2.0 * slope * v.cross(w), 2.0 * slope * w.cross(u)};
  }

  SelfNear near_of(std::uint32_t vertex, const Place& place, double area) const {
    const auto& [a, b, c] = model_.surface.triangles[place.face];
    const auto& share = place.foot.share;
    return {{vertex, a, b, c},
            {1.0, -share[0], -share[1], -share[2]},
            1,
            {place.face, place.face},
            (std::uint64_t{vertex} << 32) | place.face,
            place.apart,
            place.distance,
            area};
  }

  /// Notes, where a barrier cannot let two places be, which.
  bool close(const SelfNear& near) {
    if (!model_.barrier()) return false;
    const double gap = near.distance - model_.thick();
    if (gap > 0.0 && reachable(near, gap)) return false;
    out_.closed = SelfClosed{near.face, gap};
    if (near.of_first == 1) out_.closed->face[0] = mesh_.face_of[near.vertex[0]];
    return true;
  }

  /// Whether the gap was open all the way from where vertices were, straight: by no more than the two sides
  /// move against each other does it close [Li et al. 2021].
  bool reachable(const SelfNear& near, double gap) {
    if (!kept_ || gap >= far_ - model_.meets()) return true;
    std::array<Vec3, 4> way;
    Vec3 mean = Vec3::Zero();
    // What all four have in common brings none nearer to another.
    for (std::size_t i = 0; i < 4; ++i) mean += way[i] = surface_.before(near.vertex[i]) - at(near.vertex[i]);
    double first = 0.0, second = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      double& most = i < near.of_first ? first : second;
      most = std::max(most, (way[i] - 0.25 * mean).norm());
    }
    const double length = (first + second) * (1.0 + 1e-12);
    double s = 0.0;
    while (gap < (1.0 - s) * length) {
      s += std::max(gap, 1e-4 * model_.law.range) / length;
      if (s >= 1.0) return true;
      gap = distance_at(near, way, s) - model_.thick();
      if (!(gap > 0.0)) return false;
    }
    return true;
  }
  double distance_at(const SelfNear& near, const std::array<Vec3, 4>& way, double s) const {
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = at(near.vertex[i]) + s * way[i];
    if (near.of_first == 1) return (x[0] - foot_on({x[1], x[2], x[3]}, x[0]).point).norm();
    const SegmentFeet feet = feet_of(x[0], x[1], x[2], x[3]);
    return apart(feet, x[0], x[1], x[2], x[3]).norm();
  }

  /// Of the faces in the range of a vertex, what is counted how often: each its nearest place once, edges k
  /// of them share k - 1 times less, and vertices as often as that leaves them short of once.
  void count(std::uint32_t vertex, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) add(hits_[i].place, 1.0);
    if (end - begin > 1) {
      shared_.clear();
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t side = 0; side < 3; ++side)
          shared_.push_back({mesh_.edges_of[hits_[i].place.face][side], i, side});
      std::sort(shared_.begin(), shared_.end());
      count_edges(vertex);
      count_corners(vertex, begin, end);
    }
    for (const Counted& one : counted_)
      if (one.times != 0.0 && one.place.distance < model_.meets())
        respond(near_of(vertex, one.place, 0.25 * one.times * mesh_.area[vertex]), {});
    counted_.clear();
  }
  void count_edges(std::uint32_t vertex) {
    extra_.clear();
    for (std::size_t i = 0; i < shared_.size();) {
      std::size_t end = i;
      while (end < shared_.size() && shared_[end].edge == shared_[i].edge) ++end;
      const double more = static_cast<double>(end - i) - 1.0;
      if (more > 0.0) {
        add(on_edge(vertex, hits_[shared_[i].hit].place.face, shared_[i].side), -more);
        for (const std::uint32_t corner : mesh_.edges[shared_[i].edge].end) extra_.emplace_back(corner, more);
      }
      i = end;
    }
  }
  void count_corners(std::uint32_t vertex, std::size_t begin, std::size_t end) {
    if (extra_.empty()) return;
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t corner : model_.surface.triangles[hits_[i].place.face])
        extra_.emplace_back(corner, -1.0);
    std::sort(extra_.begin(), extra_.end());
    for (std::size_t i = 0; i < extra_.size();) {
      double times = 1.0;
      const std::uint32_t corner = extra_[i].first;
      for (; i < extra_.size() && extra_[i].first == corner; ++i) times += extra_[i].second;
      if (times != 0.0) add(on_corner(vertex, corner, begin, end), times);
    }
  }
  Place on_edge(std::uint32_t vertex, std::uint32_t face, std::size_t side) const {
    const std::array<Vec3, 3> t = corners(face);
    const Vec3 &x = at(vertex), &from = t[side], &to = t[(side + 1) % 3];
    const double square = (to - from).squaredNorm();
    const double s = square > 0.0 ? std::clamp((x - from).dot(to - from) / square, 0.0, 1.0) : 0.0;
    Foot foot{from + s * (to - from), Foot::Part::edge, side, {}};
    foot.share[side] = 1.0 - s;
    foot.share[(side + 1) % 3] = s;
    if (s == 0.0 || s == 1.0) {
      foot.part = Foot::Part::corner;
      foot.which = s == 0.0 ? side : (side + 1) % 3;
    }
    const Vec3 apart = x - foot.point;
    return {face, foot, apart, apart.norm()};
  }
  Place on_corner(std::uint32_t vertex, std::uint32_t corner, std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& of = model_.surface.triangles[hits_[i].place.face];
      for (std::size_t k = 0; k < 3; ++k) {
        if (of[k] != corner) continue;
        Foot foot{at(corner), Foot::Part::corner, k, {}};
        foot.share[k] = 1.0;
        const Vec3 apart = at(vertex) - foot.point;
        return {hits_[i].place.face, foot, apart, apart.norm()};
      }
    }
    return hits_[begin].place;
  }
  /// Places that are the same vertex or edge are counted together.
  void add(const Place& place, double times) {
    for (Counted& one : counted_)
      if (same(one.place, place)) {
        one.times += times;
        return;
      }
    counted_.push_back({place, times});
  }
  bool same(const Place& a, const Place& b) const {
    if (a.foot.part != b.foot.part) return false;
    switch (a.foot.part) {
      case Foot::Part::face:
        return a.face == b.face;
      case Foot::Part::edge:
        return mesh_.edges_of[a.face][a.foot.which] == mesh_.edges_of[b.face][b.foot.which];
      case Foot::Part::corner:
        break;
    }
    return model_.surface.triangles[a.face][a.foot.which] == model_.surface.triangles[b.face][b.foot.which];
  }

  void respond(const SelfNear& near, const Flatness& flat) {
    const double gap = near.distance - model_.thick(), weight = near.area * flat.value;
    const Vec3 n = near.apart / near.distance;
    const Vec3 rate =
        moves() ? sum(near, [&](std::uint32_t v) { return surface_.velocity(v); }) : Vec3::Zero();
    const Normal normal = push_of(model_.law, weight, gap, n, Mat3::Zero(), rate, Vec3::Zero());
    SelfResponse to{near,         gap, n,  normal.damped * normal.push * n, Vec3::Zero(), false, Vec3::Zero(),
                    Vec3::Zero(), {},  0.0};
    for (Vec3& force : to.by_angle) force.setZero();
    const double energy = model_.law.stiffness * potential(model_.law, gap).value;
    to.energy = weight * energy;
    if (flat.value < 1.0) {
      const Vec3 first = -near.area * energy * flat.by_first, second = -near.area * energy * flat.by_second;
      to.by_angle = {-first, first, -second, second};
    }
    if (model_.law.friction > 0.0 && kept_ && normal.push > 0.0) add_friction(normal, weight, rate, to);
    out_.all.push_back(to);
  }
  bool moves() const { return model_.law.damping > 0.0 || model_.law.stick_damping > 0.0; }
  template <class Of>
  static Vec3 sum(const SelfNear& near, Of&& of) {
    Vec3 result = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) result += near.weight[i] * of(near.vertex[i]);
    return result;
  }

  /// Coulomb's law as for rods that meet each other.
  void add_friction(const Normal& normal, double weight, const Vec3& rate, SelfResponse& to) {
    const Law& law = model_.law;
    const Vec3 n = to.normal;
    const auto along = [&](const Vec3& y) -> Vec3 { return y - n.dot(y) * n; };
    const double k = weight * stick_of(law), most = law.friction * normal.damped * normal.push;
    to.slid = to.at.apart - sum(to.at, [&](std::uint32_t v) { return surface_.before(v); });
    const SelfMeeting* met = meeting(to.at);
    const Vec3 u = along(met ? Vec3(met->apart + to.slid) : to.slid), s = u + law.stick_damping * along(rate);
    to.sticks = k * s.norm() <= most;
    to.friction = -(to.sticks ? k : most / s.norm()) * s;
    const double far = kTrail * most / k;
    to.apart = !to.sticks && u.norm() > far ? Vec3(far * u.normalized()) : u;
    to.force += to.friction;
  }

  /// A vertex that slid over an edge meets another face: it is the same contact.
  const SelfMeeting* meeting(const SelfNear& near) const {
    const SelfMeeting* met = find_key(kept_->meetings, near.key);
    if (met || near.of_first == 2) return met;
    const std::uint64_t vertex = near.key >> 32;
    const auto from = std::lower_bound(kept_->meetings.begin(), kept_->meetings.end(), vertex << 32,
                                       [](const SelfMeeting& a, std::uint64_t key) { return a.key < key; });
    return from != kept_->meetings.end() && from->key >> 32 == vertex ? &*from : nullptr;
  }

  struct Counted {
    Place place;
    double times;
  };
  struct Shared {
    std::uint32_t edge;
    std::size_t hit, side;
    auto operator<=>(const Shared&) const = default;
  };

  const SelfModel& model_;
  const SelfMesh& mesh_;
  PosedSelf& surface_;
  const SelfLedger* kept_;
  double far_ = 0.0;
  SelfMeetings out_;
  std::vector<Hit> hits_;
  std::vector<std::pair<SelfNear, Flatness>> edges_;
  std::vector<Counted> counted_;
  std::vector<Shared> shared_;
  std::vector<std::pair<std::uint32_t, double>> extra_;
};

}  // namespace

SelfMeetings meetings_of(const SelfModel& model, PosedSelf& surface, const SelfLedger* kept) {
  return SelfTouches(model, surface, kept).run();
}

SelfMeetings meetings_of(const SelfModel& model, PosedSelf& surface, const SelfLedger* kept,
                         const SelfPairs& pairs) {
  return SelfTouches(model, surface, kept).run(pairs);
}

}  // namespace tendril::contact
