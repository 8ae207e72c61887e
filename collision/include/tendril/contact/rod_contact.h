#pragma once

#include <tendril/base/export.h>
#include <tendril/contact/collider.h>
#include <tendril/contact/law.h>
#include <tendril/dynamics/force.h>

#include <memory>
#include <vector>

namespace tendril::contact {

/// A rod that is round about the chain of its masses.
struct ContactRod {
  std::size_t rod;         ///< its index in the scene
  double radius;           ///< positive [length]
  std::vector<Vec3> rest;  ///< where its masses rest
};

/// A point of a rod's line in contact with a solid, at an accepted state.
struct Contact {
  std::size_t rod;    ///< index in the scene
  std::size_t node;   ///< of its masses: the point is p_node + fraction (p_(node + 1) - p_node)
  double fraction;    ///< in [0, 1]
  std::size_t solid;  ///< index of the collider
  double gap;         ///< between the two surfaces [length]
  Vec3 point;         ///< on the rod's line
  Vec3 normal;        ///< away from the solid, unit
  Vec3 force;         ///< on the rod, friction included
  Vec3 friction;      ///< of it, across the normal
  bool sticks;        ///< friction below mu N
};

/// What contact was at the last accepted state, and what it has done so far: found in State::memory under
/// the force's index.
struct TENDRIL_CONTACT_API ContactMemory : ForceMemory {
  std::vector<Contact> contacts;  ///< by rod, point and collider
  double friction_work = 0.0;     ///< that friction has done on the rods, by the trapezoidal rule
  long begun = 0;                 ///< contacts of a point and a collider that began
  long looked_at = 0;             ///< points whose distance was taken, from step to step
};

struct RodModel;  ///< rods and colliders, laid out in points

/// Contact of rods with solids, along a line: every rod is followed by points so close that what bends
/// outward by R enters between two of them by at most range / 40, and the gap is taken smaller by that. So no
/// part of a rod that is stretched by less than a quarter touches a solid while all points keep off it. The
/// potential of a point of weight w (its share of the rod's length) is w kappa b(phi - radius).
///
/// Between accepted steps points are taken to move straight in the solid's frame; a state that a barrier's
/// point cannot reach without touching is refused, at whatever speed. Friction holds every point by a spring
/// to its own point of the solid, which moves along where the spring pulls by more than mu N: what sticks
/// does not creep.
///
/// Cost of an evaluation: some ns an edge where nothing is near (what was a gap less what has moved since),
/// some 50 ns a point within reach of a solid.
class TENDRIL_CONTACT_API RodContact final : public Force {
 public:
  /// Throws InvalidInput for numbers out of range, a shape missing, and a tube too narrow for a rod.
  /// \param rods       that meet the solids
  /// \param colliders  at least one
  /// \param law        of them all
  RodContact(std::vector<ContactRod> rods, std::vector<Collider> colliders, const Law& law);
  ~RodContact() override;

  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange> rods) const override;
  Couplings couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const override;
  void check(std::span<const NodeRange> rods) const override;
  bool has_energy() const override;
  double energy(const StateView& state) const override;
  bool refuses() const override;
  bool depends_on_time() const override;
  std::vector<double> breaks() const override;
  /// Throws InvalidInput where a barrier is closed at the start.
  std::shared_ptr<const ForceMemory> remember(
      const StateView& state, const std::shared_ptr<const ForceMemory>& before) const override;

 private:
  std::unique_ptr<const RodModel> model_;
};

}  // namespace tendril::contact
