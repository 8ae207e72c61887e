#pragma once

#include <tendril/contact/collider.h>
#include <tendril/contact/law.h>

#include <memory>
#include <vector>

namespace tendril::contact {

/// Two solids in contact at an accepted state.
struct BodyTouch {
  std::size_t first;   ///< index of the collider that a point belongs to, a free body
  std::size_t second;  ///< of the one it meets
  double gap;          ///< between the two surfaces [length]
  Vec3 point;          ///< where they are nearest
  Vec3 normal;         ///< away from the second, unit
  Vec3 force;          ///< on the first, friction included
  Vec3 friction;       ///< of it
  bool sticks;         ///< friction below mu N
};

/// What contact was at the last accepted state: found in State::memory under the force's index.
struct TENDRIL_CONTACT_API BodyMemory : ForceMemory {
  std::vector<BodyTouch> touches;  ///< by point and collider
};

struct BodyModel;  ///< colliders, and the points of those that are free

/// Contact of free bodies with other solids, free, driven or fixed. A free body is met at its points
/// (Shape::points): what is round at any solid; what has edges at half spaces, and by points of what is
/// round. Weight 1 is the length 2 r of a round point of radius r, or the range where r is 0, so that the
/// potential of a gap is that length times kappa b.
///
/// Nothing passes a barrier, as for rods. Friction acts at the surface: what rolls is held by no friction,
/// what slides is turned by it.
///
/// Cost: points times solids an evaluation, some 20 ns each where they are apart.
class TENDRIL_CONTACT_API BodyContact final : public Force {
 public:
  /// Throws InvalidInput for numbers out of range, and for a free body with edges beside anything but half
  /// spaces and free bodies that are round.
  /// \param colliders  at least one of them a free body
  /// \param law        of them all
  BodyContact(std::vector<Collider> colliders, const Law& law);
  ~BodyContact() override;

  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange> rods) const override;
  Couplings couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const override;
  bool has_energy() const override;
  double energy(const StateView& state) const override;
  bool refuses() const override;
  bool depends_on_time() const override;
  std::vector<double> breaks() const override;
  /// Throws InvalidInput where a barrier is closed at the start.
  std::shared_ptr<const ForceMemory> remember(
      const StateView& state, const std::shared_ptr<const ForceMemory>& before) const override;

 private:
  std::unique_ptr<const BodyModel> model_;
};

}  // namespace tendril::contact
