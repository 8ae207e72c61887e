#pragma once

#include <tendril/base/export.h>
#include <tendril/contact/collider.h>
#include <tendril/contact/law.h>
#include <tendril/dynamics/rod_points.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace tendril::contact {

/// The surface of a mesh that follows the curve-pairs of rods, and what it is thick.
struct ContactSurface {
  std::shared_ptr<const RodPoints> points;              ///< its vertices; not null
  std::vector<Vec3> rest;                               ///< where they rest
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of indices into them
  double skin;  ///< solids are kept off the triangles by this; positive [length]
};

/// A point of a surface in contact with a solid, at an accepted state.
struct SurfaceTouch {
  std::uint32_t triangle;       ///< index
  std::array<double, 3> share;  ///< of the triangle's corners: the point is sum share_i corner_i
  std::size_t solid;            ///< index of the collider
  double gap;                   ///< between the solid and the skin [length]
  Vec3 point;                   ///< on the triangle
  Vec3 normal;                  ///< away from the solid, unit
  Vec3 force;                   ///< on the surface, friction included
  Vec3 friction;                ///< of it, across the normal
  bool sticks;                  ///< friction below mu N
};

/// What contact was at the last accepted state, and what it has done so far: found in State::memory under
/// the force's index.
struct TENDRIL_CONTACT_API SurfaceMemory : ForceMemory {
  std::vector<SurfaceTouch> touches;  ///< by point and collider
  double friction_work = 0.0;         ///< that friction has done on the surface, by the trapezoidal rule
  long begun = 0;                     ///< contacts of a point and a collider that began
  long placed = 0;                    ///< vertices deformed, from step to step
};

struct SurfaceModel;  ///< the surface as points, in patches, and colliders

/// Contact of a bound mesh with solids: its triangles are followed by points so close, that what bends
/// outward by R enters a triangle between them by at most range / 32, and the gap is taken smaller by that:
/// with h the longest side of the triangles between points, h^2 / (6 (R + skin)), since the distance phi of
/// a ball about a point has second derivatives of at most 1 / phi. So no part of a triangle whose sides are
/// at most twice as long as at rest touches a solid while all points keep off it. The potential of a point
/// of weight w (its share of the surface's area at rest) is w kappa b(phi - skin).
///
/// Forces on points are forces on vertices, by their shares; these become loads on masses and torques on
/// their frames that do the same work (LoadedPoints::pull_back, RodCurves::add_loads). What cannot be reached
/// straight without touching is refused, as in RodContact, and friction holds points as there.
///
/// Vertices are deformed only where a solid could be near: in patches, by the convex hulls of the control
/// points that they depend on, at this state and the last accepted one, widened by how far off the curves the
/// vertices are. Where nothing is near, an evaluation costs some 2 ns a node and collider.
///
/// Implicit steps and equilibria take differences, by all nodes of the rods that hold what is in the range of
/// a solid.
class TENDRIL_CONTACT_API SurfaceContact final : public Force {
 public:
  /// Throws InvalidInput for numbers out of range, indices out of range, a shape missing, a tube too narrow
  /// for the skin, and more than 10^7 points.
  /// \param surface    that meets the solids
  /// \param colliders  at least one
  /// \param law        of them all; its stiffness is per area
  SurfaceContact(ContactSurface surface, std::vector<Collider> colliders, const Law& law);
  ~SurfaceContact() override;

  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange> rods) const override;
  Couplings couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const override;
  void check(std::span<const NodeRange> rods) const override;
  bool has_energy() const override;
  double energy(const StateView& state) const override;
  bool refuses() const override;
  bool depends_on_time() const override;
  bool twists() const override { return true; }
  std::vector<double> breaks() const override;
  /// Throws InvalidInput where a barrier is closed at the start.
  std::shared_ptr<const ForceMemory> remember(
      const StateView& state, const std::shared_ptr<const ForceMemory>& before) const override;

 private:
  std::unique_ptr<const SurfaceModel> model_;
};

}  // namespace tendril::contact
