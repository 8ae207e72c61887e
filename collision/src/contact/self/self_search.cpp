#include <tendril/collision/box_tree.h>

#include <utility>

#include "contact/foot.h"
#include "self_model.h"

namespace tendril::contact {
namespace {

using collision::Box;

Box widened(Box box, double by) {
  return {box.low - Vec3::Constant(by), box.high + Vec3::Constant(by)};
}

/// Fills a list: parts by their boxes, patches of two parts by theirs, then pairs. What depends on the rest
/// alone is asked for anew each time: to keep it for all pairs that rest near would take more room than the
/// mesh.
class SelfSearch {
 public:
  SelfSearch(const SelfModel& model, std::span<const Vec3> at, SelfList& list)
      : model_(model), mesh_(model.mesh), at_(at), list_(list), of_group_(at.size(), 0) {}

  void run() {
    std::vector<Box> wide;
    for (const SelfPatch& patch : mesh_.patches) {
      boxes_.push_back(box_of(patch.corners, at_));
      margin_.push_back(model_.of_patch(static_cast<std::uint32_t>(boxes_.size() - 1), list_.margin));
      wide.push_back(widened(boxes_.back(), 0.5 * model_.meets() + margin_.back()));
      if (model_.which == Meets::all) rest_.push_back(resting(patch));
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> near;
    const auto take = [&](std::uint32_t a, std::uint32_t b) {
      if (a > b) std::swap(a, b);
      if (wide[a].meets(wide[b]) && !keeps_apart(a, b)) near.emplace_back(a, b);
    };
    const std::vector<Part> parts = parts_of(wide);
    std::vector<Box> part_boxes;
    for (const Part& part : parts) part_boxes.push_back(part.box);
    const collision::BoxTree tree(part_boxes);
    tree.pairs(tree, [&](std::size_t a, std::size_t b) {
      if (a < b) look_for_patches(parts[a], parts[b], wide, take);
    });
    if (model_.which == Meets::all) {
      const collision::BoxTree all(wide);
      all.pairs(all, [&](std::size_t a, std::size_t b) {
        const auto p = static_cast<std::uint32_t>(a), q = static_cast<std::uint32_t>(b);
        if (p <= q && mesh_.patches[p].part == mesh_.patches[q].part) take(p, q);
      });
    }
    // In an order of their own, not of the trees: sums over groups are the same whatever the boxes were.
    std::sort(near.begin(), near.end());
    for (const auto& [p, q] : near) look(p, q);
    number_members();
  }

 private:
  /// Where a patch rests, and the rotation that its first face has made since.
  struct Resting {
    Vec3 centre;
    double radius;
    Mat3 turned;  ///< zero where a face has no area
  };

  /// What is connected: patches [begin, end).
  struct Part {
    std::uint32_t begin, end;
    Box box;
  };
  /// Patches of a part follow each other.
  std::vector<Part> parts_of(const std::vector<Box>& wide) const {
    std::vector<Part> parts;
    for (std::uint32_t p = 0; p < wide.size(); ++p) {
      if (p == 0 || mesh_.patches[p].part != mesh_.patches[p - 1].part) parts.push_back({p, p, wide[p]});
      parts.back().end = p + 1;
      parts.back().box = collision::join(parts.back().box, wide[p]);
    }
    return parts;
  }
  template <class Take>
  static void look_for_patches(const Part& a, const Part& b, const std::vector<Box>& wide, Take&& take) {
    std::vector<std::uint32_t> of_b;
    for (std::uint32_t q = b.begin; q < b.end; ++q)
      if (wide[q].meets(a.box)) of_b.push_back(q);
    for (std::uint32_t p = a.begin; p < a.end; ++p) {
      if (!wide[p].meets(b.box)) continue;
      for (const std::uint32_t q : of_b) take(p, q);
    }
  }
  static Box box_of(std::span<const std::uint32_t> vertices, std::span<const Vec3> at) {
    Box box{at[vertices[0]], at[vertices[0]]};
    for (const std::uint32_t v : vertices) {
      box.low = box.low.cwiseMin(at[v]);
      box.high = box.high.cwiseMax(at[v]);
    }
    return box;
  }
  static Mat3 axes(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 x = (b - a).stableNormalized(), z = x.cross(c - a).stableNormalized();
    Mat3 m;
    m << x, z.cross(x), z;
    return m;
  }
  Resting resting(const SelfPatch& patch) const {
    const Box box = box_of(patch.corners, model_.surface.rest);
    const auto& [a, b, c] = model_.surface.triangles[patch.faces[patch.faces.size() / 2]];
    const auto& rest = model_.surface.rest;
    const Mat3 turned = axes(at_[a], at_[b], at_[c]) * axes(rest[a], rest[b], rest[c]).transpose();
    return {0.5 * (box.low + box.high), 0.5 * (box.high - box.low).norm(), turned};
  }

  /// Of two patches of one part: all rest so near each other that they are left out; or, as good as in one
  /// piece, x = A X + b up to e, and so |x - y| >= |X - Y| - 2 e, with |X - Y| at least what is not left out.
  bool keeps_apart(std::size_t p, std::size_t q) const {
    const SelfPatch &first = mesh_.patches[p], &second = mesh_.patches[q];
    if (first.part != second.part) return false;
    const Resting &a = rest_[p], &b = rest_[q];
    const double least = 1.5 * model_.meets();
    if ((a.centre - b.centre).norm() + a.radius + b.radius < least) return true;
    const double room = least_left(first, second) - far(p, q);
    return room > 0.0 && a.turned.determinant() > 0.5 && strays(first, second, a) < 0.5 * room;
  }
  double far(std::size_t p, std::size_t q) const { return model_.meets() + margin_[p] + margin_[q]; }
  /// What two places of the patches that are not left out rest apart at least.
  double least_left(const SelfPatch& first, const SelfPatch& second) const {
    const auto least = [&](const SelfPatch& patch) {
      double side = kInfinite;
      for (const std::uint32_t f : patch.faces) side = std::min(side, mesh_.face_longest[f]);
      return side;
    };
    return model_.left_out(least(first), least(second));
  }
  /// How far vertices are from where the first patch's rotation about its middle would have them.
  double strays(const SelfPatch& first, const SelfPatch& second, const Resting& about) const {
    const Vec3 now = middle(first, at_), rest = middle(first, model_.surface.rest);
    double most = 0.0;
    for (const SelfPatch* patch : {&first, &second})
      for (const std::uint32_t v : patch->corners) {
        const Vec3 carried = about.turned * (model_.surface.rest[v] - rest);
        most = std::max(most, (at_[v] - now - carried).squaredNorm());
      }
    return std::sqrt(most);
  }
  static Vec3 middle(const SelfPatch& patch, std::span<const Vec3> at) {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t v : patch.corners) sum += at[v];
    return sum / static_cast<double>(patch.corners.size());
  }

  void look(std::uint32_t p, std::uint32_t q) {
    const SelfPatch &first = mesh_.patches[p], &second = mesh_.patches[q];
    far_ = far(p, q);
    if (p != q && (parted_across(first, second) || parted_across(second, first))) return;
    same_part_ = first.part == second.part;
    slack_ = kInfinite;
    const std::size_t faces = list_.faces.size(), edges = list_.edges.size();
    faces_of(first, second, boxes_[q]);
    if (p != q) faces_of(second, first, boxes_[p]);
    edges_of(near_box(first, boxes_[q]), p == q ? first.edges : near_box(second, boxes_[p]), p == q);
    if (list_.faces.size() == faces && list_.edges.size() == edges) return;
    gather_members(faces, edges);
    list_.groups.push_back(
        {p, q, list_.faces.size(), list_.edges.size(), list_.members.size(), slack_ - model_.meets()});
  }

  /// Across the middle face of the first: boxes about what is flat and aslant hold much besides.
  bool parted_across(const SelfPatch& first, const SelfPatch& second) const {
    const auto& [a, b, c] = model_.surface.triangles[first.faces[first.faces.size() / 2]];
    const Vec3 n = (at_[b] - at_[a]).cross(at_[c] - at_[a]).stableNormalized();
    double low = kInfinite, high = -kInfinite, other_low = kInfinite, other_high = -kInfinite;
    for (const std::uint32_t v : first.corners) {
      const double at = n.dot(at_[v]);
      low = std::min(low, at), high = std::max(high, at);
    }
    for (const std::uint32_t v : second.corners) {
      const double at = n.dot(at_[v]);
      other_low = std::min(other_low, at), other_high = std::max(other_high, at);
    }
    const double enough = far_ * (1.0 + 1e-9);
    return other_low - high > enough || low - other_high > enough;
  }

  void gather_members(std::size_t faces, std::size_t edges) {
    for (; faces < list_.faces.size(); ++faces) {
      gather(list_.faces[faces].first);
      for (const std::uint32_t v : model_.surface.triangles[list_.faces[faces].second]) gather(v);
    }
    for (; edges < list_.edges.size(); ++edges)
      for (const std::uint32_t e : {list_.edges[edges].first, list_.edges[edges].second})
        for (const std::uint32_t v : mesh_.edges[e].end) gather(v);
  }
  void gather(std::uint32_t vertex) {
    std::uint32_t& last = of_group_[vertex];
    if (std::exchange(last, static_cast<std::uint32_t>(list_.groups.size() + 1)) <= list_.groups.size())
      list_.members.push_back(vertex);
  }

  void number_members() {
    std::vector<std::uint32_t> number(at_.size());
    for (std::uint32_t v = 0; v < at_.size(); ++v) {
      if (of_group_[v] == 0) continue;
      number[v] = static_cast<std::uint32_t>(list_.used.size());
      list_.used.push_back(v);
    }
    for (std::uint32_t& v : list_.members) v = number[v];
  }

  /// The vertices of one with the faces of the other.
  void faces_of(const SelfPatch& of, const SelfPatch& with, const Box& box) {
    const Box near = widened(box, far_);
    for (const std::uint32_t v : of.vertices) {
      if (!near.holds(at_[v])) continue;
      for (const std::uint32_t f : with.faces) {
        const auto& [a, b, c] = model_.surface.triangles[f];
        if (v == a || v == b || v == c || !beside(at_[v], {at_[a], at_[b], at_[c]}, far_)) continue;
        const double d = (at_[v] - foot_on({at_[a], at_[b], at_[c]}, at_[v]).point).norm();
        if (!(d <= far_) || (same_part_ && rests_near(v, f))) continue;
        slack_ = std::min(slack_, d);
        list_.faces.push_back({v, f});
        list_.slack.faces.push_back(d - model_.meets());
      }
    }
  }
  bool rests_near(std::uint32_t v, std::uint32_t f) const {
    const auto& [a, b, c] = model_.surface.triangles[f];
    const auto& rest = model_.surface.rest;
    const double d = (rest[v] - foot_on({rest[a], rest[b], rest[c]}, rest[v]).point).norm();
    return d < model_.left_out(mesh_.longest[v], mesh_.face_longest[f]);
  }

  std::vector<std::uint32_t> near_box(const SelfPatch& of, const Box& box) const {
    const Box near = widened(box, far_);
    std::vector<std::uint32_t> result;
    for (const std::uint32_t e : of.edges) {
      const Vec3 &a = at_[mesh_.edges[e].end[0]], &b = at_[mesh_.edges[e].end[1]];
      if (near.meets({a.cwiseMin(b), a.cwiseMax(b)})) result.push_back(e);
    }
    return result;
  }
  void edges_of(const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& second,
                bool same) {
    for (const std::uint32_t e : first)
      for (const std::uint32_t f : second) {
        if (same && f <= e) continue;
        const auto& [a, b] = mesh_.edges[e].end;
        const auto& [c, d] = mesh_.edges[f].end;
        if (a == c || a == d || b == c || b == d || !beside(at_[a], at_[b], at_[c], at_[d], far_)) continue;
        const double d_ef = distance(at_, e, f);
        if (!(d_ef <= far_) || (same_part_ && edges_rest_near(e, f))) continue;
        slack_ = std::min(slack_, d_ef);
        list_.edges.push_back({e, f});
        list_.slack.edges.push_back(d_ef - model_.meets());
      }
  }
  bool edges_rest_near(std::uint32_t e, std::uint32_t f) const {
    return distance(model_.surface.rest, e, f) <
           model_.left_out(mesh_.edges[e].longest, mesh_.edges[f].longest);
  }
  double distance(std::span<const Vec3> at, std::uint32_t e, std::uint32_t f) const {
    const auto& [a, b] = mesh_.edges[e].end;
    const auto& [c, d] = mesh_.edges[f].end;
    return apart(feet_of(at[a], at[b], at[c], at[d]), at[a], at[b], at[c], at[d]).norm();
  }

  const SelfModel& model_;
  const SelfMesh& mesh_;
  std::span<const Vec3> at_;
  SelfList& list_;
  std::vector<Box> boxes_;
  std::vector<Resting> rest_;
  std::vector<double> margin_;           ///< per patch
  std::vector<std::uint32_t> of_group_;  ///< per vertex: one more than the last group it was gathered for
  // Of the two patches that are looked at:
  double far_ = 0.0;  ///< how far from each other pairs may be
  bool same_part_ = false;
  double slack_ = 0.0;
};

}  // namespace

std::shared_ptr<const SelfList> SelfModel::search(SelfPose pose, std::span<const Vec3> at,
                                                  std::vector<double> margin) const {
  auto list = std::make_shared<SelfList>();
  list->pose = std::move(pose);
  list->margin = std::move(margin);
  SelfSearch(*this, at, *list).run();
  return list;
}

}  // namespace tendril::contact
