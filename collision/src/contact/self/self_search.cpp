#include <tendril/collision/box_tree.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "float_boxes.h"
#include "posed_sets.h"
#include "self_model.h"

namespace tendril::contact {
namespace {

using collision::Box;

/// So often a direction is mended in which two patches are apart, or two parts; these are left for some lists
/// where that did not do.
constexpr int kRounds = 8, kPartRounds = 4, kPartWait = 8;
constexpr double kCloseEnough = 1.1;

/// Fills a list: parts by their boxes, then by planes, patches of two parts likewise.
/// What goes straight from one end of its way to another is apart all the way from what it is apart from at
/// both ends, on the same side.
class SelfSearch {
 public:
  /// \param before  a list of before; null where there is none
  SelfSearch(const SelfModel& model, std::span<const Vec3> at, std::span<const Vec3> after,
             const SelfList* before, SelfList& list)
      : model_(model),
        mesh_(model.mesh),
        at_(at),
        after_(after),
        before_(before),
        list_(list),
        parts_(mesh_.corners_of_parts, at, after),
        patches_(mesh_.corners_of_patches, at, after),
        open_(mesh_.corners_of_parts.size(), 0),
        normal_(mesh_.patches.size()) {
    wide_.resize(mesh_.patches.size(), ends());
    parts_.take(0, open_.size());
    for (std::uint32_t p = 0; p < mesh_.patches.size(); ++p)
      margin_.push_back(model_.of_patch(p, list_.margin));
    for (std::size_t part = 0; part < open_.size(); ++part) {
      of_part_.push_back(*std::max_element(margin_.begin() + mesh_.part_begin[part],
                                           margin_.begin() + mesh_.part_begin[part + 1]));
      around_.emplace_back();
      for (std::size_t end = 0; end < ends(); ++end)
        around_.back().push_back(wide(parts_.box(part, end), of_part_[part]));
    }
  }

  void run() {
    // In an order of their own, not of the trees: sums over groups are the same whatever the boxes were.
    for (const auto& [a, b] : meeting_parts())
      if (!parted(a, b)) look_between(a, b);
    if (model_.which == Meets::all) look_within_parts();
    sort_by_rod();
  }

 private:
  /// Where a patch rests, and the rotation that its first face has made since.
  struct Resting {
    Vec3 centre;
    double radius;
    Mat3 turned;  ///< zero where a face has no area
  };

  std::size_t ends() const { return parts_.ends(); }
  /// What may come near something in the box, that strays by the margin.
  Box wide(const Box& box, double margin) const {
    const Vec3 by = Vec3::Constant(0.5 * model_.meets() + margin);
    return {box.low - by, box.high + by};
  }
  /// Patches of a part that is looked into.
  void open(std::uint32_t part) {
    if (std::exchange(open_[part], 1)) return;
    const std::uint32_t first = mesh_.part_begin[part], last = mesh_.part_begin[part + 1];
    patches_.take(first, last);
    for (std::uint32_t p = first; p < last; ++p) {
      normal_[p] = normal(p);
      for (std::size_t end = 0; end < ends(); ++end)
        wide_.take(p, end, wide(patches_.box(p, end), margin_[p]));
    }
  }
  /// How far two are apart all the way, at least, along each axis.
  /// \param a, b  give the box at an end
  Vec3 gap(const auto& a, const auto& b) const {
    Vec3 before = Vec3::Constant(kInfinite), behind = before;
    for (std::size_t end = 0; end < ends(); ++end) {
      before = before.cwiseMin(b(end).low - a(end).high);
      behind = behind.cwiseMin(a(end).low - b(end).high);
    }
    return before.cwiseMax(behind).cwiseMax(0.0);
  }
  using Indices = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Indices> meeting_parts() const {
    std::vector<Box> boxes;
    for (const std::vector<Box>& part : around_) boxes.push_back(collision::join(part.front(), part.back()));
    const auto of = [&](std::size_t part) {
      return [&, part](std::size_t end) -> const Box& { return around_[part][end]; };
    };
    const collision::BoxTree tree(boxes);
    std::vector<Indices> pairs;
    tree.pairs(tree, [&](std::size_t a, std::size_t b) {
      if (a < b && !(gap(of(a), of(b)).maxCoeff() > 0.0)) pairs.emplace_back(a, b);
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }
  /// What the last list knows of two parts.
  PartedParts known(std::uint32_t a, std::uint32_t b) const {
    if (before_) {
      const std::vector<PartedParts>& all = before_->parts;
      const auto at =
          std::lower_bound(all.begin(), all.end(), Indices(a, b),
                           [](const PartedParts& x, const Indices& key) { return Indices(x.a, x.b) < key; });
      if (at != all.end() && at->a == a && at->b == b) return *at;
    }
    return {a, b, {}, 0};
  }
  /// Whether a plane parts two parts: nearly always one that did before. Where none did, it is some lists
  /// until one is sought again.
  bool parted(std::uint32_t a, std::uint32_t b) {
    PartedParts now = known(a, b);
    bool apart = false;
    if (now.wait > 0) {
      --now.wait;
    } else {
      const double far = model_.meets() + of_part_[a] + of_part_[b];
      const auto midst = [&](std::uint32_t part) {
        return (mesh_.part_begin[part] + mesh_.part_begin[part + 1]) / 2;
      };
      const auto normals = [&] { return std::array{normal(midst(a)), normal(midst(b))}; };
      apart = distance(parts_, a, b, normals, kPartRounds, far, now.across).least() > far;
      if (!apart) now = {a, b, {}, kPartWait};
    }
    list_.parts.push_back(now);
    return apart;
  }
  /// Patches of two parts, where both are.
  void look_between(std::uint32_t a, std::uint32_t b) {
    open(a);
    open(b);
    wide_.meeting(around_[b], mesh_.part_begin[a], mesh_.part_begin[a + 1], of_first_);
    if (of_first_.empty()) return;
    wide_.meeting(around_[a], mesh_.part_begin[b], mesh_.part_begin[b + 1], of_second_);
    some_.take(wide_, of_second_);
    // What parts two patches parts their neighbours as well, nearly always.
    Direction across{};
    for (const std::uint32_t p : of_first_) {
      some_.meeting(wide_, p, near_);
      for (const std::uint32_t k : near_) look(p, of_second_[k], across);
    }
  }
  void look_within_parts() {
    for (std::uint32_t part = 0; part < open_.size(); ++part) open(part);
    for (const std::span<const Vec3> at : {at_, after_}) {
      rest_.emplace_back();
      for (const SelfPatch& patch : mesh_.patches) rest_.back().push_back(resting(patch, at));
    }
    std::vector<Box> boxes;
    for (std::uint32_t p = 0; p < margin_.size(); ++p)
      boxes.push_back(wide(collision::join(patches_.box(p, 0), patches_.box(p, ends() - 1)), margin_[p]));
    std::vector<Indices> near;
    const collision::BoxTree tree(boxes);
    tree.pairs(tree, [&](std::size_t a, std::size_t b) {
      const auto p = static_cast<std::uint32_t>(a), q = static_cast<std::uint32_t>(b);
      if (p <= q && mesh_.patches[p].part == mesh_.patches[q].part && !keeps_apart(p, q))
        near.emplace_back(p, q);
    });
    std::sort(near.begin(), near.end());
    Direction across{};
    for (const auto& [p, q] : near) look(p, q, across);
  }
  void look(std::uint32_t p, std::uint32_t q, Direction& across) {
    const double far = this->far(p, q);
    const auto of = [&](std::uint32_t patch) {
      return [&, patch](std::size_t end) -> const Box& { return patches_.box(patch, end); };
    };
    if (gap(of(p), of(q)).squaredNorm() > far * far * (1.0 + 1e-9)) return;
    const auto normals = [&] { return std::array{normal_[p], normal_[q]}; };
    const Parted parted = p == q ? Parted{} : distance(patches_, p, q, normals, kRounds, far, across);
    if (!(parted.least() > far))
      list_.groups.push_back({p, q, parted.at - model_.meets(), parted.after - model_.meets()});
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
  Resting resting(const SelfPatch& patch, std::span<const Vec3> at) const {
    const Box box = box_of(patch.corners, model_.surface.rest);
    const auto& [a, b, c] = model_.surface.triangles[patch.faces[patch.faces.size() / 2]];
    const auto& rest = model_.surface.rest;
    const Mat3 turned = axes(at[a], at[b], at[c]) * axes(rest[a], rest[b], rest[c]).transpose();
    return {0.5 * (box.low + box.high), 0.5 * (box.high - box.low).norm(), turned};
  }

  /// Of two patches of one part: all rest so near each other that they are left out; or, as good as in one
  /// piece, x = A X + b up to e, and so |x - y| >= |X - Y| - 2 e, with |X - Y| at least what is not left out.
  /// On the way from A to B, turned by an angle against it, the mean of both shortens by its half's cosine.
  bool keeps_apart(std::size_t p, std::size_t q) const {
    const SelfPatch &first = mesh_.patches[p], &second = mesh_.patches[q];
    if (first.part != second.part) return false;
    const Resting &a = rest_[0][p], &b = rest_[0][q], &c = rest_[1][p];
    const double least = 1.5 * model_.meets();
    if ((a.centre - b.centre).norm() + a.radius + b.radius < least) return true;
    const double shorter = std::sqrt(std::max(0.0, 1.0 - (c.turned - a.turned).squaredNorm() / 8.0));
    const double room = shorter * least_left(first, second) - far(p, q);
    const auto follow = [&](const Resting& end, std::span<const Vec3> at) {
      return end.turned.determinant() > 0.5 && strays(first, second, end, at) < 0.5 * room;
    };
    return room > 0.0 && follow(a, at_) && follow(c, after_);
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
  double strays(const SelfPatch& first, const SelfPatch& second, const Resting& about,
                std::span<const Vec3> at) const {
    const Vec3 now = middle(first, at), rest = middle(first, model_.surface.rest);
    double most = 0.0;
    for (const SelfPatch* patch : {&first, &second})
      for (const std::uint32_t v : patch->corners) {
        const Vec3 carried = about.turned * (model_.surface.rest[v] - rest);
        most = std::max(most, (at[v] - now - carried).squaredNorm());
      }
    return std::sqrt(most);
  }
  static Vec3 middle(const SelfPatch& patch, std::span<const Vec3> at) {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t v : patch.corners) sum += at[v];
    return sum / static_cast<double>(patch.corners.size());
  }

  /// Halfway.
  Vec3 normal(std::uint32_t patch) const {
    const std::array<std::uint32_t, 3>& corner = mesh_.amidst[patch];
    const auto twice = [&](std::size_t i) { return Vec3(at_[corner[i]] + after_[corner[i]]); };
    const Vec3 from = twice(0);
    return (twice(1) - from).cross(twice(2) - from).stableNormalized();
  }

  /// How far a plane parts two sets at the beginning and the end of their ways.
  struct Parted {
    double at = 0.0, after = 0.0;
    double least() const { return std::min(at, after); }
  };
  /// A lower bound on the distance of two sets: by how much a plane across some direction parts them.
  /// Sets that have a place in common have none by their corners. Tried are a direction that is given,
  /// and their normals, as boxes about what is flat and aslant hold much besides; then the direction
  /// from the point of the hull of all differences that is known to be nearest to 0, which moves towards
  /// each round's support point [Gilbert 1966].
  /// \param enough  more need not be known
  /// \param across  0, or one to try first; that of the best
  Parted distance(const PosedSets& sets, std::uint32_t p, std::uint32_t q, auto&& normals, int rounds,
                  double enough, Direction& across) const {
    if (across != Direction{} && sets.part(p, q, across, enough)) return {kInfinite, kInfinite};
    Parted best;
    const auto look = [&](const Vec3& n) {
      const Direction direction{static_cast<float>(n.x()), static_cast<float>(n.y()),
                                static_cast<float>(n.z())};
      const PosedSets::Along here = sets.along(p, q, direction, 0);
      const PosedSets::Along there = ends() == 1 ? here : sets.along(p, q, direction, 1);
      const Parted now{here.apart, there.apart};
      if (now.least() > best.least()) best = now, across = direction;
      return now.at < now.after ? here.way : there.way;
    };
    Vec3 between = sets.middle(p) - sets.middle(q);
    for (const Vec3& n : normals()) {
      look(n.dot(between) < 0.0 ? Vec3(-n) : n);
      if (best.least() > enough) return best;
    }
    between = look(between.stableNormalized());
    for (int round = 0; round < rounds && best.least() <= enough; ++round) {
      const double length = between.norm();
      if (!(length > best.least() * kCloseEnough)) break;
      const Vec3 way = look(between / length) - between;
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
  std::span<const Vec3> at_, after_;
  const SelfList* before_;
  SelfList& list_;
  PosedSets parts_, patches_;
  std::vector<char> open_;                ///< per part: its patches are known
  std::vector<Vec3> normal_;              ///< of patches that are known
  std::vector<double> margin_;            ///< per patch
  std::vector<double> of_part_;           ///< per part, the largest
  std::vector<std::vector<Box>> around_;  ///< per part, at the ends, with these
  std::vector<std::vector<Resting>> rest_;
  FloatBoxes wide_;  ///< of all patches, with their margins
  // Of the pair of parts that is looked at: patches where both are, and boxes of the second's.
  FloatBoxes some_;
  std::vector<std::uint32_t> of_first_, of_second_, near_;
};

}  // namespace

void SelfModel::search(std::span<const Vec3> at, std::span<const Vec3> after, const SelfList* before,
                       SelfList& list) const {
  SelfSearch(*this, at, after, before, list).run();
}

}  // namespace tendril::contact
