#include <tendril/collision/box_tree.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "float_boxes.h"
#include "patch_points.h"
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
/// What goes straight from one end of its way to another is apart all the way from what it is apart from at
/// both ends, on the same side.
class SelfSearch {
 public:
  SelfSearch(const SelfModel& model, std::span<const Vec3> at, std::span<const Vec3> after, SelfList& list)
      : model_(model), mesh_(model.mesh), at_(at), after_(after), list_(list) {
    points_.emplace_back(mesh_, at);
    if (at.data() != after.data()) points_.emplace_back(mesh_, after);
  }

  void run() {
    for (std::uint32_t p = 0; p < mesh_.patches.size(); ++p)
      margin_.push_back(model_.of_patch(p, list_.margin));
    std::vector<std::vector<Box>> wide;
    for (const PatchPoints& points : points_) {
      wide.emplace_back();
      for (std::uint32_t p = 0; p < margin_.size(); ++p)
        wide.back().push_back(widened(points.box(p), 0.5 * model_.meets() + margin_[p]));
    }
    const std::vector<Part> parts = parts_of(wide);
    wide_.take(wide);
    // In an order of their own, not of the trees: sums over groups are the same whatever the boxes were.
    for (const auto& [a, b] : meeting_parts(parts)) look_between(parts[a], parts[b]);
    if (model_.which == Meets::all) look_within_parts(wide);
    sort_by_rod();
  }

 private:
  /// Where a patch rests, and the rotation that its first face has made since.
  struct Resting {
    Vec3 centre;
    double radius;
    Mat3 turned;  ///< zero where a face has no area
  };

  /// What is connected: patches [begin, end), which follow each other.
  struct Part {
    std::uint32_t begin, end;
    std::vector<Box> boxes;  ///< at the ends
  };
  /// How far two are apart all the way, at least, along each axis.
  /// \param a, b  give the box at an end
  Vec3 gap(const auto& a, const auto& b) const {
    Vec3 before = Vec3::Constant(kInfinite), behind = before;
    for (std::size_t end = 0; end < points_.size(); ++end) {
      before = before.cwiseMin(b(end).low - a(end).high);
      behind = behind.cwiseMin(a(end).low - b(end).high);
    }
    return before.cwiseMax(behind).cwiseMax(0.0);
  }
  static Box all_the_way(const std::vector<Box>& boxes) {
    return collision::join(boxes.front(), boxes.back());
  }

  std::vector<Part> parts_of(const std::vector<std::vector<Box>>& wide) const {
    std::vector<Part> parts;
    for (std::uint32_t p = 0; p < margin_.size(); ++p) {
      const bool first = p == 0 || mesh_.patches[p].part != mesh_.patches[p - 1].part;
      if (first) parts.push_back({p, p, {}});
      Part& part = parts.back();
      part.end = p + 1;
      for (std::size_t end = 0; end < wide.size(); ++end)
        if (first)
          part.boxes.push_back(wide[end][p]);
        else
          part.boxes[end] = collision::join(part.boxes[end], wide[end][p]);
    }
    return parts;
  }
  using Indices = std::pair<std::uint32_t, std::uint32_t>;
  static std::vector<Indices> meeting_parts(const std::vector<Part>& parts) {
    std::vector<Box> boxes;
    for (const Part& part : parts) boxes.push_back(all_the_way(part.boxes));
    const collision::BoxTree tree(boxes);
    std::vector<Indices> pairs;
    tree.pairs(tree, [&](std::size_t a, std::size_t b) {
      if (a < b) pairs.emplace_back(a, b);
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }
  /// Patches of two parts, where both are.
  void look_between(const Part& a, const Part& b) {
    const auto of = [](const Part& part) {
      return [&](std::size_t end) -> const Box& { return part.boxes[end]; };
    };
    if (gap(of(a), of(b)).maxCoeff() > 0.0) return;
    wide_.meeting(b.boxes, a.begin, a.end, of_first_);
    if (of_first_.empty()) return;
    wide_.meeting(a.boxes, b.begin, b.end, of_second_);
    some_.take(wide_, of_second_);
    // What parts two patches parts their neighbours as well, nearly always.
    Direction across{};
    for (const std::uint32_t p : of_first_) {
      some_.meeting(wide_, p, near_);
      for (const std::uint32_t k : near_) look(p, of_second_[k], across);
    }
  }
  void look_within_parts(const std::vector<std::vector<Box>>& wide) {
    for (const std::span<const Vec3> at : {at_, after_}) {
      rest_.emplace_back();
      for (const SelfPatch& patch : mesh_.patches) rest_.back().push_back(resting(patch, at));
    }
    std::vector<Box> boxes;
    for (std::size_t p = 0; p < margin_.size(); ++p)
      boxes.push_back(collision::join(wide.front()[p], wide.back()[p]));
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
      return [&, patch](std::size_t end) -> const Box& { return points_[end].box(patch); };
    };
    if (gap(of(p), of(q)).squaredNorm() > far * far * (1.0 + 1e-9)) return;
    const Parted parted = p == q ? Parted{} : distance(p, q, far, across);
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
    const auto& [a, b, c] = mesh_.amidst[patch];
    const auto side = [&](std::uint32_t to) { return Vec3(at_[to] - at_[a] + after_[to] - after_[a]); };
    return side(b).cross(side(c)).stableNormalized();
  }

  /// How far a plane parts two patches at the beginning and the end of their ways.
  struct Parted {
    double at = 0.0, after = 0.0;
    double least() const { return std::min(at, after); }
  };
  /// A lower bound on the distance of two patches: by how much a plane across some direction parts them.
  /// Patches that have a place in common have none by their corners. Tried are a direction that is given,
  /// and their normals, as boxes about what is flat and aslant hold much besides; then the direction
  /// from the point of the hull of all differences that is known to be nearest to 0, which moves towards
  /// each round's support point [Gilbert 1966].
  /// \param enough  more need not be known
  /// \param across  0, or one to try first; that of the best
  Parted distance(std::uint32_t p, std::uint32_t q, double enough, Direction& across) const {
    const auto parts_far = [&](const PatchPoints& points) { return points.apart(p, q, across) > enough; };
    if (across != Direction{} && std::all_of(points_.begin(), points_.end(), parts_far))
      return {kInfinite, kInfinite};
    Parted best;
    Vec3 between = points_.front().middle(p) - points_.front().middle(q) + points_.back().middle(p) -
                   points_.back().middle(q);
    const auto look = [&](const Vec3& n) {
      const Direction direction{static_cast<float>(n.x()), static_cast<float>(n.y()),
                                static_cast<float>(n.z())};
      const PatchPoints::Along here = points_.front().along(p, q, direction);
      if (points_.size() == 1) {
        if (here.apart > best.least()) best = {here.apart, here.apart}, across = direction;
        return Vec3(at_[here.of_p] - at_[here.of_q]);
      }
      const PatchPoints::Along there = points_.back().along(p, q, direction);
      const Parted now{here.apart, there.apart};
      if (now.least() > best.least()) best = now, across = direction;
      return Vec3(now.at < now.after ? at_[here.of_p] - at_[here.of_q]
                                     : after_[there.of_p] - after_[there.of_q]);
    };
    for (const std::uint32_t patch : {p, q}) {
      const Vec3 n = normal(patch);
      look(n.dot(between) < 0.0 ? Vec3(-n) : n);
      if (best.least() > enough) return best;
    }
    between = look(between.stableNormalized());
    for (int round = 0; round < kRounds && best.least() <= enough; ++round) {
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
  SelfList& list_;
  std::vector<PatchPoints> points_;  ///< at both ends, where they are two
  std::vector<double> margin_;       ///< per patch
  std::vector<std::vector<Resting>> rest_;
  FloatBoxes wide_;  ///< of all patches, with their margins
  // Of the pair of parts that is looked at: patches where both are, and boxes of the second's.
  FloatBoxes some_;
  std::vector<std::uint32_t> of_first_, of_second_, near_;
};

}  // namespace

void SelfModel::search(std::span<const Vec3> at, std::span<const Vec3> after, SelfList& list) const {
  SelfSearch(*this, at, after, list).run();
}

}  // namespace tendril::contact
