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

/// What is remembered besides what is told.
struct SelfLedger final : SurfaceSelfMemory {
  SelfPose pose;
  SelfNodes nodes;
  std::shared_ptr<const SelfList> list;
  std::vector<double> since_search;   ///< how far what each span holds moved at most
  std::vector<double> slack;          ///< per group
  PairSlacks pair_slack;              ///< of its pairs
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
  /// \param curves  whether they are wanted even where nothing is near
  PosedSelf(const SelfModel& model, const StateView& state, const SelfLedger* kept, bool curves = false);

  /// False where its curves cannot be computed.
  bool sound() const { return sound_; }
  std::vector<CurvePair>& pairs() { return pairs_; }
  const SelfList& list() const { return *list_; }
  std::shared_ptr<const SelfList> share_list() const { return list_; }
  /// Groups of the list in which something could have come within the range.
  std::span<const std::uint32_t> awake() const { return awake_; }
  /// How far the vertices of a group moved at most since the ledger was kept, both patches' together.
  double moved(const SelfGroup& group) const;

  /// The vertices of awake groups, ascending, and where they are.
  std::span<const std::uint32_t> vertices() const { return vertices_; }
  const Vec3& at(std::uint32_t vertex) const { return now_[slot_[vertex]]; }
  std::size_t slot(std::uint32_t vertex) const { return slot_[vertex]; }
  /// Where they were when the ledger was kept.
  const Vec3& before(std::uint32_t vertex);
  const Vec3& velocity(std::uint32_t vertex);
  /// Bounds since the ledger was kept, per span; none at the start.
  const std::vector<double>& motions() const { return motions_; }

 private:
  bool nothing_near();
  void choose_list();
  void wake();
  void place();

  const SelfModel& model_;
  const StateView& state_;
  const SelfLedger* kept_;
  bool sound_ = true;
  std::vector<CurvePair> pairs_;
  std::vector<double> motions_;
  std::shared_ptr<const SelfList> list_;
  bool fresh_ = false;  ///< the list was made here
  std::vector<std::uint32_t> awake_, vertices_, slot_;
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
  std::vector<SelfResponse> all;     ///< vertices with faces, then edges
  std::optional<SelfClosed> closed;  ///< then `all` says nothing
  long looked_at = 0;
};
SelfMeetings meetings_of(const SelfModel& model, PosedSelf& surface, const SelfLedger* kept);

}  // namespace tendril::contact
