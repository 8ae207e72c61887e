#pragma once

#include <tendril/contact/rod_contact.h>

#include <array>

namespace tendril::contact {

/// Two nodes at one place, where rods are joined: what is near it along the rods is no contact.
struct RodJoint {
  std::array<std::size_t, 2> rod;   ///< indices in the scene
  std::array<std::size_t, 2> node;  ///< one of each
};

/// Two points of rods' lines in contact, at an accepted state.
struct RodTouch {
  std::array<std::size_t, 2> rod;   ///< indices in the scene; the same where a rod meets itself
  std::array<std::size_t, 2> node;  ///< of their masses: points are p_node + fraction (p_(node + 1) - p_node)
  std::array<double, 2> fraction;   ///< in [0, 1]
  double gap;                       ///< between the two surfaces [length]
  Vec3 point;                       ///< between them
  Vec3 normal;                      ///< from the second to the first, unit
  Vec3 force;                       ///< on the first, friction included
  Vec3 friction;                    ///< of it
  bool sticks;                      ///< friction below mu N
};

/// What contact was at the last accepted state, and what it has done so far: found in State::memory under
/// the force's index.
struct TENDRIL_CONTACT_API RodRodMemory : ForceMemory {
  std::vector<RodTouch> touches;  ///< by the points of the first, then of the second
  double friction_work = 0.0;     ///< that friction has done on the rods, by the trapezoidal rule
  long begun = 0;                 ///< contacts of two points that began
  long looked_at = 0;             ///< pairs of points whose distance was taken, from step to step
  long searches = 0;              ///< for edges that are near each other
};

struct PairModel;  ///< rods laid out in points, and which pairs of them are left out

/// Contact of rods with each other and with themselves, along their lines: with b of Law, the potential is
/// kappa / l times the sum over pairs of points x, y of w_x w_y b(|x - y| - r_x - r_y - m), w a point's share
/// of its rod's length, l = sqrt(2 (r_x + r_y) range), about half of what is near a point of a parallel rod.
/// Points are h <= sqrt((r_x + r_y) range / 8) apart, and m = (h_x^2 + h_y^2) / (8 (r_x + r_y)), for edges
/// stretched by a quarter: of two segments between points, the ends that are nearest are never more than that
/// farther apart than the segments [README]. So no part of a rod comes into another while points keep off.
///
/// Left out are points whose way along the rods and through joints is shorter than pi / 2 times the distance
/// at which they would meet (a rod bent to a half circle is not in contact with itself before that), and
/// those within eight times that distance that rest nearer than one and a half.
///
/// Between accepted steps points move straight, as in RodContact; a state that a barrier cannot be in, or
/// could not have come to, is refused. Friction acts where the surfaces meet and turns rods: the scene keeps
/// its twist state. Linear and angular momentum are kept.
///
/// Implicit steps and equilibria couple the nodes between which rods touch; with friction, derivatives are
/// differences.
///
/// Cost of an evaluation: some ns an edge, some 5 ns a pair of edges that could be near, some 50 ns a pair of
/// points in contact; of a search, now and then, n log n.
class TENDRIL_CONTACT_API RodRodContact final : public Force {
 public:
  /// Throws InvalidInput for numbers out of range, and for joints of nodes that are not there.
  /// \param rods    that meet
  /// \param joints  of these rods
  /// \param law     of them all
  RodRodContact(std::vector<ContactRod> rods, const std::vector<RodJoint>& joints, const Law& law);
  ~RodRodContact() override;

  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange> rods) const override;
  void check(std::span<const NodeRange> rods) const override;
  bool has_energy() const override;
  double energy(const StateView& state) const override;
  bool refuses() const override;
  bool depends_on_time() const override { return false; }
  bool twists() const override;
  /// Throws InvalidInput where a barrier is closed at the start.
  std::shared_ptr<const ForceMemory> remember(
      const StateView& state, const std::shared_ptr<const ForceMemory>& before) const override;

 private:
  std::unique_ptr<const PairModel> model_;
};

}  // namespace tendril::contact
