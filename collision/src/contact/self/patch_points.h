#pragma once

#include <tendril/collision/box_tree.h>

#include <array>

#include "self_mesh.h"

namespace tendril::contact {

/// A direction, near enough of length 1; 0 where none is known.
using Direction = std::array<float, 3>;

/// Corners of patches at a state: boxes about them, and what single precision makes of the way to each from
/// the patch's first, one coordinate after the other, so that loops over them are vector code.
class PatchPoints {
 public:
  /// \param mesh  kept by reference
  /// \param at    of all vertices, kept by reference
  PatchPoints(const SelfMesh& mesh, std::span<const Vec3> at);

  const collision::Box& box(std::size_t patch) const { return boxes_[patch]; }
  const std::vector<collision::Box>& boxes() const { return boxes_; }

  /// How far patch q lies behind patch p along n, or less.
  struct Along {
    double apart;
    std::uint32_t of_p, of_q;  ///< the corners that say so
  };
  Along along(std::size_t p, std::size_t q, const Direction& n) const;
  /// The same without the corners.
  double apart(std::size_t p, std::size_t q, const Direction& n) const;

  Vec3 middle(std::size_t patch) const { return 0.5 * (boxes_[patch].low + boxes_[patch].high); }

 private:
  /// What is to be added to the difference of what both reach along n.
  double between(std::size_t p, std::size_t q, const Direction& n) const;
  double surely(std::size_t p, std::size_t q, double apart) const;

  const SelfMesh& mesh_;
  std::span<const Vec3> at_;
  std::vector<collision::Box> boxes_;
  std::vector<float> x_, y_, z_;
};

}  // namespace tendril::contact
