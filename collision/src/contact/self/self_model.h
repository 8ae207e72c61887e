#pragma once

#include <tendril/contact/surface_self_contact.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>

#include "contact/response.h"
#include "posed_sets.h"

namespace tendril::contact {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The way of a rod from where it was to where it will be, straight. What is bound to it is taken to go
/// straight, too (SpanWay). "Rods" are those of RodPoints::rods(), by their place among them.
struct RodWay {
  std::vector<Vec3> p, arm;                ///< masses, and orientation masses less them
  std::vector<Vec3> p_change, arm_change;  ///< in all
  std::vector<SpanWay> spans;              ///< its spans
  SpanShape worst;                         ///< of all of them
  double bow;                              ///< the largest
};

/// Two patches that may come near each other.
struct SelfGroup {
  std::uint32_t p, q;
  /// Their distance less that where response begins, or less, at the beginning and the end of their ways: of
  /// a plane that parts them at both, each recedes evenly, or its nearest corner faster.
  double slack, slack_after;

  std::uint64_t key() const { return (std::uint64_t{p} << 32) | q; }
  double slack_at(double share) const { return (1.0 - share) * slack + share * slack_after; }
};

/// Two parts of the surface, by their place in SelfMesh::part_begin, whose boxes meet.
struct PartedParts {
  std::uint32_t a, b;
  Direction across;  ///< 0 where no plane was found that parts them
  int wait;          ///< so many lists are made until one is sought again
};

/// All pairs of patches that may come near each other from one time to another, while what each span holds
/// strays from its way by no more than its margin.
///
/// Between accepted states a vertex moves straight, as its way is, and so strays no farther from it than it
/// does at one or the other in shares: what sleeps at both sleeps between them.
struct SelfList {
  double from = 0.0, to = kInfinite;  ///< times; where ways stay, any time is within
  std::vector<RodWay> ways;           ///< per rod; none where the list is for one state
  std::vector<double> margin;         ///< per span
  std::vector<SelfGroup> groups;
  std::vector<PartedParts> parts;  ///< ascending
  /// Per rod: groups with a patch of its, [begin[rod], begin[rod + 1]) of of_rod.
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> of_rod;
  /// Within which of its way nothing comes near and the list holds.
  std::vector<double> room;      ///< per span
  std::vector<double> rod_room;  ///< per rod, the least of its spans

  std::span<const std::uint32_t> with(std::size_t rod) const {
    return std::span(of_rod).subspan(begin[rod], begin[rod + 1] - begin[rod]);
  }
  bool stays() const { return to == kInfinite; }
  bool holds_at(double time) const { return stays() || (time >= from && time <= to); }
  double share(double time) const { return stays() ? 0.0 : (time - from) / (to - from); }
};

/// A vertex of the mesh and a face, or two edges.
struct SelfPair {
  std::uint32_t first, second;
};
/// Of two patches, what is near each other.
struct SelfPairs {
  std::vector<SelfPair> faces, edges;
};

/// Vertices that are placed, by their index in the mesh.
struct PlacedVertices {
  std::span<const Vec3> at;
  std::span<const std::uint32_t> slot;  ///< of a vertex, in `at`

  const Vec3& operator[](std::uint32_t vertex) const { return at[slot[vertex]]; }
};

/// What an evaluation needs room for: to have it made by each would cost more than what is in it.
struct SelfScratch {
  std::vector<CurvePair> now, before, rates;  ///< per rod; where it is not asked for, of any time
  std::vector<std::uint32_t> slot;            ///< per vertex; likewise
};

/// Ascending, each once.
inline void sort_once(std::vector<std::uint32_t>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

struct SelfModel {
  SelfModel(ContactSurface surface, const Law& law, Meets which);

  ContactSurface surface;
  Law law;
  Meets which;
  SelfMesh mesh;
  std::vector<std::vector<std::uint32_t>> spans_of;    ///< per rod
  std::vector<std::vector<std::uint32_t>> patches_of;  ///< per rod: what its spans hold a part of
  std::vector<std::vector<std::uint32_t>> rods_of;     ///< per patch, ascending
  std::vector<LocalGain> span_gain;                    ///< per span
  std::vector<double> patch_size;  ///< per span: the largest diagonal of its patches, at rest
  std::vector<SpanGain> rod_gain;  ///< per rod: the largest of its spans
  std::vector<double> rod_reach;   ///< likewise

  bool barrier() const { return law.kind == Law::Kind::barrier; }
  const RodPoints& points() const { return *surface.points; }
  std::size_t rods() const { return points().rods().size(); }
  double thick() const { return 2.0 * surface.skin; }
  double meets() const { return thick() + law.range; }

  std::unique_ptr<SelfScratch> take_scratch() const;
  void give_back(std::unique_ptr<SelfScratch> scratch) const;

  CurvePair curve(std::size_t rod, Points p, Points arm) const;
  /// \param from, to  its curves there and after what changes
  RodWay way(std::size_t rod, const CurvePair& from, const CurvePair& to, RodWay masses) const;
  /// Of a rod that stays.
  RodWay stay(std::size_t rod, const CurvePair& there, Points p, Points arm) const;
  /// How far what a rod holds is from its way at most, by its masses alone: 0.1 us.
  double coarse_motion(std::size_t rod, const RodWay& way, double share, Points p, Points arm) const;
  /// The same for each of its spans, by masses nearby; `motions` are those of all spans. 0.3 us.
  void local_motions(std::size_t rod, const RodWay& way, double share, Points p, Points arm,
                     std::span<double> motions) const;
  /// And by curves. Some us.
  void motions(std::size_t rod, const RodWay& way, double share, const CurvePair& now,
               std::span<double> motions) const;
  /// Of a patch: a blended vertex moves as a mean of the points it is made of.
  double of_patch(std::uint32_t patch, std::span<const double> motions) const {
    double most = 0.0;
    for (std::size_t i = mesh.spans_begin[patch]; i < mesh.spans_begin[patch + 1]; ++i)
      most = std::max(most, motions[mesh.spans_of[i]]);
    return most;
  }

  /// Fills in the groups of a list: pairs of patches nearer, somewhere on their way, than where response
  /// begins and both margins.
  /// \param at, after  all vertices at the beginning and the end; the same where they stay
  /// \param before  a list to take planes from that part what they parted; null where there is none
  void search(std::span<const Vec3> at, std::span<const Vec3> after, const SelfList* before,
              SelfList& list) const;
  /// What of two patches is within `far` of each other.
  SelfPairs pairs(const SelfGroup& group, const PlacedVertices& at, double far) const;
  double distance(const SelfPair& vertex_and_face, const PlacedVertices& at) const;
  double edge_distance(const SelfPair& edges, const PlacedVertices& at) const;

  std::vector<Vec3> place(std::span<const CurvePair> pairs) const;
  /// Two places of one part that rest this near each other are left out.
  double left_out(double first_side, double second_side) const {
    return std::max(1.5 * meets(), first_side + second_side);
  }

 private:
  double far_at_most(std::size_t span, const RodWay& way, double share, const CurvePair& now) const;

  std::vector<std::uint32_t> all_;  ///< vertices

  mutable std::mutex lock_;  ///< of what follows: a force is evaluated by several threads
  mutable std::vector<std::unique_ptr<SelfScratch>> scratch_;
};

/// What is within the range of each other at a state.
struct SelfInRange {
  SelfPairs pairs;
  std::vector<std::uint32_t> vertices;               ///< of these, ascending
  std::vector<std::uint32_t> rods;                   ///< that they are bound to, ascending
  std::vector<std::vector<std::uint32_t>> together;  ///< rods of a pair, ascending; each once
};
SelfInRange in_range(const SelfModel& model, SelfPairs pairs);

}  // namespace tendril::contact
