#pragma once

#include <optional>

#include "self_model.h"

namespace tendril::contact {

/// What two places that touch have come apart by where they met, for friction to pull with.
struct SelfMeeting {
  std::uint64_t key;  ///< of a vertex and a face; of two edges, with the highest bit
  Vec3 apart;         ///< in the world
  Vec3 friction;      ///< on the first
};

/// What of two patches is near each other, and how near at the last accepted state.
struct NearGroup {
  std::uint64_t key;  ///< of the group
  std::shared_ptr<const SelfPairs> pairs;
  std::vector<double> faces,
      edges;    ///< slacks of the pairs: distance less that where response begins, or less
  double left;  ///< how far they may move before others are as near
};

/// What is remembered besides what is told.
struct SelfLedger final : SurfaceSelfMemory {
  double time = 0.0;
  std::vector<std::vector<Vec3>> p, arm;  ///< per rod: masses, and orientation masses less them
  std::shared_ptr<const SelfList> list;
  std::vector<std::uint32_t> awake;   ///< groups in which something could be within the range, ascending
  double steps = 0.0;                 ///< since the list was made
  std::vector<NearGroup> near;        ///< what was looked at last, by ascending key
  std::vector<SelfMeeting> meetings;  ///< by ascending key
  std::vector<std::uint32_t> known;   ///< vertices that were placed, ascending
  std::vector<Vec3> at;               ///< where they are
};

inline const SelfLedger* self_ledger_of(const ForceMemory* memory) {
  return static_cast<const SelfLedger*>(memory);
}

/// The surface at a state, deformed where something could be near.
class PosedSelf {
 public:
  /// \param kept  null at the start
  PosedSelf(const SelfModel& model, const StateView& state, const SelfLedger* kept);
  /// At a state beside one: no group is awake, and nothing is looked for.
  /// \param near  what was in range there, kept by reference
  PosedSelf(const SelfModel& model, const StateView& state, const SelfLedger* kept, const SelfInRange& near);
  ~PosedSelf() { model_.give_back(std::move(scratch_)); }
  PosedSelf(const PosedSelf&) = delete;
  PosedSelf& operator=(const PosedSelf&) = delete;

  /// False where its curves cannot be computed.
  bool sound() const { return sound_; }
  /// The list that was made here, for this state alone; null where that of the ledger holds.
  const SelfList* own_list() const { return own_.get(); }
  const SelfList& list() const { return own_ ? *own_ : *kept_->list; }
  /// Groups of the list in which something could have come within the range, ascending; and those in which it
  /// could be now.
  std::span<const std::uint32_t> awake() const { return awake_; }
  const std::vector<std::uint32_t>& woken() const { return woken_; }
  /// What the ledger knows of a group; null where it does not.
  const NearGroup* known(const SelfGroup& group) const;
  /// How far the vertices of a group moved at most since the ledger was kept, both patches' together.
  double moved(const SelfGroup& group);

  Points masses(std::size_t rod) const;
  const std::vector<Vec3>& arms(std::size_t rod) const { return arms_[rod]; }
  const CurvePair& curve(std::size_t rod);
  /// How a rod is bounded.
  enum class By : char { rod, masses, curves };
  By bounded(std::size_t rod) const { return bounded_[rod]; }
  /// How far what it holds is from its way at most, by its masses as a whole.
  double coarse(std::size_t rod) const { return coarse_[rod]; }
  /// The same of its spans, at least by this; those of other rods may say anything.
  std::span<const double> motions(std::size_t rod, By by);

  /// The vertices of awake groups, ascending, and where they are.
  std::span<const std::uint32_t> vertices() const { return vertices_; }
  PlacedVertices placed() const { return {now_, scratch_->slot}; }
  const Vec3& at(std::uint32_t vertex) const { return now_[slot(vertex)]; }
  std::size_t slot(std::uint32_t vertex) const { return scratch_->slot[vertex]; }
  /// Where they were when the ledger was kept.
  const Vec3& before(std::uint32_t vertex);
  const Vec3& velocity(std::uint32_t vertex);
  /// On the knots of all rods; those that no awake vertex is bound to are anywhere.
  std::span<const CurvePair> pairs() const { return scratch_->now; }

 private:
  bool stays(std::size_t rod);
  void look();
  bool within_margins(std::size_t rod) const;
  void wake(const std::vector<std::uint32_t>& moving);
  std::vector<std::uint32_t> rods_of(const std::vector<std::uint32_t>& groups) const;  ///< ascending
  void search();
  bool take_arms(std::size_t rod);
  void place_vertices();
  const CurvePair& kept_curve(std::size_t rod);
  void place();

  const SelfModel& model_;
  const StateView& state_;
  const SelfLedger* kept_;
  double share_ = 0.0;  ///< of the ways of the ledger's list
  bool sound_ = true;
  std::unique_ptr<SelfScratch> scratch_;
  std::vector<std::vector<Vec3>> arms_;  ///< of those looked at
  std::vector<char> made_;               ///< per rod: its curve
  std::vector<double> coarse_, motions_;
  std::vector<By> bounded_;  ///< per rod
  std::shared_ptr<const SelfList> own_;
  std::vector<std::uint32_t> awake_, woken_, concerned_, vertices_;  ///< concerned_: rods of awake groups
  std::vector<Vec3> now_, before_, velocity_;
};

/// Places of the surface near each other.
struct SelfNear {
  std::array<std::uint32_t, 4> vertex;  ///< of the mesh
  std::array<double, 4> weight;         ///< apart = sum weight_i vertex_i
  std::size_t of_first;                 ///< so many of them are of the first
  std::array<std::uint32_t, 2> face;    ///< one that each is on
  std::uint64_t key;
  Vec3 apart;
  double distance;
  double area;  ///< A of the potential
};

/// What they do to each other.
struct SelfResponse {
  SelfNear at;
  double gap;
  Vec3 normal, force, friction;  ///< on the first
  bool sticks;
  Vec3 slid, apart;                ///< since the ledger was kept; what friction would pull with from here on
  std::array<Vec3, 4> by_angle{};  ///< forces on vertices besides, from how edges turn
  double energy;
};

/// Two places whose gap a barrier cannot let be.
struct SelfClosed {
  std::array<std::uint32_t, 2> face;
  double gap;
};

/// Everything within the range of each other.
struct SelfMeetings {
  std::vector<SelfResponse> all;  ///< vertices with faces, then edges
  SelfPairs pairs;                ///< all that are in the range: those of `all` and what is counted with them
  std::optional<SelfClosed> closed;  ///< then `all` says nothing
  long looked_at = 0;
};
SelfMeetings meetings_of(const SelfModel& model, PosedSelf& surface, const SelfLedger* kept);
/// The same as meetings_of, of pairs that are given.
SelfMeetings meetings_of(const SelfModel& model, PosedSelf& surface, const SelfLedger* kept,
                         const SelfPairs& pairs);

}  // namespace tendril::contact
