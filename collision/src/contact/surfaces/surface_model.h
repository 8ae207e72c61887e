#pragma once

#include <tendril/contact/surface_contact.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "contact/by_key.h"
#include "contact/kept_touch.h"
#include "contact/response.h"
#include "contact/solids.h"
#include "surface_points.h"

namespace tendril::contact {

/// What is remembered besides what is told: where everything was at the last accepted state, and how far it
/// may move before anything comes into the range of a solid.
struct SurfaceLedger final : SurfaceMemory {
  std::vector<Vec3> p;            ///< of all nodes of the surface's rods
  std::vector<CurvePair> pairs;   ///< of the surface
  std::vector<Placement> solids;  ///< per collider
  std::vector<SpanShape> shapes;  ///< of the spans
  /// By bounds that see no frames, per collider; by the vertices, per patch and collider.
  std::vector<double> slack, patch_slack;
  std::map<std::size_t, std::vector<Vec3>> vertices;  ///< of patches that were near
  std::vector<KeptTouch> kept;                        ///< by ascending key
};

inline const SurfaceLedger* surface_ledger_of(const ForceMemory* memory) {
  return static_cast<const SurfaceLedger*>(memory);
}

struct SurfaceModel {
  SurfaceModel(ContactSurface surface, std::vector<Collider> colliders, const Law& law);

  ContactSurface surface;
  Law law;
  Solids colliders;
  SurfacePoints laid;
  std::vector<double> round;   ///< per collider: a margin is that times the square of a point's side
  std::vector<double> gain;    ///< per curve-pair, see RodCurves::gain
  std::vector<double> widest;  ///< per collider: the largest margin of a point

  bool barrier() const { return law.kind == Law::Kind::barrier; }
  const RodPoints& points() const { return *surface.points; }
  /// By how much the gap of a point to a collider is taken smaller.
  double margin(const SurfacePoint& point, std::size_t collider) const {
    return round[collider] * point.side * point.side;
  }
  /// Positions of the nodes of the surface's rods.
  std::vector<Vec3> positions(const StateView& state) const;
};

/// A point of a patch that could be near a solid.
struct NearPoint {
  const Patch* patch;
  const LaidTriangle* triangle;
  const SurfacePoint* at;
  double moved;  ///< since the ledger was kept, at most, seen from the solid
  Nearness near;
};

/// Where to find a NearPoint again at another state.
struct PointInRange {
  const Patch* patch;
  const LaidTriangle* triangle;
  std::size_t collider;
  std::uint32_t point;
};
/// What is in the range of solids at a state, in the order in which it is met.
struct SurfaceInRange {
  std::vector<PointInRange> points;
  std::vector<bool> holds;  ///< per curve-pair: whether it holds one of them
};

/// The surface at a state, deformed where a solid could be near.
class PosedSurface {
 public:
  /// Which are looked at: all, or those that something could have come near since the ledger was kept.
  enum class Colliders { near, all };
  /// \param kept  null at the start
  PosedSurface(const SurfaceModel& model, const StateView& state, const SurfaceLedger* kept,
               Colliders which = Colliders::near);

  /// At a state beside one: nothing is looked for.
  /// \param near  what was in range there, kept by reference
  PosedSurface(const SurfaceModel& model, const StateView& state, const SurfaceLedger* kept,
               const SurfaceInRange& near);

  /// False where its curves cannot be computed.
  bool sound() const { return sound_; }
  const std::vector<CurvePair>& pairs() const { return pairs_; }
  const std::vector<Placement>& placed() const { return placed_; }
  long deformed() const { return deformed_; }

  /// Calls visit(NearPoint) for all points of triangles that could be in the range of a solid, or have been
  /// on their way; it returns false to end.
  template <class Visit>
  void each_near(Visit&& visit);

  /// What a solid is away from everything at least, by hulls of control points and how far vertices are from
  /// their curves: 0 or less says nothing.
  double apart(std::size_t collider) const;
  /// What a solid is away from a patch's triangles at least.
  double apart(const Patch& patch, std::size_t collider);
  /// How far points of each span moved in the frame of a solid since the ledger was kept, at most.
  std::vector<double> motions(std::size_t collider) const;
  static double of_patch(const Patch& patch, const std::vector<double>& motions);

  /// Vertices of a patch: where they are, were when the ledger was kept, and their velocities.
  const std::vector<Vec3>& vertices(const Patch& patch) { return found(patch).now; }
  const std::vector<Vec3>& vertices_before(const Patch& patch);
  const std::vector<Vec3>& velocities(const Patch& patch);
  /// Those deformed so far, by the index of their patch.
  std::map<std::size_t, std::vector<Vec3>> take_vertices();
  std::size_t index_of(const Patch& patch) const {
    return static_cast<std::size_t>(&patch - model_.laid.patches.data());
  }

 private:
  struct Found {
    std::vector<Vec3> now, before, velocity;
  };
  /// A triangle that could be near a solid, and how far its corners moved at most, seen from there.
  struct OfTriangle {
    const Patch* patch;
    const LaidTriangle* triangle;
    std::size_t collider;
    double moved;
    const std::vector<Vec3>& vertices;
  };
  template <class Visit>
  bool each_near(const Patch& patch, std::size_t collider, Visit& visit);
  template <class Visit>
  bool each_near(const OfTriangle& of, Visit& visit);
  bool still_far(std::size_t collider) const;
  bool far(const Patch& patch, std::size_t collider, const std::vector<double>& motions) const;
  Found& found(const Patch& patch);
  /// By how much a gap is smaller than a distance, at most.
  double reach_of(std::size_t collider) const { return model_.surface.skin + model_.widest[collider]; }
  /// How far vertices moved in the frame of a solid since the ledger was kept.
  std::vector<double> ways(const Patch& patch, std::size_t collider);
  NearPoint near_point(const OfTriangle& of, std::uint32_t point) const;

  const SurfaceModel& model_;
  const StateView& state_;
  const SurfaceLedger* kept_;
  bool sound_ = true;
  const SurfaceInRange* near_ = nullptr;  ///< of the state beside, or null
  std::vector<Placement> placed_;
  std::vector<std::size_t> awake_;  ///< colliders that something could be near
  std::vector<CurvePair> pairs_, rates_;
  std::map<std::size_t, Found> found_;
  long deformed_ = 0;
};

/// A triangle's centre, and the distance of its farthest corner from there.
struct AboutTriangle {
  Vec3 centre;
  double radius;
};
AboutTriangle about(const LaidTriangle& triangle, const std::vector<Vec3>& at);

template <class Visit>
void PosedSurface::each_near(Visit&& visit) {
  if (near_) {
    if (!sound_) return;
    for (const PointInRange& at : near_->points)
      if (!visit(near_point({at.patch, at.triangle, at.collider, 0.0, vertices(*at.patch)}, at.point)))
        return;
    return;
  }
  std::vector<std::vector<double>> moved;
  for (const std::size_t c : awake_) moved.push_back(motions(c));
  for (const Patch& patch : model_.laid.patches)
    for (std::size_t k = 0; k < awake_.size(); ++k)
      if (!far(patch, awake_[k], moved[k]) && !each_near(patch, awake_[k], visit)) return;
}

/// A triangle that is farther than the range and than its corners have moved has no part in it.
template <class Visit>
bool PosedSurface::each_near(const Patch& patch, std::size_t c, Visit& visit) {
  const std::vector<Vec3>& at = vertices(patch);
  const contact::Shape& shape = *model_.colliders[c].shape;
  const std::vector<double> moved = ways(patch, c);
  for (const LaidTriangle& triangle : patch.triangles) {
    const auto& [i, j, k] = triangle.corner;
    const auto [centre, radius] = about(triangle, at);
    const double enough = std::max({model_.law.range, moved[i], moved[j], moved[k]}) + reach_of(c) + radius;
    if (shape.distance(placed_[c].to_local(centre)) > enough * (1.0 + 1e-12)) continue;
    if (!each_near({&patch, &triangle, c, std::max({moved[i], moved[j], moved[k]}), at}, visit)) return false;
  }
  return true;
}

/// Along a row distances change by no more than points are apart: where one is far, others are passed over.
template <class Visit>
bool PosedSurface::each_near(const OfTriangle& of, Visit& visit) {
  const LaidTriangle& triangle = *of.triangle;
  const double apart =
      (of.vertices[triangle.corner[2]] - of.vertices[triangle.corner[0]]).norm() / triangle.parts;
  const double enough = std::max(model_.law.range, of.moved);
  std::uint32_t point = triangle.first;
  for (std::uint32_t row = 0; row < triangle.rows(); ++row) {
    const std::uint32_t end = point + triangle.in_row(row);
    while (point < end) {
      const NearPoint at = near_point(of, point);
      if (!visit(at)) return false;
      const double free = (at.near.gap - enough) * (1.0 - 1e-9);
      const double skipped = free > apart ? std::floor(free / apart) : 0.0;
      point = skipped < end - point ? point + 1 + static_cast<std::uint32_t>(skipped) : end;
    }
    point = end;
  }
  for (; point < triangle.end; ++point)
    if (!visit(near_point(of, point))) return false;
  return true;
}

}  // namespace tendril::contact
