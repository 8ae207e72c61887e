#pragma once

#include <tendril/contact/body_contact.h>

#include <cstdint>
#include <optional>

#include "contact/by_key.h"
#include "contact/response.h"
#include "contact/solids.h"

namespace tendril::contact {

/// A ball of a free body.
struct BodyPoint {
  std::size_t collider;  ///< that it belongs to
  ShapePoint at;
  double weight;
};

/// What two solids had in common at the last accepted state: friction pulls by how far the points of both
/// that met there have come apart since, and by what it pulled then.
struct Meeting {
  std::uint64_t key;         ///< point times the number of colliders, plus the other collider
  Vec3 on_first, on_second;  ///< where they met, in the frames of both
  Vec3 pulled;               ///< what they had come apart by then, in the frame of the second
};

struct BodyLedger final : BodyMemory {
  std::vector<Placement> placed;  ///< per collider
  std::vector<Meeting> meetings;  ///< ascending
};

/// A point of a free body in the range of another solid.
struct BodyContactPoint {
  Nearness near;  ///< `point` is of the model
  Vec3 surface;   ///< of the first body, where it is nearest to the second
  Response response;
  std::uint64_t key;
  Vec3 apart;  ///< what the surfaces have come apart by, that friction pulls with
};

/// A free body and what it may meet: points [begin, end) of the first, with the second.
struct BodyPair {
  std::size_t first, second;  ///< colliders
  std::size_t begin, end;     ///< of the points
};

/// How far a solid moved since the last accepted state: its origin, and what it turned by as |R - R'|, the
/// farthest that a point at 1 of the origin was carried.
struct Moved {
  double way, turn;
};

struct BodyModel {
  BodyModel(std::vector<Collider> colliders, const Law& law);

  Law law;
  Solids colliders;
  std::vector<BodyPoint> points;
  std::vector<double> reach;    ///< per collider: of its points, balls included, from its origin; 0 without
  std::vector<BodyPair> pairs;  ///< that may meet

  bool barrier() const { return law.kind == Law::Kind::barrier; }
  /// How a point is to a collider.
  Nearness nearness(std::size_t point, std::size_t collider, const std::vector<Placement>& placed) const;
  bool reachable(const BodyLedger& kept, const Nearness& near) const;
  BodyContactPoint touch(const std::vector<Placement>& placed, const BodyLedger* kept,
                         const Nearness& near) const;

  /// Calls visit(BodyContactPoint) for all in range; what a barrier cannot let be, and ends there.
  template <class Visit>
  std::optional<Nearness> each_touch(const std::vector<Placement>& placed, const BodyLedger* kept,
                                     Visit&& visit) const {
    const std::vector<Moved> moved = barrier() && kept ? moved_since(*kept, placed) : std::vector<Moved>{};
    for (const BodyPair& pair : pairs) {
      if (far(pair, placed, moved)) continue;
      for (std::size_t point = pair.begin; point < pair.end; ++point) {
        const Nearness near = nearness(point, pair.second, placed);
        if (barrier() && (!(near.gap > 0.0) || (kept && !reachable(*kept, near)))) return near;
        if (near.gap < law.range) visit(touch(placed, kept, near));
      }
    }
    return {};
  }

 private:
  void add_points(std::size_t collider);
  void add_pairs(std::size_t collider);
  std::vector<Moved> moved_since(const BodyLedger& kept, const std::vector<Placement>& placed) const;
  /// Whether no point of the pair is in range, or has met anything on its way since then.
  /// \param moved  empty where it does not matter
  bool far(const BodyPair& pair, const std::vector<Placement>& placed, const std::vector<Moved>& moved) const;
  Vec3 slid_since(const BodyLedger& kept, const std::vector<Placement>& placed, const Nearness& near,
                  const Vec3& surface) const;
};

}  // namespace tendril::contact
