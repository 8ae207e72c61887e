#include <tendril/collision/box_tree.h>

#include <utility>

#include "self_model.h"

namespace tendril::contact {
namespace {

using collision::Box;

/// So often a direction is mended in which two patches are apart.
constexpr int kRounds = 8;
constexpr double kCloseEnough = 1.02;

Box widened(Box box, double by) {
  return {box.low - Vec3::Constant(by), box.high + Vec3::Constant(by)};
}

/// Fills a list: parts by their boxes, patches of two parts by theirs, then by what is about their corners.
class SelfSearch {
 public:
  SelfSearch(const SelfModel& model, std::span<const Vec3> at, SelfList& list)
      : model_(model), mesh_(model.mesh), at_(at), list_(list) {}

  void run() {
    std::vector<Box> wide;
    for (const SelfPatch& patch : mesh_.patches) {
      boxes_.push_back(box_of(patch.corners, at_));
      margin_.push_back(model_.of_patch(static_cast<std::uint32_t>(margin_.size()), list_.margin));
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
    sort_by_rod();
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

  /// Patches that have a place in common have no distance by their corners.
  void look(std::uint32_t p, std::uint32_t q) {
    const Vec3 gap = (boxes_[p].low - boxes_[q].high).cwiseMax(boxes_[q].low - boxes_[p].high).cwiseMax(0.0);
    if (gap.norm() > far(p, q) * (1.0 + 1e-9)) return;
    const double apart = p == q ? 0.0 : distance(mesh_.patches[p], mesh_.patches[q], far(p, q));
    if (!(apart > far(p, q))) list_.groups.push_back({p, q, apart - model_.meets()});
  }

  /// How far the second lies behind the first along n, and the corners that say so.
  struct Along {
    double apart;
    Vec3 from, to;
  };
  Along along(const SelfPatch& first, const SelfPatch& second, const Vec3& n) const {
    Along result{0.0, Vec3::Zero(), Vec3::Zero()};
    const Vec3 origin = at_[first.corners[0]];
    double low = kInfinite, high = -kInfinite, size = 0.0;
    for (const std::uint32_t v : first.corners) {
      const double at = n.dot(at_[v] - origin);
      if (at < low) low = at, result.to = at_[v];
    }
    for (const std::uint32_t v : second.corners) {
      const double at = n.dot(at_[v] - origin);
      size = std::max(size, std::abs(at));
      if (at > high) high = at, result.from = at_[v];
    }
    result.apart = low - high - 1e-14 * (size + std::abs(low));
    return result;
  }
  Vec3 normal(const SelfPatch& patch) const {
    const auto& [a, b, c] = model_.surface.triangles[patch.faces[patch.faces.size() / 2]];
    return (at_[b] - at_[a]).cross(at_[c] - at_[a]).stableNormalized();
  }

  /// A lower bound on the distance of two patches: by how much a plane across some direction parts them.
  /// Tried are their normals, as boxes about what is flat and aslant hold much besides; then the direction
  /// from the point of the hull of all differences that is known to be nearest to 0, which moves towards
  /// each round's support point [Gilbert 1966].
  /// \param enough  more need not be known
  double distance(const SelfPatch& first, const SelfPatch& second, double enough) const {
    double best = 0.0;
    Vec3 between = middle(first, at_) - middle(second, at_);
    for (const SelfPatch* patch : {&first, &second}) {
      const Vec3 n = normal(*patch);
      best = std::max(best, along(first, second, n.dot(between) < 0.0 ? Vec3(-n) : n).apart);
      if (best > enough) return best;
    }
    for (int round = 0; round < kRounds && best <= enough; ++round) {
      const double length = between.norm();
      if (!(length > best * kCloseEnough)) break;
      const Along here = along(first, second, between / length);
      best = std::max(best, here.apart);
      const Vec3 way = here.to - here.from - between;
      const double square = way.squaredNorm();
      if (!(square > 0.0)) break;
      between += std::clamp(-between.dot(way) / square, 0.0, 1.0) * way;
    }
    return best;
  }

  void sort_by_rod() {
    std::vector<std::vector<std::uint32_t>> of(model_.rods());
    for (std::uint32_t g = 0; g < list_.groups.size(); ++g)
      for (const std::uint32_t patch : {list_.groups[g].p, list_.groups[g].q})
        for (const std::uint32_t rod : model_.rods_of[patch])
          if (of[rod].empty() || of[rod].back() != g) of[rod].push_back(g);
    list_.begin.push_back(0);
    for (const auto& groups : of) {
      list_.of_rod.insert(list_.of_rod.end(), groups.begin(), groups.end());
      list_.begin.push_back(list_.of_rod.size());
    }
  }

  const SelfModel& model_;
  const SelfMesh& mesh_;
  std::span<const Vec3> at_;
  SelfList& list_;
  std::vector<Box> boxes_;
  std::vector<Resting> rest_;
  std::vector<double> margin_;  ///< per patch
};

}  // namespace

std::shared_ptr<const SelfList> SelfModel::search(std::span<const Vec3> at,
                                                  std::vector<double> margin) const {
  auto list = std::make_shared<SelfList>();
  list->margin = std::move(margin);
  SelfSearch(*this, at, *list).run();
  return list;
}

}  // namespace tendril::contact
