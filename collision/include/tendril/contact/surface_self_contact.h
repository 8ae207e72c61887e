#pragma once

#include <tendril/contact/surface_contact.h>

namespace tendril::contact {

/// Two places of a surface in contact with each other, at an accepted state: a vertex and a triangle, or two
/// edges.
struct SelfTouch {
  std::array<std::uint32_t, 2> triangle;  ///< index of one that the first place is on, and the second
  double gap;                             ///< between the two skins [length]
  Vec3 point;                             ///< half way
  Vec3 normal;                            ///< from the second to the first, unit
  Vec3 force;                             ///< on the first, friction included
  Vec3 friction;                          ///< of it, across the normal
  bool sticks;                            ///< friction below mu N
};

/// What contact was at the last accepted state, and what it has done so far: found in State::memory under
/// the force's index.
struct TENDRIL_CONTACT_API SurfaceSelfMemory : ForceMemory {
  std::vector<SelfTouch> touches;  ///< vertices first, then edges
  double friction_work = 0.0;      ///< that friction has done on the surface, by the trapezoidal rule
  long begun = 0;                  ///< contacts of two places that began
  long looked_at = 0;              ///< pairs whose distance was taken, from step to step
  long searches = 0;               ///< for pairs that are near each other
  long placed = 0;                 ///< vertices deformed, from step to step
};

/// What of a surface meets what.
enum class Meets {
  all,          ///< parts each other, and each itself
  other_parts,  ///< parts each other alone: no fold is felt, and leaves that do not fold cost less
};

struct SelfModel;  ///< the surface as vertices, edges and triangles, in patches

/// Contact of a bound mesh with itself: of its parts with each other (what edges connect is a part) and of
/// each with itself. What meets are vertices with triangles and edges with edges, as in [Li et al. 2020]:
/// with d their distance, both skins off it, b of Law, A a third of the area at rest of the triangles about a
/// vertex or an edge, the potential is kappa times the sum of
///   A_x / 4 ( sum_faces b - sum_edges (k - 1) b + sum_vertices (1 - faces + sum_edges (k - 1)) b )
/// over vertices x, the sums over what of the surface is within the range of x, k an edge's faces among it;
/// and of m B^2 / (16 (B + range (2 skin + range))) b over pairs of edges, B = A_e + A_f. The first counts
/// the nearest place once, be it on a face, an edge or a vertex, and is smooth beside folds; two flat sheets
/// have about kappa b per area in all. m is 1, and goes to 0 with the angle between edges below 1.8 degrees
/// [Li et al. 2020] 4: their ends keep those apart. So no triangle comes nearer to another than both skins.
/// Where triangles are small, at a leaf's tip, so is what a barrier can stop: see Law::stiffness.
///
/// Left out are two places of one part that rest nearer than 1.5 times the distance at which they would meet,
/// or than the sum of the longest sides there: the two sides of a leaf, and what a fold cannot be sharper
/// than.
///
/// Between accepted steps vertices move straight; a state that a barrier cannot be in, or could not have
/// come to, is refused. Linear momentum is kept, angular momentum but for friction, which acts on either
/// side where it is, not where the skins meet.
///
/// Vertices are deformed only where something is near. Now and then patches of some 16 triangles that could
/// meet are sought, for some steps: each vertex is taken to go on straight as it did in the last, and a plane
/// that parts two patches at the beginning and the end of that way parts them all the way. They are looked at
/// where bounds on how far what parts of spans of curve-pairs hold is from its way (by masses nearby, then by
/// curves, with what frames turn) let them have come within the range.
///
/// Cost: of an evaluation some 0.2 us a curve-pair, some us for each that may have come near another, and
/// what is near; of a search, every two to sixty steps by how evenly things move, two updates of the mesh and
/// some 0.1 us a triangle.
/// Implicit steps and equilibria take differences, by all nodes of the rods that hold what is in the range,
/// of what is there alone.
class TENDRIL_CONTACT_API SurfaceSelfContact final : public Force {
 public:
  /// Throws InvalidInput for numbers and indices out of range, and a mesh without area.
  /// \param surface  that meets itself; parts are kept apart by twice its skin
  /// \param law      its stiffness is per area
  /// \param which    of its parts
  SurfaceSelfContact(ContactSurface surface, const Law& law, Meets which = Meets::all);
  ~SurfaceSelfContact() override;

  void add(const StateView& state, const Loads& loads) const override;
  Couplings couplings(std::span<const NodeRange> rods) const override;
  void check(std::span<const NodeRange> rods) const override;
  bool has_energy() const override;
  double energy(const StateView& state) const override;
  bool refuses() const override;
  bool depends_on_time() const override { return false; }
  bool twists() const override { return true; }
  /// Throws InvalidInput where a barrier is closed at the start.
  std::shared_ptr<const ForceMemory> remember(
      const StateView& state, const std::shared_ptr<const ForceMemory>& before) const override;

 private:
  std::unique_ptr<const SelfModel> model_;
};

}  // namespace tendril::contact
